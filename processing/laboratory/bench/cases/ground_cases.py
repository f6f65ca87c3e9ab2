"""Benchmark of the ground: the tool on a street, from columns to new ones, beside its peers."""

from __future__ import annotations

import importlib.util
import re
import shutil
import tempfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.laboratory.bench.case import BenchmarkOptions, Measurement
from processing.laboratory.bench.large_street import write_large_street
from processing.laboratory.bench.peers import read_reported_seconds, write_pcd
from processing.laboratory.bench.timing import median_seconds, seconds_of
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.drive import Drive
from processing.tools.ground import GROUND_TOOL, GroundParameters
from processing.tools.running.runner import RunRequest, run

_POINTS = 3_000_000
_REPEATS = 3
_JUDGED_POINTS = 10_000_000
_MOST_S = 15.0
_CSF = "CSF"
_PCL = "pcl_progressive_morphological_filter"
_PCL_SAYS = re.compile(r"^\[done, ([0-9.]+) ms", re.MULTILINE)
_CLOTH_CELL_M = 0.5
_WHAT = Text(
    "Ground of {points} points of a street, as for 10,000,000",
    "{points}点（街路）の地面抽出（1,000万点に換算）",
)


def measure_ground(options: BenchmarkOptions) -> tuple[Measurement, ...]:
    """The adaptive method as the tool runs; the cloth simulation and PCL's filter where installed.

    The peers get coordinates in memory or in a file and give indices; reading and writing is not
    counted for them.
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
        _tool_s(drive, folder / "ground")
        ours = median_seconds(lambda: _tool_s(drive, folder / "ground"), options.repeats(_REPEATS))
        peers = {"csf": _csf_s(local_xyz), "pcl": _pcl_s(local_xyz, folder)}
    reported = [
        f"{name} {'not installed' if seconds is None else f'{seconds:.2f} s'}"
        for name, seconds in peers.items()
    ]
    figures = {"points": float(points), "zuka_s": ours}
    figures |= {f"{name}_s": seconds for name, seconds in peers.items() if seconds is not None}
    return (
        Measurement(
            "ground",
            _WHAT.filled(points=f"{points:,}"),
            ours * _JUDGED_POINTS / points,
            "s",
            _MOST_S,
            is_at_most=True,
            detail=f"{ours:.2f} s from the drive's columns to new ones; {', '.join(reported)}",
            figures=figures,
        ),
    )


def _tool_s(drive: Drive, into: Path) -> float:
    request = RunRequest(GROUND_TOOL.id, drive, GroundParameters())
    seconds = seconds_of(lambda: run(request, SilentMonitor(), into=into))
    shutil.rmtree(into)
    return seconds


def _csf_s(local_xyz: NDArray[np.float64]) -> float | None:
    """Zhang and others 2016, as published on PyPI, with a cloth of half a metre; None without."""
    if importlib.util.find_spec(_CSF) is None:
        return None
    module = importlib.import_module(_CSF)
    cloth = module.CSF()
    cloth.params.cloth_resolution = _CLOTH_CELL_M
    cloth.params.bSloopSmooth = False
    cloth.setPointCloud(local_xyz)
    ground, other = module.VecInt(), module.VecInt()
    return seconds_of(lambda: cloth.do_filtering(ground, other, False))  # noqa: FBT003 - the peer's own order


def _pcl_s(local_xyz: NDArray[np.float64], folder: Path) -> float | None:
    """Zhang and others 2003 in PCL, the quicker approximate form; None without."""
    program = shutil.which(_PCL)
    if program is None:
        return None
    cloud = write_pcd(folder / "cloud.pcd", local_xyz)
    command = [program, str(cloud), str(folder / "ground.pcd"), "-approximate", "1"]
    return read_reported_seconds(command, _PCL_SAYS) / 1000.0
