"""DriftCorrection: how points of a drive are moved, by when they were measured and where."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from processing.core.arrays import Floats
from processing.methods.registration.tracks import Track

_KEY_DIGITS = 16


@dataclass(frozen=True, eq=False)
class DriftCorrection:
    """A correction of a trajectory and of a head's mounting.

    Attributes
    ----------
    track : Track
    at_knots : (k, 6) float64
        Shifts east, north, up, m; turns about forward, left, up, rad.
    mounting : (6,) float64
        Turns of the head about the vehicle's axes, rad, and shifts along them, m.
    """

    track: Track
    at_knots: Floats
    mounting: Floats

    @cached_property
    def key(self) -> str:
        """Another one for any other correction."""
        told = hashlib.sha256()
        for array in (self.track.knots, self.at_knots, self.mounting):
            told.update(np.ascontiguousarray(array).tobytes())
        return told.hexdigest()[:_KEY_DIGITS]

    @cached_property
    def reach_m(self) -> float:
        """No coordinate of a point within 300 m of the vehicle changes by more."""
        turned = np.abs(self.at_knots[:, 3:]).max(initial=0.0) + np.abs(self.mounting[:3]).max()
        shifted = np.abs(self.at_knots[:, :3]).max(initial=0.0) + np.abs(self.mounting[3:]).max()
        return float(2 * shifted + 2 * 300.0 * turned)

    def shifts(self, time: Floats, xyz: Floats) -> Floats:
        """What to add: (n, 3) m; nothing to points without a time.

        Parameters
        ----------
        time : (n,) float64
        xyz : (n, 3) float64
            m, project CRS.
        """
        moved = np.zeros((time.size, 3))
        timed = np.isfinite(time)
        if not timed.any():
            return moved
        at, axes = self.track.places(time[timed])
        before, share = self.track.spans(time[timed])
        knots = self.at_knots
        there = knots[before] * (1 - share)[:, None] + knots[before + 1] * share[:, None]
        away = np.einsum("nij,ni->nj", axes, xyz[timed] - at)
        inside = np.cross(there[:, 3:] + self.mounting[:3], away) + self.mounting[3:]
        moved[timed] = there[:, :3] + np.einsum("nij,nj->ni", axes, inside)
        return moved

    def of_vehicle(self, time: Floats) -> Floats:
        """What to add to the trajectory: (n, 6) shifts, m, and turns, rad, as ``at_knots``."""
        before, share = self.track.spans(time)
        knots = self.at_knots
        there: Floats = knots[before] * (1 - share)[:, None] + knots[before + 1] * share[:, None]
        return there
