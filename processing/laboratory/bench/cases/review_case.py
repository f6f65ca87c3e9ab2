"""Benchmark of the review: from the key of a decision to the next candidate in every view."""

from __future__ import annotations

import json
import statistics
import subprocess
import sys

from processing.core.text import Text
from processing.laboratory.bench.case import BenchmarkOptions, Measurement
from processing.laboratory.bench.cases.start_case import no_window

_COUNT = 50
_LEAST_COUNT = 2
"""After the last decision no candidate is left whose pictures become sharp."""


def measure_review(options: BenchmarkOptions, *, window: str) -> tuple[Measurement, ...]:
    """Milliseconds until five views have the next of 50 candidates in their middle, painted.

    Parameters
    ----------
    options : BenchmarkOptions
    window : str
        The module that reviews in a window: run by ``python -m`` with the number of candidates,
        it prints the milliseconds ``centred`` and ``sharp`` of each decision as JSON.

    Raises
    ------
    MissingInput
        The window can't be shown, mostly for want of a display.
    """
    count = max(_LEAST_COUNT, options.repeats(_COUNT))
    done = subprocess.run(  # noqa: S603 - our own program
        [sys.executable, "-m", window, str(count)],
        check=False,
        capture_output=True,
        text=True,
        errors="replace",
    )
    if done.returncode != 0:
        raise no_window(done.stderr)
    times = json.loads(done.stdout.splitlines()[-1])
    centred, sharp = sorted(times["centred"]), sorted(times["sharp"])
    row = Measurement(
        "review",
        Text("Next candidate in every view", "次の候補を全ビューに表示"),
        centred[int(0.95 * (len(centred) - 1))],
        "ms",
        200.0,
        is_at_most=True,
        detail=(
            f"median {statistics.median(centred):.0f} ms, longest {centred[-1]:.0f} ms; section "
            f"and camera sharp after {statistics.median(sharp):.0f} ms, 95 % within "
            f"{sharp[int(0.95 * (len(sharp) - 1))]:.0f} ms"
        ),
    )
    return (row,)
