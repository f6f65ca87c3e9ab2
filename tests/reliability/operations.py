"""What a user does to a project: each operation that writes into it, by commands and steps."""

from __future__ import annotations

import io
from collections.abc import Callable, Mapping, Sequence
from contextlib import closing, redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from app.cli.terminal import BAD_INPUT, DONE, end_with_status, run_in_terminal
from processing.core.text import Text
from processing.map.catalogue import Geometry
from processing.map.change import Change
from processing.map.feature import Feature, Vertex
from processing.project.project import Project
from processing.project.work_details import WorkDetails
from processing.project.work_store import WorkStore
from tests.processing.project.labelled import paint
from tests.processing.project.test_steps_of_results import STEPS

LATER = "later.laz"
_PARTS = 2
_COMMANDS: Mapping[str, Sequence[str]] = {
    "import": ("import", "{project}", "{delivered}/" + LATER),
    "curbs": ("run", "curbs", "{project}"),
    "noise": ("run", "noise", "{project}"),
    "normals": ("run", "normals", "{project}"),
    "ground": ("run", "ground", "{project}"),
    **{tool: ("run", tool, "{project}") for tool in ("trees", "signs", "poles", "wires")},
    "number": ("number", "{project}"),
    "drawings": ("export", "{project}", "--format", "dxf", "csv", "gpkg", "xlsx", "qa", "--out",
                 "{out}"),
    "points": ("export", "{project}", "--format", "las", "landxml", "--out", "{out}"),
    "sheets": ("export", "{project}", "--format", "sheets", "--candidates", "--out", "{out}"),
    "image": ("image", "{project}", "--kind", "reversible", "--attribute", "height", "--output",
              "{out}/image.png"),
    "check": ("check", "{project}", "--repair"),
}  # fmt: skip


def _draw(project: Project) -> None:
    line = tuple(Vertex((float(x), 1.0, 3.0)) for x in range(200))
    drawn = Feature("drawn", "curb_lower", Geometry.LINE, line)
    project.features.apply(Text("Draw", "作図"), Change(added=(drawn,)))


def _undo(project: Project) -> None:
    project.features.undo()


def _name_work(project: Project) -> None:
    WorkStore(project.settings).keep_details(WorkDetails(work="道路台帳"))


_STEPS: Mapping[str, Sequence[Callable[[Project], None]]] = {
    "draw": (_draw,),
    "undo": (_undo,),
    "paint": (lambda project: paint(project, np.arange(600, 900), 3),),
    "volume": STEPS["a volume"][0],
    "picture": STEPS["a picture"][0],
    "images": STEPS["images"][0],
    "work": (_name_work,),
}
OPERATIONS = (*_COMMANDS, *_STEPS)
"""The names of all of them."""


@dataclass(frozen=True)
class Answer:
    """What an operation gave: its status and the last line of what it said."""

    status: int
    line: str

    @property
    def is_right(self) -> bool:
        """It worked, or said in one sentence what, where and what to do."""
        if self.status == DONE:
            return True
        said = self.line.count(" | ") >= _PARTS and "Traceback" not in self.line
        return self.status == BAD_INPUT and said


def do(operation: str, project: Path, delivered: Path, out: Path) -> Answer:
    """Do an operation on a closed project, in this process.

    Parameters
    ----------
    operation : str
        One of `OPERATIONS`.
    delivered : Path
        The folder of the delivered files that are imported.
    out : Path
        The folder of what is handed in.
    """
    if operation in _STEPS:
        return _answer(lambda: _done(_STEPS[operation], project))
    words = [
        word.format(project=project, delivered=delivered, out=out) for word in _COMMANDS[operation]
    ]
    return answer_to(words)


def answer_to(words: Sequence[str]) -> Answer:
    """The answer to a command, in this process."""
    return _answer(lambda: int(run_in_terminal(words)))


def _done(steps: Sequence[Callable[[Project], None]], project: Path) -> int:
    with closing(Project.open(project)) as opened:
        for step in steps:
            step(opened)
    return DONE


def _answer(act: Callable[[], int]) -> Answer:
    said = io.StringIO()
    with redirect_stderr(said), redirect_stdout(io.StringIO()):
        status = end_with_status(act)
    return Answer(int(status), (said.getvalue().rstrip("\n").splitlines() or [""])[-1])
