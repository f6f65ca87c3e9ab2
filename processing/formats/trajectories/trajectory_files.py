"""The one door to trajectories: picks the reader by what the file holds, not by its name."""

from __future__ import annotations

from pathlib import Path

from processing.core.errors import report_as_user_error
from processing.formats.format import Content
from processing.formats.registry import FORMATS
from processing.recording.vehicle_path.trajectory import Trajectory

_LOOKED_AT = 4096
_TABLE, _BINARY = "trajectory", "sbet"
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
        start = file.read(_LOOKED_AT)
    found = FORMATS.recognised(start, Content.TRAJECTORY)
    # What no format knows for certain is refused by the likelier one, with its reasons.
    likely = FORMATS[_BINARY if _is_binary(start) else _TABLE] if found is None else found[0]
    trajectory: Trajectory = likely.reader(Content.TRAJECTORY)(path, crs)
    return trajectory


def _is_binary(start: bytes) -> bool:
    is_utf16 = start.startswith((b"\xff\xfe", b"\xfe\xff"))
    return not is_utf16 and any(byte < 32 and byte not in _TEXT_CONTROLS for byte in start)
