"""All that is found along a street: every extractor on the same inputs, opened once."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from processing.core.errors import (
    MissingInput,
    OutOfRange,
    Unsuitable,
    UserError,
    report_as_user_error,
)
from processing.core.monitor import Monitor, parts_of
from processing.core.parameters import ParameterValue
from processing.core.text import Text
from processing.operations.inputs import (
    OpenedInputs,
    OperationInputs,
    opened_inputs,
    opened_project,
)
from processing.operations.run import RunOperation, RunOutcome, run_in_project, run_to_file
from processing.tools.listed.registry import extractors
from processing.tools.running.runner import tool_of

_ENDING = ".geojson"


@dataclass(frozen=True)
class Extractor:
    """One tool of an extraction.

    Attributes
    ----------
    tool : str
        Id of a tool that finds things.
    parameters : mapping of str to value
        Those that are given, by name; the others are the tool's own.
    """

    tool: str
    parameters: Mapping[str, ParameterValue] = field(default_factory=dict)

    @property
    def parameter_class(self) -> type[Any]:
        """The tool's own parameters.

        Raises
        ------
        OutOfRange
            There is no such tool.
        """
        return tool_of(self.tool).parameters


@dataclass(frozen=True)
class ExtractOperation:
    """Tools that find things, to be run one after the other.

    Attributes
    ----------
    inputs : OperationInputs
    extractors : tuple of Extractor
        Empty for all of them with their own parameters.
    output : Path or None
        A folder for a GeoJSON file of each tool; None to store the runs in the project.
    accept_above : float or None
        Candidates stored with at least this confidence, 0 to 1, are accepted at once.
    """

    inputs: OperationInputs
    extractors: tuple[Extractor, ...] = ()
    output: Path | None = None
    accept_above: float | None = None

    @property
    def runs(self) -> tuple[RunOperation, ...]:
        """A run for each tool, in the order in which they are done."""
        chosen = self.extractors or tuple(Extractor(tool) for tool in extractors())
        return tuple(
            RunOperation(
                one.tool, self.inputs, one.parameters, self._file_of(one.tool), self.accept_above
            )
            for one in chosen
        )

    def check(self) -> None:
        """Refuse what can't come to a good end before anything is opened.

        Raises
        ------
        OutOfRange
            There is no such tool, parameter or value, or it finds nothing.
        MissingInput
            There is nothing to run on, or nowhere to store the result.
        """
        if self.inputs.project is None and not self.inputs.points:
            raise MissingInput(
                Text("There is nothing to look at.", "入力が指定されていません。"),
                Text.same("extract"),
                Text(
                    "Name a project or point files.",
                    "プロジェクトか点群ファイルを指定してください。",
                ),
            )
        if self.output is not None and self.output.exists() and not self.output.is_dir():
            raise OutOfRange(
                Text("Results of several tools need a folder.", "出力先にはフォルダが必要です。"),
                Text.same(str(self.output)),
                Text("Name a folder with --out.", "--out でフォルダを指定してください。"),
            )
        for one in self.runs:
            if not tool_of(one.tool).gives_candidates:
                raise OutOfRange(
                    Text("This tool finds no things.", "地物を抽出するツールではありません。"),
                    Text.same(one.tool),
                    Text(
                        f"Use some of {', '.join(extractors())}.",
                        f"{'、'.join(extractors())} から指定してください。",
                    ),
                )
            one.check()

    def _file_of(self, tool: str) -> Path | None:
        return None if self.output is None else self.output / f"{tool}{_ENDING}"


@dataclass(frozen=True)
class ExtractOutcome:
    """What came of an extraction.

    Attributes
    ----------
    done : mapping of str to RunOutcome
        By tool.
    refused : mapping of str to UserError
        What stood against the others, by tool.
    """

    done: Mapping[str, RunOutcome]
    refused: Mapping[str, UserError]

    @property
    def words(self) -> tuple[Text, ...]:
        """A line for each thing that was done."""
        return tuple(line for one in self.done.values() for line in one.words)

    @property
    def has_failed(self) -> bool:
        """Whether a tool failed on data that it could have run on."""
        return any(not isinstance(error, Unsuitable) for error in self.refused.values())


def extract(operation: ExtractOperation, monitor: Monitor) -> ExtractOutcome:
    """Run all extractors; write their results, or store each as a run of the project.

    What one tool can't do stops no other one.

    Raises
    ------
    UserError
        As :meth:`ExtractOperation.check`; the inputs can't be read; or no tool could run: what
        stood against the first.
    Cancelled
        What was written or stored before stays; each run is a step that can be undone.
    """
    operation.check()
    done: dict[str, RunOutcome] = {}
    refused: dict[str, UserError] = {}
    for tool, outcome in _outcomes(operation, monitor):
        if isinstance(outcome, RunOutcome):
            done[tool] = outcome
        else:
            refused[tool] = outcome
    if not done and refused:
        raise next(iter(refused.values()))
    return ExtractOutcome(done, refused)


def _outcomes(
    operation: ExtractOperation, monitor: Monitor
) -> Iterator[tuple[str, RunOutcome | UserError]]:
    parts = parts_of(monitor, [1] * len(operation.runs))
    if operation.output is None:
        if operation.inputs.project is None:
            raise TypeError(operation)
        with opened_project(operation.inputs.project, writing=True) as project:
            for run, part in zip(operation.runs, parts, strict=True):
                try:
                    outcome: RunOutcome | UserError = run_in_project(run, project, part)
                except UserError as error:
                    outcome = error
                yield run.tool, outcome
        return
    with report_as_user_error(operation.output):
        operation.output.mkdir(parents=True, exist_ok=True)
    with opened_inputs(operation.inputs, monitor, beside=operation.output) as opened:
        for run, part in zip(operation.runs, parts, strict=True):
            yield run.tool, _written(run, opened, part)


def _written(run: RunOperation, opened: OpenedInputs, monitor: Monitor) -> RunOutcome | UserError:
    if run.output is None:
        raise TypeError(run)
    try:
        return run_to_file(run, opened, run.output, monitor)
    except UserError as error:
        return error
