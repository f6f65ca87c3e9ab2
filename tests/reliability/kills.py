"""Operations and windows killed at instants by chance; nothing that was done is lost.

``python -m tests.reliability.kills FOLDER --kills 500 --seed 1``: every second time an operation
is killed somewhere between its start and its end, and every second time a window in which an
operator draws, edits, reviews and runs tools in any order. After each kill the project opens, its
map is what the stored history makes, its checksums agree; an operation that was killed is done
again with the result that it always has.
"""

from __future__ import annotations

import argparse
import os
import random
import shutil
import signal
import sys
import time
from collections import Counter
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

from installer.display import virtual_display
from processing.project.project import Project
from tests.broken_files.full_project import make_full_project
from tests.processing.project.drawn import features_of, replayed_history
from tests.reliability.forked import answer_of_child, silence
from tests.reliability.operations import OPERATIONS, answer_to, do
from tests.reliability.project_state import State, state_of

_LONGEST_SESSION_S = 12.0
_SESSIONS_A_PROJECT = 8
_TOLD_EVERY = 20


def whole_history_of(folder: Path) -> list[str]:
    """What is wrong with a project that was in use when its process was killed."""
    wrong = []
    with closing(Project.open(folder)) as project:
        if features_of(project) != replayed_history(folder):
            wrong.append("the map is not what its history makes")
    checked = answer_of_child(lambda: answer_to(["check", str(folder)]))
    if checked is None or checked.status != 0:
        wrong.append(f"check: {checked}")
    return wrong


class Operations:
    """Operations on copies of a project, each killed once on its way.

    Parameters
    ----------
    whole : Path
        The project that is copied, with the delivered files beside it.
    work : Path
        An empty folder.
    """

    def __init__(self, whole: Path, work: Path) -> None:
        self._whole = whole
        self._project = work / "街路.zuka"
        self._out = work / "out"
        self._known: dict[str, tuple[float, State]] = {}
        self._before = state_of(whole)

    def kill(self, operation: str, share: float) -> list[str]:
        """Kill an operation when a share of its time has gone; gives what was wrong then."""
        seconds, after = self._known.get(operation) or self._learn(operation)
        self._fresh()
        child = _fork(lambda: self._do(operation))
        time.sleep(share * seconds)
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
        wrong = []
        seen = state_of(self._project)
        if seen not in (self._before, after):
            wrong.append(f"{operation} at {share:.2f}: holds what nobody made: {seen}")
        wrong += [f"{operation} at {share:.2f}: {one}" for one in whole_history_of(self._project)]
        if seen == self._before:
            again = answer_of_child(lambda: self._do(operation))
            if again is None or again.status != 0:
                wrong.append(f"{operation} at {share:.2f}: not done again: {again}")
            elif state_of(self._project) != after:
                wrong.append(f"{operation} at {share:.2f}: other than without a kill")
        return wrong

    def _learn(self, operation: str) -> tuple[float, State]:
        """Do it here, so that forked processes find its kernels, and then once to measure."""
        for _ in range(2):
            self._fresh()
            started = time.monotonic()
            with silence():
                self._do(operation)
            seconds = time.monotonic() - started
        self._known[operation] = seconds, state_of(self._project)
        return self._known[operation]

    def _do(self, operation: str) -> object:
        return do(operation, self._project, self._whole.parent, self._out)

    def _fresh(self) -> None:
        for folder in (self._project, self._out):
            shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(self._whole, self._project)


class Windows:
    """Windows on one project after the other, each killed while somebody works in it.

    Parameters
    ----------
    street : Path
        A project with a drive; it is copied.
    work : Path
        An empty folder.
    """

    def __init__(self, street: Path, work: Path) -> None:
        self._street = street
        self._home = work
        self._project = work / "通り.zuka"
        self._sessions = 0

    def kill(self, seed: int, chance: random.Random) -> list[str]:
        """Work in a window for some seconds and kill it; gives what is wrong then."""
        if self._sessions % _SESSIONS_A_PROJECT == 0:
            shutil.rmtree(self._home, ignore_errors=True)
            self._home.mkdir()
            shutil.copytree(self._street, self._project)
        self._sessions += 1
        reading, writing = os.pipe()
        child = _fork(lambda: self._work(seed, writing))
        os.close(writing)
        with os.fdopen(reading, "rb") as said:
            is_open = said.read(1) == b"."
            time.sleep(chance.uniform(0.0, _LONGEST_SESSION_S))
            os.kill(child, signal.SIGKILL)
            ended = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        wrong = [] if is_open and ended == -signal.SIGKILL else [f"ended {ended} by itself"]
        return [f"window {seed}: {one}" for one in (*wrong, *whole_history_of(self._project))]

    def _work(self, seed: int, told: int) -> None:
        from tests.properties.operator_actions import any_action
        from tests.properties.operator_input import Operator

        choice = random.Random(seed)  # noqa: S311 - chance, no secret
        operator = Operator(self._home, self._project)
        os.write(told, b".")
        while True:
            any_action(choice)(operator, choice)
            operator.settle()


def _fork(act: Callable[[], object]) -> int:
    """Do something in a child process, whose modules are loaded; gives its number."""
    child = os.fork()
    if child == 0:
        try:
            with silence():
                act()
        finally:
            os._exit(0)
    return child


def main() -> int:
    """Kill as often as is wanted; the exit status says whether all went well."""
    wanted = argparse.ArgumentParser(description=__doc__)
    wanted.add_argument("folder", type=Path)
    wanted.add_argument("--kills", type=int, default=20)
    wanted.add_argument("--seed", type=int, default=1)
    wanted.add_argument("--of", choices=("both", "operations", "windows"), default="both")
    options = wanted.parse_args()
    os.environ["ZUKA_LANGUAGE"] = "en"
    whole = options.folder / "街路.zuka"
    if not whole.is_dir():
        options.folder.mkdir(parents=True, exist_ok=True)
        make_full_project(options.folder)
    chance = random.Random(options.seed)  # noqa: S311 - chance, no secret
    counted: Counter[str] = Counter()
    with virtual_display(os.environ) as screen:
        os.environ.update(screen)
        operations = Operations(whole, options.folder / "operations")
        windows = Windows(whole, options.folder / "windows")
        for number in range(options.kills):
            of_window = options.of == "windows" or (options.of == "both" and number % 2 == 1)
            if of_window:
                import tests.properties.operator_actions  # noqa: F401 - for the forked

                wrong = windows.kill(options.seed * 100_000 + number, chance)
            else:
                operation = OPERATIONS[counted["operations"] % len(OPERATIONS)]
                wrong = operations.kill(operation, chance.random())
            counted["windows" if of_window else "operations"] += 1
            counted["wrong"] += bool(wrong)
            if number % _TOLD_EVERY == _TOLD_EVERY - 1:
                sys.stdout.write(f"{dict(counted)}\n")
            for line in wrong:
                sys.stdout.write(f"  {line}\n")
            sys.stdout.flush()
    sys.stdout.write(f"{dict(counted)}\n")
    return int(counted["wrong"] > 0)


if __name__ == "__main__":
    sys.exit(main())
