"""Where the vehicle drove, in plan: what lies beside and under a thing is told from there."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from processing.core.arrays import Floats
from processing.methods.road.objects.sparse_plan import SparsePlan
from processing.recording.drive import Drive

_STEP_M = 0.5
"""Between places; what is asked of them is told to half a metre at best."""


def driven_places(drives: Sequence[Drive], plan: SparsePlan) -> Floats:
    """Places along the paths of all drives.

    Returns
    -------
    (n, 2) float64
        m about the origin of the plan; none without a trajectory.
    """
    places = [np.empty((0, 2))]
    for drive in drives:
        if drive.trajectory is None or len(drive.trajectory.xyz) < 2:
            continue
        path = drive.trajectory.xyz[:, :2] - plan.origin[:2]
        along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))])
        at = np.arange(0.0, along[-1], _STEP_M)
        places.append(np.column_stack([np.interp(at, along, axis) for axis in path.T]))
    return np.concatenate(places)
