"""Application: builds everything in the order it depends on, runs the window, takes it down."""

from __future__ import annotations

import signal
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from types import FrameType

from platformdirs import user_documents_path
from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QApplication

from app.classes.class_learning import ClassLearning
from app.classes.truth_evaluations import TruthEvaluations
from app.cli.window_request import WindowRequest
from app.document.document import Document
from app.drawing.draw_actions import draw_actions
from app.drawing.edit_actions import edit_actions
from app.drawing.mouse_tool_factory import make_toolbox
from app.drawing.tool_entries import TOOL_ENTRIES
from app.help.crash_news import tell_of_crashes
from app.help.help_actions import HelpActions
from app.importing.file_actions import FileActions
from app.importing.source_watch import SourceWatch
from app.jobs.crash_report import NotedRun, report_broken_runs, runs_folder
from app.jobs.jobs import JobQueue
from app.keys.shortcut_editing import give_keys
from app.layout.view_area import ViewArea
from app.layout.view_docks import DockedView, ViewDocks
from app.panel_places import panels_of
from app.review.review import Review
from app.review.review_actions import review_actions
from app.runs.process_actions import process_actions
from app.settings.settings import Settings
from app.settings.theme import Theme
from app.settings.translation import Translation
from app.views.layout_actions import adopt_view_toggles, layout_actions
from app.views.sight_actions import sight_actions
from app.views.view_actions import view_actions
from app.volumes.earthwork import Earthwork
from app.volumes.volume_exports import VOLUME_EXPORTS
from app.window.main_window import MainWindow
from app.window.quitting import Quitting
from app.window.window_contents import WindowContents
from app.window.window_parts import LastingParts, WindowParts
from app.window_change import WindowChange
from app.wiring import connect_lasting, connect_parts
from processing.core.text import Language, Text
from processing.tools.volume import VOLUME
from widgets.camera_view.panel import CameraPanel
from widgets.image_view.side_by_side import ImageViews
from widgets.map_view.view import MapView
from widgets.panels.attributes.attribute_panel import AttributePanel
from widgets.panels.class_evaluation.class_panel import ClassPanel
from widgets.panels.class_evaluation.study_panel import StudyPanel
from widgets.panels.jobs_panel import JobsPanel
from widgets.panels.processing.processing_panel import ProcessingPanel
from widgets.panels.project.label_panel import LabelPanel
from widgets.panels.project.layers_panel import LayersPanel
from widgets.panels.project.project_tree import ProjectTree
from widgets.panels.quality.quality_panel import QualityPanel
from widgets.panels.review.evaluation_panel import EvaluationPanel
from widgets.panels.review.review_panel import ReviewPanel
from widgets.panels.table.feature_table import FeatureTable
from widgets.panels.templates.template_panel import TemplatePanel
from widgets.panels.volume.volume_panel import VolumePanel
from widgets.panels.waveform.pulse_panel import PulsePanel
from widgets.parts.drawing_bar import DrawingBar
from widgets.parts.image_bar import ImageBar
from widgets.parts.message_bar import MessageBar
from widgets.parts.start_page import StartPage
from widgets.parts.status_line import StatusLine
from widgets.scene_view.view import SceneView
from widgets.section_view.view import SectionView
from widgets.shared.shared_state import SharedState

_SIGNALS_SEEN_MS = 250


def run_window(request: WindowRequest) -> int:
    """Show the window with what is wished; gives the exit status when it is closed."""
    application = make_application()
    if request.headless_out is not None:
        return _do_demo_job(request.headless_out)
    broken = report_broken_runs(runs_folder())
    noted = NotedRun(runs_folder())
    parts = build_window(Settings(), user_documents_path() / "Zuka")
    parts.window.show()
    _close_on_signals(parts.window)
    tell_of_crashes(parts, broken)
    QTimer.singleShot(0, lambda: _fulfil(request, parts))
    QTimer.singleShot(0, parts.document.tiles.get_ready)
    status = int(application.exec())
    noted.end()
    return status


def _close_on_signals(window: MainWindow) -> None:
    """Let the system's request to end close the window as its button does."""

    def close(_signal: int, _frame: FrameType | None) -> None:
        window.close_at_once()

    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, close)
    # Python sees signals only between its own instructions, and Qt's loop runs none by itself.
    pulse = QTimer(window)
    pulse.timeout.connect(lambda: None)
    pulse.start(_SIGNALS_SEEN_MS)


def _do_demo_job(out: Path) -> int:
    """The demo by itself, in a window that knows nothing of its user's habits."""
    from app.demo.demo_job import do_demo_job

    with TemporaryDirectory(prefix="zuka-") as folder:
        parts = build_window(Settings(Path(folder) / "settings.ini"), Path(folder))
        parts.window.show()
        return do_demo_job(parts, out)


def make_application() -> QApplication:
    """The one Qt application, with its look and its language."""
    application = QApplication.instance()
    if not isinstance(application, QApplication):
        application = QApplication(sys.argv[:1])
    application.setApplicationName("Zuka")
    Theme.of(application)
    return application


def build_window(settings: Settings, projects_folder: Path) -> WindowParts:
    """All parts of a window, connected; not shown yet.

    Parameters
    ----------
    projects_folder : Path
        Where new projects are made unless the user says otherwise.
    """
    lasting = _make_lasting(settings)
    translation = Translation(lasting.window)
    translation.speak(settings.language)
    parts = _make_parts(lasting, settings.language)
    files = FileActions(parts, projects_folder)
    connect_lasting(parts)
    parts.window.ask_before_closing(Quitting(parts).may_close)
    parts.window.files_dropped.connect(files.open_files)

    def furnish() -> None:
        _furnish(parts, files, change)

    change = WindowChange(parts, translation, lambda new: _make_parts(lasting, new), furnish)
    furnish()
    if settings.layout is not None:
        parts.window.restore_layout(settings.layout)
    return parts


def _make_lasting(settings: Settings) -> LastingParts:
    theme = Theme.of(make_application())
    theme.choose(settings.theme)
    jobs = JobQueue()
    document = Document(jobs)
    document.shared.view_settings.orient_image(settings.image_orientation)
    owners: tuple[object, ...] = (
        Review(document, document),
        SourceWatch(document, document),
        TruthEvaluations(document, jobs, document),
        ClassLearning(document, jobs, document),
        Earthwork(document, jobs, document),
    )
    return LastingParts(
        settings=settings,
        theme=theme,
        jobs=jobs,
        document=document,
        toolbox=make_toolbox(document),
        window=MainWindow(),
        owners={type(owner): owner for owner in owners},
    )


def _make_parts(lasting: LastingParts, language: Language) -> WindowParts:
    document = lasting.document
    shared, tiles = document.shared, document.tiles
    image_views = ImageViews(document, shared, tiles, language=language)
    scene_view = SceneView(document, shared, tiles, language=language)
    scene_view.clipping.set_slab(lasting.settings.slab)
    section_view = SectionView(document, shared, language=language)
    section_view.use_settings(lasting.settings.section)
    camera_panel = CameraPanel(document, shared, language=language)
    map_view = MapView(document, shared, tiles, language=language)
    views = (
        DockedView("scene", Text.same("3D"), scene_view),
        DockedView("section", Text("Section", "断面"), section_view),
        DockedView("camera", Text("Camera", "カメラ"), camera_panel),
        DockedView("map", Text("Map", "地図"), map_view),
    )
    image_bar = ImageBar(document, shared, language)
    hints = {entry.name: entry.hint for entry in TOOL_ENTRIES}
    message_bar = MessageBar(language)
    start_page = StartPage(language)
    status_line = StatusLine(document, shared, language)
    return WindowParts(
        language=language,
        settings=lasting.settings,
        theme=lasting.theme,
        jobs=lasting.jobs,
        document=document,
        toolbox=lasting.toolbox,
        image_views=image_views,
        scene_view=scene_view,
        section_view=section_view,
        camera_panel=camera_panel,
        map_view=map_view,
        view_docks=ViewDocks(views, language),
        image_bar=image_bar,
        drawing_bar=DrawingBar(shared, hints, language),
        message_bar=message_bar,
        start_page=start_page,
        status_line=status_line,
        project_tree=ProjectTree(document, shared, language),
        layers_panel=LayersPanel(document, shared, language),
        processing_panel=ProcessingPanel(language),
        attribute_panel=AttributePanel(document, shared, language),
        review_panel=ReviewPanel(document, shared, language),
        evaluation_panel=EvaluationPanel(document, shared, language),
        class_panel=ClassPanel(shared, language),
        quality_panel=QualityPanel(document, shared, document.run_in_background, language),
        study_panel=StudyPanel(language),
        label_panel=LabelPanel(document, shared, language),
        template_panel=TemplatePanel(
            document, shared, document.templates, document.run_in_background, language=language
        ),
        volume_panel=_make_volume_panel(shared, language),
        pulse_panel=PulsePanel(document, shared, document.run_in_background, language),
        feature_table=FeatureTable(document, shared, language),
        jobs_panel=JobsPanel(language),
        window=lasting.window,
        owners=lasting.owners,
    )


def _make_volume_panel(shared: SharedState, language: Language) -> VolumePanel:
    exports = tuple((one.id, one.name) for one in VOLUME_EXPORTS)
    return VolumePanel(shared, VOLUME.parameters, exports, language=language)


def _furnish(parts: WindowParts, files: FileActions, change: WindowChange) -> None:
    """Put the widgets into the window, with all that one can do with them."""
    parts.toolbox.use_views(parts.views)
    contents = WindowContents(
        language=parts.language,
        start_page=parts.start_page,
        views=ViewArea(parts.image_views, parts.view_docks),
        tools=parts.image_bar,
        header=parts.drawing_bar,
        message=parts.message_bar,
        status=parts.status_line,
    )
    parts.window.hold(contents)
    _add_actions(parts, files, change)
    parts.window.end_toolbar(contents.tools)
    parts.window.add_panels(panels_of(parts), parts.language)
    give_keys(parts)
    connect_parts(parts)
    parts.window.show_work(is_open=parts.document.project is not None)


def _add_actions(parts: WindowParts, files: FileActions, change: WindowChange) -> None:
    help_ = HelpActions(parts)
    actions = (
        *files.actions(),
        *edit_actions(parts),
        *layout_actions(parts),
        *sight_actions(parts),
        *view_actions(parts, change.speak),
        *draw_actions(parts),
        *process_actions(parts),
        *review_actions(parts),
        *help_.actions(),
    )
    parts.window.add_actions(actions)
    files.recent.connect()
    adopt_view_toggles(parts)
    parts.window.show_in_corner("language-en" if parts.language == "ja" else "language-ja")
    parts.start_page.open_requested.connect(files.choose_project)
    parts.start_page.import_requested.connect(files.choose_import)
    parts.start_page.demo_requested.connect(files.open_demo)
    parts.start_page.simulation_requested.connect(files.simulations.choose)
    parts.project_tree.trajectory_requested.connect(files.drives.choose_trajectory)
    parts.project_tree.images_requested.connect(files.drives.choose_images)
    parts.project_tree.properties_requested.connect(files.properties.choose)
    parts.project_tree.removal_requested.connect(files.drives.remove)
    for view in (parts.image_views, parts.map_view):
        view.open_requested.connect(files.choose_project)
        view.import_requested.connect(files.choose_import)


def _fulfil(request: WindowRequest, parts: WindowParts) -> None:
    actions = parts.window.actions_by_id
    if request.demo:
        actions["demo"].trigger()
    elif request.paths:
        parts.window.files_dropped.emit(request.paths)
