"""What signs hang on: one post, two, an arm or a gantry over the road, or another thing."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
from scipy.ndimage import label as label_cells
from scipy.spatial import cKDTree

from processing.core.arrays import Floats
from processing.core.monitor import Monitor
from processing.core.worked_ahead import in_order
from processing.methods.road.objects.column_points import points_about
from processing.methods.road.objects.sparse_plan import SparsePlan
from processing.methods.road.signs.plates import Plate
from processing.recording.drive import Drive

PostForm = Literal["single", "double", "cantilever", "gantry", "attached"]
"""As the ledger of signs names them (catalogue: ``post``)."""

_REACH_M = 3.0
"""About a plate's centre in plan: half of the widest plate, and beams that hold it beyond."""

_ONE_POST_M = 0.8
"""Between middles of plates that hang on one post, in plan."""

_CELL_M, _SLAB_M = 0.08, 0.25
"""Posts are sought in cells about as wide as they are (60 to 90 mm), by the share of slabs of the
height in which they were met."""

_FOOT_M = 0.4
"""Above the ground, below which grass and kerbs stand beside posts."""

_FEWEST_SLABS, _LEAST_SHARE = 3, 0.5
_WIDEST_POST_M = 0.5
"""Across: a utility pole is up to 40 cm thick; what is wider is a wall or a hedge."""

_ASIDE_M, _BEFORE_M, _BEHIND_M = 0.4, 0.2, 0.6
"""Beside a plate's edges, before and behind its plane: where its posts stand."""

_ABOVE_M = (0.3, 1.5)
"""Over the highest plate: posts of signs end within some 10 cm of it, poles and walls go on."""

_OVER_ROAD_M, _HIGHEST_M, _SMALL_M = 4.0, 7.5, 0.5
"""Lower edges from here on hang over the carriageway (5 m of clearance, 道路標識設置基準 2-2) up
to here; plates of the small scales don't (標識令, 縮小率). Leaves of crowns are smaller or hang
higher."""

_BEAM_M = (0.15, 1.2)
_FEWEST_ON_BEAM = 4
"""Beside the edges of a plate over the road, where the beam that holds it goes on; points there."""

_SQUARE_M, _MOST_FILLED = 0.15, 0.5
"""Share of the squares beside a plate in which beams and their post were met, at most; walls fill
all."""


def posts_of(
    drives: Sequence[Drive], plan: SparsePlan, plates: Sequence[tuple[Plate, float]],
    monitor: Monitor,
) -> list[PostForm | None]:  # fmt: skip
    """What each plate hangs on; None where nothing that holds it was measured.

    Parameters
    ----------
    plates : sequence of (Plate, float)
        With the height of the ground below each, m about the origin of the plan.
    """
    if not plates:
        return []
    centres = np.array([plate.centre for plate, _ in plates])
    tree = cKDTree(centres[:, :2])
    near = tree.query_ball_point(centres[:, :2], _ONE_POST_M)
    gathered = points_about(drives, plan, centres[:, :2].copy(), _REACH_M, monitor)

    def of_plate(number: int) -> PostForm | None:
        monitor.check()
        plate, ground = plates[number]
        # A point is of the nearest plate alone: those of plates near by hold what this one lacks.
        owners = tree.query_ball_point(centres[number, :2], 2 * _REACH_M)
        local = np.concatenate([gathered.local[gathered.of(one)] for one in owners])
        outlines = [plates[one][0].outline[:, 2] for one in near[number]]
        span = np.array([min(map(np.min, outlines)), max(map(np.max, outlines))]) - ground
        return _form_of(plate, _in_frame(plate, local, ground), span)

    return list(in_order(of_plate, range(len(plates))))


def _in_frame(plate: Plate, local: Floats, ground_m: float) -> Floats:
    """(n, 3) right of a plate's centre, behind its plane, above the ground, m."""
    look = plate.normal[:2] / max(float(np.hypot(*plate.normal[:2])), 1e-9)
    flat = local[:, :2] - plate.centre[:2]
    return np.column_stack([flat @ [-look[1], look[0]], -(flat @ look), local[:, 2] - ground_m])


def _form_of(plate: Plate, about: Floats, span: Floats) -> PostForm | None:
    """What one plate hangs on.

    Parameters
    ----------
    about : (n, 3)
        Right of the centre, behind the plane, above the ground, m.
    span : (2,)
        Lowest and highest edge of the plates on its post, above the ground, m.
    """
    half = plate.shape.wide_m / 2
    is_behind = (about[:, 1] >= -_BEFORE_M) & (about[:, 1] <= _BEHIND_M)
    behind = about[is_behind & (np.abs(about[:, 0]) <= half + _ASIDE_M)]
    posts = _upright_things(behind, _FOOT_M, float(span[0]) - 0.05)
    if posts:
        goes_on = any(_goes_on(behind, one, float(span[1])) for one in posts)
        if goes_on or any(np.ptp(one[:, 0]) > _WIDEST_POST_M for one in posts):
            return "attached"
        return "single" if len(posts) == 1 else "double"
    longer = max(plate.shape.wide_m, plate.shape.high_m)
    if not _OVER_ROAD_M <= span[0] <= _HIGHEST_M or longer < _SMALL_M:
        return None
    beam = about[is_behind & (about[:, 2] >= span[0] - 0.2) & (about[:, 2] <= span[1] + 0.3)]
    aside = np.abs(beam[:, 0]) - half
    beam = beam[(aside >= _BEAM_M[0]) & (aside <= _BEAM_M[1])]
    sides = sum(_is_beam(beam[beam[:, 0] * side > 0], span) for side in (-1, 1))
    return (None, "cantilever", "gantry")[sides]


def _is_beam(beside: Floats, span: Floats) -> bool:
    """Whether what lies on one side of a plate holds it and is no wall."""
    squares = np.unique((beside[:, [0, 2]] / _SQUARE_M).astype(np.int64), axis=0)
    every = (_BEAM_M[1] - _BEAM_M[0]) * np.ptp(span) / _SQUARE_M**2
    return bool(len(beside) >= _FEWEST_ON_BEAM and len(squares) <= _MOST_FILLED * every)


def _upright_things(behind: Floats, low_m: float, high_m: float) -> list[Floats]:
    """Cells that are met from low to high, grouped where they touch: (k, 2) each, m."""
    slabs = int((high_m - low_m) / _SLAB_M)
    chosen = behind[(behind[:, 2] > low_m) & (behind[:, 2] < low_m + slabs * _SLAB_M)]
    if slabs < _FEWEST_SLABS or not len(chosen):
        return []
    cells = np.floor(chosen[:, :2] / _CELL_M).astype(np.int64)
    first = cells.min(axis=0) - 1
    size = cells.max(axis=0) - first + 2
    met = np.zeros((*size, slabs), np.bool_)
    levels = ((chosen[:, 2] - low_m) / _SLAB_M).astype(np.int64)
    met[(*(cells - first).T, levels)] = True
    # A thing on the border of cells, or one that leans, is met in either.
    wide = met.copy()
    for axis, step in ((0, 1), (0, -1), (1, 1), (1, -1)):
        wide |= np.roll(met, step, axis=axis)
    is_upright = (wide.mean(axis=2) >= _LEAST_SHARE) & met.any(axis=2)
    groups, count = label_cells(is_upright, np.ones((3, 3), np.int64))
    return [
        (np.argwhere(groups == number) + first + 0.5) * _CELL_M for number in range(1, count + 1)
    ]


def _goes_on(behind: Floats, post: Floats, top_m: float) -> bool:
    """Whether a thing goes on above the plates."""
    low, high = top_m + _ABOVE_M[0], top_m + _ABOVE_M[1]
    above = behind[(behind[:, 2] > low) & (behind[:, 2] < high)]
    middle = post.mean(axis=0)
    reach = np.ptp(post, axis=0).max() / 2 + 2 * _CELL_M
    on = above[np.hypot(*(above[:, :2] - middle).T) <= reach]
    slabs = np.unique(((on[:, 2] - low) / _SLAB_M).astype(np.int64)).size
    return bool(slabs >= _LEAST_SHARE * (high - low) / _SLAB_M)
