"""Other programs as they are installed, for normals and outliers: Open3D, PCL, CloudCompare.

For normals each gives the seconds that it needs for them alone, its search tree included: reading
and writing files is not counted, as far as the program tells.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from processing.laboratory.bench.timing import seconds_of

if TYPE_CHECKING:
    import open3d

RADIUS_M = 0.2
MOST_NEIGHBOURS = 30
OUTLIER_RADIUS_M, OUTLIER_NEIGHBOURS, OUTLIER_DEVIATIONS = 0.5, 113, 1.5
_LONGEST_S = 1800
_PCL_SAYS = re.compile(r"Computed normals in ([0-9.]+) ms")
_CLOUDCOMPARE_SAYS = re.compile(r"\[ComputeCloudNormals\] Timing: ([0-9.]+) s")
_PCL, _CLOUDCOMPARE = "pcl_normal_estimation", "CloudCompare"
_PCD = (
    "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n"
    "WIDTH {count}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {count}\nDATA binary\n"
)
_PLY = (
    "ply\nformat binary_little_endian 1.0\nelement vertex {count}\n"
    "property float x\nproperty float y\nproperty float z\nend_header\n"
)


def open3d_normals_s(local_xyz: NDArray[np.float64]) -> float:
    """Open3D: at most 30 neighbours within 0.2 m, points in memory already."""
    import open3d

    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(local_xyz))
    search = open3d.geometry.KDTreeSearchParamHybrid(radius=RADIUS_M, max_nn=MOST_NEIGHBOURS)
    return seconds_of(lambda: cloud.estimate_normals(search))


def open3d_searchable(
    local_xyz: NDArray[np.float64],
) -> tuple[open3d.geometry.PointCloud, open3d.geometry.KDTreeFlann]:
    """Open3D's cloud with a tree that answers which points are near; both must be kept."""
    import open3d

    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(local_xyz))
    return cloud, open3d.geometry.KDTreeFlann(cloud)


def remove_radius(local_xyz: NDArray[np.float64]) -> None:
    """Open3D's radius outliers: 0.5 m, 113 points; its cloud and tree are made for it."""
    import open3d

    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(local_xyz))
    cloud.remove_radius_outlier(OUTLIER_NEIGHBOURS, OUTLIER_RADIUS_M)


def remove_statistical(local_xyz: NDArray[np.float64]) -> None:
    """Open3D's statistical outliers: 113 neighbours, 1.5 deviations."""
    import open3d

    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(local_xyz))
    cloud.remove_statistical_outlier(OUTLIER_NEIGHBOURS, OUTLIER_DEVIATIONS)


def pcl_normals_s(local_xyz: NDArray[np.float64], folder: Path) -> float | None:
    """PCL's tool: 30 nearest neighbours; None where it isn't installed."""
    if shutil.which(_PCL) is None:
        return None
    source = _write_cloud(folder / "peer.pcd", _PCD, local_xyz)
    command = [_PCL, str(source), str(folder / "peer-normals.pcd"), "-k", str(MOST_NEIGHBOURS)]
    return read_reported_seconds(command, _PCL_SAYS) / 1000


def cloudcompare_normals_s(local_xyz: NDArray[np.float64], folder: Path) -> float | None:
    """CloudCompare's command line: all neighbours within 0.2 m; None where it isn't installed."""
    if shutil.which(_CLOUDCOMPARE) is None:
        return None
    source = _write_cloud(folder / "peer.ply", _PLY, local_xyz)
    quiet = [_CLOUDCOMPARE, "-SILENT", "-AUTO_SAVE", "OFF", "-O", str(source)]
    hidden = {**os.environ, "QT_QPA_PLATFORM": "offscreen"}
    return read_reported_seconds(
        [*quiet, "-OCTREE_NORMALS", str(RADIUS_M)], _CLOUDCOMPARE_SAYS, hidden
    )


def write_pcd(path: Path, local_xyz: NDArray[np.float64]) -> Path:
    """The points as a binary PCD file, written if it isn't there."""
    return _write_cloud(path, _PCD, local_xyz)


def _write_cloud(path: Path, header: str, local_xyz: NDArray[np.float64]) -> Path:
    if not path.exists():
        head = header.format(count=len(local_xyz)).encode()
        path.write_bytes(head + local_xyz.astype("<f4").tobytes())
    return path


def read_reported_seconds(
    command: list[str], says: re.Pattern[str], environment: Mapping[str, str] | None = None
) -> float:
    """The time that a program says it needed.

    Raises
    ------
    RuntimeError
        It said none.
    """
    done = subprocess.run(  # noqa: S603 - the named peers with files of our own
        command,
        check=False,
        capture_output=True,
        text=True,
        errors="replace",
        timeout=_LONGEST_S,
        env=environment,
    )
    found = says.search(done.stdout + done.stderr)
    if found is None:
        message = f"{command[0]} ended with {done.returncode} and told no time"
        raise RuntimeError(message)
    return float(found[1])
