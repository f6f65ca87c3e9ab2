"""Which trajectory belongs to a recording, and by how much their clocks differ."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import OutOfRange
from processing.formats.trajectories.trajectory_files import read_trajectory
from processing.recording.vehicle_path.clock import match_clock
from processing.recording.vehicle_path.trajectory import Trajectory


@dataclass(frozen=True)
class NamedTrajectory:
    """A trajectory and the file it came from."""

    path: Path
    trajectory: Trajectory


@dataclass(frozen=True)
class MatchedTrajectory:
    """The trajectory of a recording.

    Attributes
    ----------
    clock_offset_s : float
        To be added to the recording's times.
    """

    trajectory: Trajectory
    clock_offset_s: float


def read_trajectories(paths: tuple[Path, ...], crs: str) -> tuple[NamedTrajectory, ...]:
    """Read all trajectory files of a delivery.

    Raises
    ------
    UserError
        For a file that can't be read.
    """
    return tuple(NamedTrajectory(path, read_trajectory(path, crs)) for path in paths)


def match_trajectory(
    times: NDArray[np.float64],
    trajectories: tuple[NamedTrajectory, ...],
    recording: str,
    *,
    is_adjusted_standard: bool | None,
) -> MatchedTrajectory | None:
    """The trajectory whose times cover a recording's, on whichever clock.

    Parameters
    ----------
    times : (n,) float64
        Some of the recording's times, the first and the last among them, delivered clock.
    recording : str
        Its name, for the message.

    Returns
    -------
    MatchedTrajectory or None
        None when there are no trajectories.

    Raises
    ------
    OutOfRange
        None of them covers the recording; says what the last one lacks.
    """
    refusal: OutOfRange | None = None
    for named in trajectories:
        try:
            offset = match_clock(
                times,
                named.trajectory,
                f"{recording}, {named.path.name}",
                is_adjusted_standard=is_adjusted_standard,
            )
        except OutOfRange as error:
            refusal = error
        else:
            return MatchedTrajectory(named.trajectory, offset)
    if refusal is not None:
        raise refusal
    return None
