"""DeliveryLook: the import form says what was chosen, and what lies beside it, before it runs."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from PySide6.QtCore import QObject

from app.importing.delivery_words import rows_of, shapes_of, summary_of
from app.jobs.jobs import JobLane, JobQueue
from processing.core.errors import UserError
from processing.core.monitor import Monitor
from processing.core.text import Language, Text
from processing.operations.delivery_overview import DeliveryOverview, look_at_delivery
from processing.project.importing.dropped_files import additions_of_files
from processing.project.importing.trajectory_beside import (
    images_beside,
    trajectories_beside,
    wants_trajectory,
)
from processing.project.project import is_project
from widgets.dialogs.import_drive import ImportForm

_LOOKING = Text("Looking at the files", "ファイルを調べています")


@dataclass(frozen=True)
class _Looked:
    """What was found in files and beside them."""

    overview: DeliveryOverview
    trajectories: tuple[Path, ...] = ()
    is_lacking: bool = False
    images: tuple[Path, ...] = ()
    project: Path | None = None


class DeliveryLook(QObject):
    """Looks at a form's files in the background whenever these change; goes with the form.

    Parameters
    ----------
    form : ImportForm
    jobs : JobQueue
    language : Language
    """

    def __init__(self, form: ImportForm, jobs: JobQueue, language: Language) -> None:
        super().__init__(form)
        self._form = form
        self._jobs = jobs
        self._language: Language = language
        self._job = ""
        form.files_changed.connect(self._look)
        jobs.finished.connect(self._on_jobs_finished)
        self._look(form.files)

    def _look(self, files: tuple[Path, ...]) -> None:
        crs = self._form.crs
        if self._job:
            self._jobs.cancel(self._job)

        def work(monitor: Monitor) -> _Looked:
            return look_beside(look_at_delivery(files, crs, monitor), files, crs)

        self._job = self._jobs.start(_LOOKING, work, lane=JobLane.INTERACTIVE)

    def _on_jobs_finished(self, job: str, found: object) -> None:
        if job != self._job or not isinstance(found, _Looked):
            return
        overview, language = found.overview, self._language
        said = "\n".join(line.in_language(language) for line in summary_of(overview))
        self._form.show_delivery(rows_of(overview, language), shapes_of(overview), said)
        self._form.offer(found.trajectories, is_lacking=found.is_lacking)
        self._form.offer_images(found.images)
        self._form.offer_project(found.project)


def look_beside(overview: DeliveryOverview, files: tuple[Path, ...], crs: str) -> _Looked:
    """What was chosen, with what lies beside it and would belong to it."""
    try:
        request = additions_of_files(files, crs)
    except UserError:  # the import tells
        return _Looked(overview)
    inputs = request.inputs
    images = () if request.images or not inputs else images_beside(inputs)
    homes = dict.fromkeys(path.resolve().parent for path in inputs)
    beside = [one for home in homes for one in sorted(home.glob("*.zuka")) if is_project(one)]
    project = beside[0] if beside else None
    if request.trajectories or not wants_trajectory(inputs):
        return _Looked(overview, images=images, project=project)
    return _Looked(
        overview, trajectories_beside(inputs, crs), is_lacking=True, images=images, project=project
    )
