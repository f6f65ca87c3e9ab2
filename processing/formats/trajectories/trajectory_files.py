"""The one door to trajectories: picks the reader by what the file holds, not by its name."""

from __future__ import annotations

from pathlib import Path

from processing.core.errors import report_as_user_error
from processing.formats.trajectories.sbet import RECORD_BYTES, read_sbet
from processing.formats.trajectories.trajectory_csv import read_trajectory_csv
from processing.recording.vehicle_path.trajectory import Trajectory

TRAJECTORY_ENDINGS = (".out", ".sbet")
"""How the names of trajectories end that are no text."""

_TEXT_CONTROLS = frozenset(b"\t\n\v\f\r\x1a")


def read_trajectory(path: Path, crs: str) -> Trajectory:
    """Read a trajectory: CSV with a header, POSPac's text export, or SBET.

    Parameters
    ----------
    crs : str
        ``EPSG:n`` of the project; only SBET needs it, text is taken to be in it already.

    Raises
    ------
    MissingInput, OutOfRange, NoSpace, BadFile
        As the readers say.
    """
    with report_as_user_error(path), path.open("rb") as file:
        start = file.read(4 * RECORD_BYTES)
    if _is_binary(start):
        return read_sbet(path, crs)
    return read_trajectory_csv(path)


def _is_binary(start: bytes) -> bool:
    is_utf16 = start.startswith((b"\xff\xfe", b"\xfe\xff"))
    return not is_utf16 and any(byte < 32 and byte not in _TEXT_CONTROLS for byte in start)
