"""Notches: places where a row of a recording dips into the road, as lids of gutters let it.

The feature points of Takahashi 2022, section 7.3 b, with what weighs each of them. Rows are
revolutions, so a notch is one crossing of one opening by one revolution.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

OPENING = 1
"""Pattern 1 of Takahashi 2022 (equation 7-2): the beam fell through a hole, down and aside."""
DENT = 2
"""Pattern 2 of Takahashi 2022 (equation 7-3): it met a lid's side face, or soil in a hole."""
LOST = 4
"""Pulses without return within smooth road, as holes and joints leave them."""
JOINT = 8
"""A narrow dip or a step too small for the thesis' limits, as joints between lids make them."""

_WALK_M, _RISE = 0.15, 0.02
"""Walks lie higher than a road, by a curb of 15 cm, and a road in a bend falls to one side, 2 %
beyond its usual cross fall. By trial; no measurement is recorded."""


@dataclass(frozen=True)
class NotchParameters:
    """What counts as a notch: values of Takahashi 2022, Table 7-3, where it has them.

    Attributes
    ----------
    height_range_m : float
        How far above or below the road under the vehicle points are looked at: slopes, banks.
    bridge : int
        Consecutive points below the road that still belong to it.
    aside_m, down_m : float
        h_t and z_t of equation (7-2).
    step_m : float
        z_t2 of equation (7-3).
    below_m : float
        δ: how far points beside a hole may lie below the road's median.
    reach_m : float
        Lids farther from the vehicle's path than this are not looked for: holes are missed there
        (see `gutter_lines.REACH_M`).
    noise_factor : float
        Limits are at least this many times the ranging noise measured beside the place: what normal
        noise exceeds once in 740 points.
    """

    height_range_m: float = 1.5
    bridge: int = 5
    aside_m: float = 0.02
    down_m: float = 0.01
    step_m: float = 0.10
    below_m: float = 0.10
    reach_m: float = 8.0
    noise_factor: float = 3.0


@dataclass(frozen=True)
class Notches:
    """Where rows of one drive dip into a smooth surface, in the order they were measured.

    Attributes
    ----------
    xyz : (n, 3) float64
        Middle of the opening on the lid's surface (7.3 b2), m, project CRS.
    time_s : (n,) float64
        When it was passed.
    depth_m : (n,) float64
        How far the deepest point lies below the surface; 0 where only pulses are lost.
    width_m : (n,) float64
        Between the last point before and the first after the opening, along the row.
    spacing_m : (n,) float64
        Between points of the row there, as pulses come, lost ones counted.
    steepness : (n,) float64
        How far the beam came down per metre in plan: so deep it goes into a hole of a metre.
    pattern : (n,) uint8
        Bits ``OPENING``, ``DENT``, ``LOST``, ``JOINT``.
    strength : (n,) float64
        0 … 1: how sure it is that the surface is open here; joints are weak, deep holes near 1.
    row : (n,) int64
        Revolution of the drive (`Revolutions`).
    point : (n,) int64
        Point of the drive last measured before the opening.
    station_m, across_m : (n,) float64
        Along the vehicle's path (the trajectory, smoothed), and to its right.
    pass_number : (n,) int64
        Of the pass: stations are one axis within each.
    direction : (n, 2) float64
        Unit vector in plan along which the row crosses the surface.
    area_m2 : (n,) float64
        Of road that the opening stands for: its width by how far rows lie apart there. A slow or
        waiting vehicle measures more notches, but no more area.
    raised_m : (n,) float64
        How far it lies above the road below the vehicle, beside it.
    """

    xyz: NDArray[np.float64]
    time_s: NDArray[np.float64]
    depth_m: NDArray[np.float64]
    width_m: NDArray[np.float64]
    spacing_m: NDArray[np.float64]
    steepness: NDArray[np.float64]
    pattern: NDArray[np.uint8]
    strength: NDArray[np.float64]
    row: NDArray[np.int64]
    point: NDArray[np.int64]
    station_m: NDArray[np.float64]
    across_m: NDArray[np.float64]
    pass_number: NDArray[np.int64]
    direction: NDArray[np.float64]
    area_m2: NDArray[np.float64]
    raised_m: NDArray[np.float64]

    @property
    def count(self) -> int:
        """How many there are."""
        return len(self.time_s)

    def higher_m(self, which: NDArray[np.bool_]) -> NDArray[np.float64]:
        """How far some lie above what roads and walks rise to their sides, m; 0 below."""
        rise = _WALK_M + _RISE * np.abs(self.across_m[which])
        return np.asarray(np.maximum(self.raised_m[which] - rise, 0.0))

    def chosen(self, which: NDArray[np.bool_] | NDArray[np.int64]) -> Notches:
        """Some of them."""
        return Notches(**{field.name: getattr(self, field.name)[which] for field in fields(self)})


def join_notches(parts: list[Notches]) -> Notches:
    """Notches of several blocks, one after another."""
    if not parts:
        empty = np.empty(0)
        none = np.empty(0, np.int64)
        return Notches(
            np.empty((0, 3)),
            time_s=empty,
            depth_m=empty,
            width_m=empty,
            spacing_m=empty,
            steepness=empty,
            pattern=np.empty(0, np.uint8),
            strength=empty,
            row=none,
            point=none,
            station_m=empty,
            across_m=empty,
            pass_number=none,
            direction=np.empty((0, 2)),
            area_m2=empty,
            raised_m=empty,
        )
    names = Notches.__dataclass_fields__
    return Notches(**{name: np.concatenate([getattr(p, name) for p in parts]) for name in names})
