"""Benchmark of street trees: the tool on a simulated avenue, as for 3 M points."""

from __future__ import annotations

import statistics
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.laboratory.bench.case import BenchmarkOptions, Measurement
from processing.laboratory.simulate.requests import StreetRequest
from processing.laboratory.simulate.streets import simulate_street
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.drive import Drive
from processing.tools.trees import TreeParameters, find_trees

_POINTS, _LENGTH_M, _MOST_S = 3_000_000, 80.0, 1.5
_SEED, _LEAST_PULSES, _REPEATS = 11, 300, 3


def measure_trees(options: BenchmarkOptions) -> tuple[Measurement, ...]:
    """How long street trees take once an avenue is imported."""
    share = options.limited(_POINTS) / _POINTS
    request = StreetRequest(
        seed=_SEED,
        length_m=max(10.0, _LENGTH_M * min(1.0, 10 * share)),
        pulses=0 if share >= 1 else _LEAST_PULSES,
        avenue=True,
        images=False,
    )
    with tempfile.TemporaryDirectory(prefix="zuka-bench-") as name:
        folder = Path(name)
        made = simulate_street(request, folder / "street", SilentMonitor())
        delivery = ImportRequest(made.points, made.trajectories)
        drives = [Drive(one) for one in import_drives(delivery, folder / "drives", SilentMonitor())]
        _seconds(drives)  # kernels are compiled
        found = [_seconds(drives) for _ in range(options.repeats(_REPEATS))]
    points = sum(drive.count for drive in drives)
    seconds = statistics.median(found)
    return (
        Measurement(
            "trees",
            Text(
                "Street trees of an avenue, as for {wanted} points",
                "並木道の街路樹抽出（{wanted}点に換算）",
            ).filled(wanted=f"{_POINTS:,}"),
            seconds * _POINTS / points,
            "s",
            _MOST_S,
            is_at_most=True,
            detail=f"{points:,} points of {len(drives)} heads: {seconds:.2f} s",
            figures={"points": points, "trees_s": seconds},
        ),
    )


def _seconds(drives: Sequence[Drive]) -> float:
    begin = time.perf_counter()
    find_trees(tuple(drives), TreeParameters(), SilentMonitor())
    return time.perf_counter() - begin
