"""Benchmarks of importing: time against plain decoding, and memory."""

from __future__ import annotations

import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import laspy

from processing.bench.case import Measurement
from processing.bench.large_street import write_large_street
from processing.monitor import SilentMonitor
from processing.project.importing import ImportRequest, import_drives
from processing.text import Text

_TIMED_POINTS = 3_000_000
_LARGE_POINTS = 100_000_000
_REPEATS = 5


def measure_import() -> Measurement:
    """Import of 3 M points to a drive, against decoding the same LAZ by laspy and lazrs alone.

    The two take turns; the ratio of their medians is judged. Kernels are compiled before.
    """
    with tempfile.TemporaryDirectory(prefix="zuka-bench-") as name:
        folder = Path(name)
        cloud, trajectory = write_large_street(folder, _TIMED_POINTS)
        request = ImportRequest((cloud,), (trajectory,))
        into = folder / "import"

        def import_once() -> None:
            # Files of the import before give their memory back: on a virtual machine memory that
            # is touched for the first time costs more than all the rest.
            shutil.rmtree(into, ignore_errors=True)
            import_drives(request, into, SilentMonitor())

        def decode_once() -> None:
            with laspy.open(cloud) as reader:
                for _ in reader.chunk_iterator(1_000_000):
                    pass

        import_once()
        decode_once()
        pairs = [(seconds_of(import_once), seconds_of(decode_once)) for _ in range(_REPEATS)]
    ours, theirs = (sorted(column)[_REPEATS // 2] for column in zip(*pairs, strict=True))
    return Measurement(
        "import",
        Text(
            "Import of 3 M points, times its decoding", "300万点のインポート（復号時間に対する比）"
        ),
        ours / theirs,
        "x",
        2.0,
        is_at_most=True,
        detail=f"import {ours:.2f} s, decoding {theirs:.2f} s, medians of {_REPEATS}",
    )


def measure_import_memory() -> Measurement:
    """Peak resident memory over the baseline while 100 M points are imported.

    The baseline is the same process with its modules loaded, before it opens a file.
    """
    with tempfile.TemporaryDirectory(prefix="zuka-bench-") as name:
        folder = Path(name)
        cloud, trajectory = write_large_street(folder, _LARGE_POINTS)
        command = [sys.executable, "-m", "processing.bench.import_cases"]
        start = time.perf_counter()
        done = subprocess.run(  # noqa: S603 - our own module with our own files
            [*command, str(cloud), str(trajectory), str(folder / "drives")],
            check=True,
            capture_output=True,
            text=True,
        )
        seconds = time.perf_counter() - start
    baseline, peak = (int(word) / 1024**2 for word in done.stdout.split())
    return Measurement(
        "memory",
        Text(
            "Memory for importing 100 M points, over the baseline", "1億点インポート時の追加メモリ"
        ),
        peak - baseline,
        "GiB",
        1.5,
        is_at_most=True,
        detail=f"baseline {baseline:.2f} GiB, peak {peak:.2f} GiB, {seconds:.0f} s",
    )


def seconds_of(act: Callable[[], object]) -> float:
    """How long a call takes."""
    start = time.perf_counter()
    act()
    return time.perf_counter() - start


def _import_and_tell_memory(cloud: str, trajectory: str, into: str) -> None:
    """Runs in a process of its own: prints baseline and peak in KiB."""
    baseline = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    request = ImportRequest((Path(cloud),), (Path(trajectory),))
    import_drives(request, Path(into), SilentMonitor())
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    sys.stdout.write(f"{baseline} {peak}\n")


if __name__ == "__main__":
    _import_and_tell_memory(*sys.argv[1:4])
