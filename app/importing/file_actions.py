"""File actions: projects, imports, exports."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from PySide6.QtCore import QCoreApplication
from PySide6.QtWidgets import QFileDialog

from app.catalogue.catalogue_update import adopt_catalogue
from app.importing.column_request import with_columns
from app.importing.delivery_look import DeliveryLook
from app.importing.drive_actions import DELIVERIES, DriveActions
from app.importing.drive_properties import DriveProperties
from app.importing.existing_maps import ExistingMaps
from app.importing.project_checking import ProjectChecking
from app.importing.recent_menu import RecentMenu
from app.importing.sheet_printing import SheetPrinting
from app.importing.source_watch import SourceWatch
from app.roads.road_viewing import RoadViewing
from app.simulation.simulate_wiring import Simulations
from app.window.action import Action, grouped
from app.window.project_dialogs import ProjectDialogs
from app.window.window_parts import WindowParts
from processing.core.errors import UserError
from processing.core.text import Text
from processing.formats.format import DELIVERED, Content
from processing.formats.registry import FORMATS
from processing.operations.export import ExportRequest
from processing.project.importing.dropped_files import additions_of_files, request_of_files
from processing.project.importing.importing import ImportRequest
from processing.project.project import is_project
from processing.project.work_details import WorkDetails
from processing.project.work_store import WorkStore
from resources import path_of
from widgets.dialogs.export_map import ExportChoices, ExportForm, ExportOptions
from widgets.dialogs.import_drive import ImportForm, ImportOptions
from widgets.dialogs.reference_systems import ReferenceSystemForm
from widgets.dialogs.work_details import WorkDetailsForm


class FileActions:
    """What the file menu does; also what a drop and the start page ask for."""

    def __init__(self, parts: WindowParts, projects_folder: Path) -> None:
        self._parts = parts
        self._projects_folder = projects_folder
        self._dialogs = ProjectDialogs(parts)
        self.simulations = Simulations(parts, projects_folder)
        self.drives = DriveActions(parts)
        self.properties = DriveProperties(parts, self._dialogs, self.drives)
        self.recent = RecentMenu(parts)
        self._asked: tuple[str, ImportOptions] | None = None
        parts.jobs.failed.connect(self._on_jobs_failed)
        self.printing = SheetPrinting(parts, self._dialogs)
        self.roads = RoadViewing(parts, self._dialogs)
        self.existing_maps = ExistingMaps(parts, self._dialogs)
        self.checking = ProjectChecking(parts)

    def actions(self) -> tuple[Action, ...]:
        """The file menu, from top to bottom."""
        opening, *others = self._of_files()
        adding = 2 + len(self.drives.actions())
        return grouped(
            (opening, self.recent.action()),
            others[:adding],
            others[adding:],
            self._of_the_project(),
            self._of_the_program(),
        )

    def _of_files(self) -> tuple[Action, ...]:
        return (
            Action(
                "open",
                Text("Open project…", "プロジェクトを開く…"),
                self.choose_project,
                "file",
                ("Ctrl+O",),
                "mdi6.folder-open-outline",
                1,
                hint=Text(
                    "Opens a folder NAME.zuka in place of what is open.",
                    "フォルダ「名前.zuka」を、開いているものに代えて開きます。",
                ),
            ),
            Action(
                "import",
                Text("Import a drive…", "走行データをインポート…"),
                self.choose_import,
                "file",
                ("Ctrl+I",),
                "mdi6.tray-arrow-down",
                1,
                hint=Text(
                    "Reads point clouds with trajectory and images; the files stay as they are.",
                    "点群を軌跡・画像とともに読み込みます。元のファイルは変更しません。",
                ),
            ),
            self.properties.action(),
            *self.drives.actions(),
            self._existing_map(),
            self._simulate(),
            Action(
                "export",
                Text("Export…", "書き出し…"),
                self.choose_export,
                "file",
                ("Ctrl+E",),
                "mdi6.tray-arrow-up",
                1,
                hint=Text(
                    "Writes the map as DXF, CSV and other files.",
                    "図面をDXFやCSVなどのファイルに書き出します。",
                ),
                needs_project=True,
            ),
            self.printing.action(),
            self.roads.action(),
        )

    def _existing_map(self) -> Action:
        return Action(
            "existing-map",
            Text("Existing map…", "既存図の比較・取り込み…"),
            self.existing_maps.choose,
            "file",
            icon="mdi6.map-plus",
            hint=Text(
                "Finds what is new, moved and gone since a delivered map, or takes it in.",
                "納品済みの図面と比較して新設・移動・消滅を抽出するか、地物として取り込みます。",
            ),
            needs_project=True,
        )

    def _simulate(self) -> Action:
        return Action(
            "simulate",
            Text("Simulate a recording…", "模擬計測データの作成…"),
            self.simulations.choose,
            "file",
            hint=Text(
                "Makes a street or a site with its truth, and shows what a sensor records.",
                "正解付きの道路・現場データを作り、センサーの計測結果を確認できます。",
            ),
        )

    def _of_the_project(self) -> tuple[Action, ...]:
        return (
            Action(
                "reference-system",
                Text("Reference system…", "座標参照系…"),
                self.choose_reference_system,
                "file",
                ("Ctrl+R",),
                hint=Text(
                    "Says what the coordinates refer to; no coordinate is changed.",
                    "座標が何に基づくかを指定します。座標値は変わりません。",
                ),
                needs_project=True,
            ),
            Action(
                "work-details",
                Text("Work details…", "工事情報…"),
                self.choose_work_details,
                "file",
                hint=Text(
                    "Says for whom and by whom the work is done, for reports and forms.",
                    "帳票に記載する工事名・発注者・受注者などを入力します。",
                ),
                needs_project=True,
            ),
            Action(
                "find-files",
                Text("Find delivered files…", "納品ファイルの場所を指定…"),
                self.choose_delivery,
                "file",
                hint=Text(
                    "Says in which folder missing point files and camera images are now.",
                    "見つからない点群ファイルとカメラ画像がある現在のフォルダを指定します。",
                ),
                needs_project=True,
            ),
            self._check(),
            Action(
                "adopt-catalogue",
                Text("Use an office's catalogue…", "事務所のカタログを使う…"),
                self.choose_catalogue,
                "file",
                hint=Text(
                    "Reads feature kinds from a file; kinds that the map uses are never lost.",
                    "地物の種別をファイルから読み込みます。図面で使用中の種別は失われません。",
                ),
                needs_project=True,
            ),
            Action(
                "export-catalogue",
                Text("Write the catalogue as a file…", "カタログをファイルに書き出す…"),
                self.choose_catalogue_copy,
                "file",
                hint=Text(
                    "To start an office's own from: docs/catalogue.md says how.",
                    "事務所独自のカタログの雛形になります（docs/catalogue.md参照）。",
                ),
                needs_project=True,
            ),
        )

    def _check(self) -> Action:
        return Action(
            "check-project",
            Text("Check project", "プロジェクトの検査"),
            self.checking.choose,
            "file",
            hint=Text(
                "Names damaged files of the project, and makes again what can be made again.",
                "プロジェクトの壊れたファイルを調べ、作り直せるものを修復します。",
            ),
            needs_project=True,
        )

    def _of_the_program(self) -> tuple[Action, ...]:
        return (
            Action(
                "demo",
                Text("Open the sample street", "サンプル街路を開く"),
                self.open_demo,
                "file",
                hint=Text(
                    "A short street to try everything on.", "操作を試せる短い街路データです。"
                ),
            ),
            Action(
                "close",
                Text("Close project", "プロジェクトを閉じる"),
                self._parts.document.close,
                "file",
                ("Ctrl+W",),
                hint=Text(
                    "Nothing has to be saved: every step was, when it was done.",
                    "操作のたびに保存されているため、保存の必要はありません。",
                ),
                needs_project=True,
            ),
            Action("quit", Text("Quit", "終了"), self._parts.window.close, "file", ("Ctrl+Q",)),
        )

    def choose_project(self) -> None:
        """Ask for a project folder and open it."""
        title = QCoreApplication.translate("FileActions", "Open project")
        name = QFileDialog.getExistingDirectory(
            self._parts.window, title, str(self._projects_folder)
        )
        if name:
            self._parts.document.open(Path(name))

    def choose_import(self, files: tuple[Path, ...] = ()) -> None:
        """Show the import form, with some files in it."""
        project = self._parts.document.project
        folder = project.folder if project else self._new_project_for(files)

        def make() -> ImportForm:
            kinds = FORMATS.filter_read(*DELIVERED, name=DELIVERIES)
            form = ImportForm(
                folder,
                files,
                self._parts.window,
                kinds=kinds.in_language(self._parts.language),
            )
            form.import_requested.connect(self._on_form_import_requested)
            DeliveryLook(form, self._parts.jobs, self._parts.language)
            return form

        self._dialogs.show(ImportForm, make).add_files(files)

    def choose_export(self) -> None:
        """Show the export form."""
        project = self._parts.document.project
        if project is None:
            return
        language = self._parts.language
        formats = tuple((one.id, one.map_title) for one in FORMATS.maps() if one.map_title)
        folder = project.folder.parent / f"{project.name}-export"

        def make() -> ExportForm:
            options, owners = FORMATS.map_options(), FORMATS.map_option_owners()
            choices = ExportChoices(formats, options, owners)
            form = ExportForm(folder, choices, language, self._parts.window)
            form.export_requested.connect(self._on_form_export_requested)
            return form

        self._dialogs.show(ExportForm, make)

    def choose_reference_system(self) -> None:
        """Ask what reference system the coordinates of the project are in."""
        document = self._parts.document
        if document.project is None:
            return

        def make() -> ReferenceSystemForm:
            form = ReferenceSystemForm(document.crs(), self._parts.window)
            form.system_chosen.connect(document.set_reference_system)
            return form

        self._dialogs.show(ReferenceSystemForm, make)

    def choose_work_details(self) -> None:
        """Ask what the papers of the project say of the work."""
        document = self._parts.document
        project = document.project
        if project is None:
            return
        store, name = WorkStore(project.settings), project.name

        def make() -> WorkDetailsForm:
            details = WorkDetails()
            try:
                details = store.details()
            except UserError as error:  # entered once more, they are right again
                document.refused.emit(error)
            form = WorkDetailsForm(details, name, self._parts.language, self._parts.window)
            form.details_given.connect(keep)
            return form

        def keep(given: WorkDetails) -> None:
            try:
                store.keep_details(given)
            except UserError as error:
                document.refused.emit(error)
                return
            form.close()

        form = self._dialogs.show(WorkDetailsForm, make)

    def choose_delivery(self) -> None:
        """Ask in which folder delivered files are now."""
        project = self._parts.document.project
        if project is None:
            return
        title = QCoreApplication.translate("FileActions", "Find delivered files")
        name = QFileDialog.getExistingDirectory(
            self._parts.window, title, str(project.folder.parent)
        )
        if name:
            self._parts.of(SourceWatch).look_in(Path(name))

    def choose_catalogue(self) -> None:
        """Ask for a catalogue file and use it in the project."""
        title = QCoreApplication.translate("FileActions", "Use an office's catalogue")
        files = FORMATS.filter_read(Content.CATALOGUE).in_language(self._parts.language)
        name, _ = QFileDialog.getOpenFileName(
            self._parts.window, title, str(self._projects_folder), files
        )
        if name:
            adopt_catalogue(self._parts, Path(name))

    def choose_catalogue_copy(self) -> None:
        """Ask where the project's catalogue is to be written."""
        title = QCoreApplication.translate("FileActions", "Write the catalogue")
        files = FORMATS.filter_written(Content.CATALOGUE).in_language(self._parts.language)
        name, _ = QFileDialog.getSaveFileName(
            self._parts.window,
            title,
            str(self._projects_folder / "catalogue.toml"),
            files,
        )
        if name:
            self._parts.document.export_catalogue(Path(name))

    def open_files(self, paths: tuple[Path, ...]) -> None:
        """Open a project, or import delivered files into the open or a new project."""
        if len(paths) == 1 and is_project(paths[0]):
            self._parts.document.open(paths[0])
            return
        document = self._parts.document
        # Without points they are for drives that are there already.
        sort_out = request_of_files if document.project is None else additions_of_files
        try:
            request = sort_out(paths, "")
        except UserError as error:
            self._parts.message_bar.show_error(error)
            return

        def start(clear: ImportRequest) -> None:
            if document.project is None:
                document.import_into_new(self._new_project_for(clear.inputs), clear)
            else:
                document.import_files(clear)

        with_columns(self._parts, request, start)

    def open_demo(self) -> None:
        """Open the sample street; the first time it is imported."""
        folder = self._projects_folder / "sample_street.zuka"
        if is_project(folder):
            self._parts.document.open(folder)
            return
        street = path_of("sample_street")
        self._parts.document.import_into_new(folder, request_of_files((street,), ""))

    def _new_project_for(self, files: tuple[Path, ...]) -> Path:
        """A project folder that does not exist yet, named after the first file's folder."""
        stem = files[0].resolve().parent.name if files else ""
        stem = stem or "street"
        folder = self._projects_folder / f"{stem}.zuka"
        number = 2
        while folder.exists():
            folder = self._projects_folder / f"{stem}-{number}.zuka"
            number += 1
        return folder

    def _on_form_import_requested(self, request: ImportOptions) -> None:
        document = self._parts.document
        is_open = (
            document.project is not None and document.project.folder == request.project.resolve()
        )
        sort_out = (
            additions_of_files if is_open or is_project(request.project) else request_of_files
        )
        try:
            files_request = sort_out(request.files, request.crs)
            if request.classes_as_labels:
                files_request = replace(files_request, labels="classification")
        except UserError as error:
            self._parts.message_bar.show_error(error)
            return

        def start(clear: ImportRequest) -> None:
            self._asked = self._import_into(request.project, clear), request

        with_columns(self._parts, files_request, start)

    def _import_into(self, folder: Path, request: ImportRequest) -> str:
        document = self._parts.document
        is_open = document.project is not None and document.project.folder == folder.resolve()
        if not is_open and not is_project(folder):
            return document.import_into_new(folder, request)
        return document.import_files(request) if is_open or document.open(folder) else ""

    def _on_jobs_failed(self, job: str) -> None:
        """What was chosen for an import that failed stands in the form again."""
        if self._asked is None or self._asked[0] != job:
            return
        asked, self._asked = self._asked[1], None
        self.choose_import(asked.files)
        for form in self._parts.window.findChildren(ImportForm):
            if form.isVisible():
                form.use_options(asked)

    def _on_form_export_requested(self, request: ExportOptions) -> None:
        self._parts.document.export(
            ExportRequest(
                formats=request.formats,
                folder=request.folder,
                language=self._parts.language,
                options=request.options,
                candidates=request.candidates,
            )
        )
