"""Thousands of actions of an operator: ``python -m tests.properties.long_session --actions 5000``.

Prints what was done, and how much memory and how many of Qt's objects there are on the way.
"""

from __future__ import annotations

import argparse
import gc
import random
import resource
import sys
import time
from collections import Counter
from pathlib import Path
from tempfile import TemporaryDirectory

from PySide6.QtCore import QObject
from PySide6.QtWidgets import QApplication

from tests.properties.operator_actions import any_action
from tests.properties.operator_session import Session, check_whole_history
from tests.sample_project import make_sample_project

_CHECKED_EACH = 50


def main() -> int:
    wanted = argparse.ArgumentParser(description=__doc__)
    wanted.add_argument("--actions", type=int, default=5000)
    wanted.add_argument("--seed", type=int, default=0)
    wanted.add_argument("--told-each", type=int, default=500)
    options = wanted.parse_args()
    with TemporaryDirectory(prefix="zuka-session-") as folder:
        home = Path(folder)
        street = make_sample_project(home / "street.zuka")
        choice = random.Random(options.seed)  # noqa: S311 - chance, no secret
        started = time.perf_counter()
        with Session.on(street, home / "work") as session:
            for number in range(1, options.actions + 1):
                action = any_action(choice)
                try:
                    session.do(action, choice)
                    if number % _CHECKED_EACH == 0:
                        session.check_all()
                except BaseException:
                    _report(f"action {number} of seed {options.seed}: {action.__name__}")
                    raise
                if number % options.told_each == 0:
                    passed = time.perf_counter() - started
                    _report(f"{number} actions, {passed:.0f} s, {_counted(session)}")
            _report(str(dict(session.done.most_common())))
            refusals = Counter(error.what.en for error in session.operator.refused)
            _report(f"refused: {dict(refusals)}")
            _report(f"told: {len(set(session.operator.reported))} different sentences")
        steps = check_whole_history(home / "work" / "通り.zuka")
        _report(f"{steps} steps undone and done again; the project reopened the same")
    return 0


def _counted(session: Session) -> str:
    operator = session.operator
    operator.parts.toolbox.current_tool.put_down()
    operator.settle()
    gc.collect()
    widgets = len(QApplication.allWidgets())
    objects = len(operator.parts.window.findChildren(QObject))
    jobs = len(operator.parts.jobs.statuses)
    return (
        f"{len(operator.features())} features, {resident_mb():.0f} MB, {widgets} widgets,"
        f" {objects} objects in the window, {jobs} jobs, {len(gc.get_objects())} objects of Python"
    )


def resident_mb() -> float:
    """Memory that the process has now."""
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    return pages * resource.getpagesize() / 1e6


def _report(line: str) -> None:
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    sys.exit(main())
