"""Plates in space: outlines that were fitted on planes, with which way they face and how sure."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.methods.road.signs.fit_kernels import (
    ALONG_U,
    ALONG_V,
    LONG,
    OPEN_END,
    OPEN_START,
    SIGMA_M,
    U,
    V,
)
from processing.methods.road.signs.piece_kernels import (
    BEFORE,
    BEHIND,
    COUNT,
    FREE,
    HIDDEN,
    NOISE,
    STEP,
)
from processing.methods.road.signs.plate_fit import Fit, FittedPlate, hangs_below, is_board_below
from processing.methods.road.signs.plate_groups import PlateGroup, group_of
from processing.methods.road.signs.plate_sides import sides_of
from processing.methods.road.signs.scan_pieces import ScanPieces
from processing.methods.road.signs.sign_shapes import SignShape, centroid_of, outline_of

_SECTORS = 12
"""Of a plate's rim, 30 degrees each."""

_FEWEST_ENDS = 3
"""Of lines at an edge, that say whether it is thick."""

_INSIDE_M = 0.03
"""How far beyond an outline the middle of a piece on it may lie."""


class PlateEvidence(NamedTuple):
    """What is known of a plate beside its outline.

    Attributes
    ----------
    bright : float
        Share of its points that shine, on the side where more do.
    cost : float
        Mean of what the ends of its lines say against it, 0 to 9.
    explained : float
        Share of what lay in its plane that plates explain.
    open_ends : int
        Where its rim was seen.
    sectors : float
        Share of the directions about its middle in which its rim was seen.
    turns : int
        Scan lines that met it.
    points : int
    noise_m : float
        How far its points lie off it.
    roll_rad : float
    tilt : float
        Sine of the angle by which it looks up or down.
    front_seen : bool
        Whether a scanner saw the side that is taken for the face.
    is_facing_sure : bool
        Whether what was measured tells the face from the back.
    thick : float
        By how much more of the scan lines go on at one of two opposite edges than at the other, 0
        to 1: they cross over to the side of a thick board or a box, or to a roof.
    both_seen : bool
        Whether both sides were seen.
    shine : float
        How bright the brighter side is that was seen, in standard deviations above the middle of
        diffuse things; NaN where nothing of a recording shines.
    cut : float
        Share of its points of drives that begin or end on it: it may go on where nothing was
        measured.
    over_board : bool
        Whether a board that is higher than it hangs right below it, as at bus stops.
    faint : float
        Of what shines, how far it stays below the brightest faces of the survey, 0 to 1.
    """

    bright: float
    cost: float
    explained: float
    open_ends: int
    sectors: float
    turns: int
    points: int
    noise_m: float
    roll_rad: float
    tilt: float
    front_seen: bool
    is_facing_sure: bool
    thick: float
    both_seen: bool
    shine: float
    cut: float
    over_board: bool
    faint: float


@dataclass(frozen=True)
class Plate:
    """A plate of a survey.

    Attributes
    ----------
    shape : SignShape
    centre : (3,) float64
        Of its area, m about the origin of the plan.
    outline : (n, 3) float64
        Corners, m about the origin of the plan.
    normal : (3,) float64
        Where its face looks.
    evidence : PlateEvidence
    upper : int
        Number of the plate that it hangs below as its supplement, among those of its plane; −1:
        none.
    pieces : (k,) int64
        Of scan lines on it.
    """

    shape: SignShape
    centre: Floats
    outline: Floats
    normal: Floats
    evidence: PlateEvidence
    upper: int
    pieces: Integers


def plates_of(pieces: ScanPieces, group: PlateGroup, lines: Floats, fit: Fit) -> list[Plate]:
    """The plates of a plane.

    Parameters
    ----------
    lines : (k, LINE) float64
        Of the group's pieces, in their order.
    """
    found = []
    for one in fit.plates:
        on = _inside(one, lines)
        if not on.any():
            continue
        upper = next((n for n, other in enumerate(fit.plates) if hangs_below(one, other)), -1)
        found.append(_plate(pieces, group, one, np.flatnonzero(on), (lines, fit, upper)))
    return found


def plate_alone(
    pieces: ScanPieces, group: PlateGroup, lines: Floats, fitted: FittedPlate, explained: float
) -> Plate | None:
    """A plate of a plane, a share of which is explained; None: no line lies on it."""
    on = _inside(fitted, lines)
    if not on.any():
        return None
    alone = Fit((fitted,), 1.0 - explained, 1.0)
    return _plate(pieces, group, fitted, np.flatnonzero(on), (lines, alone, -1))


def _inside(plate: FittedPlate, lines: Floats) -> Floats:
    """(k,) bool: lines that cross an outline's middle part or have their own middle in it."""
    middles = lines[:, [U, V]] + lines[:, [LONG]] / 2 * lines[:, [ALONG_U, ALONG_V]]
    flat = _turned(middles - plate.pose[:2], -plate.pose[2])
    half = np.array([plate.shape.wide_m, plate.shape.high_m]) / 2 + _INSIDE_M
    return np.asarray((np.abs(flat) <= half).all(axis=1))


def _turned(flat: Floats, by_rad: float) -> Floats:
    c, s = np.cos(by_rad), np.sin(by_rad)
    return np.column_stack([c * flat[:, 0] - s * flat[:, 1], s * flat[:, 0] + c * flat[:, 1]])


def _plate(
    pieces: ScanPieces,
    group: PlateGroup,
    fitted: FittedPlate,
    on: Integers,
    context: tuple[Floats, Fit, int],
) -> Plate:
    lines, fit, upper = context
    members = group.pieces[on]
    own = group_of(pieces.values, members) if on.size > 1 else None
    normal, noise = group.normal, group.noise_m
    corners = outline_of(fitted.shape)
    if len(corners) == 1:
        turn = np.linspace(0.0, 2 * np.pi, 24, endpoint=False)
        corners = corners[0, 0] * np.column_stack([np.cos(turn), np.sin(turn)])
    flat = np.vstack([centroid_of(fitted.shape)[None], corners])
    xyz = group.xyz(_turned(flat, fitted.pose[2]) + fitted.pose[:2])
    if own is not None and abs(own.normal @ group.normal) > np.cos(np.radians(20.0)):
        # The plane of its own points: the group's holds those of its post, too.
        noise, sign = own.noise_m, np.sign(own.normal @ group.normal)
        depth = (own.middle - xyz) @ own.normal / (group.normal @ own.normal)
        xyz, normal = xyz + depth[:, None] * group.normal, sign * own.normal
    sides = sides_of(pieces, members, normal)
    open_ends, sectors = _rim(fitted, lines[on])
    rows = pieces.drive[members] * (pieces.row.max() + 1) + pieces.row[members]
    evidence = PlateEvidence(
        bright=sides.bright,
        cost=fitted.cost / max(1, fitted.ends),
        explained=1.0 - fit.cost / max(fit.nothing, 1e-9),
        open_ends=open_ends,
        sectors=sectors,
        turns=int(np.unique(rows).size),
        points=int(pieces.values[members, COUNT].sum()),
        noise_m=max(noise, float(np.median(pieces.values[members, NOISE]))),
        roll_rad=float(fitted.pose[2]),
        tilt=float(sides.facing[2]),
        front_seen=sides.front_seen,
        is_facing_sure=sides.is_sure,
        thick=_thick(fitted, lines[on], pieces.values[members]),
        both_seen=sides.both_seen,
        shine=sides.shine,
        cut=_cut(pieces, members),
        over_board=any(is_board_below(one, fitted) for one in fit.plates),
        faint=sides.faint,
    )
    return Plate(fitted.shape, xyz[0], xyz[1:], sides.facing, evidence, upper, members)


def _thick(fitted: FittedPlate, lines: Floats, values: Floats) -> float:
    """How differently lines end at the left and the right edge of a plate, or at its other two.

    Other plates of its post lie above or below it: there only what lies farther behind counts.
    """
    ends = []
    for column, along in ((BEFORE, 0.0), (BEHIND, 1.0)):
        places = lines[:, [U, V]] + along * lines[:, [LONG]] * lines[:, [ALONG_U, ALONG_V]]
        ends.append(np.column_stack([places, values[:, column]]))
    every = np.concatenate(ends)
    flat = _turned(every[:, :2] - fitted.pose[:2], -fitted.pose[2])
    halves = fitted.shape.wide_m / 2, fitted.shape.high_m / 2
    goes_on = every[:, 2] != FREE, every[:, 2] == STEP
    is_seen = every[:, 2] != HIDDEN
    most = 0.0
    for axis in range(2):
        shares = []
        for side in (-1.0, 1.0):
            near = np.abs(side * flat[:, axis] - halves[axis]) <= 3 * SIGMA_M + 0.03
            if np.count_nonzero(near & is_seen) >= _FEWEST_ENDS:
                shares.append(float(goes_on[axis][near & is_seen].mean()))
        if len(shares) == 2:
            most = max(most, abs(shares[0] - shares[1]))
    return most


def _cut(pieces: ScanPieces, members: Integers) -> float:
    """Share of the points on a plate that are of drives that begin or end on it."""
    ending = np.unique(pieces.drive[members[pieces.at_end[members]]])
    counts = pieces.values[members, COUNT]
    return float(counts[np.isin(pieces.drive[members], ending)].sum() / counts.sum())


def _rim(fitted: FittedPlate, lines: Floats) -> tuple[int, float]:
    """How many open ends lie on a plate's rim, and in which share of directions."""
    ends = []
    for column, along in ((OPEN_START, 0.0), (OPEN_END, 1.0)):
        is_open = lines[:, column] > 0
        places = lines[:, [U, V]] + along * lines[:, [LONG]] * lines[:, [ALONG_U, ALONG_V]]
        ends.append(places[is_open])
    flat = _turned(np.concatenate(ends) - fitted.pose[:2], -fitted.pose[2])
    half = np.array([fitted.shape.wide_m, fitted.shape.high_m]) / 2
    near = flat[(np.abs(flat) <= half + 3 * SIGMA_M).all(axis=1)]
    turn = np.arctan2(near[:, 1] / half[1], near[:, 0] / half[0])
    sectors = np.unique(np.floor((turn / (2 * np.pi) + 0.5) * _SECTORS).clip(0, _SECTORS - 1))
    return len(near), sectors.size / _SECTORS
