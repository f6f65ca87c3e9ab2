"""TemplateForm: one template drawn small, the lines it makes and its tolerance."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QSignalBlocker, Signal
from PySide6.QtWidgets import QComboBox, QFormLayout, QSizePolicy, QVBoxLayout, QWidget

from processing.core.text import Language
from processing.map.catalogue import Geometry
from processing.methods.templates.profile_template import (
    LEAST_TOLERANCE_M,
    MOST_TOLERANCE_M,
    ProfilePoint,
    ProfileTemplate,
)
from widgets.feature_drawing.swatch import swatch_of
from widgets.panels.templates.template_picture import TemplatePicture
from widgets.parts.number_field import NumberField
from widgets.shared.map_source import MapSource

_ANCHOR: ProfilePoint = (0.0, 0.0)
_TOLERANCE_STEP_M = 0.005


class TemplateForm(QWidget):
    """Shows a template; a click on a vertex marks it, and the list says which line is made there.

    Signals
    -------
    edited(template: ProfileTemplate)
        The user changed it.
    """

    edited = Signal(object)

    def __init__(
        self, source: MapSource, language: Language, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self._source = source
        self._language = language
        self._template: ProfileTemplate | None = None
        self._marked = _ANCHOR
        self.picture = TemplatePicture(self)
        self._kinds = QComboBox(self)
        self._kinds.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self._kinds.setToolTip(self.tr("The line that is made at the marked vertex"))
        self._tolerance = NumberField(
            LEAST_TOLERANCE_M, MOST_TOLERANCE_M, unit="m", decimals=3, parent=self
        )
        self._tolerance.setSingleStep(_TOLERANCE_STEP_M)
        self._tolerance.setToolTip(self.tr("Points this near to the shape lie on it"))
        form = QFormLayout()
        form.setContentsMargins(0, 0, 0, 0)
        form.setHorizontalSpacing(8)
        form.setVerticalSpacing(4)
        form.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
        form.addRow(self.tr("Line here"), self._kinds)
        form.addRow(self.tr("Tolerance"), self._tolerance)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(4)
        layout.addWidget(self.picture, 1)
        layout.addLayout(form)
        self.picture.vertex_chosen.connect(self.mark)
        self._kinds.activated.connect(self._on_kinds_activated)
        self._tolerance.valueChanged.connect(self._on_tolerance_value_changed)
        self.read_catalogue()

    @property
    def template(self) -> ProfileTemplate | None:
        """What is shown."""
        return self._template

    @property
    def marked(self) -> ProfilePoint:
        """The vertex whose line is shown in the list."""
        return self._marked

    def read_catalogue(self) -> None:
        """Offer the lines of another catalogue."""
        catalogue = self._source.catalogue()
        self.picture.use_catalogue(catalogue)
        with QSignalBlocker(self._kinds):
            self._kinds.clear()
            self._kinds.addItem(self.tr("No line"), "")
            for kind in catalogue:
                if kind.geometry is Geometry.LINE:
                    name = kind.name.in_language(self._language)
                    self._kinds.addItem(swatch_of(kind.colour), name, kind.id)
        self._show()

    def show_template(self, template: ProfileTemplate | None) -> None:
        """Show a template; None: nothing."""
        before = self._template
        self._template = template
        is_other = template is None or before is None or template.name != before.name
        if is_other or template is None or self._marked not in template.vertices:
            self._marked = _ANCHOR
            self.show_points(np.empty((0, 2)))
        self._show()

    def show_points(self, points: NDArray[np.float64]) -> None:
        """Show (n, 2) points of a section behind the template, in its axes."""
        self.picture.show_points(points)

    def mark(self, vertex: ProfilePoint) -> None:
        """Mark a vertex."""
        self._marked = vertex
        self._show()

    def _show(self) -> None:
        template = self._template
        self.setEnabled(template is not None)
        self.picture.show_template(template, self._marked)
        if template is None:
            return
        with QSignalBlocker(self._kinds), QSignalBlocker(self._tolerance):
            kind = template.kind_at(self._marked)
            position = self._kinds.findData(kind)
            if position < 0:  # a kind that this project's catalogue doesn't have
                self._kinds.addItem(kind, kind)
                position = self._kinds.count() - 1
            self._kinds.setCurrentIndex(position)
            self._tolerance.setValue(template.tolerance_m)

    def _on_kinds_activated(self) -> None:
        if self._template is not None:
            kind = str(self._kinds.currentData())
            self.edited.emit(self._template.with_kind_at(self._marked, kind))

    def _on_tolerance_value_changed(self, value: float) -> None:
        if self._template is not None and value != self._template.tolerance_m:
            self.edited.emit(replace(self._template, tolerance_m=value))
