"""Scenes of forms, of questions, and of what is shown while nothing is open."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Mapping

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QCheckBox, QLineEdit, QTreeWidget

from app.catalogue.catalogue_update import adopt_catalogue
from app.screenshots.screenshot_window import ScreenshotWindow
from app.screenshots.simulated_mouse import CONTROL
from app.screenshots.street import RIGHT, at
from processing.project.importing.dropped_files import request_of_files
from resources import path_of
from widgets.dialogs.export_map import ExportForm
from widgets.dialogs.import_drive import ImportForm
from widgets.dialogs.shortcuts import ShortcutsForm
from widgets.dialogs.simulate import SimulateForm


def import_form(studio: ScreenshotWindow) -> None:
    """What is to be imported."""
    studio.letter("I", CONTROL)
    form = studio.dialog(ImportForm)
    form.add_files(tuple(sorted(path_of("sample_street").glob("*.[lc][as][zv]"))))


def export_form(studio: ScreenshotWindow) -> None:
    """What is to be written: the drawing, and points with their labels."""
    studio.letter("E", CONTROL)
    form = studio.dialog(ExportForm)
    *_, labelled = [box for box in form.findChildren(QCheckBox) if "LAS" in box.text()]
    labelled.setChecked(True)


def reference_system(studio: ScreenshotWindow) -> None:
    """What the coordinates refer to."""
    studio.letter("R", CONTROL)


def simulate_form(studio: ScreenshotWindow) -> None:
    """A street to be made, and how densely it would be measured."""
    studio.act("simulate")
    studio.dialog(SimulateForm)


def shortcuts(studio: ScreenshotWindow) -> None:
    """All keys; a new one for the line belongs to something else."""
    studio.key(Qt.Key.Key_F1, CONTROL)
    form = studio.dialog(ShortcutsForm)
    studio.mouse.type(form.findChildren(QLineEdit)[0], "line")
    studio.settle()
    form.choose("tool-line")
    studio.settle()
    rows = form.findChildren(QTreeWidget)[0]
    rows.itemActivated.emit(rows.currentItem(), 0)
    studio.key_in_focus(Qt.Key.Key_P)


def catalogue_question(studio: ScreenshotWindow) -> None:
    """An office's catalogue that lacks kinds which the map uses."""
    whole = path_of("catalogue/level500.toml").read_text(encoding="utf-8")
    head, *kinds = whole.split("[[kind]]")
    kept = [kind for kind in kinds if 'id = "street_tree"' not in kind]
    path = studio.scratch / "office.toml"
    path.write_text("[[kind]]".join([head, *kept]), encoding="utf-8")
    adopt_catalogue(studio.parts, path)


def images_missing(studio: ScreenshotWindow) -> None:
    """A delivery whose images were not delivered: what the camera view says."""
    delivery = studio.scratch / "without images"
    shutil.copytree(path_of("sample_street"), delivery, ignore=shutil.ignore_patterns("*.jpg"))
    document = studio.parts.document
    document.create(studio.scratch / "images.zuka", "")
    document.import_files(request_of_files((delivery,), ""))
    studio.wait(lambda: bool(document.drives()) and not studio.parts.jobs.is_busy)
    studio.bring("view-camera")
    studio.parts.document.shared.cursor.move_to(studio.position(RIGHT, at(9.0, 0.5)))


def start_recent(studio: ScreenshotWindow) -> None:
    """Recent projects, one of them gone."""
    settings, document = studio.parts.settings, studio.parts.document
    gone = studio.scratch / "県道12号 富士見町.zuka"
    gone.mkdir()
    settings.remember_project(gone)
    for name in ("国道20号 甲州街道 3工区", "Nishi-Shinjuku ward road 7"):
        document.create(studio.scratch / f"{name}.zuka", "EPSG:6677")
    document.close()
    gone.rmdir()
    studio.settle()
    studio.parts.start_page.show_recent(settings.recent_projects)


def start_empty(studio: ScreenshotWindow) -> None:
    """The first start."""
    for project in studio.parts.settings.recent_projects:
        studio.parts.start_page.forget_requested.emit(project.folder)


def empty_project(studio: ScreenshotWindow) -> None:
    """A project without a drive."""
    studio.parts.document.create(studio.scratch / "empty.zuka", "")


FORMS: Mapping[str, Callable[[ScreenshotWindow], None]] = {
    "catalogue-question": catalogue_question,
    "form-export": export_form,
    "form-import": import_form,
    "form-reference-system": reference_system,
    "form-shortcuts": shortcuts,
    "form-simulate": simulate_form,
}
WITHOUT_STREET: Mapping[str, Callable[[ScreenshotWindow], None]] = {
    "start-recent": start_recent,
    "start-empty": start_empty,
    "empty-project": empty_project,
    "camera-missing": images_missing,
}
