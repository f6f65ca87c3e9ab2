"""Wiring of the review: the queue, its panel, its keys, and the views that show each candidate."""

from __future__ import annotations

from dataclasses import replace

from PySide6.QtCore import QObject, Qt

from app.review.review import Review
from app.review.review_actions import QUEUE_KEYS
from app.review.run_comparing import RunComparing
from app.runs.process_actions import one_click_buttons
from app.window.project_dialogs import ProjectDialogs
from app.window.window_parts import WindowParts
from processing.map.catalogue import Geometry
from processing.map.feature import Feature, Status
from widgets.panels.geometry_facts import length_m
from widgets.shared.cursor import PickedPosition

QUEUE_ACTIONS = (*QUEUE_KEYS, "review-worst", "review-along", "review-end")
"""Actions that can be done only while a queue is open."""

_LEAST_IMAGE_ZOOM = 2.0
"""Screen pixels of a pixel of the image."""

_FARTHEST_M = 15.0
_LEAST_MAP_SCALE = 12.0
"""Screen pixels of a metre."""

_LEAST_SECTION_SCALE = 200.0
"""The same across a line or an area: a curb is a step of a few centimetres."""

_ROOM = 2.4
"""Heights of a tree, a pole or a sign's post that a section holds about its place: all is seen."""


_ROOM_ALONG = 1.2
"""Lengths of a wire that a section along it is wide."""


def connect_review(parts: WindowParts) -> None:
    """Connect the review with the widgets of a window; again for new ones."""
    wiring = _ReviewWiring(parts)
    review, panel = parts.of(Review), parts.review_panel
    review.shown.connect(wiring.on_review_shown)
    review.coming.connect(parts.camera_view.prepare)
    review.changed.connect(wiring.on_review_changed)
    review.edit_requested.connect(wiring.on_review_edit_requested)
    parts.document.shared.sketch.changed.connect(wiring.on_sketch_changed)
    panel.open_requested.connect(review.open)
    panel.order_requested.connect(review.put_in_order)
    panel.accept_requested.connect(review.accept)
    panel.reject_requested.connect(review.reject)
    panel.accept_line_requested.connect(review.accept_line)
    panel.reject_line_requested.connect(review.reject_line)
    panel.edit_requested.connect(review.edit)
    panel.next_requested.connect(review.next)
    panel.back_requested.connect(review.back)
    panel.accept_from_requested.connect(review.accept_from)
    panel.evaluation_requested.connect(wiring.on_panel_evaluation_requested)
    panel.processing_requested.connect(wiring.on_panel_processing_requested)
    panel.ask_count_from(review.count_from)
    parts.project_tree.review_requested.connect(wiring.on_tree_review_requested)
    comparing = RunComparing(parts, ProjectDialogs(parts))
    parts.project_tree.comparison_requested.connect(comparing.choose)
    parts.document.shared.view_settings.shows_rejected_changed.connect(
        wiring.on_settings_shows_rejected_changed
    )
    parts.document.shared.map_changes.candidates_found.connect(wiring.on_candidates_found)
    wiring.keep_keys_to_views()
    wiring.on_review_changed()


class _ReviewWiring(QObject):
    """What has to be translated between the queue and the window."""

    def __init__(self, parts: WindowParts) -> None:
        super().__init__(parts.window.centralWidget())  # goes with the widgets
        self._parts = parts
        self._edited = ""
        self._is_near = False
        self._framed: tuple[Geometry, bool] | None = None
        self._section_scales: tuple[float, ...] = ()
        self._hangs = False

    def keep_keys_to_views(self) -> None:
        """Enter and letters judge over the views and the queue only: in forms they are typed."""
        parts = self._parts
        for name in QUEUE_KEYS:
            action = parts.window.actions_by_id[name]
            action.setShortcutContext(Qt.ShortcutContext.WidgetWithChildrenShortcut)
            parts.window.removeAction(action)
            for widget in (*parts.views, parts.review_panel):
                widget.addAction(action)

    def on_review_shown(self, feature: Feature, position: PickedPosition) -> None:
        """Every view has the candidate in its middle; the section cuts through it."""
        if not self._is_near:
            self._is_near = True
            self._come_near()
        self._turn_section(hangs="sag_m" in feature.attributes)
        self._come_near_in_section(feature)
        self._show_its_image(position)
        camera, section = self._parts.camera_view, self._parts.section_view
        for view in self._parts.views:
            if view not in (camera, section):
                view.center_on(position)
        section.show_position(position, asks_lines=feature.geometry is not Geometry.POINT)
        camera.show_position(position)

    def _show_its_image(self, position: PickedPosition) -> None:
        """A candidate that the shown scanner didn't see is shown in the image of its own."""
        settings = self._parts.document.shared.view_settings
        if position.measured is None or position.measured.drive == settings.drive_id:
            return
        if self._parts.image_view.position_of(position) is None:
            kinds = self._parts.document.drive(position.measured.drive).image_kinds
            kind = settings.image_kind if settings.image_kind in kinds else kinds[0]
            settings.show_image(position.measured.drive, kind)

    def on_review_changed(self) -> None:
        review = self._parts.of(Review)
        self._parts.review_panel.show_review(review.progress, review.current, review.line_count)
        self._allow_keys()
        if not review.is_open:
            self._is_near, self._framed = False, None
            self._turn_section(hangs=False)
        current = review.current
        is_judged = current is None or current.status is not Status.CANDIDATE
        if self._edited and (current is None or is_judged or current.id != self._edited):
            # What was corrected is judged: the hand has the pointer again.
            self._edited = ""
            if self._parts.toolbox.name == "edit":
                self._parts.toolbox.choose("select")

    def on_review_edit_requested(self, feature: Feature) -> None:
        self._parts.document.shared.selection.choose_features(frozenset({feature.id}))
        self._parts.toolbox.choose("edit")
        self._edited = feature.id

    def on_sketch_changed(self) -> None:
        self._allow_keys()

    def on_settings_shows_rejected_changed(self) -> None:
        is_shown = self._parts.document.shared.view_settings.shows_rejected
        self._parts.window.actions_by_id["show-rejected"].setChecked(is_shown)

    def on_candidates_found(self, tool: str, run: str) -> None:
        """What was found by one click goes to the queue; the views stay where they are."""
        if tool not in one_click_buttons():
            return
        self._parts.window.show_panel("review")
        if self._parts.of(Review).is_open:
            self._parts.of(Review).add(run)

    def on_panel_processing_requested(self) -> None:
        self._parts.window.show_panel("processing")

    def on_panel_evaluation_requested(self) -> None:
        self._parts.window.show_panel("evaluation")

    def on_tree_review_requested(self, run: str) -> None:
        review = self._parts.of(Review)
        self._parts.window.show_panel("review")
        review.open((run,), review.progress.state.order)

    def _come_near(self) -> None:
        """Show what is judged large enough; later the operator's own zoom is kept."""
        image, scene, map_view = (
            self._parts.image_view,
            self._parts.scene_view,
            self._parts.map_view,
        )
        image.zoom_by(max(_LEAST_IMAGE_ZOOM / image.viewport.zoom_v, 1.0))
        scene.zoom_by(max(scene.camera.distance_m / _FARTHEST_M, 1.0))
        map_view.zoom_by(max(_LEAST_MAP_SCALE / map_view.viewport.scale, 1.0))

    def _turn_section(self, *, hangs: bool) -> None:
        """What hangs is looked at along: across it, a few points are all there is.

        Whoever has the section along anyway keeps it.
        """
        section = self._parts.section_view
        if hangs != self._hangs and (self._hangs or not section.settings.is_along):
            section.use_settings(replace(section.settings, is_along=hangs))
            self._hangs = hangs

    def _come_near_in_section(self, feature: Feature) -> None:
        """Lines are looked at from near; of trees, poles, signs and wires all is seen.

        Between candidates that are framed alike the operator's own zoom is kept.
        """
        panes = self._parts.section_view.panes
        is_chosen = tuple(pane.viewport.scale for pane in panes) != self._section_scales
        framed = feature.geometry, self._hangs
        if framed == self._framed and is_chosen:
            return
        high_m = feature.attributes.get("height_m")
        for pane in panes:
            scale = pane.viewport.scale
            if self._hangs:
                pane.zoom_by(pane.width() / (_ROOM_ALONG * length_m(feature)) / scale)
            elif feature.geometry is not Geometry.POINT:
                pane.zoom_by(max(_LEAST_SECTION_SCALE / scale, 1.0))
            elif isinstance(high_m, (int, float)) and high_m > 0:
                shown_m = pane.height() / pane.viewport.scale_y
                pane.zoom_by(min(shown_m / (_ROOM * high_m), _LEAST_SECTION_SCALE / scale))
        self._framed = framed
        self._section_scales = tuple(pane.viewport.scale for pane in panes)

    def _allow_keys(self) -> None:
        """While something is drawn, Enter and Delete belong to what is drawn."""
        parts = self._parts
        is_judging = parts.of(Review).is_open and not parts.toolbox.current_tool.is_busy
        for name in QUEUE_ACTIONS:
            is_key = name in QUEUE_KEYS
            allowed = is_judging if is_key else parts.of(Review).is_open
            parts.window.actions_made.allow(name, is_allowed=allowed)
