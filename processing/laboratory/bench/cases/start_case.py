"""Benchmark of the start: from the command to a window that answers."""

from __future__ import annotations

import os
import subprocess
import sys
import time

from processing.core.errors import MissingInput
from processing.core.text import Text
from processing.laboratory.bench.case import BenchmarkOptions, Measurement

_REPEATS = 5
_NO_BYTECODE = "PYTHONDONTWRITEBYTECODE"


def measure_start(options: BenchmarkOptions, *, window: str) -> tuple[Measurement, ...]:
    """Seconds from starting the process to a painted window that takes events.

    Parameters
    ----------
    options : BenchmarkOptions
    window : str
        The module that shows the window: run by ``python -m``, it prints when the window was
        usable, in seconds since 1970.

    Raises
    ------
    MissingInput
        The window can't be shown, mostly for want of a display.
    """
    times = []
    repeats = options.repeats(_REPEATS)
    # The first start writes it, as after an installation, wherever the shell forbids it.
    with_bytecode = {name: value for name, value in os.environ.items() if name != _NO_BYTECODE}
    for _ in range(repeats + 1):
        start = time.time()
        done = subprocess.run(  # noqa: S603 - our own program
            [sys.executable, "-m", window],
            check=False,
            capture_output=True,
            text=True,
            errors="replace",
            env=with_bytecode,
        )
        if done.returncode != 0:
            raise no_window(done.stderr)
        times.append(float(done.stdout.split()[-1]) - start)
    warm = sorted(times[1:])
    row = Measurement(
        "start",
        Text("Window usable after start", "起動から操作可能になるまで"),
        warm[repeats // 2],
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
