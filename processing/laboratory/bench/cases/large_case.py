"""Benchmark of a large project: imported, opened, looked at, drawn upon and exported."""

from __future__ import annotations

import json
import tempfile
from pathlib import Path

from processing.laboratory.bench.case import BenchmarkOptions, Measurement
from processing.laboratory.bench.cases.large_import import import_watched, measure_large_import
from processing.laboratory.bench.cases.large_window import window_rows
from processing.laboratory.bench.cases.start_case import no_window
from processing.laboratory.bench.large_street import write_long_delivery
from processing.laboratory.bench.project_copy import link_project
from processing.laboratory.bench.watched_run import run_watched

_POINTS = 300_000_000
_POINTS_PER_FILE = 30_000_000
_REHEARSED = 100_000
_DISPLAY = "display"


def measure_large(options: BenchmarkOptions) -> tuple[Measurement, ...]:
    """A project of 300 M points from the delivered files to the drawing that is handed in.

    Raises
    ------
    MissingInput
        The window can't be shown, mostly for want of a display.
    """
    with tempfile.TemporaryDirectory(prefix="zuka-bench-") as name:
        folder = Path(name)
        project, out = folder / "street.zuka", folder / "out"
        out.mkdir()
        rows: tuple[Measurement, ...] = ()
        if options.project is not None:
            link_project(options.project, project)
        else:
            points = options.points or options.limited(_POINTS)
            files = max(2, points // _POINTS_PER_FILE)
            delivery = write_long_delivery(folder, points, scanners=("left",), files=files)
            if options.share == 1.0:  # what isn't judged needs no rehearsal
                rehearsal = write_long_delivery(folder, _REHEARSED, scanners=("left",))
                import_watched(rehearsal, folder / "rehearsal.zuka")
            rows = measure_large_import(delivery, project, points)
        run = run_watched(
            "app.large_steps.large_bench", [str(project), str(out), str(options.share)]
        )
        if run.status != 0:
            if _DISPLAY in run.complaints:
                raise no_window(run.complaints)
            raise RuntimeError(run.complaints)
        steps = [json.loads(line) for line in run.lines if line.startswith("{")]
        return rows + window_rows(run, steps)
