"""Grass and soil between the vehicle's path and a run: what lies behind a verge is no curb.

A curb stands at the road, or on a walk that another curb raised; ridges and levees of fields and
the edges of lots stand as steep and as straight behind ground that nobody paved.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from processing.image.scan_lines.scanlines import Scanlines, ScanlineSettings
from processing.methods.road.curbs.steps.curb_runs import StepRun
from processing.methods.road.curbs.steps.verge_kernels import BIN_M, EVERY, verges_kernel
from processing.methods.road.rising import nearest_rising

Floats = NDArray[np.float64]

_BINS = round(ScanlineSettings().half_width_m / BIN_M)
"""As far as scanlines reach."""


_BEFORE_M, _LEAST_AHEAD_M = 0.5, 1e-3
"""How far before the lower edge the ground is asked for: two bins, so that the face is in neither;
and the guard of a division, m."""


@dataclass(frozen=True)
class PassVerges:
    """Rough ground beside the vehicle's path, some decimetres apart along it.

    Attributes
    ----------
    stations_m, positions, rights
        Of the scanlines that were looked at, as in `Scanlines`.
    wide_m : (s, 2, b) float32
        How much of it lies left and right of the path up to the far end of each bin, m.
    """

    stations_m: Floats
    positions: Floats
    rights: Floats
    wide_m: NDArray[np.float32]

    def of(self, run: StepRun) -> StepRun:
        """The run, with how much of it lies between the path and the ground before each place.

        That ground is asked for beside the step: scanlines may run along its face.
        """
        ahead = np.gradient(run.lower[:, :2], axis=0)
        ahead /= np.maximum(np.hypot(ahead[:, 0], ahead[:, 1]), _LEAST_AHEAD_M)[:, None]
        # What is higher on the far side of the path has its foot on the near one.
        left = np.column_stack([-ahead[:, 1], ahead[:, 0]]) * (run.side * run.rises)
        foot = run.lower[:, :2] + _BEFORE_M * left
        stations = run.stations_m
        at = nearest_rising(self.stations_m, stations)
        along = np.column_stack([-self.rights[at, 1], self.rights[at, 0]])
        stations = stations + _BEFORE_M * (left * along).sum(axis=1)
        at = nearest_rising(self.stations_m, stations)
        across = ((foot - self.positions[at, :2]) * self.rights[at]).sum(axis=1)
        bins = np.clip(np.abs(across) / BIN_M, 0, _BINS - 1).astype(np.int64)
        wide = self.wide_m[at, (across > 0).astype(np.int64), bins]
        return replace(run, verge_m=wide.astype(np.float64))


def verges_of(scanlines: Scanlines) -> PassVerges:
    """The verges of the scanlines of one stretch."""
    every = slice(None, None, EVERY)
    stations = scanlines.stations_m[every]
    wide = np.empty((stations.size, 2, _BINS), np.float32)
    verges_kernel(scanlines.across_m, scanlines.height_m, scanlines.starts, wide)
    return PassVerges(stations, scanlines.positions[every], scanlines.rights[every], wide)


def join_verges(parts: Sequence[PassVerges]) -> PassVerges:
    """Verges of the stretches of one pass as of one."""
    return PassVerges(
        np.concatenate([part.stations_m for part in parts]),
        np.vstack([part.positions for part in parts]),
        np.vstack([part.rights for part in parts]),
        np.concatenate([part.wide_m for part in parts]),
    )
