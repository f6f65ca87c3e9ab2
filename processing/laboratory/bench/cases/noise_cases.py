"""Benchmarks of noise removal: the study's methods beside Open3D and PCL, and the combined."""

from __future__ import annotations

import shutil
import tempfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.laboratory.accuracy.filters.peer_filters import (
    kept_by_open3d_radius,
    kept_by_open3d_statistics,
    kept_by_pcl,
)
from processing.laboratory.bench.case import BenchmarkOptions, Measurement
from processing.laboratory.bench.large_street import write_large_street
from processing.laboratory.bench.peers import (
    OUTLIER_DEVIATIONS,
    OUTLIER_NEIGHBOURS,
    OUTLIER_RADIUS_M,
    remove_radius,
    remove_statistical,
)
from processing.laboratory.bench.timing import alternating, median_seconds, seconds_of
from processing.methods.noise.neighbours.radius import radius_outliers
from processing.methods.noise.neighbours.statistical import statistical_outliers
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.drive import Drive
from processing.tools.noise import COMBINED, NOISE, RADIUS, STATISTICAL, NoiseParameters
from processing.tools.running.runner import RunRequest, run

_POINTS = 3_000_000
_POINTS_BESIDE_PCL = 200_000
_REPEATS = 3
_JUDGED_POINTS = 10_000_000
_MOST_S = 10.0
_LEAST_TIMES = {RADIUS: 20.0, STATISTICAL: 4.0}
_OURS = {RADIUS: radius_outliers, STATISTICAL: statistical_outliers}
_PEER = {RADIUS: remove_radius, STATISTICAL: remove_statistical}
_WHAT = {
    RADIUS: Text(
        "Radius outliers of {points} points (0.5 m, 113): how many times faster than Open3D",
        "{points}点の半径法ノイズ判定（0.5m・113点、Open3Dに対する速さの比）",
    ),
    STATISTICAL: Text(
        "Statistical outliers of {points} points (113, 1.5 σ): how many times faster than Open3D",
        "{points}点の統計法ノイズ判定（113点・1.5σ、Open3Dに対する速さの比）",
    ),
}
_SAME = Text(
    "Outliers of {points} points: points that Open3D or PCL judges otherwise",
    "{points}点の半径法・統計法ノイズ判定（Open3D・PCLと判定が異なる点の数）",
)
_COMBINED = Text(
    "Combined noise of {points} points, as for 10,000,000",
    "{points}点の複合ノイズ判定（1,000万点に換算）",
)


def measure_noise(options: BenchmarkOptions) -> tuple[Measurement, ...]:
    """Both methods on coordinates in memory, as the peer's; the combined as the tool runs."""
    points = options.limited(_POINTS)
    with tempfile.TemporaryDirectory(prefix="zuka-bench-") as name:
        folder = Path(name)
        cloud, trajectory = write_large_street(folder, points)
        request = ImportRequest((cloud,), (trajectory,))
        (drive_folder,) = import_drives(request, folder / "drives", SilentMonitor())
        drive = Drive(drive_folder)
        local_xyz = drive.xyz(slice(0, drive.count))
        local_xyz -= local_xyz[0].copy()
        repeats = options.repeats(_REPEATS)
        into = folder / "noise"
        rows = [
            _beside_the_peer(method, local_xyz, _tool_s(drive, method, into), repeats)
            for method in (RADIUS, STATISTICAL)
        ]
        same = _same_points(local_xyz, folder)
        _tool_s(drive, COMBINED, into)
        seconds = median_seconds(lambda: _tool_s(drive, COMBINED, into), repeats)
    rows += [
        same,
        Measurement(
            "noise-combined",
            _COMBINED.filled(points=f"{points:,}"),
            seconds * _JUDGED_POINTS / points,
            "s",
            _MOST_S,
            is_at_most=True,
            detail=f"{seconds:.2f} s from the drive's columns to a new one",
            figures={"points": points, "zuka_s": seconds},
        ),
    ]
    return tuple(rows)


def _beside_the_peer(
    method: str, local_xyz: NDArray[np.float64], tool_s: float, repeats: int
) -> Measurement:
    ours, theirs = alternating(
        [lambda: _OURS[method](local_xyz), lambda: _PEER[method](local_xyz)], repeats
    )
    return Measurement(
        f"noise-{method}",
        _WHAT[method].filled(points=f"{len(local_xyz):,}"),
        theirs / ours,
        "x",
        _LEAST_TIMES[method],
        is_at_most=False,
        detail=(
            f"ours {ours:.2f} s, Open3D {theirs:.2f} s; as a tool, from columns to a new one, "
            f"{tool_s:.2f} s"
        ),
        figures={"points": len(local_xyz), "zuka_s": ours, "open3d_s": theirs, "tool_s": tool_s},
    )


def _same_points(local_xyz: NDArray[np.float64], folder: Path) -> Measurement:
    """How many points are judged otherwise, of as many as PCL takes in bearable time.

    PCL knows single precision only, so all get coordinates rounded to it; in its statistics a
    point isn't one of its own neighbours.
    """
    rounded = local_xyz[:_POINTS_BESIDE_PCL].astype(np.float32).astype(np.float64)
    radius, count, deviations = OUTLIER_RADIUS_M, OUTLIER_NEIGHBOURS, OUTLIER_DEVIATIONS
    by_radius = ("-method", "radius", "-radius", str(radius), "-min_pts", str(count))
    by_statistics = ("-method", "statistical", "-mean_k", str(count), "-std_dev_mul")
    ours = radius_outliers(rounded)
    pairs = {
        "open3d_radius": (ours, kept_by_open3d_radius(rounded, radius, count)),
        "pcl_radius": (ours, kept_by_pcl(rounded, by_radius, folder)),
        "open3d_statistical": (
            statistical_outliers(rounded),
            kept_by_open3d_statistics(rounded, count, deviations),
        ),
        "pcl_statistical": (
            statistical_outliers(rounded, counts_itself=False),
            kept_by_pcl(rounded, (*by_statistics, str(deviations)), folder),
        ),
    }
    differing = {
        name: int((outliers == kept).sum())
        for name, (outliers, kept) in pairs.items()
        if kept is not None
    }
    return Measurement(
        "noise-same",
        _SAME.filled(points=f"{len(rounded):,}"),
        float(sum(differing.values())) if differing else None,
        "points",
        0.0,
        is_at_most=True,
        detail=", ".join(
            f"{name.replace('_', ' ')}: {differing.get(name, 'is not installed')}" for name in pairs
        ),
        figures={"points": len(rounded), **differing},
    )


def _tool_s(drive: Drive, method: str, into: Path) -> float:
    request = RunRequest(NOISE.id, drive, NoiseParameters(method=method))
    seconds = seconds_of(lambda: run(request, SilentMonitor(), into=into))
    shutil.rmtree(into)
    return seconds
