"""RunResultApplier: a run from the operation that is asked for to what the project stores of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

from app.document.job_results import JobResultApplier
from app.document.label_steps import LabelSteps
from app.document.long_work import run_work
from app.jobs.jobs import JobLane
from processing.map.change import Change
from processing.operations.inputs import OpenedInputs, inputs_in
from processing.operations.run import RunFolders, RunOperation
from processing.operations.runs.finished_runs import FinishedRun
from processing.project.importing.drive_completion import drive_changed
from processing.project.project import Project
from processing.project.results.found_classes import relabel_points
from processing.project.results.found_features import FoundFeatures
from processing.tools.running.runner import tool_of


@dataclass(frozen=True)
class RunResultApplier:
    """Starts runs, and hands over what they give.

    Attributes
    ----------
    adoption : JobResultApplier
    label_steps : LabelSteps
    store : callable
        Gets a finished run, for the project.
    store_prepared : callable
        Gets one that nobody asked for.
    """

    adoption: JobResultApplier
    label_steps: LabelSteps
    store: Callable[[FinishedRun], object]
    store_prepared: Callable[[FinishedRun], object]

    def start(self, project: Project, operation: RunOperation, lane: JobLane) -> str:
        """Run a tool on one drive in the background; gives the job's id."""
        opened = inputs_in(project, operation.inputs.drives)
        tool, steps = tool_of(operation.tool), self.label_steps
        step = steps.begin(project, tool.name, partial(relabel_points, tool=tool))
        folders = RunFolders.of(project, len(opened.chosen))
        title, work = run_work(operation, opened, folders, step.missed.clear)

        def take(all_done: tuple[FinishedRun, ...]) -> None:
            (done,) = all_done
            if not _is_current(project, opened, done):
                done.remove()
                drop()
                if lane is not JobLane.PREPARED:
                    raise drive_changed(opened.chosen[0].info.name)
                return
            if done.columns is not None:
                steps.drop(step)
                if lane is not JobLane.PREPARED:
                    self.store(done)
                elif _has_columns(project, done):
                    # The user ran the tool meanwhile, with parameters of their own.
                    done.remove()
                else:
                    self.store_prepared(done)
            if (found := done.found) is not None:
                steps.arrive(step, found.change, partial(store, done, found))

        def store(done: FinishedRun, found: FoundFeatures, change: Change) -> None:
            self.store(replace(done, found=replace(found, change=change)))

        def drop() -> None:
            steps.drop(step)

        return self.adoption.start(project, title, work, take, lane=lane, otherwise=drop)


def _has_columns(project: Project, done: FinishedRun) -> bool:
    """Whether a drive has what a run made for it."""
    names = () if done.columns is None else done.columns.names
    return all(map(project.drive(done.drive).columns.has, names))


def _is_current(project: Project, opened: OpenedInputs, done: FinishedRun) -> bool:
    """Whether the drives that a run is about still have the points that it was done on."""
    asked = {drive.id: drive for drive in opened.drives}
    ids = (done.drive,) if done.found is None else done.found.run.drives
    folders = {drive.folder for drive in project.drives}
    return all(asked[id_].folder in folders for id_ in ids)
