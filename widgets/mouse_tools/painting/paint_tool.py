"""PaintTool: what all ways of labelling points have in common, from a stroke to its change."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject
from typing_extensions import override

from processing.core.errors import UserError
from processing.core.text import Text
from processing.image.attributes.attributes import SHOWS_INTENSITY
from processing.labels.label_column import labels_of
from processing.labels.rules import PaintRule
from processing.map.change import Change
from processing.map.label_change import LabelChange, label_changes
from processing.recording.columns.classes import point_classes
from processing.recording.columns.counted_classes import class_columns, seen_points
from widgets.mouse_tools.mouse_tool import MouseTool
from widgets.mouse_tools.tracing import BackgroundRunner
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState

PaintedPoints = Mapping[str, NDArray[np.int64]]

NOTHING_THERE = Text("No point there gets another label.", "ラベルが変わる点はありません。")
_LABELLED = Text("{count:,} points: {name}", "{count:,}点: {name}")
_ERASED = Text("{count:,} points without label", "{count:,}点のラベルを消去")
_LABEL_POINTS = Text("Label points: {name}", "点のラベル: {name}")
ERASE = Text("Erase labels", "ラベルの消去")
_MANY_POINTS = 200_000
"""More than so many are worked on beside the window."""


@dataclass(frozen=True)
class Painted:
    """A stroke that is complete.

    Attributes
    ----------
    points : mapping of str to (n,) int64
        Drive id to the points below it.
    rule : PaintRule
        As it was then.
    hides_noise : bool
        Whether noise was hidden then: what isn't seen isn't painted.
    """

    points: PaintedPoints
    rule: PaintRule
    hides_noise: bool = False

    def changes(self, source: MapSource) -> tuple[LabelChange, ...]:
        """What it changes, as labels are now; drives that are gone are left out.

        Raises
        ------
        BadFile
            A drive's column of labels is damaged.
        """
        drives = {drive.id: drive for drive in source.drives()}
        made: list[LabelChange] = []
        for drive_id, points in self.points.items():
            if drive_id in drives:
                if (np.diff(points) <= 0).any():
                    points = np.unique(points)
                drive = drives[drive_id]
                points = seen_points(drive.columns, points, hides_noise=self.hides_noise)
                labels = labels_of(drive, points)
                chosen = self.rule.chosen(labels, class_columns(drive.columns).codes_of(points))
                made += label_changes(drive_id, points[chosen], labels[chosen], self.rule.code)
        return tuple(made)


def class_name(code: int) -> Text:
    """The name of a class; its number where the table has none."""
    found = next((one.name for one in point_classes() if one.code == code), None)
    return Text("Class {code}", "クラス {code}").filled(code=code) if found is None else found


@dataclass
class Stroke:
    """A stroke in the hand, or one that is being worked out.

    Attributes
    ----------
    chosen_before : dict of str to (n,) int64
        The points that were chosen before it; chosen again afterwards.
    is_whole : bool
        Whether the button went up.
    is_dropped : bool
        Whether nothing is to come of it.
    """

    chosen_before: dict[str, NDArray[np.int64]]
    is_whole: bool = False
    is_dropped: bool = False


class PaintTool(MouseTool):
    """Base of the ways of painting: shows the points of the stroke, and makes its change.

    While a stroke is drawn its points are the chosen ones, so that every view shows them; what was
    chosen before is chosen again afterwards.

    Parameters
    ----------
    in_background : BackgroundRunner
        Where long strokes are worked out.
    """

    def __init__(
        self,
        source: MapSource,
        shared: SharedState,
        in_background: BackgroundRunner,
        parent: QObject | None = None,
    ) -> None:
        super().__init__(parent)
        self._source = source
        self._shared = shared
        self._in_background = in_background
        self._stroke: Stroke | None = None
        self._edits = 0
        shared.map_changes.labels_changed.connect(self._on_map_labels_changed)

    @property
    @override
    def is_busy(self) -> bool:
        return self._stroke is not None

    @property
    def is_pressed(self) -> bool:
        """Whether a stroke is being drawn."""
        return self._stroke is not None and not self._stroke.is_whole

    @override
    def complete(self) -> None:
        """A stroke ends when the button goes up."""

    @override
    def step_back(self) -> None:
        self.put_down()

    @override
    def settle(self) -> None:
        if self.is_pressed:
            self.put_down()
        else:
            self._show_chosen()

    @override
    def put_down(self) -> None:
        if self._stroke is not None:
            self._stroke.is_dropped = True
        self._show_chosen()

    def _show_chosen(self) -> None:
        """Show again what was chosen before the stroke."""
        stroke, self._stroke = self._stroke, None
        if stroke is not None:
            self._shared.selection.choose_points(stroke.chosen_before)

    def _begin(self) -> None:
        """A stroke begins; over grey points its colours are shown from now on."""
        self.settle()
        self._stroke = Stroke(self._shared.selection.points)
        settings = self._shared.view_settings
        if settings.look.attribute in SHOWS_INTENSITY:
            settings.change_look(attribute="label")

    def _show_stroke(self, points: PaintedPoints) -> None:
        self._shared.selection.choose_points(dict(points))

    def _paint(self, points: PaintedPoints) -> None:
        """Give the points of a stroke the label that is on the brush."""
        if sum(one.size for one in points.values()) > _MANY_POINTS:
            self._paint_later(lambda: points)
            return
        painted = Painted(points, self._shared.labels.rule, self._hides_noise)
        try:
            self._ask_for(painted, painted.changes(self._source))
        except UserError as error:
            self.reported.emit(error.what)
        self._show_chosen()

    def _paint_later(self, points_of: Callable[[], PaintedPoints]) -> None:
        """The same with points that are found beside the window."""
        stroke, rule, hides_noise = self._stroke, self._shared.labels.rule, self._hides_noise
        if stroke is None:
            return
        stroke.is_whole = True
        self._work_out(stroke, lambda: Painted(points_of(), rule, hides_noise))

    def _work_out(self, stroke: Stroke, painted_of: Callable[[], Painted]) -> None:
        """Make the change of a stroke; again where labels changed while it was made."""
        edits = self._edits

        def work() -> tuple[Painted, tuple[LabelChange, ...]]:
            painted = painted_of()
            return painted, painted.changes(self._source)

        def take(result: object) -> None:
            if isinstance(result, tuple) and not stroke.is_dropped:
                if self._edits != edits:
                    self._work_out(stroke, painted_of)
                    return
                self._ask_for(*result)
            if self._stroke is stroke:
                self._show_chosen()

        self._in_background(work, take)

    @property
    def _hides_noise(self) -> bool:
        return self._shared.view_settings.look.hides_noise

    def _on_map_labels_changed(self) -> None:
        self._edits += 1

    def _ask_for(self, painted: Painted, changes: tuple[LabelChange, ...]) -> None:
        code = painted.rule.code
        if changes:
            name = _LABEL_POINTS.filled(name=class_name(code)) if code else ERASE
            self.change_requested.emit(name, Change(labels=changes))
            count = sum(one.count for one in changes)
            words = _LABELLED if code else _ERASED
            self.reported.emit(words.filled(count=count, name=class_name(code)))
        else:
            self.reported.emit(NOTHING_THERE)
