"""The trajectory that a correction makes of the delivered one."""

from __future__ import annotations

import numpy as np

from processing.methods.registration.drift_correction import DriftCorrection
from processing.recording.vehicle_path.trajectory import Trajectory

_SIGNS = np.array([1.0, -1.0, -1.0])
"""Turns about forward, left and up are roll, pitch nose down, and heading to the left."""


def corrected_trajectory(correction: DriftCorrection) -> Trajectory:
    """The delivered trajectory at its own times, corrected; what it says of the head is left out.

    Turns so small add to roll, pitch and heading as they are.
    """
    delivered = correction.track.trajectory
    change = correction.of_vehicle(delivered.time)
    angles = delivered.roll_pitch_heading_deg + np.degrees(change[:, 3:]) * _SIGNS
    angles[:, 2] %= 360.0
    return Trajectory(
        delivered.time, delivered.xyz + change[:, :3], angles, has_attitude=delivered.has_attitude
    )
