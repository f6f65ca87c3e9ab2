"""Gutters: regular lines of notches with their row of covers and the middle of their lids."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.points.passes import Pass
from processing.road.gutter_axis import STEP_M, GutterAxis
from processing.road.gutter_holes import HoleFit, hole_fit
from processing.road.gutter_joints import JointRow, joint_row
from processing.road.gutter_lines import LENGTHS_M, GutterLine, gutter_lines
from processing.road.notches import Notches

_Floats = NDArray[np.float64]

_BAND_M = 0.45
_JOINT_M = 0.04
_WINDOW_M = (1.0, 4.0)  # over which the middle of a gutter is found, by how many notches there are
_NOTCHES = 12.0
_ASIDE_M = 0.04
_STRONG = 0.1
_CLEAR_M = 0.6
_END_M = 0.1
_ROUNDS = 3
_LEAST_COVERS = 2


@dataclass(frozen=True)
class GutterRun:
    """One gutter.

    Attributes
    ----------
    axis : GutterAxis
        Along the middle of its lids.
    row : JointRow
        Its covers.
    holes : HoleFit
        What the holes say of its lids' width.
    length_m : float
        Of most of its lids.
    regularity : float
        See `GutterLine`.
    """

    axis: GutterAxis
    row: JointRow
    holes: HoleFit
    length_m: float
    regularity: float

    @property
    def edges(self) -> tuple[float, float]:
        """Left and right edge of the lids across the axis, m: of the type that the holes tell.

        The groove beside the lids is too narrow to be measured; the largest change of intensity
        is that of the bed's outer side, some centimetres beyond them.
        """
        half = self.holes.type.width_m / 2
        return -half, half


def gutter_runs(
    passes: Sequence[Pass], notches: Sequence[Notches], most_missed: int
) -> tuple[GutterRun, ...]:
    """Gutters that the notches of all drives show.

    Parameters
    ----------
    passes : sequence of Pass
        Of all drives.
    notches : sequence of Notches
        Of each drive.
    most_missed : int
        n_max of equation (7-5): lids in a row whose joints may all be unseen.
    """
    if not notches:
        return ()
    xyz = np.vstack([one.xyz for one in notches])
    strength = np.concatenate([one.strength for one in notches])
    lines = gutter_lines(passes, notches, most_missed * 0.6 + 1.0)
    found: list[GutterRun] = []
    for line in lines:
        run = _run_of(line, (xyz, strength), most_missed)
        if run is not None:
            found.append(run)
            is_free = ~_is_covered(run, xyz)
            xyz, strength = xyz[is_free], strength[is_free]
    return tuple(found)


def _is_covered(run: GutterRun, xyz: _Floats) -> NDArray[np.bool_]:
    """Which notches lie on the covers of a run or close beside them."""
    along, _, _ = run.axis.told(xyz, _CLEAR_M)
    first, last = float(run.row.starts_m.min()), float(run.row.ends_m.max())
    return np.asarray((along > first - _END_M) & (along < last + _END_M))


def _run_of(
    line: GutterLine, notches: tuple[_Floats, _Floats], most_missed: int
) -> GutterRun | None:
    axis, (xyz, all_strength) = line.axis, notches
    low, high = axis.xyz.min(axis=0) - 2.0, axis.xyz.max(axis=0) + 2.0
    is_near = ((xyz >= low) & (xyz <= high)).all(axis=1)
    near, strength = xyz[is_near], all_strength[is_near]
    holes, length_m = None, line.length_m
    for _ in range(_ROUNDS):
        along, across, above = axis.told(near, _BAND_M)
        is_on = np.isfinite(along) & (np.abs(above) < 0.15)
        notches_on = along[is_on], strength[is_on]
        if holes is None:
            lengths = _lengths(line.length_m)
            rows = [joint_row(notches_on, one, axis.length_m, most_missed) for one in lengths]
            worth = [-np.inf if one is None else one.value for one in rows]
            length_m = lengths[int(np.argmax(worth))]
        row = joint_row(notches_on, length_m, axis.length_m, most_missed)
        if row is None or row.starts_m.size < _LEAST_COVERS:
            return None
        at_joint = is_on & (strength >= _STRONG)
        at_joint[at_joint] = _is_at_joint(along[at_joint], row)
        if not at_joint.any():
            return None
        if holes is None:
            axis = _moved(axis, along[at_joint], across[at_joint])
        else:
            off = holes.type.off(across[at_joint])
            of_hole = np.abs(off) <= holes.type.hole_wide_m / 2 + _ASIDE_M
            axis = _moved(axis, along[at_joint][of_hole], off[of_hole])
        along, across, _ = axis.told(near[at_joint], _BAND_M)
        holes = hole_fit(across[np.isfinite(across)])
        axis = _aside(axis, holes.middle_m)
    along, across, above = axis.told(near, _BAND_M)
    is_on = np.isfinite(along) & (np.abs(above) < 0.15)
    row = joint_row((along[is_on], strength[is_on]), length_m, axis.length_m, most_missed)
    if row is None or holes is None or row.starts_m.size < _LEAST_COVERS:
        return None
    return GutterRun(axis, row, holes, length_m, line.regularity)


def _lengths(first_m: float) -> tuple[float, ...]:
    """The length that the spacing tells, and the others."""
    return (first_m, *(one for one in LENGTHS_M if one != first_m))


def _is_at_joint(along: _Floats, row: JointRow) -> NDArray[np.bool_]:
    ends = np.sort(np.concatenate([row.starts_m, row.ends_m]))
    after = np.clip(np.searchsorted(ends, along), 1, ends.size - 1)
    away = np.minimum(np.abs(along - ends[after - 1]), np.abs(along - ends[after]))
    return np.asarray(away < _JOINT_M)


def _moved(axis: GutterAxis, along: _Floats, across: _Floats) -> GutterAxis:
    """The axis through the middle of the notches about every place of it: locally a line."""
    at = np.arange(len(axis.xyz), dtype=np.float64) * STEP_M
    bins = np.clip((along / STEP_M).round().astype(np.int64), 0, at.size - 1)
    weight = np.bincount(bins, minlength=at.size).astype(np.float64)
    # So that many holes in one place do not outweigh those about it.
    one = 1.0 / np.maximum(weight, 1.0)
    share = np.minimum(weight, 4.0) * one
    sums = [np.bincount(bins, across**power, minlength=at.size) * share for power in range(2)]
    density = max(float(sums[0].sum()) / axis.length_m, 0.1)
    sigma = float(np.clip(_NOTCHES / density, *_WINDOW_M))
    aside = _local_lines(at, sums[0], sums[1], sigma)
    return _aside(axis, aside)


def _local_lines(at: _Floats, weight: _Floats, total: _Floats, sigma_m: float) -> _Floats:
    """Values of weighted local lines (Gaussian windows) at every place."""
    reach = int(3 * sigma_m / STEP_M)
    away = np.arange(-reach, reach + 1) * STEP_M
    window = np.exp(-0.5 * (away / sigma_m) ** 2)

    def summed(values: _Floats, power: int) -> _Floats:
        kernel = window * away**power
        return np.convolve(values, kernel[::-1], mode="full")[reach : reach + values.size]

    w0, w1, w2 = (summed(weight, power) for power in range(3))
    t0, t1 = (summed(total, power) for power in range(2))
    bottom = w0 * (w2 + 1e-3) - w1**2
    value = (t0 * (w2 + 1e-3) - t1 * w1) / np.where(np.abs(bottom) < 1e-9, np.inf, bottom)
    known = w0 > 0.05
    if not known.any():
        return np.zeros(at.size)
    filled: _Floats = np.interp(at, at[known], value[known])
    return filled


def _aside(axis: GutterAxis, aside: _Floats | float) -> GutterAxis:
    at = np.arange(len(axis.xyz), dtype=np.float64) * STEP_M
    return GutterAxis.through(axis.places(at, np.broadcast_to(aside, at.shape)))
