"""What stands beside and over a shaft: rails, roofs, crowns; posts of poles stand free.

A fence's post has rails on two opposite sides, a shelter's a roof over it, a trunk a crown. What a
pole carries is narrow: an arm, a plate, a lamp.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from processing.core.arrays import Flags, Floats
from processing.core.kernels import kernel
from processing.methods.road.poles.leaves import LeavesAbout, leaves_about
from processing.methods.road.poles.roofs import roof_share
from processing.methods.road.poles.shaft_kernels import FREE
from processing.methods.road.poles.shafts import Shaft

_RAIL_FROM_M, _RAIL_TO_M, _RAIL_FAR_M = 0.06, 0.6, 0.9
"""How far from a shaft's surface rails, meshes and walls are looked for, and those on one side."""

_PLATE_M, _CLOTH_M = 0.4, 0.65
"""What goes on beside a shaft beyond is longer than half a sign's plate, or, of one as high as
canes are, than the cloth of a banner (60 cm by 180 cm): a rail, a wall."""

_SLAB_M, _SLABS = 0.1, 160

_SECTORS = 8
"""Of 45 degrees about the axis."""

_COVER_M, _CELL_M = 1.25, 0.25
"""How far about the top a roof is looked for, in cells of the plan: an arm fills a tenth of them,
a sign's plate fewer."""

_BELOW_TOP_M, _ABOVE_TOP_M = 0.3, 1.2

_BELOW_TOP_SHARE, _RAILED_SHARE = 0.25, 0.5
"""Of the height of a low shaft: from there on a roof is looked for, and rails; a hedge or a curb
about its foot is neither, rails of fences go to the top."""

_LEAST_CROWN_M = 1.8
"""Lower shafts carry neither crowns nor banners."""

_ROUGH, _LEAST_FREE = 2.5, 0.25
"""Noise over the usual one, and share of free heights, beyond which nobody asks for a crown."""

_OVER_FROM_M, _OVER_TO_M, _OVER_BESIDE_M = 0.15, 1.15, 0.3
"""Between which heights above its top a shaft may go on: a trunk that bends, a person, an edge."""

_BEAM_FROM_M, _BEAM_TO_M, _BEAM_WIDE_M = 0.15, 1.75, 0.12
"""How far from an axis beams of guard rails and pipes of fences lead on, whose posts stand 2 m and
more apart, and how far beside a line through it: a post carries its beam on one face."""

_BEAM_PIECE_M, _BEAM_PIECES, _BEAM_LINES = 0.2, 8, 24
"""Pieces of the way on each side, and directions of such lines, 7.5 degrees apart."""

_ABOVE_GROUND_SLABS, _BEAM_ABOVE_SLABS = 2, 5
"""Below, grass and the ground itself lead on; and how far above what was seen of a post its beam
may lie: the beam of a guard rail is 35 cm high and hides what of the post is behind it."""

RAILS, COVER, OVER = range(3)
"""Share of the heights with something on two opposite sides, or a rail on one; share of the plan
about the top that is filled; share of the metre above the top that is."""


@dataclass(frozen=True)
class Surroundings:
    """What was measured beside and over a shaft.

    Attributes
    ----------
    rails : float
        Share of its heights that have something on two opposite sides, or a rail on one.
    cover : float
        Share of the plan within 1.25 m about its top that something fills.
    over : float
        Share of the metre above its top that something fills near its axis.
    roof : float
        Share of the way to another post's top that something level fills.
    crown : LeavesAbout or None
        What could be a crown; None of low shafts, and of those too rough or hemmed in for a pole.
    alike : float
        As of :func:`processing.methods.road.poles.alike_shafts.alike_of`; 0 of high ones.
    beam : float
        How far something leads on from a low one at one height to both sides, over 1.6 m.
    """

    rails: float
    cover: float
    over: float
    roof: float
    crown: LeavesAbout | None
    alike: float = 0.0
    beam: float = 0.0


def surroundings_of(
    points: Floats, shaft: Shaft, usual_noise_m: float, fellows: Floats
) -> Surroundings:
    """What stands about a shaft.

    Parameters
    ----------
    points : (n, 3) float64
        m about its foot; those that are nearer to no other shaft.
    usual_noise_m : float
        How far points lie off the smooth shafts of this recording.
    fellows : (k, 2) float64
        Other shafts that end as high, m from its top.
    """
    told = np.zeros(3)
    axis = np.array([*shaft.lean, shaft.radius_m, shaft.taper, shaft.low_m, shaft.top_m])
    surroundings_kernel(points, axis, told)
    crown = None
    is_rough = shaft.noise_m > _ROUGH * usual_noise_m or shaft.told[FREE] < _LEAST_FREE
    if shaft.top_m > _LEAST_CROWN_M and len(points) and not is_rough:
        crown = leaves_about(points, shaft)
    roof = roof_share(points, shaft, fellows)
    beam = beam_kernel(points, axis) if shaft.top_m <= _LEAST_CROWN_M else 0.0
    rails, cover, over = told.tolist()
    return Surroundings(rails, cover, over, roof, crown, beam=beam)


@kernel
def surroundings_kernel(points: Floats, axis: Floats, told: Floats) -> None:
    """Fill sectors of heights and cells of the plan, and count them.

    Parameters
    ----------
    axis : (6,) float64
        Lean to the east and north, radius at the foot, taper, low and top.
    """
    beside = np.zeros((_SLABS, _SECTORS), np.bool_)
    beyond = np.zeros((_SLABS, _SECTORS), np.bool_)
    side = 2 * int(_COVER_M / _CELL_M)
    plan = np.zeros((side, side), np.bool_)
    over = np.zeros(10, np.bool_)
    low, top = axis[4], axis[5]
    is_low = top <= _LEAST_CROWN_M
    covered_from = top - min(_BELOW_TOP_M, _BELOW_TOP_SHARE * top)
    plate = _CLOTH_M if top > _LEAST_CROWN_M else _PLATE_M
    for point in range(len(points)):
        up = points[point, 2]
        east, north = points[point, 0] - axis[0] * up, points[point, 1] - axis[1] * up
        off = math.hypot(east, north) - axis[2] + axis[3] * up
        if top + _OVER_FROM_M <= up < top + _OVER_TO_M and off < _OVER_BESIDE_M:
            over[min(int((up - top - _OVER_FROM_M) * over.size), over.size - 1)] = True
        if off < _RAIL_FROM_M:
            continue
        if off < _RAIL_FAR_M and 0.0 <= up < _SLABS * _SLAB_M:
            sector = int((math.atan2(north, east) / math.pi + 1) / 2 * _SECTORS)
            sector = min(sector, _SECTORS - 1)
            beside[int(up / _SLAB_M), sector] |= off < _RAIL_TO_M
            beyond[int(up / _SLAB_M), sector] |= off > plate
        i = math.floor(east / _CELL_M) + side // 2
        j = math.floor(north / _CELL_M) + side // 2
        if 0 <= i < side and 0 <= j < side:
            plan[i, j] |= covered_from <= up <= top + _ABOVE_TOP_M
    seen_from = max(low, _RAILED_SHARE * top) if is_low else low
    first, last = max(int(seen_from / _SLAB_M), 2), min(int(top / _SLAB_M), _SLABS)
    hemmed = 0
    for slab in range(first, last):
        for sector in range(_SECTORS):
            across = sector + _SECTORS // 2
            opposite = (
                beside[slab, across % _SECTORS]
                or beside[slab, (across - 1) % _SECTORS]
                or beside[slab, (across + 1) % _SECTORS]
            )
            # The last post of a fence has rails on one side, longer than half a plate.
            if beside[slab, sector] and (opposite or beyond[slab, sector]):
                hemmed += 1
                break
    told[RAILS] = hemmed / max(last - first, 1)
    told[COVER] = plan.sum() / (side * side)
    told[OVER] = over.sum() / over.size


@kernel
def beam_kernel(points: Floats, axis: Floats) -> float:
    """Fill pieces of lines through a low shaft, slab by slab; the longest way on of 1.6 m, 0 to 1.

    Parameters
    ----------
    axis : (6,) float64
        As of `surroundings_kernel`.
    """
    last = min(int(axis[5] / _SLAB_M) + _BEAM_ABOVE_SLABS, _SLABS - 1)
    turns = np.arange(_BEAM_LINES) * (math.pi / _BEAM_LINES)
    east_way, north_way = np.cos(turns), np.sin(turns)
    filled = np.zeros((_BEAM_LINES, last + 2, 2, _BEAM_PIECES), np.bool_)
    for point in range(len(points)):
        up = points[point, 2]
        slab = math.floor(up / _SLAB_M)
        east, north = points[point, 0] - axis[0] * up, points[point, 1] - axis[1] * up
        away = east * east + north * north
        if not _ABOVE_GROUND_SLABS <= slab <= last or away > _BEAM_TO_M**2 + _BEAM_WIDE_M**2:
            continue
        for line in range(_BEAM_LINES):
            across = north * east_way[line] - east * north_way[line]
            along = east * east_way[line] + north * north_way[line]
            piece = math.floor((abs(along) - _BEAM_FROM_M) / _BEAM_PIECE_M)
            if abs(across) < _BEAM_WIDE_M and 0 <= piece < _BEAM_PIECES:
                filled[line, slab, int(along > 0), piece] = True
    best = 0
    for line in range(_BEAM_LINES):
        for slab in range(_ABOVE_GROUND_SLABS, last + 1):
            # A pipe may lie in two slabs, and slope as the street does.
            both = filled[line, slab] | filled[line, slab + 1]
            best = max(best, min(_run(both[0]), _run(both[1])))
    return best / _BEAM_PIECES


@kernel
def _run(filled: Flags) -> int:
    """How many are filled before the first that isn't, but for one hidden by the post itself."""
    count = 0
    for piece in range(filled.size):
        if not filled[piece] and piece > 0:
            break
        count += filled[piece]
    return count
