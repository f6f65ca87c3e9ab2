"""Where on the vehicle a drive's head is: from how its revolutions sweep over what they met.

How deep a beam falls into a hole follows from how steeply it comes in, so from the head's height
above the road and its place over it; a trajectory is that of the antenna or the wheels, a metre or
two away.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.image.edges.beam import sweep_of
from processing.recording.drive import Drive

Floats = NDArray[np.float64]

_REVOLUTIONS = 12
"""That are asked, all along the drive; their median counts, so that cars beside one don't."""

_POINTS, _FEWEST = 300, 60
"""Of a revolution that are looked at, at most and at least."""

_FARTHEST_M = 6.0
"""No head is farther from its trajectory's reference point: a lorry's length of bumpers to mast."""


def head_position(drive: Drive) -> Floats:
    """The head's place on the vehicle.

    Returns
    -------
    (3,) float64
        Forward, left and up of the trajectory's reference point, m; zeros, the reference point
        itself, where revolutions don't say.
    """
    revolutions, trajectory = drive.revolutions, drive.trajectory
    nowhere = np.zeros(3)
    if revolutions is None or trajectory is None:
        return nowhere
    folds = np.asarray(revolutions.fold_pulses, np.int64)
    half = int(revolutions.pulses_per_revolution / 2)
    pulse, time = drive.columns["pulse"], drive.columns["time"]
    found = []
    for fold in folds[:: max(1, folds.size // _REVOLUTIONS)]:
        start, stop = np.searchsorted(pulse, [fold - half, fold + half])
        points = np.arange(start, stop, max(1, (stop - start) // _POINTS))
        times = np.asarray(time[points], np.float64)
        if points.size < _FEWEST or not trajectory.covers(times).all():
            continue
        numbers = np.asarray(pulse[points], np.float64) - fold
        vehicle = trajectory.to_vehicle(drive.xyz(points), times)
        sweep = sweep_of(vehicle, numbers, 2 * np.pi / revolutions.pulses_per_revolution)
        if sweep is not None and np.linalg.norm(sweep.centre) <= _FARTHEST_M:
            found.append(sweep.centre)
    return np.asarray(np.median(found, axis=0), np.float64) if found else nowhere
