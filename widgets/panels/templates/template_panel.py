"""TemplatePanel: the project's templates; draw one, look how it lies, fit it along the street."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from PySide6.QtCore import Signal
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import QHBoxLayout, QLabel, QPushButton, QSizePolicy, QVBoxLayout, QWidget
from typing_extensions import override

from processing.core.errors import UserError
from processing.core.text import Language, Text
from processing.map.catalogue import FeatureKind, Geometry
from processing.map.feature import Position
from processing.methods.templates.fit import FitSettings
from processing.methods.templates.preview import Preview, preview_at
from processing.methods.templates.profile_template import MadeLine, ProfileTemplate, TemplateProfile
from processing.section.cut import Cut
from widgets.mouse_tools.drawing.draw_template import DrawnProfile, TemplatePart
from widgets.mouse_tools.tracing import BackgroundRunner
from widgets.panels.templates.template_form import TemplateForm
from widgets.panels.templates.template_list import TemplateList, TemplateStoreSource
from widgets.panels.templates.template_start import TemplateStart, start_at
from widgets.shared.cursor import PickedPosition
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState

NOWHERE = Text(
    "Put the cursor where the template fits, then draw the empty zone in that section.",
    "テンプレートが合う位置にカーソルを置き、その断面に空白域を描いてください。",
)
_UPPER, _LOWER = "curb_upper", "curb_lower"
_LIES = 0.5


@dataclass(frozen=True)
class _Lying:
    """Where the chosen template lies in the section: what zones are drawn about."""

    anchor: Position
    is_mirrored: bool


class TemplatePanel(QWidget):
    """Lists templates, shows the chosen one with the points at the cursor, and asks for its fit.

    Parameters
    ----------
    source : MapSource
    shared : SharedState
    shelf : callable
        Gives the `TemplateStore` of the open project, or None.
    in_background : BackgroundRunner
        Does the preview's work beside the window.
    language : Language

    Signals
    -------
    draw_requested(part: TemplatePart)
        A shape or an empty zone is to be drawn in the section.
    fit_requested(drive: str, parameters: TemplateParameters)
        Run the tool ``template`` on this drive.
    refused(error: UserError)
    reported(text: Text)
    """

    draw_requested = Signal(object)
    fit_requested = Signal(str, object)
    refused = Signal(object)
    reported = Signal(object)

    def __init__(
        self,
        source: MapSource,
        shared: SharedState,
        shelf: TemplateStoreSource,
        in_background: BackgroundRunner,
        *,
        language: Language = "en",
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self._source = source
        self._shared = shared
        self._in_background = in_background
        self._cut: Cut | None = None
        self._kind = ""
        self._drawn: TemplateStart | None = None
        self._lying: _Lying | None = None
        self._is_looking = False
        self._looks_again = False
        self.list = TemplateList(shelf, self)
        self.form = TemplateForm(source, language, self)
        self._lay_out()
        self.list.chosen.connect(self._on_list_chosen)
        self.list.draw_requested.connect(lambda: self.draw_requested.emit(TemplatePart.SHAPE))
        self.list.refused.connect(self.refused)
        self.form.edited.connect(self.list.replace)
        shared.cursor.moved.connect(self._on_cursor_moved)
        self._on_list_chosen(self.list.current)

    def _lay_out(self) -> None:
        self._hint = QLabel(self)
        self._hint.setWordWrap(True)
        self._score = QLabel(self)
        self._score.setWordWrap(True)
        self._zone = QPushButton(self.tr("Add empty zone"), self)
        self._zone.setToolTip(self.tr("Draw in the section where no point should be"))
        self._clear = QPushButton(self.tr("Remove zones"), self)
        self._fit = QPushButton(self.tr("Fit from here"), self)
        self._fit.setToolTip(
            self.tr("Follow the template along the street, both ways from the cursor")
        )
        zones = QHBoxLayout()
        zones.setSpacing(4)
        for button in (self._zone, self._clear):
            button.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
            zones.addWidget(button, 1)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(8, 8, 8, 8)
        layout.setSpacing(4)
        layout.addWidget(self.list)
        layout.addWidget(self._hint)
        layout.addWidget(self.form, 100)
        layout.addLayout(zones)
        layout.addWidget(self._score)
        layout.addWidget(self._fit)
        layout.addStretch(1)  # only where the form is hidden
        self._zone.clicked.connect(lambda: self.draw_requested.emit(TemplatePart.EMPTY_ZONE))
        self._clear.clicked.connect(self._on_clear_clicked)
        self._fit.clicked.connect(self._on_fit_clicked)

    # What others ask.

    def read_project(self) -> None:
        """Another project is open, or none."""
        self._drawn = self._lying = None
        self._is_looking = self._looks_again = False
        self.form.read_catalogue()
        self.list.refresh()

    def use_cut(self, cut: Cut | None) -> None:
        """The section is here now."""
        if cut != self._cut:
            self._cut = cut
            self._look()

    def use_kind(self, kind: FeatureKind) -> None:
        """Templates drawn from now on make lines of this kind, if it is one of lines."""
        if kind.geometry is Geometry.LINE:
            self._kind = kind.id

    def take_drawn(self, drawn: DrawnProfile) -> None:
        """A profile was drawn in the section: a new template, or a zone of the chosen one."""
        if drawn.part is TemplatePart.EMPTY_ZONE:
            self._take_zone(drawn)
            return
        try:
            shape = drawn.about(drawn.anchor)
            kind = self._usual_kind(shape)
            template = ProfileTemplate(self.tr("Template"), shape, (MadeLine(kind),))
        except UserError as error:
            self.refused.emit(error)
            return
        self.list.add(template)
        position = PickedPosition(drawn.anchor)
        shown = self._shared.view_settings.drive_id
        self._drawn = start_at(self._source, position, drawn.cut, shown)
        self._look()

    @override
    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        self._look()

    # What happens in it.

    def _take_zone(self, drawn: DrawnProfile) -> None:
        template, lying = self.list.current, self._lying
        if template is None or lying is None:
            self.reported.emit(NOWHERE)
            return
        zones = drawn.about(lying.anchor)
        if lying.is_mirrored:
            zones = tuple(_mirror_profile(zone) for zone in zones)
        try:
            changed = replace(template, empty=(*template.empty, *zones))
        except UserError as error:
            self.refused.emit(error)
            return
        self.list.replace(changed)

    def _on_list_chosen(self, template: ProfileTemplate | None) -> None:
        self.form.show_template(template)
        self.form.setVisible(template is not None)
        for part in (self._zone, self._clear, self._fit, self._score):
            part.setVisible(template is not None)
        self._clear.setEnabled(template is not None and bool(template.empty))
        self._hint.setVisible(template is None)
        self._hint.setText(
            self.tr(
                "Draw a curb or a gutter once in the section; it is then fitted along the road."
            )
        )
        self._look()

    def _on_cursor_moved(self) -> None:
        self._drawn = None
        self._look()

    def _on_clear_clicked(self) -> None:
        template = self.list.current
        if template is not None:
            self.list.replace(replace(template, empty=()))

    def _on_fit_clicked(self) -> None:
        template, start = self.list.current, self._start()
        if template is not None and start is not None:
            self.fit_requested.emit(start.drive.id, start.parameters(template))

    def _start(self) -> TemplateStart | None:
        """Where a fit would begin: where the template was drawn, else at the cursor."""
        if self._drawn is not None:
            return self._drawn
        position = self._shared.cursor.position
        if position is None:
            return None
        return start_at(self._source, position, self._cut, self._shared.view_settings.drive_id)

    def _usual_kind(self, shape: tuple[TemplateProfile, ...]) -> str:
        """The kind that is drawn elsewhere, else the edge of a curb at which the shape begins."""
        catalogue = self._source.catalogue()
        is_upper = min(height for profile in shape for _, height in profile) < 0
        usual = _UPPER if is_upper else _LOWER
        lines = (kind.id for kind in catalogue if kind.geometry is Geometry.LINE)
        known = (one for one in (self._kind, usual) if one in catalogue)
        return next(known, None) or next(lines, usual)

    # How the template lies where the cursor is.

    def _look(self) -> None:
        """Lay the template on the section's points, beside the window; the newest wish counts."""
        template = self.list.current
        self._lying = None
        begins = self._drawn is not None or self._shared.cursor.position is not None
        self._fit.setEnabled(template is not None and begins)
        if not self.isVisible() or template is None:
            return
        start = self._start()
        frame = None if start is None else start.frame
        if start is None or frame is None:
            self.form.show_points(np.empty((0, 2)))
            self._score.setText(self.tr("Put the cursor on the curb to see how the template lies."))
            return
        if self._is_looking:
            self._looks_again = True
            return
        self._is_looking = True
        drive = start.drive
        self._in_background(
            lambda: preview_at(drive, template, frame, FitSettings()), self._take_preview
        )

    def _take_preview(self, preview: object | None) -> None:
        self._is_looking = False
        if self._looks_again:
            self._looks_again = False
            self._look()
            return
        if not isinstance(preview, Preview):
            self._score.clear()
            return
        score = preview.start.score
        self.form.show_points(preview.points)
        self._score.setText(self.tr("Score here: {score}").format(score=f"{score:.2f}"))
        if score >= _LIES:
            easting, northing, height = preview.start.frame.position.tolist()
            self._lying = _Lying((easting, northing, height), preview.is_mirrored)


def _mirror_profile(profile: TemplateProfile) -> TemplateProfile:
    return tuple((0.0 - offset, height) for offset, height in profile)
