"""Benchmarks side by side with other programs: normals, and a cloud that can be searched."""

from __future__ import annotations

import shutil
import statistics
import tempfile
from collections.abc import Callable
from pathlib import Path

import laspy
import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.laboratory.bench.case import BenchmarkOptions, Measurement
from processing.laboratory.bench.cases.import_cases import importing
from processing.laboratory.bench.large_street import write_large_street
from processing.laboratory.bench.peers import (
    cloudcompare_normals_s,
    open3d_normals_s,
    open3d_searchable,
    pcl_normals_s,
)
from processing.laboratory.bench.timing import alternating, seconds_of
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.drive import Drive
from processing.tools.normals import NORMALS
from processing.tools.running.runner import RunRequest, run

_POINTS = 3_000_000
_REPEATS = 3
_NORMALS = Text(
    "Normals of {points} points: how many times faster than {peer}",
    "{points}点の法線推定（{peer}に対する速さの比）",
)
_PEERS = {
    "open3d": ("Open3D", "at most 30 neighbours within 0.2 m, tree included, files not"),
    "pcl": ("PCL", "30 nearest neighbours, tree included, files not"),
    "cloudcompare": ("CloudCompare", "all neighbours within 0.2 m, octree included, files not"),
}


def measure_normals(options: BenchmarkOptions) -> tuple[Measurement, ...]:
    """The tool "normals" on a drive, from its columns to new ones, and those of peers, in turns.

    Ours looks at neighbours in the image within 0.2 m, turns normals to the scanner and finds
    shapes as well; reading and writing its columns is counted.
    """
    points = options.limited(_POINTS)
    with tempfile.TemporaryDirectory(prefix="zuka-bench-") as name:
        folder = Path(name)
        cloud, trajectory = write_large_street(folder, points)
        request = ImportRequest((cloud,), (trajectory,))
        (drive_folder,) = import_drives(request, folder / "drives", SilentMonitor())
        drive = Drive(drive_folder)
        local_xyz = drive.xyz(slice(0, drive.count))
        local_xyz -= local_xyz[0].copy()
        times = _in_turns(
            {
                "zuka": lambda: _our_normals_s(drive, folder / "normals"),
                "open3d": lambda: open3d_normals_s(local_xyz),
                "pcl": lambda: pcl_normals_s(local_xyz, folder),
                "cloudcompare": lambda: cloudcompare_normals_s(local_xyz, folder),
            },
            options.repeats(_REPEATS),
        )
    ours = times["zuka"] or 0.0
    return tuple(_normals_row(peer, points, ours, times[peer]) for peer in _PEERS)


def measure_searchable(options: BenchmarkOptions) -> tuple[Measurement, ...]:
    """From a LAZ file to a cloud that can be asked for neighbours.

    Ours is the import: a drive on disk, whose rows and columns are its index. The peer's is
    decoding by laspy, and Open3D's cloud and tree, in memory and gone with the process.
    """
    points = options.limited(_POINTS)
    with tempfile.TemporaryDirectory(prefix="zuka-bench-") as name:
        folder = Path(name)
        cloud, trajectory = write_large_street(folder, points)
        request = ImportRequest((cloud,), (trajectory,))
        ours, theirs = alternating(
            [
                importing(request, folder / "import"),
                lambda: open3d_searchable(_decode_coordinates(cloud)),
            ],
            options.repeats(_REPEATS),
        )
    row = Measurement(
        "searchable",
        Text(
            "LAZ of {points} points to a cloud that answers what is near: times faster than "
            "laspy with Open3D's tree",
            "{points}点のLAZから近傍検索できる状態まで（laspyとOpen3Dの木に対する速さの比）",
        ).filled(points=f"{points:,}"),
        theirs / ours,
        "x",
        None,
        is_at_most=False,
        detail=f"import to disk {ours:.2f} s, decoding and tree in memory {theirs:.2f} s",
        figures={"points": points, "zuka_s": ours, "open3d_s": theirs},
    )
    return (row,)


def _in_turns(acts: dict[str, Callable[[], float | None]], repeats: int) -> dict[str, float | None]:
    """Medians of the seconds that acts tell in turns; None for one that tells none.

    A round before is not counted, unless one round is all that is wanted.
    """
    rounds = [{name: act() for name, act in acts.items()} for _ in range(repeats + (repeats > 1))]
    rounds = rounds[-repeats:]
    return {name: _median([one[name] for one in rounds]) for name in acts}


def _median(seconds: list[float | None]) -> float | None:
    reported = [one for one in seconds if one is not None]
    return statistics.median(reported) if reported else None


def _our_normals_s(drive: Drive, into: Path) -> float:
    request = RunRequest(NORMALS.id, drive, NORMALS.parameters())
    seconds = seconds_of(lambda: run(request, SilentMonitor(), into=into))
    shutil.rmtree(into)
    return seconds


def _normals_row(peer: str, points: int, ours: float, theirs: float | None) -> Measurement:
    name, what = _PEERS[peer]
    figures = {"points": float(points), "zuka_s": ours}
    if theirs is not None:
        figures[f"{peer}_s"] = theirs
    return Measurement(
        f"normals-{peer}",
        _NORMALS.filled(points=f"{points:,}", peer=name),
        None if theirs is None else theirs / ours,
        "x",
        None,
        is_at_most=False,
        detail=(
            f"{name} is not installed"
            if theirs is None
            else f"ours {ours:.2f} s, {name} {theirs:.2f} s ({what})"
        ),
        figures=figures,
    )


def _decode_coordinates(cloud: Path) -> NDArray[np.float64]:
    """Coordinates about the first point, as laspy gives them."""
    xyz = np.asarray(laspy.read(cloud).xyz, np.float64)
    local_xyz: NDArray[np.float64] = xyz - xyz[0]
    return local_xyz
