"""TrajectoryOffer: looks beside the files of an import form for the trajectory they lack."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QObject

from app.jobs.jobs import JobLane, JobQueue
from processing.core.errors import UserError
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.project.importing.dropped_files import additions_of_files
from processing.project.importing.trajectory_beside import trajectories_beside, wants_trajectory
from widgets.dialogs.import_drive import ImportForm

_LOOKING = Text("Looking for the trajectory", "走行軌跡を探しています")


class TrajectoryOffer(QObject):
    """Offers in a form what lies beside its files, whenever these change; goes with the form.

    Parameters
    ----------
    form : ImportForm
    jobs : JobQueue
    """

    def __init__(self, form: ImportForm, jobs: JobQueue) -> None:
        super().__init__(form)
        self._form = form
        self._jobs = jobs
        self._job = ""
        form.files_changed.connect(self._look)
        jobs.finished.connect(self._on_jobs_finished)
        self._look(form.files)

    def _look(self, files: tuple[Path, ...]) -> None:
        crs = self._form.crs

        def work(_monitor: Monitor) -> tuple[tuple[Path, ...], bool]:
            try:
                request = additions_of_files(files, crs)
            except UserError:  # the import tells
                return (), False
            if request.trajectories or not wants_trajectory(request.inputs):
                return (), False
            return trajectories_beside(request.inputs, crs), True

        self._job = self._jobs.start(_LOOKING, work, lane=JobLane.INTERACTIVE)

    def _on_jobs_finished(self, job: str, found: object) -> None:
        if job == self._job and isinstance(found, tuple):
            beside, is_lacking = found
            self._form.offer(beside, is_lacking=is_lacking)
