"""Benchmark of trees, signs, poles and wires on ever longer drives: times and memory.

Each drive is looked at in a process that can be watched:
``python -m processing.laboratory.bench.cases.extraction_growth REHEARSAL FOLDER DRIVE…`` (a drive
to compile kernels with, and the folder for what tools write) says "ready" once that is done, and of
each tool its name, each with the moment at which it ended, on the clock that all processes share.
"""

from __future__ import annotations

import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from itertools import pairwise
from pathlib import Path

from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.core.text import Text
from processing.laboratory.bench.case import BenchmarkOptions, Measurement
from processing.laboratory.bench.growth import growth_row, sizes_within
from processing.laboratory.bench.large_street import write_long_delivery
from processing.laboratory.bench.watched_run import WatchedRun, run_watched
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.drive import Drive
from processing.tools.listed.registry import TOOLS
from processing.tools.running.runner import RunRequest, run

_THING_TOOLS = ("trees", "signs", "poles", "wires")
_MOST_GIB = 1.5
_REHEARSED = 600_000
"""Points on which every kernel is used once: two lengths of the sample street."""

_FILES = 2


def measure_extraction_growth(options: BenchmarkOptions) -> tuple[Measurement, ...]:
    """The exponent with which each tool's time grows with the points, and what they hold."""
    sizes = sizes_within(options)
    with tempfile.TemporaryDirectory(prefix="zuka-bench-") as name:
        rehearsal = _drive(Path(name) / "rehearsal", min(_REHEARSED, sizes[-1]))
        runs = [_run_on(Path(name), rehearsal, size) for size in sizes]
    times = [_times_of(one) for one in runs]
    rows = [
        growth_row(tool, TOOLS[tool].name, sizes, [one[tool] for one in times])
        for tool in _THING_TOOLS
    ]
    return (*rows, _memory_row(sizes, [_held_gib(one) for one in runs]))


def _run_on(folder: Path, rehearsal: Path, size: int) -> WatchedRun:
    """All tools on a drive of so many points, which is gone afterwards: the largest fill disks."""
    with tempfile.TemporaryDirectory(dir=folder) as name:
        drive = _drive(Path(name), size)
        arguments = [str(rehearsal), str(Path(name) / "written"), str(drive)]
        return run_watched("processing.laboratory.bench.cases.extraction_growth", arguments)


def _drive(folder: Path, points: int) -> Path:
    folder.mkdir(exist_ok=True)
    delivery = write_long_delivery(folder, points, scanners=("left",), files=_FILES)
    request = ImportRequest(delivery.clouds, (delivery.trajectory,))
    (made,) = import_drives(request, folder / "drives", SilentMonitor())
    for cloud in delivery.clouds:
        cloud.unlink()
    return made


def _times_of(ran: WatchedRun) -> Mapping[str, float]:
    """Seconds of each tool."""
    return {tool: end - begin for (_, begin), (tool, end) in pairwise(ran.moments.items())}


def _held_gib(ran: WatchedRun) -> float | None:
    """Memory in no file over that of the process with everything compiled."""
    ready_s, end_s = ran.moments["ready"], ran.moments[_THING_TOOLS[-1]]
    return ran.over_baseline(ready_s, ready_s, end_s)[1]


def _memory_row(sizes: Sequence[int], held: Sequence[float | None]) -> Measurement:
    known = {size: one for size, one in zip(sizes, held, strict=True) if one is not None}
    return Measurement(
        "growth-extraction-memory",
        Text(
            "Memory of trees, signs, poles and wires in no file, over the baseline",
            "街路樹・標識・柱状物・架線の抽出時の追加メモリ（ファイル以外）",
        ),
        max(known.values(), default=None),
        "GiB",
        _MOST_GIB,
        is_at_most=True,
        detail=", ".join(f"{size / 1e6:g} M {one:.2f} GiB" for size, one in known.items()),
        figures={f"{size}_gib": one for size, one in known.items()},
    )


def _run_alone(tool: str, folders: Sequence[Path], into: Path) -> None:
    """Run a tool on drives as they are just after opening."""
    first, *others = [Drive(folder) for folder in folders]
    request = RunRequest(tool, first, TOOLS[tool].parameters(), tuple(others))
    run(request, SilentMonitor(), into=into / tool)


def main(arguments: Sequence[str]) -> None:
    """Run each, and tell when."""
    rehearsal, into, *folders = map(Path, arguments)
    for tool in _THING_TOOLS:
        _run_alone(tool, [rehearsal], into)
    _tell("ready")
    for tool in _THING_TOOLS:
        _run_alone(tool, folders, into)
        _tell(tool)


def _tell(what: str) -> None:
    sys.stdout.write(f"{what} {time.monotonic()}\n")
    sys.stdout.flush()


if __name__ == "__main__":
    write_every_character()
    main(sys.argv[1:])
