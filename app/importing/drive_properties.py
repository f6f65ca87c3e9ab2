"""DriveProperties: the form on a drive follows it, and what is given there becomes steps."""

from __future__ import annotations

from PySide6.QtCore import QObject

from app.importing.drive_actions import DriveActions
from app.window.action import Action
from app.window.project_dialogs import ProjectDialogs
from app.window.window_parts import WindowParts
from processing.core.errors import UserError
from processing.core.text import Text
from processing.project.drive_description import (
    day_by_times,
    description_change,
    facts_of_drive,
)
from widgets.dialogs.drive_properties import DrivePropertiesForm


class DriveProperties(QObject):
    """Shows the properties of drives.

    Parameters
    ----------
    parts : WindowParts
    dialogs : ProjectDialogs
    drives : DriveActions
        Complete, replace and remove drives.
    """

    def __init__(self, parts: WindowParts, dialogs: ProjectDialogs, drives: DriveActions) -> None:
        super().__init__(parts.window.centralWidget())  # goes with the widgets
        self._parts = parts
        self._dialogs = dialogs
        self._drives = drives
        parts.document.shared.map_changes.drives_changed.connect(self._follow)

    def action(self) -> Action:
        """The entry of the file menu."""
        return Action(
            "drive-properties",
            Text("Properties of the drive…", "走行データのプロパティ…"),
            self.choose,
            "file",
            hint=Text(
                "Name, day, extent, rows, trajectory, images and files of the drive shown.",
                "表示中の走行データの名称、計測日、範囲、行、走行軌跡、画像、ファイルです。",
            ),
            needs_project=True,
        )

    def choose(self, drive: str = "") -> None:
        """Show the properties of a drive, or of the one that the image shows."""
        id_ = drive or self._parts.document.shared.view_settings.drive_id
        if not id_:
            return
        for form in self._forms():
            if form.drive != id_:
                form.close()
        self._show(self._dialogs.show(DrivePropertiesForm, lambda: self._make(id_)))

    def _make(self, drive: str) -> DrivePropertiesForm:
        form = DrivePropertiesForm(drive, self._parts.window)
        form.described.connect(self._on_form_described)
        form.trajectory_requested.connect(self._drives.choose_trajectory)
        form.images_requested.connect(self._drives.choose_images)
        system = self._parts.window.actions_by_id["reference-system"]
        form.system_requested.connect(lambda _drive: system.trigger())
        form.replacement_requested.connect(self._drives.choose_replacement)
        form.removal_requested.connect(self._drives.remove)
        return form

    def _forms(self) -> list[DrivePropertiesForm]:
        forms = self._parts.window.findChildren(DrivePropertiesForm)
        return [form for form in forms if form.isVisible()]

    def _follow(self) -> None:
        ids = {drive.id for drive in self._parts.document.drives()}
        for form in self._forms():
            if form.drive in ids:
                self._show(form)
            else:
                form.close()

    def _show(self, form: DrivePropertiesForm) -> None:
        drive, language = self._parts.document.drive(form.drive), self._parts.language
        facts = [
            (name.in_language(language), value.in_language(language))
            for name, value in facts_of_drive(drive)
        ]
        info = drive.info
        form.show_drive((info.name, info.measured_on), day_by_times(drive), facts)

    def _on_form_described(self, id_: str, name: str, measured_on: str) -> None:
        document = self._parts.document
        project = document.project
        if project is None:
            return
        try:
            change = description_change(project, document.drive(id_), name, measured_on)
        except UserError as error:
            for form in self._forms():
                form.show_trouble(error.line(self._parts.language))
            return
        words = Text("Properties of {name}", "{name} のプロパティ").filled(name=name.strip())
        if change.is_empty or document.apply(words, change):
            for form in self._forms():
                form.close()
