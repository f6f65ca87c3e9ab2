"""The local origin of a project's drawing: near its first drive, and kept."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.project.store.database_errors import damaged
from processing.project.store.project_settings import ProjectSettings
from processing.recording.drive import Drive

ORIGIN = "origin"
"""Setting: easting, northing, height in metres."""

_STEP_M = 100.0


def origin_of(drive: Drive) -> NDArray[np.float64]:
    """(3,) the origin of a project whose first drive this is: its middle, to whole 100 m."""
    middle = (np.array(drive.info.lowest) + np.array(drive.info.highest)) / 2
    return np.asarray(np.rint(middle / _STEP_M) * _STEP_M, dtype=np.float64)


def stored_origin(settings: ProjectSettings, database: Path) -> NDArray[np.float64]:
    """(3,) the origin that a project has; zeros before its first drive.

    Raises
    ------
    BadFile
        What is stored is none.
    """
    stored = settings.get(ORIGIN)
    if stored is None:
        return np.zeros(3)
    if isinstance(stored, list) and len(stored) == 3:
        numbers = [float(one) for one in stored if isinstance(one, (int, float))]
        if len(numbers) == 3 and all(map(math.isfinite, numbers)):
            return np.array(numbers)
    raise damaged(database, f"zuka_settings.origin: {stored}")
