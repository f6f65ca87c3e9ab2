"""Trajectories as text: Zuka's own CSV and the text export of POSPac."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import UNCHANGED, BadFile
from processing.core.text import Text
from processing.formats.trajectories.text_table import TextTable, read_table
from processing.recording.vehicle_path.trajectory import Trajectory

OWN_COLUMNS = (
    "time_s",
    "easting_m",
    "northing_m",
    "height_m",
    "roll_deg",
    "pitch_deg",
    "heading_deg",
)
_POSPAC_COLUMNS = ("GpsTime", "X", "Y", "Z", "Roll", "Pitch", "Azimuth")
_FARTHEST_M = 1e8
_SAY_SO = (b"time_s,easting_m", b"heading", b"azimuth")


def is_trajectory_table(start: bytes) -> bool:
    """Whether a file's first line is the header of a trajectory."""
    first_line = start.partition(b"\n")[0].lower()
    return any(word in first_line for word in _SAY_SO)


def read_trajectory_table(path: Path, _crs: str) -> Trajectory:
    """Read a table, as :func:`read_trajectory_csv`: its coordinates are taken as they are."""
    return read_trajectory_csv(path)


def read_trajectory_csv(path: Path) -> Trajectory:
    """Read a trajectory from a table whose header names the columns.

    Parameters
    ----------
    path : Path
        With columns ``time_s,easting_m,northing_m,height_m,roll_deg,pitch_deg,heading_deg`` or
        POSPac's ``GpsTime,Y,X,Z,Roll,Pitch,Azimuth``, in any order, among any others.

    Returns
    -------
    Trajectory
        In the file's coordinates. Of records with the same time the first is kept.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        It can't be read; a column is missing; a cell is no number; the time runs backwards;
        fewer than two records.
    """
    table = read_table(path)
    is_pospac = not table.has(OWN_COLUMNS[0]) and table.has(_POSPAC_COLUMNS[0])
    columns = _POSPAC_COLUMNS if is_pospac else OWN_COLUMNS
    table.require(columns)
    time = table.numbers(columns[0])
    xyz = [table.numbers(name, -_FARTHEST_M, _FARTHEST_M) for name in columns[1:4]]
    angles = [table.numbers(name, -360.0, 360.0) for name in columns[4:]]
    kept = _rising(time, table)
    return Trajectory(
        time[kept],
        np.column_stack(xyz)[kept],
        np.column_stack(angles)[kept],
        has_attitude=True,
    )


def _rising(time: NDArray[np.float64], table: TextTable) -> NDArray[np.bool_]:
    step = np.diff(time)
    if (step < 0).any():
        back = int(np.argmax(step < 0)) + 1
        what = Text(
            "The time goes back from {before:.6f} to {after:.6f} s.",
            "時刻が {before:.6f} 秒から {after:.6f} 秒へ逆戻りしています。",
        )
        raise table.damage(back, what.filled(before=time[back - 1], after=time[back]))
    kept = np.ones(time.size, dtype=np.bool_)
    kept[1:] = step > 0
    if kept.sum() < 2:
        raise too_few_records(table.path)
    return kept


def too_few_records(path: Path) -> BadFile:
    """What to say of a trajectory with fewer than two records."""
    return BadFile(
        Text(
            "A trajectory needs two records with different times at least.",
            "走行軌跡には異なる時刻の記録が2つ以上必要です。",
        ),
        Text.same(str(path)),
        Text(
            "Choose the whole trajectory of the drive. {unchanged}",
            "走行全体の走行軌跡を選んでください。{unchanged}",
        ).filled(unchanged=UNCHANGED),
    )
