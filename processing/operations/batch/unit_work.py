"""BatchUnit: what becomes one project, and the tasks by which it does; the next run goes on."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from processing.core.errors import Unsuitable, UserError
from processing.core.monitor import Monitor, parts_of
from processing.core.text import Text
from processing.operations.batch.deliveries import BatchDelivery
from processing.operations.batch.job import (
    JobFile,
    StepPlaces,
    is_import,
    kind_id_of,
    operation_of_step,
)
from processing.operations.batch.unit_state import (
    ErrorWords,
    TaskState,
    UnitState,
    input_files,
    read_state,
    refuse_other_files,
    write_state,
)
from processing.operations.extraction import ExtractOperation
from processing.operations.operation_files import operation_text, perform
from processing.operations.run import RunOperation
from processing.project.importing.import_request import ImportRequest
from processing.tools.running.runner import tool_of

_TITLES = {
    "import": Text("Import", "取り込み"),
    "learn": Text("Learn from corrections", "修正結果から学習"),
    "number": Text("Number along the routes", "測点・番号の記入"),
    "take-map": Text("Take in a map", "既存図の取り込み"),
    "compare-map": Text("Compare with a map", "既存図との比較"),
    "export": Text("Export", "書き出し"),
}
_NOTHING = ImportRequest(())


@dataclass(frozen=True)
class BatchUnit:
    """Deliveries that become one project: usually one.

    Attributes
    ----------
    name : str
    folder : Path
        Of its results.
    deliveries : tuple of BatchDelivery
    """

    name: str
    folder: Path
    deliveries: tuple[BatchDelivery, ...]

    @property
    def project(self) -> Path:
        """The folder of its project."""
        return self.folder / f"{self.name}.zuka"

    @property
    def size(self) -> int:
        """Bytes that were delivered."""
        return sum(one.size for one in self.deliveries)


@dataclass(frozen=True)
class PlannedTask:
    """A task of a unit.

    Attributes
    ----------
    operation : object
        Frozen, as files hold it; or what stands against it.
    ends_all : bool
        Whether no later task has a sense once it fails.
    """

    title: Text
    operation: Any  # any kind of operation
    ends_all: bool

    @property
    def text(self) -> str:
        """By what it is known again."""
        if isinstance(self.operation, UserError):
            return str(self.operation)
        return operation_text(self.operation)


def units_of(file: JobFile, deliveries: Sequence[BatchDelivery]) -> tuple[BatchUnit, ...]:
    """The projects that a job makes."""
    if file.job.results == "one":
        return (BatchUnit(file.name, file.output / file.name, tuple(deliveries)),)
    return tuple(BatchUnit(one.name, file.output / one.name, (one,)) for one in deliveries)


def is_finished(file: JobFile, unit: BatchUnit) -> bool:
    """Whether all that is asked of a unit is done, of the files that lie there now."""
    try:
        state = read_state(unit.folder, unit.name)
        if not state.is_whole or state.trouble is not None:
            return False
        requests = [one.request() for one in unit.deliveries]
        files = input_files(requests, state)
        tasks = tuple(planned_tasks(file, unit))
    except UserError:
        return False  # the process that works on it says why
    return _contents(files) == _contents(state.files) and [one.text for one in tasks] == [
        one.task for one in state.tasks
    ]


def _contents(files: Sequence[Any]) -> list[tuple[str, str]]:
    return [(one.path, one.sha256) for one in files]


def planned_tasks(file: JobFile, unit: BatchUnit) -> Iterator[PlannedTask]:
    """The tasks of a unit in their order; an extraction is a task for each tool.

    Raises
    ------
    UserError
        A step can't be, of this drive.
    """
    places = StepPlaces(unit.name, unit.folder, unit.project, _NOTHING)
    is_shared = file.job.results == "one"
    for number, step in enumerate(file.job.steps):
        if is_import(step):
            for delivery in unit.deliveries:
                yield _import_task(file, number, places, delivery, is_shared=is_shared)
            continue
        operation = operation_of_step(file, number, places)
        if isinstance(operation, ExtractOperation):
            for run in operation.runs:
                yield PlannedTask(tool_of(run.tool).name, run, ends_all=False)
        elif isinstance(operation, RunOperation):
            yield PlannedTask(tool_of(operation.tool).name, operation, ends_all=True)
        else:
            yield PlannedTask(_TITLES[kind_id_of(step)], operation, ends_all=True)


def _import_task(
    file: JobFile, number: int, places: StepPlaces, delivery: BatchDelivery, *, is_shared: bool
) -> PlannedTask:
    title = _TITLES["import"]
    if is_shared:
        title = Text("{title}: {name}", "{title}: {name}").filled(title=title, name=delivery.name)
    try:
        own = replace(places, request=delivery.request())
        operation = operation_of_step(file, number, own)
    except UserError as error:
        return PlannedTask(title, error, ends_all=not is_shared)
    return PlannedTask(title, operation, ends_all=not is_shared)


def work_on(file: JobFile, unit: BatchUnit, monitor: Monitor, peak: Callable[[], int]) -> UnitState:
    """Do what is still to be done for a unit; each task is noted when it is done.

    What goes wrong in a task is noted with it. A task that was killed is done again: its operation
    gives the same the second time.

    Parameters
    ----------
    peak : callable
        The most memory that was held since it was asked last, bytes.

    Raises
    ------
    Cancelled
        The running task has left nothing; those before are noted.
    """
    unit.folder.mkdir(parents=True, exist_ok=True)
    known = read_state(unit.folder, unit.name)
    requests = tuple(_requests(unit))
    files = input_files(requests, known)
    refuse_other_files(known, files, unit.folder)
    tasks = tuple(planned_tasks(file, unit))
    settled = {one.task: one for one in known.tasks if one.is_settled}
    state = UnitState(unit.name, files)
    is_anew = has_ended = False
    for task, part in zip(tasks, parts_of(monitor, [1] * len(tasks)), strict=True):
        before = None if is_anew else settled.get(task.text)
        done = before or _tried(task, part, peak)
        is_anew = is_anew or (before is None and done.became == "done")
        state = replace(state, tasks=(*state.tasks, done))
        if before is None:
            write_state(unit.folder, state)
        has_ended = not done.is_settled and task.ends_all
        if has_ended:
            break
    state = replace(state, is_whole=not has_ended and all(one.is_settled for one in state.tasks))
    write_state(unit.folder, state)
    return state


def _requests(unit: BatchUnit) -> Iterator[ImportRequest]:
    for one in unit.deliveries:
        try:
            yield one.request()
        except UserError:
            continue  # told with the task of its import


def _tried(task: PlannedTask, monitor: Monitor, peak: Callable[[], int]) -> TaskState:
    started = time.monotonic()
    peak()
    monitor.report(0.0, task.title)
    monitor.check()
    try:
        if isinstance(task.operation, UserError):
            raise task.operation
        outcome = perform(task.operation, monitor)
    except UserError as error:
        is_unsuited = isinstance(error, Unsuitable) and not task.ends_all
        return TaskState(
            task.text,
            task.title,
            "unsuited" if is_unsuited else "failed",
            time.monotonic() - started,
            peak(),
            error=ErrorWords.of(error),
        )
    words = tuple(getattr(outcome, "words", ()))
    return TaskState(task.text, task.title, "done", time.monotonic() - started, peak(), words=words)
