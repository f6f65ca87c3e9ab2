"""Benchmarks of importing: time against plain decoding, and memory."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Callable
from pathlib import Path

from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.laboratory.bench.case import BenchmarkOptions, Measurement
from processing.laboratory.bench.cases.import_run import decode
from processing.laboratory.bench.cases.large_import import import_watched, memory_row
from processing.laboratory.bench.large_street import write_large_street, write_long_delivery
from processing.laboratory.bench.timing import alternating
from processing.project.importing.importing import ImportRequest, import_drives

_TIMED_POINTS = 3_000_000
_LARGE_POINTS = 100_000_000
_FILES = 4
_REPEATS = 5


def measure_import(options: BenchmarkOptions) -> tuple[Measurement, ...]:
    """Import of 3 M points to a drive, against decoding the same LAZ by laspy and lazrs alone.

    The two take turns; the ratio of their medians is judged. Kernels are compiled before.
    """
    points = options.limited(_TIMED_POINTS)
    with tempfile.TemporaryDirectory(prefix="zuka-bench-") as name:
        folder = Path(name)
        cloud, trajectory = write_large_street(folder, points)
        request = ImportRequest((cloud,), (trajectory,))
        ours, theirs = alternating(
            [importing(request, folder / "import"), lambda: decode([cloud])],
            options.repeats(_REPEATS),
        )
    row = Measurement(
        "import",
        Text(
            "Import of {points} points, times decoding them by laspy and lazrs",
            "{points}点のインポート（laspyとlazrsによる復号時間に対する比）",
        ).filled(points=f"{points:,}"),
        ours / theirs,
        "x",
        2.0,
        is_at_most=True,
        detail=f"import {ours:.2f} s, decoding {theirs:.2f} s, medians of {_REPEATS}",
        figures={"points": points, "import_s": ours, "decoding_s": theirs},
    )
    return (row,)


def measure_import_memory(options: BenchmarkOptions) -> tuple[Measurement, ...]:
    """Peak memory over the baseline while 100 M points of two scanners are imported.

    The baseline is the same process with its modules loaded, before it opens a file; processes
    that it starts are counted with it.
    """
    points = options.limited(_LARGE_POINTS)
    with tempfile.TemporaryDirectory(prefix="zuka-bench-") as name:
        folder = Path(name)
        delivery = write_long_delivery(folder, points, files=_FILES)
        run = import_watched(delivery, folder / "street.zuka")
    what = Text(
        "Memory for importing {points} points of two scanners, over the baseline",
        "2スキャナ・{points}点のインポート時の追加メモリ",
    ).filled(points=f"{points:,}")
    return (
        memory_row("memory", what, run.resident_gib, run.anonymous_gib, f"{run.seconds:.0f} s"),
    )


def importing(request: ImportRequest, into: Path) -> Callable[[], object]:
    """An import that can be timed again and again: what the one before left is removed first."""

    def import_once() -> None:
        # Files of the import before give their memory back: on a virtual machine memory that
        # is touched for the first time costs more than all the rest.
        shutil.rmtree(into, ignore_errors=True)
        import_drives(request, into, SilentMonitor())

    return import_once
