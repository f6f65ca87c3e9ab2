"""Where a road runs: curves with transitions, grades and super-elevation by chainage."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.street.styles import Style

Floats = NDArray[np.float64]

MARGIN_M = 320.0
"""How far the road goes on before the beginning and behind the end of what is driven."""

_KNOT_M = 20.0
_STEP_M = 0.25
_MOST_TURNED_RAD = 0.9  # from the first heading: a street that never meets itself


@dataclass(frozen=True)
class Alignment:
    """A road's centre line in the street's frame (x east, y north, z up, m).

    Attributes
    ----------
    chainages : (n,) float64
        m, rising by a quarter of a metre; 0 where the drive begins.
    positions : (n, 3) float64
    headings : (n,) float64
        Radians anticlockwise from east.
    curvatures : (n,) float64
        1/m, positive to the left.
    tilts : (n,) float64
        Super-elevation: rise per metre to the left.
    grades : (n,) float64
        Rise per metre along the road.
    camber : float
        Fall from the centre to both edges where there is no super-elevation.
    """

    chainages: Floats
    positions: Floats
    headings: Floats
    curvatures: Floats
    tilts: Floats
    grades: Floats
    camber: float

    def at(self, chainage: ArrayLike, offset: ArrayLike, height: ArrayLike) -> Floats:
        """Places beside the centre line.

        Parameters
        ----------
        chainage : (...) float64
        offset : (...) float64
            m to the left, square to the road.
        height : (...) float64
            z, m.

        Returns
        -------
        (..., 3) float64
        """
        s, o, z = np.broadcast_arrays(
            np.asarray(chainage, np.float64), np.asarray(offset, np.float64), height
        )
        heading = self.heading(s)
        x = np.interp(s, self.chainages, self.positions[:, 0]) - np.sin(heading) * o
        y = np.interp(s, self.chainages, self.positions[:, 1]) + np.cos(heading) * o
        return np.stack([x, y, z], axis=-1)

    def heading(self, chainage: ArrayLike) -> Floats:
        """Radians anticlockwise from east."""
        return np.interp(np.asarray(chainage, np.float64), self.chainages, self.headings)

    def carriageway_height(self, chainage: ArrayLike, offset: ArrayLike) -> Floats:
        """Height of the road's surface, z in m, with camber and super-elevation."""
        s, o = np.asarray(chainage, np.float64), np.asarray(offset, np.float64)
        centre = np.interp(s, self.chainages, self.positions[:, 2])
        tilt = np.interp(s, self.chainages, self.tilts)
        crowned = np.maximum(0.0, 1.0 - np.abs(tilt) / self.camber)
        return centre + tilt * o - self.camber * crowned * np.abs(o)


def alignment_of(seed: int, style: Style, length_m: float) -> Alignment:
    """The road of a seed: the longer one begins like the shorter one."""
    random = chance(seed, "alignment")
    heading = float(random.uniform(-np.pi, np.pi))
    camber = float(random.uniform(*style.camber))
    curviness, hilliness = float(random.uniform(0.2, 1.0)), float(random.uniform(0.1, 1.0))
    ahead = _knots(seed, 1, style, int(np.ceil((length_m + MARGIN_M) / _KNOT_M)) + 2)
    behind = _knots(seed, -1, style, int(np.ceil(MARGIN_M / _KNOT_M)) + 2)
    curves, grades = (
        np.concatenate([back[:0:-1], fore]) for back, fore in zip(behind, ahead, strict=True)
    )
    knots = (np.arange(curves.size) - (behind[0].size - 1)) * _KNOT_M
    per_knot = int(_KNOT_M / _STEP_M)
    first, last = -int(MARGIN_M / _STEP_M), int(np.ceil((length_m + MARGIN_M) / _STEP_M))
    chainages = np.arange(first, last + 1).astype(np.float64) * _STEP_M
    curvatures: Floats = np.interp(chainages, knots, curves * curviness)
    slopes: Floats = np.interp(chainages, knots, grades * hilliness)
    zero = -first
    headings: Floats = heading + _summed(curvatures, zero)
    positions = np.column_stack(
        [
            _summed(np.cos(headings), zero),
            _summed(np.sin(headings), zero),
            _summed(slopes, zero),
        ]
    )
    tilts: Floats = -np.sign(curvatures) * np.minimum(
        style.most_tilt, style.most_tilt * np.abs(curvatures) * style.least_radius_m * 2
    )
    padded: Floats = np.pad(tilts, per_knot, mode="edge")
    spread: Floats = np.convolve(padded, np.ones(per_knot) / per_knot, "same")
    spread = spread[per_knot:-per_knot]
    return Alignment(chainages, positions, headings, curvatures, spread, slopes, camber)


def _knots(seed: int, direction: int, style: Style, count: int) -> tuple[Floats, Floats]:
    """Curvature and grade every 20 m, from the beginning outwards, one stream per knot."""
    curves, grades = np.zeros(count), np.zeros(count)
    turned, left, curve, grade = 0.0, 0, 0.0, 0.0
    for knot in range(count):
        random = chance(seed, "knot", direction, knot)
        if left == 0:
            left = int(random.integers(2, 7))
            curve = 0.0
            if random.random() < style.curve_share:
                radius = style.least_radius_m * 2 ** random.uniform(0, 3)
                side = -1.0 if random.random() < 0.5 else 1.0
                if abs(turned) > _MOST_TURNED_RAD / 2:
                    side = -float(np.sign(turned))
                curve = side / radius
            grade = float(np.clip(random.normal(0, 0.6), -1, 1)) * style.most_grade
        if abs(turned + direction * curve * _KNOT_M) > _MOST_TURNED_RAD:
            curve = 0.0
        left -= 1
        curves[knot], grades[knot] = curve, grade
        turned += direction * curve * _KNOT_M
    return curves, grades


def _summed(rates: Floats, zero: int) -> Floats:
    """The integral over the chainage, 0 at row ``zero``; the same there however long it is."""
    steps = (rates[1:] + rates[:-1]) / 2 * _STEP_M
    ahead = np.concatenate([[0.0], np.cumsum(steps[zero:])])
    behind = -np.cumsum(steps[:zero][::-1])[::-1]
    return np.concatenate([behind, ahead])
