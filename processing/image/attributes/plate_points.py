"""What a drive measured on a flat plate: its points' colours, and a picture painted of them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from processing.core.arrays import Floats, Integers
from processing.image.attributes.attributes import colours
from processing.recording.drive import Drive

_MARGIN = 0.15
"""Of a plate's larger side, shown around it."""

_OFF_M = 0.04
"""Points so far off the plate's plane are on it: it bends, and ranges are noisy."""

_HIGH_PX = 96
"""Of a picture: a plate has some ten to fifty scan lines."""

_GAP = 2.5
"""Of the middle distance of neighbouring points: what lies farther from any is not painted."""

_FEWEST = 12
_MORE_TURNS = 4
"""Of the scanner before and behind those that met the plate."""

_AROUND = 100_000
"""Points before and behind that are looked through where a drive has no turns."""

_MOST_AROUND = 1_000_000
"""Of the same, of any drive: some tens of milliseconds to read."""

_ENDS = (2.0, 98.0)
"""Percentiles at the dark and the bright end."""

_EVERY = 7
"""Points of which one is looked at for how bright things are."""

_NOTHING = (60, 64, 70)
"""Where nothing was measured."""


@dataclass(frozen=True)
class PlatePlace:
    """A plate in space.

    Attributes
    ----------
    centre : (3,) float64
        m, project CRS.
    facing_deg, tilt_deg : float
        Where its face looks, clockwise from north, and up.
    wide_m, high_m : float
    turns : int
        Of the scanner, that met it.
    """

    centre: Floats
    facing_deg: float
    tilt_deg: float
    wide_m: float
    high_m: float
    turns: int

    @property
    def axes(self) -> Floats:
        """(3, 3) unit vectors: to the right as one who looks at the face sees it, up, outwards."""
        facing, tilt = math.radians(self.facing_deg), math.radians(self.tilt_deg)
        look = np.array(
            [
                math.sin(facing) * math.cos(tilt),
                math.cos(facing) * math.cos(tilt),
                math.sin(tilt),
            ]
        )
        right = np.array([-math.cos(facing), math.sin(facing), 0.0])
        return np.stack([right, np.cross(look, right), look])


def has_colours(drive: Drive) -> bool:
    """Whether the points have colours of their own, delivered or seen by images."""
    has = drive.columns.has
    return has("color") or (has("seen_color") and has("is_seen"))


def colours_on(drive: Drive, point: int, plate: PlatePlace) -> NDArray[np.uint8]:
    """(n, 3) red, green, blue of the points on a plate of a drive whose points have colours.

    Parameters
    ----------
    point : int
        Of the drive, on the plate.
    """
    numbers, flat = _points_about(drive, point, plate)
    half = np.array([plate.wide_m, plate.high_m]) / 2
    on = numbers[(np.abs(flat) <= half).all(axis=1)]
    if not drive.columns.has("color"):
        on = on[drive.columns["is_seen"][on] > 0]
    return colours(drive, on, "color", *_ENDS)


def picture_of(drive: Drive, point: int, plate: PlatePlace) -> NDArray[np.uint8] | None:
    """(h, w, 3) red, green, blue: the points of a plate as somebody before it sees them.

    By their colours where they have some, otherwise by intensity, dark where they are as dull as
    what is about the plate; None where too few were measured.
    """
    numbers, flat = _points_about(drive, point, plate)
    if numbers.size < _FEWEST:
        return None
    pixels = _pixels_about(plate)
    tree = cKDTree(flat)
    # The second nearest: the nearest is the point itself.
    apart = float(np.median(np.asarray(tree.query(flat, k=2)[0])[:, 1]))
    between_lines = max(plate.wide_m, plate.high_m) / max(plate.turns, 1)
    reach = _GAP * max(apart, between_lines / 2)
    nearest = np.asarray(tree.query(pixels, distance_upper_bound=reach)[1])
    picture = np.empty((*nearest.shape, 3), np.uint8)
    picture[:] = _NOTHING
    is_near = nearest < len(flat)
    picture[is_near] = _shown(drive, numbers)[nearest[is_near]]
    return picture


def _pixels_about(plate: PlatePlace) -> Floats:
    """(h, w, 2) middles of a picture's pixels, right and up of the plate's centre, m."""
    margin = _MARGIN * max(plate.wide_m, plate.high_m)
    wide, high = plate.wide_m / 2 + margin, plate.high_m / 2 + margin
    step = 2 * high / _HIGH_PX
    across = np.arange(-wide + step / 2, wide, step)
    down = np.arange(high - step / 2, -high, -step)
    return np.stack(np.meshgrid(across, down), axis=-1)


def _shown(drive: Drive, numbers: Integers) -> NDArray[np.uint8]:
    if has_colours(drive):
        return colours(drive, numbers, "color", *_ENDS)
    values = drive.columns["intensity"][numbers].astype(np.float64)
    # Of a bare bright plate all points are alike: dark is what other things about it look like.
    around = slice(int(numbers.min()), int(numbers.max()) + 1, _EVERY)
    dull, high = np.percentile(values, _ENDS)
    low = min(float(np.median(drive.columns["intensity"][around])), float(dull))
    grey = 255 * np.clip((values - low) / max(high - low, 1.0), 0.0, 1.0)
    return np.repeat(grey.astype(np.uint8)[:, None], 3, axis=1)


def _points_about(drive: Drive, point: int, plate: PlatePlace) -> tuple[Integers, Floats]:
    """Points in a plate's plane with its surroundings, and their places right and up on it."""
    turn = drive.revolutions.pulses_per_revolution if drive.revolutions else 0.0
    around = math.ceil((plate.turns + _MORE_TURNS) * turn) or _AROUND
    around = min(around, _MOST_AROUND)
    first = max(0, point - around)
    xyz = drive.xyz(slice(first, min(drive.count, point + around)))
    along = (xyz - plate.centre) @ plate.axes.T
    margin = _MARGIN * max(plate.wide_m, plate.high_m)
    half = np.array([plate.wide_m / 2 + margin, plate.high_m / 2 + margin, _OFF_M])
    near = np.flatnonzero((np.abs(along) <= half).all(axis=1))
    return near + first, along[near, :2]
