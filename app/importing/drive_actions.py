"""Actions on drives that a project has: to complete them, or to take them out of it."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QCoreApplication
from PySide6.QtWidgets import QFileDialog

from app.window.action import Action
from app.window.window_parts import WindowParts
from processing.core.text import Text
from processing.formats.format import Content
from processing.formats.registry import FORMATS
from processing.project.importing.import_request import ImportRequest


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

    def remove(self, drive: str = "") -> None:
        """Take a drive, or the one that the image shows, out of the project."""
        document = self._parts.document
        id_ = drive or document.shared.view_settings.drive_id
        if id_:
            document.remove_drives((id_,))

    def _add(self, request: ImportRequest, drive: str) -> None:
        self._parts.document.import_files(request, (drive,) if drive else ())

    def _choose_files(self, title: str, content: Content) -> tuple[Path, ...]:
        document = self._parts.document
        if document.project is None:
            return ()
        files = [file for drive in document.drives() for file in drive.delivered_files]
        folder = files[0].parent if files else document.project.folder.parent
        kinds = FORMATS.filter_read(content).in_language(self._parts.language)
        names, _ = QFileDialog.getOpenFileNames(self._parts.window, title, str(folder), kinds)
        return tuple(Path(name) for name in names)
