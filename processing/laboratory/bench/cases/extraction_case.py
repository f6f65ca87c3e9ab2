"""Benchmarks on a simulated avenue, as for 3 M points: each extractor, their sum, and classes."""

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
from processing.tools.classify import ClassifyParameters
from processing.tools.listed.registry import TOOLS, extractors
from processing.tools.running.run_shares import run_shares
from processing.tools.running.runner import run, run_together
from processing.tools.tool import FinishedColumns

_POINTS, _LENGTH_M = 3_000_000, 80.0
_MOST_S = {"trees": 1.5, "signs": 1.5, "poles": 1.5, "wires": 1.5}
"""Curbs and gutters have a benchmark of their own."""

_MOST_OF_ALL_S = 8.0
_SEED, _LEAST_PULSES, _REPEATS = 11, 300, 3
_NOISE, _CLASSIFY = "noise", "classify"
_LEAST_CLASSES = 0.5  # M points/s


def measure_extraction(options: BenchmarkOptions) -> tuple[Measurement, ...]:
    """How long noise, each extractor and classes take once an avenue is imported."""
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
        folders = import_drives(delivery, folder / "drives", SilentMonitor())
        points = sum(drive.count for drive in _opened(folders))
        tools = (_NOISE, *extractors())
        _times_of(tools, _opened(folders), folder)  # kernels are compiled
        alone = [_each_alone(tools, folders, folder) for _ in range(options.repeats(_REPEATS))]
        passes = [
            _times_of(tools, _opened(folders), folder) for _ in range(options.repeats(_REPEATS))
        ]
        classes = [
            statistics.median(
                _seconds(_CLASSIFY, _opened(folders), folder / _CLASSIFY, looks)
                for _ in range(options.repeats(_REPEATS))
            )
            for looks in (ClassifyParameters(), ClassifyParameters(looks_for_things=False))
        ]
    seconds, together = (
        {tool: statistics.median(one[tool] for one in runs) * _POINTS / points for tool in tools}
        for runs in (alone, passes)
    )
    detail = f"{points:,} points of {len(folders)} heads"
    rows = [_row(tool, seconds[tool], most, detail) for tool, most in _MOST_S.items()]
    speeds = [points / one / 1e6 for one in classes]
    return (*rows, _row_of_all(together, detail), _row_of_classes(speeds, detail))


def _opened(folders: Sequence[Path]) -> list[Drive]:
    """The drives as they are just after opening: what runs share is not there yet."""
    return [Drive(one) for one in folders]


def _times_of(tools: Sequence[str], drives: Sequence[Drive], folder: Path) -> dict[str, float]:
    """Seconds of each tool in one pass over the same drives."""
    return {tool: _seconds(tool, drives, folder / tool) for tool in tools}


def _each_alone(tools: Sequence[str], folders: Sequence[Path], folder: Path) -> dict[str, float]:
    """Seconds of each tool on drives that no other has looked at."""
    return {tool: _seconds(tool, _opened(folders), folder / tool) for tool in tools}


def _row(tool: str, seconds: float, most_s: float, detail: str) -> Measurement:
    return Measurement(
        tool,
        Text(
            "{tool} along an avenue, as for {points} points",
            "並木道での{tool}（{points}点に換算）",
        ).filled(tool=TOOLS[tool].name, points=f"{_POINTS:,}"),
        seconds,
        "s",
        most_s,
        is_at_most=True,
        detail=detail,
        figures={f"{tool}_s": seconds},
    )


def _row_of_all(seconds: dict[str, float], detail: str) -> Measurement:
    parts = ", ".join(f"{tool} {one:.2f} s" for tool, one in seconds.items())
    return Measurement(
        "extraction",
        Text(
            "Noise and all extraction along an avenue, as for {points} points",
            "並木道でのノイズ除去と全抽出（{points}点に換算）",
        ).filled(points=f"{_POINTS:,}"),
        sum(seconds.values()),
        "s",
        _MOST_OF_ALL_S,
        is_at_most=True,
        detail=f"{detail}: {parts}",
        figures={f"{tool}_s": one for tool, one in seconds.items()},
    )


def _row_of_classes(speeds: Sequence[float], detail: str) -> Measurement:
    looking, alone = speeds
    return Measurement(
        "classes",
        Text("Classes along an avenue", "並木道での点群の分類"),
        looking,
        "M points/s",
        _LEAST_CLASSES,
        is_at_most=False,
        detail=f"{detail}; without looking for things first {alone:.2f} M points/s",
        figures={"looking_mpps": looking, "alone_mpps": alone},
    )


def _seconds(
    tool: str, drives: Sequence[Drive], into: Path, parameters: ClassifyParameters | None = None
) -> float:
    """Of one run on all drives, its columns removed again; by default with the tool's defaults."""
    begin = time.perf_counter()
    results: list[FinishedColumns] = []
    asked = parameters or TOOLS[tool].parameters()
    shares = run_shares(tool, drives, asked, SilentMonitor())
    for number, share in enumerate(shares):
        folder = into.with_name(f"{into.name}-{number}")
        if TOOLS[tool].outputs:
            results.extend(run_together(share.request, share.monitor, into=folder).columns)
        else:
            run(share.request, share.monitor, into=folder)
    passed = time.perf_counter() - begin
    for one in results:
        one.remove()
    return passed
