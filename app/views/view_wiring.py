"""Wiring of the views beside the image: section, camera and map tell each other where they are."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from PySide6.QtCore import QCoreApplication, QObject
from PySide6.QtWidgets import QFileDialog

from app.classes.evaluation import Evaluation
from app.classes.evaluation_files import write_evaluation_file
from app.window.window_parts import WindowParts
from processing.core.errors import UserError
from processing.core.text import Text
from processing.formats.drawings.profile_dxf import ProfileStyle, write_profile_dxf
from processing.formats.format import Content
from processing.formats.registry import FORMATS
from processing.recording.camera_images.calibration import CameraOffset
from processing.section.cut import Cut
from processing.tools.listed.registry import TOOLS
from widgets.shared.view_settings import PointStyle

_KEPT = Text("The camera offsets are kept.", "カメラの補正値を保存しました。")
_WROTE = Text("Wrote {path}.", "{path} を書き出しました。")
_NO_SECTION = Text(
    "There is no section to write: put the cursor on the street first.",
    "書き出す断面がありません。先に道路上にカーソルを置いてください。",
)


def connect_views(parts: WindowParts) -> None:
    """Connect the views with each other and with the window; again for new ones."""
    wiring = _ViewWiring(parts)
    section, camera, map_view = parts.section_view, parts.camera_view, parts.map_view
    images, bar = parts.image_views, parts.image_bar
    bar.another_requested.connect(wiring.on_bar_another_requested)
    images.images_changed.connect(wiring.on_images_changed)
    parts.scene_view.clipping.changed.connect(wiring.on_clipping_changed)
    parts.document.shared.view_settings.image_orientation_changed.connect(
        wiring.on_settings_orientation_changed
    )
    parts.document.shared.view_settings.look_changed.connect(wiring.on_settings_look_changed)
    section.reported.connect(parts.status_line.show_message)
    section.settings_changed.connect(parts.settings.remember_section)
    section.profile_export_requested.connect(wiring.on_section_profile_export_requested)
    section.cut_changed.connect(wiring.on_section_cut_changed)
    wiring.on_section_cut_changed(section.cut)
    parts.processing_panel.values_changed.connect(wiring.on_processing_values_changed)
    wiring.on_processing_values_changed()
    camera.reported.connect(parts.status_line.show_message)
    camera.fields_of_view_changed.connect(map_view.show_fields_of_view)
    parts.camera_panel.offsets_save_requested.connect(wiring.on_camera_offsets_save_requested)
    parts.evaluation_panel.evaluation_wanted.connect(wiring.on_evaluation_wanted)
    parts.evaluation_panel.export_requested.connect(wiring.on_evaluation_export_requested)


class _ViewWiring(QObject):
    """What has to be translated between the views and the document."""

    def __init__(self, parts: WindowParts) -> None:
        super().__init__(parts.window.centralWidget())  # goes with the widgets
        self._parts = parts
        self._evaluation = Evaluation(parts.document)

    def on_section_cut_changed(self, cut: Cut | None) -> None:
        outline = None if cut is None else cut.outline
        self._parts.map_view.show_slab(outline)
        self._parts.scene_view.clipping.know_section(outline)

    def on_processing_values_changed(self) -> None:
        panel = self._parts.processing_panel
        self._parts.section_view.use_tool_parameters(
            {
                tool.id: panel.parameters_of(tool.id)
                for tool in TOOLS.values()
                if tool.diagnostics is not None
            }
        )

    def on_bar_another_requested(self) -> None:
        self._parts.image_views.add()

    def on_images_changed(self) -> None:
        self._parts.image_bar.allow_another(self._parts.image_views.can_add)

    def on_clipping_changed(self) -> None:
        clipping = self._parts.scene_view.clipping
        self._parts.settings.remember_slab(clipping.slab)
        actions = self._parts.window.actions_by_id
        actions[f"clip-{clipping.choice.value}"].setChecked(True)

    def on_settings_orientation_changed(self) -> None:
        orientation = self._parts.document.shared.view_settings.image_orientation
        self._parts.settings.remember_image_orientation(orientation)
        actions = self._parts.window.actions_by_id
        actions["image-upwards"].setChecked(orientation.is_vertical)
        actions["image-mirrored"].setChecked(orientation.is_mirrored_across)
        actions["image-reversed"].setChecked(orientation.is_reversed_along)

    def on_settings_look_changed(self, look: PointStyle) -> None:
        self._parts.window.actions_by_id["hide-noise"].setChecked(look.hides_noise)

    def on_section_profile_export_requested(self) -> None:
        document, section = self._parts.document, self._parts.section_view
        request = section.profile_request()
        if request is None:
            document.reported.emit(_NO_SECTION)
            return
        path = self._asked_path(
            QCoreApplication.translate("ViewWiring", "Write the profile"),
            "profile.dxf",
            FORMATS.filter_written(Content.DRAWING).in_language(self._parts.language),
        )
        if path is None:
            return
        look = ProfileStyle(
            exaggeration=section.settings.exaggeration, language=self._parts.language
        )
        never = tuple(file for drive in document.drives() for file in drive.delivered_files)

        def write() -> Path:
            write_profile_dxf(path, request(), look, never=never)
            return path

        document.run_in_background(write, self._tell_written)

    def on_camera_offsets_save_requested(self, offsets: Mapping[str, CameraOffset]) -> None:
        document = self._parts.document
        try:
            for drive in document.drives():
                if drive.images:
                    drive.keep_camera_offsets({**drive.camera_offsets, **offsets})
        except UserError as error:
            document.refused.emit(error)
            return
        for drive in document.drives():
            document.tiles.drop(drive.id)
            document.shared.map_changes.drive_columns_changed.emit(drive.id)
        self._parts.camera_panel.show_kept_offsets()
        document.reported.emit(_KEPT)

    def on_evaluation_wanted(self) -> None:
        panel = self._parts.evaluation_panel
        panel.show_evaluations(self._evaluation.evaluations())
        self._evaluation.score_maps(panel.show_map_scores)

    def on_evaluation_export_requested(self, ending: str) -> None:
        path = self._asked_path(
            QCoreApplication.translate("ViewWiring", "Write the evaluation"),
            f"evaluation.{ending}",
            f"*.{ending}",
        )
        if path is None:
            return
        plot = None if ending == "csv" else self._parts.evaluation_panel.plot
        try:
            write_evaluation_file(path, self._evaluation.evaluations(), plot)
        except UserError as error:
            self._parts.document.refused.emit(error)
            return
        self._tell_written(path)

    def _asked_path(self, title: str, name: str, files: str) -> Path | None:
        project = self._parts.document.project
        if project is None:
            return None
        start = str(project.folder.parent / name)
        chosen, _ = QFileDialog.getSaveFileName(self._parts.window, title, start, files)
        return Path(chosen) if chosen else None

    def _tell_written(self, path: object) -> None:
        if isinstance(path, Path):
            self._parts.document.reported.emit(_WROTE.filled(path=path.name))
