"""Benchmark of the start: from the command to a window that answers."""

from __future__ import annotations

import subprocess
import sys
import time

from processing.core.errors import MissingInput
from processing.core.text import Text
from processing.laboratory.bench.case import BenchmarkOptions, Measurement

_REPEATS = 5

# Runs in a process of its own; prints when the window has been painted and the loop is idle.
_PROGRAM = """
import sys, time, tempfile, pathlib
from app.cli.terminal import run_in_terminal
run_in_terminal([])
from PySide6.QtCore import QTimer
from app.application import build_window, make_application
from app.settings.settings import Settings
application = make_application()
with tempfile.TemporaryDirectory() as folder:
    parts = build_window(Settings(pathlib.Path(folder) / "settings.ini"), pathlib.Path(folder))
    parts.window.show()
    application.processEvents()
    QTimer.singleShot(0, application.quit)
    application.exec()
    sys.stdout.write(f"{time.time()}\\n")
    parts.window.close()
"""


def measure_start(options: BenchmarkOptions) -> tuple[Measurement, ...]:  # noqa: ARG001 - it takes no points
    """Seconds from starting the process to a painted window that takes events.

    Raises
    ------
    MissingInput
        The window can't be shown, mostly for want of a display.
    """
    times = []
    for _ in range(_REPEATS + 1):
        start = time.time()
        done = subprocess.run(  # noqa: S603 - our own program
            [sys.executable, "-c", _PROGRAM],
            check=False,
            capture_output=True,
            text=True,
            errors="replace",
        )
        if done.returncode != 0:
            raise no_window(done.stderr)
        times.append(float(done.stdout.split()[-1]) - start)
    warm = sorted(times[1:])
    row = Measurement(
        "start",
        Text("Window usable after start", "起動から操作可能になるまで"),
        warm[_REPEATS // 2],
        "s",
        2.0,
        is_at_most=True,
        detail=f"first {times[0]:.2f} s, then {warm[0]:.2f} … {warm[-1]:.2f} s",
    )
    return (row,)


def no_window(reported: str) -> MissingInput:
    """The refusal when a process of the window ended, with its last words."""
    last = reported.strip().splitlines()[-1:] or [""]
    return MissingInput(
        Text("The window could not be shown.", "ウィンドウを表示できません。"),
        Text.same(last[0]),
        Text(
            "Run this where there is a display (on a server with xvfb-run).",
            "画面のある環境で実行してください（サーバーでは xvfb-run を使います）。",
        ),
    )
