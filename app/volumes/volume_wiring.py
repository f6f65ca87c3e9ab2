"""Wiring of earthwork: the panel of volumes, the files it asks for, and what the map has chosen."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from PySide6.QtCore import QCoreApplication, QObject
from PySide6.QtWidgets import QFileDialog
from shapely.geometry.base import BaseGeometry

from app.volumes.earthwork import Earthwork
from app.volumes.limits_wiring import connect_limits
from app.volumes.volume_exports import VOLUME_EXPORTS
from app.volumes.volume_reports import is_judged
from app.volumes.volume_requests import (
    boundary_of_features,
    boundary_of_file,
    lines_of_features,
    name_of_areas,
    reason_against,
)
from app.window.window_parts import WindowParts
from processing.core.errors import UserError
from processing.core.text import Text
from processing.formats.format import Content
from processing.formats.registry import FORMATS
from processing.formats.surfaces.landxml import read_landxml
from processing.formats.vectors.boundary_files import boundary_layers
from processing.map.feature import Feature
from processing.project.results.found_features import parameter_values
from processing.project.volumes.volume import VolumeRequest
from processing.tools.volume import VOLUME
from widgets.panels.volume.side_box import SideBox
from widgets.panels.volume.volume_form import AreaChoice
from widgets.shared.shown_volume import VolumeStyle

_SEVERAL = Text(
    "{name} has areas on several layers: choose the one that is meant as “Within”.",
    "{name} の複数のレイヤに面があります。「範囲」で使用するレイヤを選んでください。",
)


def connect_volumes(parts: WindowParts) -> None:
    """Connect the panel of volumes with the document; again for new ones."""
    wiring = _VolumeWiring(parts)
    panel, earthwork = parts.volume_panel, parts.of(Earthwork)
    form = panel.form
    form.ask_reason_from(wiring.reason_against)
    form.ask_ground_from(wiring.needs_ground)
    form.run_requested.connect(wiring.on_form_run_requested)
    form.ground_requested.connect(wiring.on_form_ground_requested)
    form.boundary_wanted.connect(wiring.on_form_boundary_wanted)
    form.before.design_wanted.connect(lambda: wiring.on_box_design_wanted(form.before))
    form.after.design_wanted.connect(lambda: wiring.on_box_design_wanted(form.after))
    panel.volume_chosen.connect(earthwork.show)
    panel.removal_requested.connect(earthwork.remove)
    panel.export_requested.connect(wiring.on_panel_export_requested)
    panel.table.correction_requested.connect(wiring.on_table_correction_requested)
    earthwork.volumes_changed.connect(wiring.show_volumes)
    earthwork.epochs_changed.connect(wiring.show_epochs)
    parts.document.closed.connect(form.start_anew)
    parts.document.shared.volume.look_changed.connect(wiring.on_volume_look_changed)
    connect_limits(parts)
    wiring.show_epochs()
    wiring.show_volumes()


class _VolumeWiring(QObject):
    """What has to be translated between the panel and the document."""

    def __init__(self, parts: WindowParts) -> None:
        super().__init__(parts.window.centralWidget())  # goes with the widgets
        self._parts = parts

    def on_volume_look_changed(self, look: VolumeStyle) -> None:
        self._parts.window.actions_by_id["heat-map"].setChecked(look.is_shown)

    def show_epochs(self) -> None:
        self._parts.volume_panel.form.show_epochs(self._parts.of(Earthwork).epochs)

    def show_volumes(self) -> None:
        earthwork = self._parts.of(Earthwork)
        shown = earthwork.shown
        panel = self._parts.volume_panel
        panel.show_volumes(earthwork.volumes, "" if shown is None else shown.id)
        if shown is not None:
            panel.offer_exports({one.id for one in VOLUME_EXPORTS if one.is_for(shown)})
            panel.limits.setVisible(is_judged(shown))

    def reason_against(self) -> Text | None:
        """Why nothing can be compared as the form stands; None: it can."""
        form = self._parts.volume_panel.form
        return reason_against(*form.sides, self._parts.of(Earthwork).epochs)

    def needs_ground(self) -> bool:
        """Whether the ground of a chosen epoch is still to be found."""
        form, earthwork = self._parts.volume_panel.form, self._parts.of(Earthwork)
        return any(earthwork.lacks_ground(box.side) for box in (form.before, form.after))

    def on_form_ground_requested(self) -> None:
        form = self._parts.volume_panel.form
        self._parts.of(Earthwork).find_ground((form.before.side, form.after.side))

    def on_form_run_requested(self) -> None:
        try:
            request = self._request()
        except UserError as error:
            self._parts.document.refused.emit(error)
            return
        if request is not None:
            self._parts.of(Earthwork).compute(request)

    def on_table_correction_requested(self) -> None:
        """The same again, with the later epoch moved back."""
        shown = self._parts.of(Earthwork).shown
        if shown is not None:
            parameters = {**shown.request.parameters, "correct_shift": True}
            self._parts.of(Earthwork).compute(replace(shown.request, parameters=parameters))

    def on_panel_export_requested(self, id_: str) -> None:
        """What is there already is asked for by the dialog."""
        parts = self._parts
        project = parts.document.project
        kind = next(one for one in VOLUME_EXPORTS if one.id == id_)
        if project is None:
            return
        chosen, _ = QFileDialog.getSaveFileName(
            parts.window,
            QCoreApplication.translate("VolumeWiring", "Export the volume"),
            str(project.folder.parent / f"{project.name}-{kind.id}{kind.format.ending}"),
            kind.format.file_filter.in_language(parts.language),
        )
        if chosen:
            parts.of(Earthwork).export(kind, Path(chosen), parts.language)

    def on_form_boundary_wanted(self) -> None:
        path = self._asked_file(
            QCoreApplication.translate("VolumeWiring", "The area that is computed within"),
            Content.AREAS,
        )
        if path is None:
            return

        def take(found: object | None) -> None:
            if isinstance(found, tuple):
                self._parts.volume_panel.form.take_boundaries(path, found)
                if len(found) > 1:
                    self._parts.document.reported.emit(_SEVERAL.filled(name=path.name))

        self._parts.document.run_in_background(lambda: boundary_layers(path), take)

    def on_box_design_wanted(self, box: SideBox) -> None:
        """The file is read beside the window: a large design takes seconds."""
        path = self._asked_file(
            QCoreApplication.translate("VolumeWiring", "Design surface"),
            Content.SURFACE,
        )
        if path is None:
            return

        def names() -> tuple[str, ...]:
            return tuple(one.surface.name for one in read_landxml(path).surfaces)

        def take(found: object | None) -> None:
            if isinstance(found, tuple):
                box.take_designs(path, found)

        self._parts.document.run_in_background(names, take)

    def _request(self) -> VolumeRequest | None:
        form = self._parts.volume_panel.form
        before, after = form.sides
        if before is None or after is None:
            return None
        boundary: BaseGeometry | None = None
        name = ""
        lines: tuple[BaseGeometry, ...] = ()
        if form.within is AreaChoice.SELECTED:
            chosen = self._selected_features()
            boundary = boundary_of_features(chosen)
            name = name_of_areas(chosen, self._parts.document.catalogue(), self._parts.language)
        elif (area := form.boundary) is not None:
            boundary = boundary_of_file(area.path, area.layer, self._parts.document.crs())
            name = f"{area.path.name}#{area.layer}" if area.layer else area.path.name
        if form.uses_lines:
            lines = lines_of_features(self._selected_features())
        values = parameter_values(VOLUME, form.parameters.value())
        return VolumeRequest(
            before,
            after,
            {name: value for name, value in values.items() if value is not None},
            boundary,
            lines[0] if len(lines) == 1 else None,
            lines,
            self._parts.of(Earthwork).others_than((before, after)),
            name,
        )

    def _selected_features(self) -> Sequence[Feature]:
        document = self._parts.document
        chosen = sorted(document.shared.selection.features)
        return [one for id_ in chosen if (one := document.feature(id_)) is not None]

    def _asked_file(self, title: str, content: Content) -> Path | None:
        project = self._parts.document.project
        if project is None:
            return None
        files = FORMATS.filter_read(content).in_language(self._parts.language)
        chosen, _ = QFileDialog.getOpenFileName(
            self._parts.window, title, str(project.folder.parent), files
        )
        return Path(chosen) if chosen else None
