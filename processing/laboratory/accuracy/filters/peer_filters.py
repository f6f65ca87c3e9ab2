"""Other programs' filters of noise and ground as they are installed: Open3D, PCL, CSF, SMRF.

Each gives which points it keeps, or calls ground; None where it isn't installed. CSF is the
package ``cloth-simulation-filter``, SMRF the package ``pysmrf``.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from importlib.util import find_spec
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Flags, Floats

_LONGEST_S = 600
_OUTLIERS, _MORPHOLOGY = "pcl_outlier_removal", "pcl_progressive_morphological_filter"
_CONVERTER, _AS_BINARY = "pcl_convert_pcd_ascii_binary", "1"
_PCD = (
    "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n"
    "WIDTH {count}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {count}\nDATA binary\n"
)


_CLOTH = """
import sys
import CSF
import numpy as np
places, found, cloth_m, rigidness, distance_m = sys.argv[1:]
cloth = CSF.CSF()
cloth.params.bSloopSmooth = True
cloth.params.cloth_resolution = float(cloth_m)
cloth.params.rigidness = int(rigidness)
cloth.params.class_threshold = float(distance_m)
cloth.setPointCloud(np.load(places))
ground, others = CSF.VecInt(), CSF.VecInt()
cloth.do_filtering(ground, others, False)
np.save(found, np.array(ground, np.int64))
"""


def kept_by_open3d_radius(local_xyz: Floats, radius_m: float, neighbours: int) -> Flags | None:
    """Open3D's radius outlier removal: points with more neighbours are kept, itself counted."""
    if find_spec("open3d") is None:
        return None
    import open3d

    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(local_xyz))
    _, kept = cloud.remove_radius_outlier(neighbours, radius_m)
    return _flags(len(local_xyz), np.asarray(kept, np.int64))


def kept_by_open3d_statistics(
    local_xyz: Floats, neighbours: int, deviations: float
) -> Flags | None:
    """Open3D's statistical outlier removal."""
    if find_spec("open3d") is None:
        return None
    import open3d

    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(local_xyz))
    _, kept = cloud.remove_statistical_outlier(neighbours, deviations)
    return _flags(len(local_xyz), np.asarray(kept, np.int64))


def kept_by_pcl(local_xyz: Floats, settings: tuple[str, ...], folder: Path) -> Flags | None:
    """PCL's outlier removal, its options as typed; ``folder`` for files of its own."""
    return _of_pcl(_OUTLIERS, local_xyz, settings, folder)


def ground_by_pcl(local_xyz: Floats, settings: tuple[str, ...], folder: Path) -> Flags | None:
    """PCL's progressive morphological filter, its options as typed."""
    return _of_pcl(_MORPHOLOGY, local_xyz, settings, folder)


def ground_by_cloth(
    local_xyz: Floats, cloth_m: float, rigidness: int, distance_m: float
) -> Flags | None:
    """CSF: a cloth of so wide meshes laid on the cloud upside down, with its slopes smoothed.

    References
    ----------
    Zhang et al. 2016, Remote Sensing 8(6), 501.
    """
    if find_spec("CSF") is None:
        return None
    with tempfile.TemporaryDirectory(prefix="zuka-") as folder:
        positions, found = Path(folder) / "places.npy", Path(folder) / "ground.npy"
        np.save(positions, local_xyz)
        # A process of its own, since it talks to standard output from C++; of one thread, since
        # with several its result changes from run to run.
        told = [str(value) for value in (positions, found, cloth_m, rigidness, distance_m)]
        subprocess.run(  # noqa: S603 - our own lines, with files of our own
            [sys.executable, "-c", _CLOTH, *told],
            check=True,
            stdout=subprocess.DEVNULL,
            timeout=_LONGEST_S,
            env={**os.environ, "OMP_NUM_THREADS": "1"},
        )
        return _flags(len(local_xyz), np.load(found))


def ground_by_smrf(local_xyz: Floats, cell_m: float, width_m: float, slope: float) -> Flags | None:
    """SMRF: openings of growing windows, its other numbers as it has them.

    Parameters
    ----------
    width_m : float
        Radius of the widest window.

    References
    ----------
    Pingel, Clarke, McBride 2013, ISPRS Journal 77, p. 21-30.
    """
    if any(find_spec(name) is None for name in ("pysmrf", "rasterio", "pandas")):
        return None
    import pysmrf

    windows = max(1, round(width_m / cell_m))
    told = pysmrf.smrf(*local_xyz.T, cellsize=cell_m, windows=windows, slope_threshold=slope)
    is_ground: Flags = ~np.asarray(told[3], np.bool_)
    return is_ground


def _flags(count: int, chosen: NDArray[np.int64]) -> Flags:
    flags = np.zeros(count, np.bool_)
    flags[chosen] = True
    return flags


def _of_pcl(
    program: str, local_xyz: Floats, settings: tuple[str, ...], folder: Path
) -> Flags | None:
    """Points that PCL's program wrote: found again by their places, which it keeps to the bit."""
    if shutil.which(program) is None or shutil.which(_CONVERTER) is None:
        return None
    rounded = np.ascontiguousarray(local_xyz, "<f4")
    source, packed, plain = (folder / name for name in ("in.pcd", "packed.pcd", "out.pcd"))
    source.write_bytes(_PCD.format(count=len(rounded)).encode() + rounded.tobytes())
    for command in (
        [program, str(source), str(packed), *settings],
        [_CONVERTER, str(packed), str(plain), _AS_BINARY],
    ):
        subprocess.run(  # noqa: S603 - the named peers with files of our own
            command, check=True, capture_output=True, timeout=_LONGEST_S
        )
    head, _, data = plain.read_bytes().partition(b"DATA binary\n")
    count = int(head.partition(b"\nPOINTS ")[2].split()[0])
    # PCL leaves room behind the last point.
    positions = np.frombuffer(data, "<f4", 3 * count).reshape(-1, 3)
    return np.isin(_as_one(rounded), _as_one(positions))


def _as_one(positions: NDArray[np.float32]) -> NDArray[np.void]:
    return positions.view(np.dtype((np.void, positions.dtype.itemsize * 3))).ravel()
