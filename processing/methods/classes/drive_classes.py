"""The classes of a whole drive, a part of space at a time.

1. Points are taken together in cells of 10 cm and described by what lies around them at several
   sizes (:mod:`processing.methods.classes.features`).
2. Boosted trees say how likely each class is for a cell.
3. Trees that see this of the cells around as well say it again: what hangs together is one thing.
   Averaged trees say it too; the two err differently in a world that neither learnt from.
4. What tools found along the street tells its points, and makes others of its class less likely
   (:mod:`processing.methods.classes.found_things`).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel
from processing.core.monitor import Monitor, PartMonitor
from processing.methods.classes.class_models import ClassModels
from processing.methods.classes.class_trees import class_shares
from processing.methods.classes.features import CELL_M, REACH, ClassCells, class_cells
from processing.methods.classes.found_things import (
    CURB,
    POLE_LIKE,
    ROAD,
    SIGN,
    FoundThings,
    NearThings,
    ToldPoints,
)
from processing.methods.noise.tiles_of_space import TiledCloud
from processing.methods.road.objects.ground_heights import GROUND_CELLS
from processing.methods.road.objects.sparse_plan import SparsePlan, cell_of
from processing.methods.road.objects.survey import survey_ground
from processing.recording.columns.counted_classes import class_columns
from processing.recording.drive import Drive

_NOTHING = FoundThings()

_TILE_M = 4.0
"""Side of a tile: about as wide as what is looked at around a point."""

_POINTS_PER_PART = 1_000_000
"""Points in memory at a time, with those around: some 700 MB."""

_GROUND, _SORTED = 0.05, 0.15
"""Of the progress: when the ground is known, and when points lie in tiles."""

_ON_GROUND_M = 0.3
"""Height up to which points tell how bright the ground is: curbs and grass count."""

_SAMPLE = 100_000
"""Points that the ground's brightness is taken from."""

_TRUE = {SIGN: 0.99, POLE_LIKE: 0.92, CURB: 0.98, ROAD: 0.91}
"""Share of the points on found things of confidence 1 that are of their class: measured, as what
follows, on the streets 3100–3103 (3130, 3140 and 3141: by worn heads and any mounting) of the own
simulator, by ``python -m processing.laboratory.class_training --score-only``; of points before
curbs, of which all others are ground, on 3100, 3101, 3130 and 3141."""

_OTHER, _OTHER_WEIGHT = 1, 0.25
"""What is none of the classes looks otherwise in every town: a likeness to what was learnt counts a
quarter. With models that knew no single scans yet, mean F rose by 0.006 by it on those streets,
and F of “other” itself on six of seven."""

_MISSED = {SIGN: 0.11, POLE_LIKE: 0.24, CURB: 0.21}
"""Share of a class's points that are on no found thing though it was looked for."""

_OFF_ROAD = 0.999
"""Share of the points behind curbs of confidence 1 that are not of the road: measured as is told in
`points_on_curbs`."""

_SURE = 0.9
"""Where the first trees are so sure of a cell, and in the mean of those within 0.6 m, the second
aren't asked: half of the cells; 0.3 to 0.6 % of the sample streets' would be of another class."""

_MOST_STEPS = 6.0
"""Doublings of the intensity that are told apart: a retro-reflector is some 2⁵ times as bright."""


@dataclass(frozen=True)
class DriveSurroundings:
    """What is known of a drive as a whole before its points are looked at.

    Attributes
    ----------
    drive : Drive
    plan : SparsePlan
    ground : (…,) float32
        m about the plan's origin, by the plan's cells.
    ground_intensity : float
        Median of the points on the ground.
    """

    drive: Drive
    plan: SparsePlan
    ground: NDArray[np.float32]
    ground_intensity: float

    @classmethod
    def of(cls, drive: Drive, monitor: Monitor) -> DriveSurroundings:
        """Find the ground of a drive and how bright it is."""
        plan, cells = survey_ground([drive], monitor)
        ground = cells.reshape(-1)
        bare = cls(drive, plan, ground, 0.0)
        points = np.arange(0, drive.count, max(1, drive.count // _SAMPLE))
        heights = bare.heights_of(drive.xyz(points) - plan.origin)
        intensity = np.asarray(drive.columns["intensity"][points], np.float64)
        on_ground = np.abs(heights) < _ON_GROUND_M
        known = intensity[on_ground] if on_ground.any() else intensity
        return cls(drive, plan, ground, float(np.median(known)) if known.size else 0.0)

    def heights_of(self, local: Floats) -> Floats:
        """(n,) m above the ground; 0 where none is known near by."""
        heights = np.empty(len(local))
        heights_kernel(np.ascontiguousarray(local), self.plan.table, self.ground, heights)
        return heights

    def cells_of(
        self, local: Floats, intensity: NDArray[np.uint16], monitor: Monitor
    ) -> ClassCells:
        """Cells of some points with their features; ``local`` m about the plan's origin."""
        bright = (intensity.astype(np.float32) + 1) / np.float32(self.ground_intensity + 1)
        steps = np.clip(np.log2(bright), -_MOST_STEPS, _MOST_STEPS)
        return class_cells(local, self.heights_of(local), steps, monitor)


@dataclass(frozen=True)
class FoundClasses:
    """What each point is likely to be.

    Attributes
    ----------
    codes : (n,) uint8
        0 where nothing was asked.
    confidence : (n,) float32
        The share of its like that are of this class, 0 to 1.
    """

    codes: NDArray[np.uint8]
    confidence: NDArray[np.float32]


@dataclass(frozen=True)
class PartCells:
    """The cells of a part of a drive, with what is around it.

    Attributes
    ----------
    points : (n,) int64
        Those that the cells are of: first some of the part's own, then some around.
    own : int
        How many of them are the part's own.
    xyz : (n, 3) float64
        m, project CRS.
    cells : ClassCells
    """

    points: Integers
    own: int
    xyz: Floats
    cells: ClassCells


def classify_drive(
    drive: Drive,
    codes: NDArray[np.uint8],
    confidence: NDArray[np.float32],
    scratch: Path,
    monitor: Monitor,
    *,
    models: ClassModels,
    things: FoundThings = _NOTHING,
) -> None:
    """Find the class of every point that isn't known to be noise.

    Parameters
    ----------
    codes : (n,) uint8
        Zero; gets the classes.
    confidence : (n,) float32
        Zero; gets how sure they are.
    scratch : Path
        A folder for files meanwhile; the caller deletes it.
    models : ClassModels
        What says how likely each class is.
    things : FoundThings
        What was found along the street.

    Raises
    ------
    NoSpace, Cancelled
    """
    near = NearThings(things)
    for one in cells_of_drive(drive, scratch, monitor, most=_POINTS_PER_PART):
        told = near.told(one.xyz[: one.own])
        found = classes_of_cells(one.cells, models, told, things.sought, monitor)
        asked = one.points[: one.own]
        codes[asked] = found.codes[: one.own]
        confidence[asked] = found.confidence[: one.own]


def cells_of_drive(
    drive: Drive,
    scratch: Path,
    monitor: Monitor,
    *,
    most: int,
    wanted: NDArray[np.bool_] | None = None,
) -> Iterator[PartCells]:
    """The cells of a drive, a part of space at a time; noise is in none.

    Parameters
    ----------
    scratch : Path
        A folder for files meanwhile; the caller deletes it.
    most : int
        Points of a part, with those around it.
    wanted : (n,) bool, optional
        Parts without such points are left out.

    Raises
    ------
    NoSpace, Cancelled
    """
    around = DriveSurroundings.of(drive, PartMonitor(monitor, 0.0, _GROUND))
    classes = class_columns(drive.columns)

    def read(points: Integers | slice) -> Floats:
        drive.columns.give_back()
        return drive.xyz(points)

    sorting = PartMonitor(monitor, _GROUND, _SORTED)
    cloud = TiledCloud(read, drive.count, scratch / "order", _TILE_M, monitor=sorting)
    rest, done = PartMonitor(monitor, _SORTED, 1.0), 0
    for part in cloud.parts(REACH * CELL_M, most, wanted):
        rest.check()
        rest.report(done / cloud.count)
        points = np.concatenate([part.own, part.around])
        xyz = drive.xyz(points)
        is_asked = ~classes.are_noise(points) & np.isfinite(xyz).all(axis=1)
        if is_asked.any():
            intensity = np.asarray(drive.columns["intensity"][points[is_asked]])
            asked = xyz[is_asked]
            cells = around.cells_of(asked - around.plan.origin, intensity, rest)
            own = int(np.count_nonzero(is_asked[: part.own.size]))
            yield PartCells(points[is_asked], own, asked, cells)
        done += part.own.size


def classes_of_cells(
    cells: ClassCells,
    models: ClassModels,
    told: ToldPoints,
    sought: frozenset[int],
    monitor: Monitor,
) -> FoundClasses:
    """The classes of the points of cells.

    A thing is there with its confidence, and nearly all points on it are of its class then; else
    its surroundings tell. Points on nothing are of a class that was looked for only where the tool
    missed it (Bayes). Behind a curb, level with its top, none is of the road.

    Parameters
    ----------
    told : ToldPoints
        What things say of the first of the points; the others are on nothing.
    sought : frozenset of int
        The classes that were looked for.
    """
    shares = shares_of_cells(cells, models, monitor)
    codes = models.codes
    # Both were measured by shares that weren't sharpened.
    shares *= np.where(codes == _OTHER, _OTHER_WEIGHT, 1.0) ** models.sharpened
    shares /= shares.sum(axis=1, keepdims=True)
    missed = np.array([_MISSED[code] if code in sought else 1.0 for code in codes.tolist()])
    beside = shares * missed**models.sharpened
    best, share = _likeliest(beside)
    sure = (share / beside.sum(axis=1)).astype(np.float32)
    found = FoundClasses(codes[best][cells.cell_of], sure[cells.cell_of])
    _without_road(found, beside, cells.cell_of, codes, told)
    for code in np.unique(told.codes[told.codes > 0]).tolist():
        own = np.flatnonzero(told.codes == code)
        there = told.chances[own] * _TRUE[code]
        mixed = shares[cells.cell_of[own]] * (1 - there)[:, None]
        mixed[:, codes == code] += there[:, None]
        best, found.confidence[own] = _likeliest(mixed)
        found.codes[own] = codes[best]
    return found


def _likeliest(shares: Floats) -> tuple[Integers, Floats]:
    """(n,) which class has the largest share of each row, and that share."""
    best = shares.argmax(axis=1)
    return best, np.take_along_axis(shares, best[:, None], axis=1)[:, 0]


def _without_road(
    found: FoundClasses,
    shares: Floats,
    cell_of: NDArray[np.int32],
    codes: NDArray[np.uint8],
    told: ToldPoints,
) -> None:
    """Take the road from points behind curbs that were called so; changes what was found."""
    count = told.codes.size
    own = np.flatnonzero((told.off_road > 0) & (found.codes[:count] == ROAD))
    mixed = shares[cell_of[own]]
    mixed[:, codes == ROAD] *= (1 - told.off_road[own] * _OFF_ROAD)[:, None]
    best, share = _likeliest(mixed)
    found.codes[own] = codes[best]
    found.confidence[own] = share / mixed.sum(axis=1)


def rows_seen_again(
    cells: ClassCells, models: ClassModels, monitor: Monitor
) -> NDArray[np.float32]:
    """(c, columns of the models) what is known of cells before the second trees are asked.

    Features, what the first trees said of a cell and around, and the smoothed word of averaged
    trees where there are such.
    """
    shares, averaged = class_shares(models.alone, cells.rows, monitor), None
    if models.averaged is not None:
        averaged = class_shares(models.averaged, cells.rows, monitor)
    return cells.with_neighbours(shares, monitor, averaged=averaged)


def shares_of_cells(
    cells: ClassCells, models: ClassModels, monitor: Monitor
) -> NDArray[np.float32]:
    """(c, k) how likely each class of the second trees is in each cell.

    Where the first trees are sure, and say the same around, theirs count in place of the second; of
    a project's own trees all cells are asked, since they may have been taught otherwise.
    """
    rows = rows_seen_again(cells, models, monitor)
    return shares_of_rows(rows, cells.rows.shape[1], models, monitor)


def shares_of_rows(
    rows: NDArray[np.float32], features: int, models: ClassModels, monitor: Monitor
) -> NDArray[np.float32]:
    """(c, k) as :func:`shares_of_cells`, of rows as :func:`rows_seen_again` gives them.

    Parameters
    ----------
    features : int
        Columns before what the first trees said.
    """
    if models.is_own or not np.array_equal(models.alone.codes, models.again.codes):
        return models.say_again(rows, monitor)
    classes = models.alone.codes.size
    shares, near = rows[:, features : features + classes], rows[:, features + classes :]
    best = shares.argmax(axis=1)[:, None]
    is_sure = np.take_along_axis(shares, best, axis=1)[:, 0] > _SURE
    is_sure &= np.take_along_axis(near, best, axis=1)[:, 0] > _SURE
    asked = np.flatnonzero(~is_sure)
    shares = models.with_averaged(shares, rows)
    shares[asked] = models.say_again(rows[asked], monitor)
    return shares


@kernel
def heights_kernel(
    local: Floats, table: NDArray[np.int32], ground: NDArray[np.float32], heights: Floats
) -> None:
    """Heights of points above the ground of their cells."""
    for point in range(len(local)):
        cell = cell_of(local[point, 0], local[point, 1], table, GROUND_CELLS)
        height = local[point, 2] - ground[cell] if cell >= 0 else np.nan
        heights[point] = height if np.isfinite(height) else 0.0


def warm_up() -> None:
    """Compile the kernel."""
    table, ground = np.zeros((1, 1), np.int32), np.zeros(GROUND_CELLS**2, np.float32)
    heights_kernel(np.zeros((1, 3)), table, ground, np.empty(1))
