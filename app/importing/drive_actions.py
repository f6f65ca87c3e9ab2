"""Actions on drives that a project has: to complete them, or to take them out of it."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QCoreApplication
from PySide6.QtWidgets import QFileDialog

from app.importing.column_request import with_columns
from app.window.action import Action
from app.window.window_parts import WindowParts
from processing.core.errors import UserError
from processing.core.text import Text
from processing.formats.format import DELIVERED, Content
from processing.formats.registry import FORMATS
from processing.project.importing.dropped_files import request_of_files
from processing.project.importing.import_request import ImportRequest

DELIVERIES = Text("Deliveries", "納品ファイル")


class DriveActions:
    """What the file menu and the menu of a drive offer."""

    def __init__(self, parts: WindowParts) -> None:
        self._parts = parts

    def actions(self) -> tuple[Action, ...]:
        """Entries of the file menu, from top to bottom."""
        return (
            Action(
                "add-trajectory",
                Text("Add a trajectory…", "走行軌跡を追加…"),
                self.choose_trajectory,
                "file",
                hint=Text(
                    "Finds rows anew for drives that were imported without one; the map stays.",
                    "走行軌跡なしで読み込んだ走行データの行を求め直します。"
                    "作図した内容は保たれます。",
                ),
                needs_project=True,
            ),
            Action(
                "add-images",
                Text("Add camera images…", "カメラ画像を追加…"),
                self.choose_images,
                "file",
                hint=Text(
                    "Reads an image list for drives that are in the project.",
                    "プロジェクトにある走行データの画像一覧を読み込みます。",
                ),
                needs_project=True,
            ),
            Action(
                "replace-drive",
                Text("Replace the drive shown…", "表示中の走行データを差し替え…"),
                self.choose_replacement,
                "file",
                hint=Text(
                    "Imports a new delivery in the place of the drive in the image; the map stays.",
                    "画像に表示中の走行データを新しい納品データに差し替えます。図面は残ります。",
                ),
                needs_project=True,
            ),
            Action(
                "remove-drive",
                Text("Remove the drive shown", "表示中の走行データを除く"),
                self.remove,
                "file",
                hint=Text(
                    "Takes the drive in the image out of the project; the map stays.",
                    "画像に表示中の走行データをプロジェクトから除きます。図面は残ります。",
                ),
                needs_project=True,
            ),
        )

    def choose_trajectory(self, drive: str = "") -> None:
        """Ask for trajectory files, and complete a drive, or all that they cover, with them."""
        title = QCoreApplication.translate("DriveActions", "Add a trajectory")
        paths = self._choose_files(title, Content.TRAJECTORY)
        if paths:
            self._add(ImportRequest((), trajectories=paths), drive)

    def choose_images(self, drive: str = "") -> None:
        """Ask for image lists, and add them to a drive, or to all on which they were taken."""
        title = QCoreApplication.translate("DriveActions", "Add camera images")
        paths = self._choose_files(title, Content.IMAGES)
        if paths:
            self._add(ImportRequest((), images=paths), drive)

    def choose_replacement(self, drive: str = "") -> None:
        """Ask for the files of a new delivery that takes the place of a drive."""
        document = self._parts.document
        id_ = drive or document.shared.view_settings.drive_id
        title = QCoreApplication.translate("DriveActions", "Replace by a new delivery")
        paths = self._choose_files(title, *DELIVERED) if id_ else ()
        if not paths:
            return
        try:
            request = request_of_files(paths, "")
        except UserError as error:
            self._parts.message_bar.show_error(error)
            return

        def start(clear: ImportRequest) -> None:
            document.import_files(clear, replacing=(id_,))

        with_columns(self._parts, request, start)

    def remove(self, drive: str = "") -> None:
        """Take a drive, or the one that the image shows, out of the project."""
        document = self._parts.document
        id_ = drive or document.shared.view_settings.drive_id
        if id_:
            document.remove_drives((id_,))

    def _add(self, request: ImportRequest, drive: str) -> None:
        self._parts.document.import_files(request, (drive,) if drive else ())

    def _choose_files(self, title: str, *contents: Content) -> tuple[Path, ...]:
        document = self._parts.document
        if document.project is None:
            return ()
        files = [file for drive in document.drives() for file in drive.delivered_files]
        folder = files[0].parent if files else document.project.folder.parent
        name = DELIVERIES if len(contents) > 1 else None
        kinds = FORMATS.filter_read(*contents, name=name).in_language(self._parts.language)
        names, _ = QFileDialog.getOpenFileNames(self._parts.window, title, str(folder), kinds)
        return tuple(Path(name) for name in names)
