"""Running a tool: a value that says what on what, and the one function that does it.

The window, the command line and a written operation come here: into a file, or into a project as
runs that can be undone.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from processing.core.errors import MissingInput, OutOfRange
from processing.core.monitor import Monitor, PartMonitor
from processing.core.parameters import ParameterValue, fill_parameters, parameters_of
from processing.core.text import Language, Text
from processing.formats.format import Content
from processing.formats.registry import FORMATS
from processing.operations.inputs import (
    OpenedInputs,
    OperationInputs,
    inputs_in,
    opened_inputs,
    opened_project,
)
from processing.operations.run_files import write_run
from processing.operations.runs.finished_runs import FinishedRun, finish_run
from processing.operations.store import StoredRun, accept_above, store_run
from processing.project.own_models import with_own_model
from processing.project.project import Project
from processing.project.results.surface_files import surface_beside, surface_file_of
from processing.recording.drive import Drive
from processing.tools.running.run_shares import RunShare, run_shares
from processing.tools.running.runner import RunRequest, check_needs, tool_of
from processing.tools.tool import Tool

_RUNNING = 0.95


@dataclass(frozen=True)
class RunOperation:
    """A tool to be run.

    Attributes
    ----------
    tool : str
        Id of a tool that runs on drives.
    inputs : OperationInputs
    parameters : mapping of str to value
        Those that are given, by name; the others are the tool's own.
    output : Path or None
        The file of the result; None to store it in the project.
    accept_above : float or None
        Candidates stored with at least this confidence, 0 to 1, are accepted at once.
    language : "en", "ja" or None
        Of the headers of a table; None for the ids of its columns, which scripts read.
    """

    tool: str
    inputs: OperationInputs
    parameters: Mapping[str, ParameterValue] = field(default_factory=dict)
    output: Path | None = None
    accept_above: float | None = None
    language: Language | None = None

    @property
    def parameter_class(self) -> type[Any]:
        """The tool's own parameters.

        Raises
        ------
        OutOfRange
            There is no such tool.
        """
        return tool_of(self.tool).parameters

    def check(self) -> None:
        """Refuse what can't come to a good end before anything is opened.

        Raises
        ------
        OutOfRange
            There is no such tool, parameter, value or kind of file.
        MissingInput
            There is nothing to run on, or nowhere to store the result.
        """
        tool = tool_of(self.tool)
        fill_parameters(tool.parameters, self.parameters)
        if self.inputs.project is None and not self.inputs.points:
            raise no_single_input(self.tool)
        if self.output is not None:
            _check_output(tool, self.output, self.inputs)
        elif self.inputs.project is None:
            raise MissingInput(
                Text(
                    "The result has no place: only a project can store it.",
                    "結果の保存先がありません。保存できるのはプロジェクトだけです。",
                ),
                Text.same(", ".join(str(path) for path in self.inputs.points)),
                Text("Name a file with --output.", "--output でファイルを指定してください。"),
            )
        if self.accept_above is not None:
            self._check_acceptance(tool, self.accept_above)

    def _check_acceptance(self, tool: Tool, least: float) -> None:
        if not tool.gives_candidates or self.output is not None:
            raise OutOfRange(
                Text(
                    "Only candidates stored in a project can be accepted.",
                    "採用できるのはプロジェクトに保存した候補だけです。",
                ),
                Text.same(f"{self.tool}, accept_above={least:g}"),
                Text("Leave it out.", "この指定を外してください。"),
            )
        if not 0.0 <= least <= 1.0:
            raise OutOfRange(
                Text("A confidence is between 0 and 1.", "信頼度は0から1までの値です。"),
                Text.same(f"accept_above={least:g}"),
                Text("Use for instance 0.9.", "0.9 などの値を指定してください。"),
            )


@dataclass(frozen=True)
class RunOutcome:
    """What came of a run.

    Attributes
    ----------
    paths : tuple of Path
        The files that were written.
    stored : tuple of StoredRun
        The runs that a project has now.
    accepted : int
        Candidates of theirs that were accepted at once.
    """

    paths: tuple[Path, ...] = ()
    stored: tuple[StoredRun, ...] = ()
    accepted: int = 0

    @property
    def words(self) -> tuple[Text, ...]:
        """A line for each thing that was done."""
        lines = [Text.same(str(path)) for path in self.paths]
        lines += [one.summary for one in self.stored]
        if self.accepted:
            lines.append(_ACCEPTED.filled(count=f"{self.accepted:,}"))
        return tuple(lines)


_ACCEPTED = Text("{count} of them accepted", "うち{count}件を採用")


@dataclass(frozen=True)
class RunFolders:
    """New names of a project for what a run writes before it is stored.

    Attributes
    ----------
    columns : Path
        On the disk of the drives.
    labels : Path
        For labels of many points.
    """

    columns: Path
    labels: Path

    @staticmethod
    def of(project: Project, count: int) -> tuple[RunFolders, ...]:
        """Folders for so many runs."""
        return tuple(
            RunFolders(project.temporary_folder(), project.label_folder()) for _ in range(count)
        )


def run_operation(operation: RunOperation, monitor: Monitor) -> RunOutcome:
    """Run a tool on all drives of its inputs; write the result, or store it in the project.

    Raises
    ------
    UserError
        As :meth:`RunOperation.check`, and what stands against reading, running or writing; neither
        a file nor the project was changed. Only where a disk is full at the very end, the project
        has the runs that were stored before it was.
    Cancelled
        Neither was changed.
    """
    operation.check()
    if operation.output is None:
        return _stored(operation, monitor)
    output = operation.output
    with opened_inputs(operation.inputs, monitor, beside=output.parent) as opened:
        return run_to_file(operation, opened, output, monitor)


def run_to_file(
    operation: RunOperation, opened: OpenedInputs, output: Path, monitor: Monitor
) -> RunOutcome:
    """Run a tool on inputs that are open already, and write what it gives.

    Raises
    ------
    UserError, Cancelled
        Nothing was written.
    """
    tool, parameters = _what(operation, opened)
    _check_needs(tool, opened.chosen)
    return RunOutcome(
        paths=write_run(tool, parameters, opened, output, monitor, language=operation.language)
    )


def run_in_project(operation: RunOperation, project: Project, monitor: Monitor) -> RunOutcome:
    """Run a tool on drives of a project that is open for writing, and store what it gives.

    All runs are finished before the first is stored: a failure leaves the project as it was.

    Raises
    ------
    UserError, Cancelled
        As :func:`run_operation`.
    """
    opened = inputs_in(project, operation.inputs.drives)
    folders = RunFolders.of(project, len(opened.chosen))
    done = finish_runs(operation, opened, folders, PartMonitor(monitor, 0.0, _RUNNING))
    stored = tuple(store_run(project, one) for one in done)
    least = operation.accept_above
    accepted = 0 if least is None else accept_above(project, stored, least)
    return RunOutcome(stored=stored, accepted=accepted)


def finish_runs(
    operation: RunOperation,
    opened: OpenedInputs,
    folders: Sequence[RunFolders],
    monitor: Monitor,
    *,
    begin: Callable[[], None] = lambda: None,
) -> tuple[FinishedRun, ...]:
    """Run a tool as far as it needs no project; for a worker's thread.

    Parameters
    ----------
    folders : sequence of RunFolders
        At least one for each drive that the operation is for.
    begin : callable
        As of :func:`processing.operations.runs.finished_runs.finish_run`.

    Returns
    -------
    tuple of FinishedRun
        To be stored or removed.

    Raises
    ------
    UserError, Cancelled
        Nothing is left.
    """
    tool, parameters = _what(operation, opened)
    _check_needs(tool, opened.chosen)
    shares = [*run_shares(tool.id, opened.chosen, parameters, monitor, beside=opened.beside)]
    done: list[FinishedRun] = []
    try:
        for share, own in zip(shares, folders, strict=False):
            request = share.request if len(shares) == 1 else _with_own_surface(share)
            labels = own.labels
            done.append(
                finish_run(request, own.columns, share.monitor, labels_into=labels, begin=begin)
            )
    except BaseException:
        for one in done:
            one.remove()
        raise
    return tuple(done)


def operation_on_drive(tool: str, parameters: object, folder: Path, drive_id: str) -> RunOperation:
    """A run on one drive of a project with all parameters as they are, as the window asks for it.

    Parameters
    ----------
    parameters : object
        An instance of the tool's own parameter class.
    folder : Path
        The project's.
    """
    declared = parameters_of(tool_of(tool).parameters)
    values = {one.id: getattr(parameters, one.id) for one in declared}
    return RunOperation(tool, OperationInputs(folder, (drive_id,)), values)


def no_single_input(tool: str) -> MissingInput:
    """The refusal of a tool that was given nothing, or two sides."""
    return MissingInput(
        Text("The tool runs on one input.", "このツールは1つの入力を処理します。"),
        Text.same(tool),
        Text(
            "Name a project or point files, without --before and --after.",
            "--before・--after を使わずに、プロジェクトか点群ファイルを指定してください。",
        ),
    )


def _stored(operation: RunOperation, monitor: Monitor) -> RunOutcome:
    folder = operation.inputs.project
    if folder is None:
        raise TypeError(operation)
    with opened_project(folder, writing=True) as project:
        return run_in_project(operation, project, monitor)


def _what(operation: RunOperation, opened: OpenedInputs) -> tuple[Tool, object]:
    tool = tool_of(operation.tool)
    parameters = fill_parameters(tool.parameters, operation.parameters)
    return tool, with_own_model(parameters, opened.project)


def _check_needs(tool: Tool, drives: Sequence[Drive]) -> None:
    for drive in drives:
        check_needs(tool, drive)


def _with_own_surface(share: RunShare) -> RunRequest:
    """The request of one run of several: each writes a surface of its own, where one is wanted."""
    parameters: Any = share.request.parameters  # a tool's own dataclass
    wanted = surface_file_of(parameters)
    if wanted is None:
        return share.request
    own = replace(parameters, surface=str(surface_beside(wanted, share.drives[0])))
    return replace(share.request, parameters=own)


def _check_output(tool: Tool, output: Path, inputs: OperationInputs) -> None:
    content = Content.FEATURES if tool.gives_candidates else Content.POINTS
    FORMATS.format_to_write(output, content)
    if inputs.drives and not tool.gives_candidates:
        raise OutOfRange(
            Text(
                "Point results are written for all drives of a project.",
                "点の処理結果は、プロジェクトのすべての走行データについて書き出します。",
            ),
            Text.same(", ".join(inputs.drives)),
            Text("Name no drives.", "走行データを指定しないでください。"),
        )
