"""Small point and trajectory files as they are delivered, with known content, made by tests."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import laspy
import numpy as np
import pyproj
from numpy.typing import NDArray

TRAJECTORY_HEADER = "time_s,easting_m,northing_m,height_m,roll_deg,pitch_deg,heading_deg"
_SCALE, _OFFSET = 0.001, (-11_000.0, -35_000.0, 100.0)


@dataclass(frozen=True)
class LasContent:
    """What a LAS file of :func:`make_las` holds: integers and times."""

    xyz: NDArray[np.int32]
    time: NDArray[np.float64]
    intensity: NDArray[np.uint16]
    classification: NDArray[np.uint8]


def make_las(
    path: Path,
    *,
    point_format: int = 6,
    count: int = 500,
    epsg: int = 6677,
    with_extra: bool = False,
) -> LasContent:
    """Write a LAS or LAZ file (by the name) of points along a road; seeded."""
    version = "1.4" if point_format >= 6 else "1.3" if point_format >= 4 else "1.2"
    header = laspy.LasHeader(point_format=point_format, version=version)
    header.scales, header.offsets = [_SCALE] * 3, list(_OFFSET)
    if epsg:
        header.add_crs(pyproj.CRS.from_epsg(epsg))
    if with_extra:
        header.add_extra_dim(laspy.ExtraBytesParams("pulse_width", np.float32))
    random = np.random.default_rng(point_format)
    content = LasContent(
        xyz=np.cumsum(random.integers(-50, 60, (count, 3)), axis=0).astype(np.int32),
        time=1_000.0 + np.cumsum(random.uniform(1e-6, 1e-4, count)),
        intensity=random.integers(0, 65_536, count).astype(np.uint16),
        classification=random.integers(0, 32, count).astype(np.uint8),
    )
    las = laspy.LasData(header)
    las.X, las.Y, las.Z = content.xyz.T
    names = set(las.point_format.dimension_names)
    las.intensity = content.intensity
    las.classification = content.classification
    las.point_source_id = np.full(count, 2)
    las.user_data = np.arange(count) % 7
    las.return_number = np.full(count, 1)
    las.number_of_returns = np.full(count, 1)
    if "gps_time" in names:
        las.gps_time = content.time
    if "scan_angle" in names:
        las.scan_angle = np.arange(count) % 100 * 50
    else:
        las.scan_angle_rank = np.arange(count) % 50 - 25
    if "red" in names:
        las.red, las.green, las.blue = random.integers(0, 65_536, (3, count))
    if with_extra:
        las["pulse_width"] = random.random(count).astype(np.float32)
    las.write(path)
    return content


def trajectory_rows(count: int = 50, start_s: float = 1_000.0) -> NDArray[np.float64]:
    """(count, 7) numbers of a straight drive to the east at 10 m/s, 0.1 s apart."""
    rows = np.zeros((count, 7))
    rows[:, 0] = start_s + 0.1 * np.arange(count)
    rows[:, 1] = -11_000.0 + np.arange(count)
    rows[:, 2], rows[:, 3], rows[:, 6] = -35_000.0, 120.0, 90.0
    return rows


def trajectory_text(rows: NDArray[np.float64]) -> str:
    """A trajectory CSV of these rows."""
    lines = [",".join(f"{value:.4f}" for value in row) for row in rows]
    return "\n".join([TRAJECTORY_HEADER, *lines, ""])


def sbet_bytes(count: int = 50) -> bytes:
    """An SBET of a drive to true north near Tokyo, level; heading 10°, wander angle 10°."""
    records = np.zeros((count, 17), dtype="<f8")
    records[:, 0] = 400_000.0 + 0.005 * np.arange(count)
    records[:, 1] = np.radians(35.6 + 1e-6 * np.arange(count))
    records[:, 2] = np.radians(139.5)
    records[:, 3] = 80.0
    records[:, 9] = np.radians(10.0)
    records[:, 10] = np.radians(10.0)
    return records.tobytes()


def ply_bytes(form: str = "binary_little_endian", count: int = 40) -> bytes:
    """A PLY as mobile mapping programs write it, with an offset in a comment."""
    kinds = [
        ("float64", "GPS_time", "f8"),
        ("float32", "x", "f4"),
        ("float32", "y", "f4"),
        ("float32", "z", "f4"),
        ("float32", "x_origin", "f4"),
        ("float32", "y_origin", "f4"),
        ("float32", "z_origin", "f4"),
        ("uint8", "num_echo", "u1"),
        ("uint8", "nb_of_echo", "u1"),
        ("float32", "reflectance", "f4"),
    ]
    order = ">" if form == "binary_big_endian" else "<"
    points = np.zeros(count, dtype=[(name, order + kind) for _, name, kind in kinds])
    points["GPS_time"] = 54_160.0 + 0.001 * np.arange(count)
    points["x"], points["y"], points["z"] = np.arange(count) * 0.5, 20.25, 45.0
    points["x_origin"], points["y_origin"], points["z_origin"] = np.arange(count) * 0.5, 18.0, 47.0
    points["num_echo"], points["nb_of_echo"] = 1, 2
    points["reflectance"] = np.linspace(-20.0, 5.0, count)
    header = [
        "ply",
        f"format {form} 1.0",
        "comment offset Pos 649000.000000 6840000.000000 0.000000",
        f"element vertex {count}",
        *(f"property {kind} {name}" for kind, name, _ in kinds),
        "element face 1",
        "property list uchar int vertex_indices",
        "end_header",
        "",
    ]
    if form == "ascii":
        rows = [" ".join(f"{float(value):.6f}" for value in point) for point in points]
        return ("\n".join(header) + "\n".join([*rows, "3 0 1 2", ""])).encode()
    face = np.array([3], "u1").tobytes() + np.array([0, 1, 2], order + "i4").tobytes()
    return "\n".join(header).encode() + points.tobytes() + face
