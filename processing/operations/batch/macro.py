"""A macro: steps that were done to one project, done again to another.

It is written like the steps of a job, so that it can be pasted into one. What a project has been
put through is known from its runs, whether they were asked for in the window or on the command
line: nothing has to be recorded beforehand.
"""

from __future__ import annotations

from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

from processing.core.errors import MissingInput, report_as_user_error
from processing.core.monitor import Monitor, parts_of
from processing.core.parameters import parameters_of
from processing.core.safe_write import write_safely
from processing.core.text import Text
from processing.operations.batch.job import (
    BatchJob,
    JobFile,
    StepPlaces,
    is_import,
    operation_of_step,
    steps_of_text,
)
from processing.operations.operation_files import perform
from processing.operations.written_values import Table, toml_value
from processing.project.importing.import_request import ImportRequest
from processing.project.project import Project
from processing.project.store.runs import Run
from processing.tools.listed.registry import TOOLS


@dataclass(frozen=True)
class ReplayOperation:
    """A macro to be done to a project.

    Attributes
    ----------
    macro, project : Path
    """

    macro: Path
    project: Path


def record_macro(project: Path, macro: Path) -> int:
    """Write what a project was put through as a macro; gives the number of its steps.

    A tool that ran several times with the same parameters is one step, at its last place. Runs of
    tools that the program no longer has are left out.

    Raises
    ------
    MissingInput
        There is no project, or nothing was run in it.
    BadFile, NoSpace, InUse
    """
    with closing(Project.open(project, writing=False)) as opened:
        runs = opened.runs.all()
    steps: dict[str, None] = {}
    for run in runs:
        if run.tool in TOOLS:
            text = "".join(f"{name} = {toml_value(one)}\n" for name, one in _step_of(run).items())
            steps.pop(text, None)
            steps[text] = None
    if not steps:
        raise MissingInput(
            Text(
                "Nothing was run in this project.", "このプロジェクトでは何も実行されていません。"
            ),
            Text.same(str(project)),
            Text("Run a tool first.", "先にツールを実行してください。"),
        )
    with write_safely(macro) as temporary:
        whole = "\n".join(f"[[steps]]\n{text}" for text in steps)
        temporary.write_text(whole, encoding="utf-8")
    return len(steps)


def replay(operation: ReplayOperation, monitor: Monitor) -> tuple[Text, ...]:
    """Do the steps of a macro to a project; gives what came of them.

    Raises
    ------
    UserError
        A step can't be, which is told before the first one is done; or one failed: those before it
        are done, each a step that can be undone.
    Cancelled
        As for one that failed.
    """
    path = operation.macro.absolute()
    with report_as_user_error(path):
        text = path.read_bytes().decode("utf-8-sig", errors="replace")
    steps = tuple(one for one in steps_of_text(text, path) if not is_import(one))
    project = operation.project.absolute()
    file = JobFile(path, BatchJob((str(project),), steps))
    places = StepPlaces(project.stem, project.parent, project, ImportRequest(()))
    operations = [operation_of_step(file, number, places) for number in range(len(steps))]
    words: list[Text] = []
    for one, part in zip(operations, parts_of(monitor, [1] * len(operations)), strict=True):
        monitor.check()
        words += getattr(perform(one, part), "words", ())
    return tuple(words)


def _step_of(run: Run) -> Table:
    """A run as a step; what has its usual value is left out."""
    usual = {one.id: one.default for one in parameters_of(TOOLS[run.tool].parameters)}
    given = {
        name: value
        for name, value in run.parameters.items()
        if name in usual and value is not None and value != usual[name]
    }
    return {
        "kind": "run",
        "tool": run.tool,
        **{f"parameters.{name}": one for name, one in given.items()},
    }
