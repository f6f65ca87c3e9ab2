"""Trajectories as Applanix POSPac writes them: SBET, the smoothed best estimate of trajectory."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import (
    UNCHANGED,
    BadFile,
    MissingInput,
    OutOfRange,
    report_as_user_error,
)
from processing.core.text import Text
from processing.formats.trajectories.trajectory_csv import too_few_records
from processing.recording.vehicle_path.trajectory import Trajectory

RECORD_BYTES = 136
_FIELDS = (
    "time", "latitude", "longitude", "height", "vx", "vy", "vz", "roll", "pitch", "heading",
    "wander", "ax", "ay", "az", "wx", "wy", "wz",
)  # fmt: skip
_RECORD = np.dtype([(name, "<f8") for name in _FIELDS])
_LIMITS = {
    "time": (0.0, 1e11),
    "latitude": (-np.pi / 2, np.pi / 2),
    "longitude": (-2 * np.pi, 2 * np.pi),
    "height": (-1e3, 1e5),
    "roll": (-np.pi, np.pi),
    "pitch": (-np.pi / 2, np.pi / 2),
    "heading": (-2 * np.pi, 4 * np.pi),
    "wander": (-2 * np.pi, 4 * np.pi),
}
_NORTH_STEP_DEG = 1e-4
_UTF16 = (b"\xff\xfe", b"\xfe\xff")


def is_sbet(start: bytes) -> bool:
    """Whether a file's first bytes are a record that a vehicle can have, and no text."""
    if len(start) < RECORD_BYTES or b"\0" not in start or start.startswith(_UTF16):
        return False
    record = np.frombuffer(start[:RECORD_BYTES], _RECORD)[0]
    return all(low <= record[name] <= high for name, (low, high) in _LIMITS.items())


def read_sbet(path: Path, crs: str) -> Trajectory:
    """Read a binary SBET and project it.

    Parameters
    ----------
    crs : str
        ``EPSG:n`` of a projected system. Latitude and longitude are taken to be of its datum.

    Returns
    -------
    Trajectory
        Heights stay as they are (ellipsoidal). Headings are from grid north.

    Raises
    ------
    MissingInput
        ``crs`` is empty.
    OutOfRange
        ``crs`` is unknown or not projected, or the records lie outside its area.
    BadFile
        Not whole records, or values that no vehicle can have: names the record.

    Notes
    -----
    Records are 17 little-endian doubles: time (s), latitude, longitude (rad), height (m), three
    velocities in the wander frame, roll, pitch, platform heading, wander angle (rad), three
    accelerations, three angular rates. The platform heading counts clockwise from the wander
    frame's x axis, which lies the wander angle anticlockwise of true north (so do the recorded
    velocities), hence true heading = platform heading - wander angle. The grid bearing of true
    north, found by projecting a second point north of each record, is added to it.
    """
    if not crs:
        raise MissingInput(
            Text(
                "The trajectory is in latitude and longitude, and no reference system is given.",
                "走行軌跡は緯度・経度ですが、座標参照系が指定されていません。",
            ),
            Text.same(str(path)),
            Text(
                "Say which system to project it to, for example --crs EPSG:6677.",
                "投影する座標系を指定してください（例：--crs EPSG:6677）。",
            ),
        )
    records = _read_records(path)
    easting, northing, bearing_rad = _project_records(records, crs, path)
    heading = records["heading"] - records["wander"] + bearing_rad
    xyz = np.column_stack([easting, northing, records["height"]])
    angles = np.degrees(np.column_stack([records["roll"], records["pitch"], heading]))
    angles[:, 2] %= 360.0
    time = np.ascontiguousarray(records["time"])
    return Trajectory(time, xyz, angles, has_attitude=True)


@np.errstate(invalid="ignore")
def _read_records(path: Path) -> NDArray[np.void]:
    with report_as_user_error(path):
        data = path.read_bytes()
    if len(data) % RECORD_BYTES or not data:
        raise _bad_record(
            path,
            len(data) // RECORD_BYTES,
            Text(
                f"{len(data):,} bytes are not whole records of {RECORD_BYTES} bytes.",
                f"{len(data):,}バイトは1記録{RECORD_BYTES}バイトの整数倍ではありません。",
            ),
        )
    records = np.frombuffer(data, _RECORD)
    for name, (low, high) in _LIMITS.items():
        values = records[name]
        good = (values >= low) & (values <= high)
        if not good.all():
            bad = int(np.argmin(good))
            what = Text("{value:g} can't be a {name}.", "{name} の値 {value:g} は不正です。")
            raise _bad_record(path, bad, what.filled(value=float(values[bad]), name=name))
    step = np.diff(records["time"])
    if (step < 0).any():
        back = int(np.argmax(step < 0)) + 1
        raise _bad_record(path, back, Text("The time goes back.", "時刻が逆戻りしています。"))
    kept = np.ones(records.size, dtype=np.bool_)
    kept[1:] = step > 0
    if kept.sum() < 2:
        raise too_few_records(path)
    return records[kept]


def _project_records(
    records: NDArray[np.void], crs: str, path: Path
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Easting, northing, and the grid bearing of true north (rad) of each record."""
    from pyproj import Transformer

    system = _projected_system(crs, path)
    transformer = Transformer.from_crs(system.geodetic_crs, system, always_xy=True)
    longitude, latitude = np.degrees(records["longitude"]), np.degrees(records["latitude"])
    easting, northing = transformer.transform(longitude, latitude)
    bearing = _bearings(transformer, longitude, latitude)
    good = np.isfinite(easting) & np.isfinite(northing) & np.isfinite(bearing)
    if not good.all():
        bad = int(np.argmin(good))
        raise OutOfRange(
            Text(
                f"Record {bad + 1:,} lies outside the area of {crs}.",
                f"{bad + 1:,}番目の記録は {crs} の適用範囲外です。",
            ),
            Text.same(str(path)),
            Text(
                "Choose the zone of the survey.", "測量区域の座標系（系番号）を指定してください。"
            ),
        )
    return easting, northing, bearing


def record_type() -> np.dtype[np.void]:
    """The type of an SBET's records."""
    return _RECORD


def bearings_of_north(
    xy: NDArray[np.float64], crs: str, path: Path
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Longitude and latitude, degrees, and the grid bearing of true north, rad, of places.

    Parameters
    ----------
    xy : (n, 2) float64
        m, ``crs``.
    path : Path
        Of the file that they are for.

    Raises
    ------
    OutOfRange
        ``crs`` is unknown or not projected.
    """
    from pyproj import Transformer

    system = _projected_system(crs, path)
    transformer = Transformer.from_crs(system.geodetic_crs, system, always_xy=True)
    longitude, latitude = transformer.transform(xy[:, 0], xy[:, 1], direction="INVERSE")
    return longitude, latitude, _bearings(transformer, longitude, latitude)


# Any: pyproj has no types of its own for its transformers and systems.
def _bearings(
    transformer: Any, longitude: NDArray[np.float64], latitude: NDArray[np.float64]
) -> NDArray[np.float64]:
    easting, northing = transformer.transform(longitude, latitude)
    # Towards the pole a step north would leave the sphere; a step south serves as well.
    step = np.where(latitude > 0, -_NORTH_STEP_DEG, _NORTH_STEP_DEG)
    east_of_step, north_of_step = transformer.transform(longitude, latitude + step)
    sign = np.sign(step)
    return np.asarray(
        np.arctan2(sign * (east_of_step - easting), sign * (north_of_step - northing))
    )


def _projected_system(crs: str, path: Path) -> Any:  # as above
    from pyproj import CRS
    from pyproj.exceptions import CRSError

    try:
        system = CRS.from_user_input(crs)
    except CRSError:
        system = None
    if system is None or not system.is_projected or system.geodetic_crs is None:
        raise OutOfRange(
            Text(
                f"{crs} is not a projected reference system.",
                f"{crs} は投影座標系ではありません。",
            ),
            Text.same(str(path)),
            Text(
                "Choose a plane system such as EPSG:6677.",
                "EPSG:6677などの平面直角座標系を指定してください。",
            ),
        )
    return system


def _bad_record(path: Path, record: int, what: Text) -> BadFile:
    return BadFile(
        what,
        Text(f"{path}, record {record + 1:,}", f"{path}、{record + 1:,}番目の記録"),
        Text(
            "Check that it is an SBET file and copy it again. {unchanged}",
            "SBETファイルであることを確認し、コピーし直してください。{unchanged}",
        ).filled(unchanged=UNCHANGED),
    )
