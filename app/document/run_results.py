"""RunResultApplier: a run from the request for it to what the project takes over of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

from app.document.job_results import JobResultApplier
from app.document.label_steps import LabelSteps
from app.document.long_work import run_work
from app.document.run_storing import FinishedRun
from app.jobs.jobs import JobLane
from processing.map.change import Change
from processing.project.importing.drive_completion import drive_changed
from processing.project.project import Project
from processing.project.results.found_classes import relabel_points
from processing.project.results.found_features import FoundFeatures
from processing.tools.runner import RunRequest, tool_of
from processing.tools.tool import FinishedColumns


@dataclass(frozen=True)
class RunResultApplier:
    """Starts runs, and hands over what they give.

    Attributes
    ----------
    adoption : JobResultApplier
    label_steps : LabelSteps
    store_run : callable
        Gets a run with its candidates or labels.
    """

    adoption: JobResultApplier
    label_steps: LabelSteps
    store_run: Callable[[FoundFeatures], object]

    def start(
        self,
        project: Project,
        request: RunRequest,
        store_columns: Callable[[FinishedColumns], None],
        lane: JobLane,
    ) -> str:
        """Run a tool in the background; gives the job's id.

        Parameters
        ----------
        store_columns : callable
            Gets what the tool says about the points of the request's drive.
        """
        tool, steps = tool_of(request.tool), self.label_steps
        step = steps.begin(project, tool.name, partial(relabel_points, tool=tool))
        title, work = run_work(
            request, project.temporary_folder(), project.label_folder(), step.missed.clear
        )

        def take(done: FinishedRun) -> None:
            if not _is_current(project, request, done):
                done.remove()
                drop()
                if lane is not JobLane.PREPARED:
                    raise drive_changed(request.drive.info.name)
                return
            if done.columns is not None:
                steps.drop(step)
                store_columns(done.columns)
            if (found := done.found) is not None:
                steps.arrive(step, found.change, partial(store, done, found))

        def store(done: FinishedRun, found: FoundFeatures, change: Change) -> None:
            done.keep_with(project.drive)
            self.store_run(replace(found, change=change))

        def drop() -> None:
            steps.drop(step)

        return self.adoption.start(project, title, work, take, lane=lane, otherwise=drop)


def _is_current(project: Project, request: RunRequest, done: FinishedRun) -> bool:
    """Whether the drives that a run is about still have the points that it was done on."""
    asked = {drive.id: drive for drive in (request.drive, *request.beside)}
    ids = (request.drive.id,) if done.found is None else done.found.run.drives
    folders = {drive.folder for drive in project.drives}
    return all(asked[id_].folder in folders for id_ in ids)
