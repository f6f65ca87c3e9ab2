"""Wiring: every connection between document, views, panels and jobs, on one page."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QObject

from app.classes.class_wiring import connect_classes
from app.drawing.drawing_wiring import connect_drawing
from app.importing.drive_wiring import connect_drives
from app.importing.import_wiring import connect_imports
from app.jobs.jobs import JobState, JobStatus
from app.review.review_wiring import connect_review
from app.runs.point_making import ask_and_make_points
from app.runs.process_actions import FIND_ALL, one_click_buttons, run_action_of
from app.templates.template_wiring import connect_templates
from app.views.view_wiring import connect_views
from app.volumes.volume_wiring import connect_volumes
from app.window.window_parts import WindowParts, take_down
from processing.core.errors import Unsuitable
from processing.core.text import Text
from processing.map.change import Change
from processing.tools.listed.registry import POINT_MAKERS, extractors, tools_of_drives
from processing.tools.running.runner import check_needs
from widgets.parts.job_view import JobView
from widgets.parts.literal_text import literal

_CANCELLED = Text("Cancelled: {title}", "中止しました: {title}")


def connect_lasting(parts: WindowParts) -> None:
    """Connect what stays through changes of language with each other, once."""
    document, toolbox = parts.document, parts.toolbox

    def apply(label: Text, change: Change) -> None:
        if not document.apply(label, change):
            toolbox.take_back()

    toolbox.change_requested.connect(apply)
    document.about_to_close.connect(toolbox.put_away)
    document.drive_results.points_leaving.connect(toolbox.put_away)


def connect_parts(parts: WindowParts) -> None:
    """Connect the widgets of a window with what stays; again for new ones."""
    wiring = _Wiring(parts)
    _connect_document(parts, wiring)
    _connect_intentions(parts, wiring)
    connect_drawing(parts)
    connect_views(parts)
    connect_drives(parts)
    connect_imports(parts)
    connect_review(parts)
    connect_templates(parts)
    connect_classes(parts)
    connect_volumes(parts)
    parts.window.closed.connect(wiring.on_window_closed)
    wiring.on_undo_stack_changed()
    wiring.on_toolbox_tool_chosen(parts.toolbox.name)
    if parts.toolbox.kind is not None:
        parts.layers_panel.mark_kind(parts.toolbox.kind)
    for status in parts.jobs.statuses:
        wiring.on_jobs_changed(status)
    wiring.show_recent()


def _connect_document(parts: WindowParts, wiring: _Wiring) -> None:
    document = parts.document
    document.opened.connect(wiring.on_document_opened)
    document.closed.connect(wiring.on_document_closed)
    document.refused.connect(parts.message_bar.show_error)
    document.reported.connect(parts.status_line.show_message)
    document.reported.connect(parts.message_bar.hide)
    document.undo_stack.changed.connect(parts.message_bar.hide)
    document.undo_stack.changed.connect(wiring.on_undo_stack_changed)
    document.shared.sketch.changed.connect(wiring.on_sketch_changed)
    parts.jobs.changed.connect(wiring.on_jobs_changed)
    parts.jobs.forgotten.connect(wiring.on_jobs_forgotten)
    document.shared.view_settings.image_changed.connect(parts.processing_panel.refresh)
    document.shared.map_changes.drives_changed.connect(parts.processing_panel.refresh)
    parts.processing_panel.ask_reasons_from(wiring.reason_against_tool)
    parts.processing_panel.ask_remarks_from(wiring.remark_on_tool)
    document.shared.view_settings.image_changed.connect(wiring.allow_tools)
    document.shared.map_changes.drives_changed.connect(wiring.allow_tools)
    wiring.allow_tools()


def _connect_intentions(parts: WindowParts, wiring: _Wiring) -> None:
    document, toolbox = parts.document, parts.toolbox
    toolbox.reported.connect(parts.status_line.show_message)
    toolbox.tool_chosen.connect(wiring.on_toolbox_tool_chosen)
    toolbox.kind_chosen.connect(parts.layers_panel.mark_kind)
    parts.layers_panel.kind_chosen.connect(wiring.on_layers_kind_chosen)
    parts.attribute_panel.change_requested.connect(document.apply)
    parts.feature_table.change_requested.connect(document.apply)
    parts.quality_panel.change_requested.connect(document.apply)
    parts.project_tree.change_requested.connect(document.apply)
    parts.project_tree.drive_chosen.connect(wiring.on_tree_drive_chosen)
    parts.processing_panel.run_requested.connect(wiring.on_processing_run_requested)
    parts.jobs_panel.cancel_requested.connect(parts.jobs.cancel)
    parts.status_line.cancel_requested.connect(parts.jobs.cancel)
    parts.image_bar.everything_requested.connect(parts.image_views.show_everything)
    parts.start_page.recent_chosen.connect(document.open)
    parts.start_page.forget_requested.connect(wiring.on_start_page_forget_requested)
    parts.image_bar.one_to_one_requested.connect(parts.image_views.show_one_to_one)


class _Wiring(QObject):
    """The few connections that have to translate between what is sent and what is asked."""

    def __init__(self, parts: WindowParts) -> None:
        super().__init__(parts.window.centralWidget())  # goes with the widgets
        self._parts = parts
        self._was_drawing = parts.toolbox.current_tool.is_busy

    def reason_against_tool(self, tool: str) -> Text | None:
        """Why a tool can't run on the drive shown; None when it can."""
        drive_id = self._parts.document.shared.view_settings.drive_id
        if not drive_id:
            return Text("Open a drive first.", "先に走行データを開いてください。")
        try:
            check_needs(tools_of_drives()[tool], self._parts.document.drive(drive_id))
        except Unsuitable as reason:
            return reason.what
        return None

    def allow_tools(self) -> None:
        """Let those tools be run by one click that can run on the drive shown."""
        for tool in one_click_buttons():
            reason = self.reason_against_tool(tool)
            self._parts.window.actions_made.forbid(run_action_of(tool), reason)
        reasons = [self.reason_against_tool(tool) for tool in extractors()]
        against_all = reasons[0] if reasons and all(reasons) else None
        self._parts.window.actions_made.forbid(FIND_ALL, against_all)

    def remark_on_tool(self, tool: str) -> Text | None:
        """What must be given for a tool on the drive shown; None where nothing must."""
        drive_id = self._parts.document.shared.view_settings.drive_id
        if not drive_id:
            return None
        return tools_of_drives()[tool].remark(self._parts.document.drive(drive_id))

    def on_document_opened(self) -> None:
        project = self._parts.document.project
        if project is not None:
            self._parts.settings.remember_project(project.folder)
            self._parts.window.show_title(project.name)
        self._parts.window.show_work(is_open=True)

    def on_document_closed(self) -> None:
        self._parts.window.show_work(is_open=False)
        self._parts.window.show_title("")
        self.show_recent()

    def on_start_page_forget_requested(self, folder: Path) -> None:
        self._parts.settings.forget_project(folder)
        self.show_recent()

    def show_recent(self) -> None:
        self._parts.start_page.show_recent(self._parts.settings.recent_projects)

    def on_undo_stack_changed(self) -> None:
        stack, language = self._parts.document.undo_stack, self._parts.language
        actions = self._parts.window.actions_by_id
        labels = {"undo": stack.undo_label, "redo": stack.redo_label}
        verbs = {
            "undo": Text("Undo: {label}", "元に戻す: {label}"),
            "redo": Text("Redo: {label}", "やり直す: {label}"),
        }
        plain = {"undo": Text("Undo", "元に戻す"), "redo": Text("Redo", "やり直す")}
        for name, label in labels.items():
            text = plain[name] if label is None else verbs[name].filled(label=label)
            actions[name].setText(literal(text.in_language(language)))
            # While something is drawn, undo takes its last vertex back.
            is_drawing = name == "undo" and self._was_drawing
            is_allowed = label is not None or is_drawing
            self._parts.window.actions_made.allow(name, is_allowed=is_allowed)

    def on_sketch_changed(self) -> None:
        is_drawing = self._parts.toolbox.current_tool.is_busy
        if is_drawing is not self._was_drawing:
            self._was_drawing = is_drawing
            self.on_undo_stack_changed()

    def on_toolbox_tool_chosen(self, name: str) -> None:
        self._parts.window.actions_by_id[f"tool-{name}"].setChecked(True)

    def on_layers_kind_chosen(self, kind_id: str) -> None:
        self._parts.toolbox.choose_kind(self._parts.document.catalogue()[kind_id])

    def on_tree_drive_chosen(self, drive_id: str) -> None:
        settings = self._parts.document.shared.view_settings
        kinds = self._parts.document.drive(drive_id).image_kinds
        kind = settings.image_kind if settings.image_kind in kinds else kinds[0]
        settings.show_image(drive_id, kind)

    def on_processing_run_requested(self, tool: str, parameters: object) -> None:
        drive_id = self._parts.document.shared.view_settings.drive_id
        if drive_id and tool in POINT_MAKERS:
            ask_and_make_points(self._parts, tool, drive_id, parameters)
        elif drive_id:
            self._parts.document.start_run(tool, drive_id, parameters)

    def on_jobs_changed(self, status: JobStatus) -> None:
        language = self._parts.language
        view = JobView(
            id=status.id,
            title=status.title.in_language(language),
            fraction=status.fraction,
            text=status.text.in_language(language),
            seconds_left=status.seconds_left,
            state=status.state.value,
            error="" if status.error is None else status.error.line(language),
            started="" if status.started_at is None else f"{status.started_at:%H:%M}",
            seconds=status.seconds,
            result=status.result.in_language(language),
        )
        self._parts.jobs_panel.show_job(view)
        running = status.state in (JobState.WAITING, JobState.RUNNING)
        self._parts.status_line.show_job(view if running else None)
        if status.state is JobState.CANCELLED:
            self._parts.status_line.show_message(_CANCELLED.filled(title=status.title))

    def on_jobs_forgotten(self, job: str) -> None:
        self._parts.jobs_panel.forget_job(job)
        at_work = [one for one in self._parts.jobs.statuses if not one.is_over]
        if not at_work:
            self._parts.status_line.show_job(None)

    def on_window_closed(self) -> None:
        self._parts.settings.remember_layout(self._parts.window.layout_to_keep())
        take_down(self._parts)
