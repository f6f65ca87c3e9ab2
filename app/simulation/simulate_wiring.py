"""Simulations: made in the background, then opened as a project.

The simulator is loaded when it is asked for; the window shows itself sooner.
"""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject
from PySide6.QtGui import QAction

from app.help.manual import show_manual
from app.jobs.jobs import JobLane
from app.window.window_parts import WindowParts
from processing.core.errors import UserError
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.laboratory.simulate.simulated import Simulated
from processing.project.importing.import_request import ImportRequest

if TYPE_CHECKING:
    from processing.laboratory.simulate.forecast import Forecast
    from widgets.dialogs.simulate import SimulateForm, SimulationRequest


class Simulations(QObject):
    """Shows the form, has its wish fulfilled, and opens what came of it.

    Parameters
    ----------
    parts : WindowParts
    folder : Path
        In which folders for simulated recordings are proposed.
    """

    def __init__(self, parts: WindowParts, folder: Path) -> None:
        # What is being made goes on through a change of language, as the document does.
        super().__init__(parts.document)
        self._parts, self._folder = parts, folder
        self._form: SimulateForm | None = None
        self._forecast = ""
        self._making: set[str] = set()
        self._importing: dict[str, Simulated] = {}
        self._waiting: Simulated | None = None
        parts.jobs.finished.connect(self._on_jobs_finished)
        parts.jobs.failed.connect(self._on_jobs_failed)
        parts.jobs.cancelled.connect(self._on_jobs_cancelled)

    def choose(self) -> None:
        """Show the form."""
        from widgets.dialogs.simulate import SimulateForm

        if self._form is not None:
            self._form.raise_()
            self._form.activateWindow()
            return
        form = SimulateForm(self._folder, self._parts.language, self._parts.window)
        form.forecast_wanted.connect(self._on_form_forecast_wanted)
        form.simulation_requested.connect(self._on_form_simulation_requested)
        form.help_requested.connect(self._on_form_help_requested)
        form.finished.connect(self._on_form_finished)
        self._form = form
        form.ask_forecast()
        form.show()

    def _on_form_finished(self) -> None:
        self._form = None

    def _on_form_help_requested(self) -> None:
        show_manual(self._parts, "simulate.html")

    def _on_form_forecast_wanted(self, asked: SimulationRequest) -> None:
        from processing.laboratory.simulate.simulations import SIMULATIONS

        def work(_monitor: Monitor) -> tuple[Forecast, int]:
            forecast = SIMULATIONS[asked.order].forecast(asked.request)
            return forecast, shutil.disk_usage(_there(asked.folder)).free

        title = Text("Forecast", "見積もり")
        # The last one counts; the others are worked out in a moment.
        self._forecast = self._parts.jobs.start(title, work, lane=JobLane.INTERACTIVE)

    def _on_form_simulation_requested(self, asked: SimulationRequest) -> None:
        from processing.laboratory.simulate.simulate_operation import operation_for, simulate

        operation = operation_for(asked.order, asked.request, asked.folder)

        def work(monitor: Monitor) -> Simulated:
            return simulate(operation, monitor)

        title = Text("Simulation: {name}", "模擬計測: {name}").filled(name=asked.folder.name)
        self._making.add(self._parts.jobs.start(title, work))

    def _on_jobs_finished(self, job: str, result: object) -> None:
        if job == self._forecast and isinstance(result, tuple) and self._form is not None:
            self._form.show_forecast(*result)
        elif job in self._making and isinstance(result, Simulated):
            self._making.discard(job)
            self._offer(result)
        elif job in self._importing:
            self._tell_truth(self._importing.pop(job))

    def _on_jobs_failed(self, job: str, error: UserError) -> None:
        if job == self._forecast and self._form is not None:
            self._form.show_refusal(error.line(self._parts.language))
        if job in self._making:
            self._parts.message_bar.show_error(error)
        self._on_jobs_cancelled(job)

    def _on_jobs_cancelled(self, job: str) -> None:
        self._making.discard(job)
        self._importing.pop(job, None)

    def _offer(self, made: Simulated) -> None:
        """Open it at once where nothing is open; nobody's work is put away unasked."""
        if self._parts.document.project is None:
            self._open(made)
            return
        self._waiting = made
        parts = self._parts
        is_wanted = QAction(self.tr("Open"), parts.message_bar)
        is_wanted.triggered.connect(self._on_open_triggered)
        parts.message_bar.show_error(describe_simulation_offer(made), is_wanted)

    def _on_open_triggered(self) -> None:
        made, self._waiting = self._waiting, None
        self._parts.message_bar.hide()
        if made is not None:
            self._open(made)

    def _open(self, made: Simulated) -> None:
        request = ImportRequest(made.points, made.trajectories, made.images, made.crs)
        job = self._parts.document.import_into_new(project_beside(made.folder), request)
        if job:
            self._importing[job] = made

    def _tell_truth(self, made: Simulated) -> None:
        reported = Text(
            "{points:,} points imported; their truth is in {folder}: see “zuka score”.",
            "{points:,}点をインポートしました。正解データは {folder} にあります"
            "（評価は zuka score）。",
        )
        self._parts.document.reported.emit(reported.filled(points=made.count, folder=made.truth))


def describe_simulation_offer(made: Simulated) -> UserError:
    """What is said of a simulation that is ready while a project is open."""
    return UserError(
        Text("The simulated recording is ready.", "模擬計測データができました。"),
        Text.same(str(made.folder)),
        Text(
            "Open it in place of this project, or import its files later.",
            "このプロジェクトに代えて開くか、後でファイルをインポートしてください。",
        ),
    )


def project_beside(folder: Path) -> Path:
    """A project folder beside a folder, with its name, that does not exist yet."""
    project, number = folder.with_name(f"{folder.name}.zuka"), 2
    while project.exists():
        project = folder.with_name(f"{folder.name}-{number}.zuka")
        number += 1
    return project


def _there(folder: Path) -> Path:
    """The nearest folder above that exists."""
    return next(one for one in (folder.resolve(), *folder.resolve().parents) if one.exists())
