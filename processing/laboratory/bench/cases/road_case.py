"""Benchmark of curbs and gutters: both on a simulated street, by length, and what they hold."""

from __future__ import annotations

import statistics
import tempfile
from collections.abc import Sequence
from pathlib import Path

from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.laboratory.bench.case import BenchmarkOptions, Measurement
from processing.laboratory.bench.cases.road_run import ROAD_TOOLS, StageWatch, run_tools
from processing.laboratory.bench.growth import MOST_EXPONENT, exponent_of
from processing.laboratory.bench.watched_run import run_watched
from processing.laboratory.simulate.requests import StreetRequest
from processing.laboratory.simulate.streets import simulate_street
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.drive import Drive

_POINTS, _LENGTH_M, _SPEED_KM_H = 3_000_000, 174.0, 61.2
_MOST_S, _MOST_STOP_MS, _MOST_GIB = 2.0, 200.0, 0.5
_LENGTHS = (1 / 3, 1.0, 3.0)
_SEED = 11
_LEAST_PULSES = 300
_REPEATS = 3


def measure_road(options: BenchmarkOptions) -> tuple[Measurement, ...]:
    """Both tools, as for 3 M points: seconds, growth with length, memory, how soon they stop."""
    share = options.limited(_POINTS) / _POINTS
    with tempfile.TemporaryDirectory(prefix="zuka-bench-") as name:
        folder = Path(name)
        roads = [_drives(folder / f"{n}", _street(part, share)) for n, part in enumerate(_LENGTHS)]
        _seconds(roads[0], folder / "first", 1)  # kernels are compiled
        repeats = options.repeats(_REPEATS)
        times = [_seconds(road, folder / f"run{n}", repeats) for n, road in enumerate(roads)]
        watches = run_tools(roads[1], folder / "stages")
        held = _held_gib(roads, folder / "watched")
    points = [sum(drive.count for drive in road) for road in roads]
    rows = [_road_row(points[1], times[1], watches), _growth_row(points, times)]
    return (*rows, _memory_row(points, held), _stop_row(watches))


def _street(part: float, share: float) -> StreetRequest:
    """A country road with gutters, recorded by two heads at 17 m/s."""
    return StreetRequest(
        seed=_SEED,
        length_m=max(10.0, _LENGTH_M * part * min(1.0, 10 * share)),
        style="rural",
        speed_km_h=_SPEED_KM_H,
        pulses=0 if share >= 1 else _LEAST_PULSES,
        images=False,
    )


def _drives(folder: Path, options: StreetRequest) -> tuple[Drive, ...]:
    made = simulate_street(options, folder / "street", SilentMonitor())
    request = ImportRequest(made.points, made.trajectories)
    folders = import_drives(request, folder / "drives", SilentMonitor())
    return tuple(Drive(one) for one in folders)


def _seconds(drives: Sequence[Drive], into: Path, repeats: int) -> dict[str, float]:
    """The median of each tool over some runs."""
    runs = [run_tools(drives, into / f"{number}") for number in range(repeats)]
    return {
        tool: statistics.median(sum(one[tool].seconds.values()) for one in runs)
        for tool in ROAD_TOOLS
    }


def _held_gib(roads: Sequence[Sequence[Drive]], into: Path) -> list[float | None]:
    """Memory in no file over that of the process with its modules loaded, for each length."""
    held: list[float | None] = []
    for number, road in enumerate(roads):
        arguments = [str(into / f"{number}"), *(str(drive.folder) for drive in road)]
        watched = run_watched("processing.laboratory.bench.cases.road_run", arguments)
        ends = watched.moments["ready"], watched.moments["done"]
        held.append(watched.over_baseline(ends[0], *ends)[1])
    return held


def _road_row(
    points: int, seconds: dict[str, float], watches: dict[str, StageWatch]
) -> Measurement:
    scaled = sum(seconds.values()) * _POINTS / points
    stages = ", ".join(
        f"{stage} {part:.2f} s"
        for watch in watches.values()
        for stage, part in watch.seconds.items()
        if part >= 0.01 * sum(seconds.values())
    )
    reported = ", ".join(f"{tool} {one:.2f} s" for tool, one in seconds.items())
    return Measurement(
        "road",
        Text(
            "Curbs and covered gutters on {length:.0f} m, as for {wanted} points",
            "縁石と蓋付き側溝の抽出（延長{length:.0f}m、{wanted}点に換算）",
        ).filled(length=_LENGTH_M, wanted=f"{_POINTS:,}"),
        scaled,
        "s",
        _MOST_S,
        is_at_most=True,
        detail=f"{points:,} points of two heads: {reported}; {stages}",
        figures={"points": points, **{f"{tool}_s": one for tool, one in seconds.items()}},
    )


def _growth_row(points: Sequence[int], times: Sequence[dict[str, float]]) -> Measurement:
    whole = [sum(one.values()) for one in times]
    reported = ", ".join(
        f"{n / 1e6:.1f} M {one:.2f} s" for n, one in zip(points, whole, strict=True)
    )
    return Measurement(
        "road-growth",
        Text("Growth: curbs and gutters with length", "増え方: 延長に対する縁石・側溝の処理時間"),
        exponent_of(points, whole),
        "exponent",
        MOST_EXPONENT,
        is_at_most=True,
        detail=reported,
        figures={f"{n}_s": one for n, one in zip(points, whole, strict=True)},
    )


def _memory_row(points: Sequence[int], held: Sequence[float | None]) -> Measurement:
    known = [one for one in held if one is not None]
    reported = ", ".join(
        f"{n / 1e6:.1f} M {'–' if one is None else f'{one:.2f} GiB'}"
        for n, one in zip(points, held, strict=True)
    )
    return Measurement(
        "road-memory",
        Text(
            "Memory of curbs and gutters in no file, over the baseline",
            "縁石・側溝の抽出時の追加メモリ（ファイル以外）",
        ),
        max(known) if known else None,
        "GiB",
        _MOST_GIB,
        is_at_most=True,
        detail=reported,
        figures={f"{n}_gib": one for n, one in zip(points, held, strict=True) if one is not None},
    )


def _stop_row(watches: dict[str, StageWatch]) -> Measurement:
    reported = {tool: 1000 * watch.longest_s for tool, watch in watches.items()}
    return Measurement(
        "road-stop",
        Text("Longest time until a cancelled run stops", "中止してから止まるまでの最長時間"),
        max(reported.values()),
        "ms",
        _MOST_STOP_MS,
        is_at_most=True,
        detail=", ".join(f"{tool} {one:.0f} ms" for tool, one in reported.items()),
        figures={f"{tool}_ms": one for tool, one in reported.items()},
    )
