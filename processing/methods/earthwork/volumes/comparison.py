"""Volumes between two sides: what lies between them, within what, and how surely."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely
from numpy.typing import NDArray

from processing.core.monitor import Monitor, parts_of
from processing.core.text import Text
from processing.methods.earthwork.geometry.boundary import inside_shares
from processing.methods.earthwork.geometry.volume_scope import EVERYWHERE, VolumeScope
from processing.methods.earthwork.maps.change_grid import ChangeGrid
from processing.methods.earthwork.surfaces.ground_cells import GroundCells, grid_over, ground_cells
from processing.methods.earthwork.surfaces.joined_dates import (
    JoinedDates,
    join_dates,
    reached_ground,
    shown_by_others,
)
from processing.methods.earthwork.surfaces.sides import EpochGround, Side
from processing.methods.earthwork.surfaces.stray_islands import (
    contradicted,
    loose_islands,
)
from processing.methods.earthwork.surfaces.surfaces import (
    EpochContext,
    SideHeights,
    cells_of_hole,
    coarse_means,
    designed_surface,
    measured_surface,
)
from processing.methods.earthwork.volumes import comparison_checks as checks
from processing.methods.earthwork.volumes.change_sums import change_sums, is_certain, is_filled
from processing.methods.earthwork.volumes.other_methods import OtherMethod, volume_by
from processing.methods.earthwork.volumes.registration import correctable_shift, registration_of
from processing.methods.earthwork.volumes.uncertainty import volume_spread
from processing.methods.earthwork.volumes.volume_parameters import GRID, VolumeParameters
from processing.methods.earthwork.volumes.volume_result import Registration, VolumeResult, Volumes
from processing.methods.ground.filters.cells import CellGrid

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

_MARGIN_M = 20.0
"""Ground around a boundary from which beams and slopes come in; by trial."""

_CLOSED_M = 1.0
"""Half width of gaps between points that don't divide an area without a boundary; by trial."""

_SHARES_OF_WORK = (0.4, 0.4, 0.2)
"""Of the progress bar: counting points, filling holes, summing."""

_ON_CORNER = 1e-9
"""Cells by which rounding may move a side off a corner of the mesh."""
_COUNTING = Text("Counting ground points", "地面の点を集計しています")
_FILLING = Text("Filling what nobody saw", "見えなかった地面を補っています")
_SUMMING = Text("Summing", "土量を計算しています")


def compare(
    before: Side,
    after: Side,
    parameters: VolumeParameters,
    monitor: Monitor,
    within: VolumeScope = EVERYWHERE,
    *,
    others: Sequence[EpochGround] = (),
) -> VolumeResult:
    """The volume between two sides.

    Parameters
    ----------
    others : sequence of EpochGround
        Of the same site on other dates: they tell the shape of ground that a side did not show.

    Raises
    ------
    Unsuitable
        The sides have different systems, or no ground in common; an epoch has hardly a point;
        neither side has an extent; the epochs lie metres apart everywhere.
    OutOfRange
        The boundary lies outside, or the mesh is too fine for so large an area.
    Cancelled
    """
    checks.check_systems(before, after, *others)
    grid = _grid_of((before, after), parameters.grid_m, within.boundary)
    counting, filling, summing = parts_of(monitor, _SHARES_OF_WORK)
    counting.report(0.0, _COUNTING)
    cells = [_cells_of(side, grid, counting) for side in (before, after)]
    registration = _registration(cells)
    shift = (0.0, 0.0, 0.0)
    if registration is not None and parameters.correct_shift and isinstance(after, EpochGround):
        registration = correctable_shift(registration)
        if registration.is_corrected:
            shift = registration.shift_m
            cells[1] = ground_cells(after, grid, counting, shift)
    filling.report(0.0, _FILLING)
    designs = [_designed(side, grid) for side in (before, after)]
    inside = _inside(cells, designs, grid, within.boundary)
    shifts = ((0.0, 0.0, 0.0), shift)
    epochs = [
        _Epoch(side, counted, moved)
        for side, counted, moved in zip((before, after), cells, shifts, strict=True)
        if isinstance(side, EpochGround) and counted is not None
    ]
    seen = [_Epoch(one, ground_cells(one, grid, filling), shifts[0]) for one in others]
    joined = _filled(epochs, seen, inside, grid, filling)
    filled = iter(joined.grounds)
    surfaces = [designed if designed is not None else next(filled) for designed in designs]
    change = _change(grid, surfaces, inside)
    checks.check_common(change, before, after)
    summing.report(0.0, _SUMMING)
    is_alone = len(epochs) == 1
    spread = joined.grounds[0].spread if is_alone else joined.change_spread
    tie = _Tie((before, after), registration, len(epochs), spread, tuple(others))
    return _result_of(change, tie, (parameters, within), summing)


@dataclass(frozen=True)
class _Epoch:
    """A date that was measured, counted into cells, and what was taken from its points first."""

    ground: EpochGround
    cells: GroundCells
    shift_m: tuple[float, float, float]


def _filled(
    epochs: list[_Epoch],
    others: list[_Epoch],
    inside: NDArray[np.float32],
    grid: CellGrid,
    monitor: Monitor,
) -> JoinedDates:
    """The epochs that are compared, each filled in by all that were measured."""
    every = [*epochs, *others]
    if not every:
        # A design against another, or a level: nothing was measured that could be unsure.
        return JoinedDates((), np.zeros((grid.rows, grid.columns)))
    if len(every) < 2:
        grounds = _each_filled(every, inside, monitor)
        return JoinedDates(tuple(grounds), grounds[0].spread)
    every = _without_strays(every, inside, monitor)
    grounds = _each_filled(every, inside, monitor)
    wanted = inside > 0
    for number, ground in enumerate(grounds[: len(epochs)]):
        wanted &= reached_ground(ground, shown_by_others(grounds, number), grid.size_m)
    counted = [one.cells.heights for one in every]
    return join_dates(grounds, counted, wanted, grid.size_m, monitor)


def _each_filled(
    every: list[_Epoch], inside: NDArray[np.float32], monitor: Monitor
) -> list[SideHeights]:
    """Each date filled in from its own surroundings."""
    counted = [one.cells.heights for one in every]
    grounds = []
    for number, one in enumerate(every):
        context = EpochContext(one.shift_m, (*counted[:number], *counted[number + 1 :]))
        grounds.append(measured_surface(one.ground, one.cells, inside > 0, monitor, context))
    return grounds


def _without_strays(
    every: list[_Epoch], inside: NDArray[np.float32], monitor: Monitor
) -> list[_Epoch]:
    """The dates without islands of points that are no ground, as the other dates tell."""
    size_m = every[0].cells.grid.size_m
    islands = [loose_islands(one.cells.heights, size_m) for one in every]
    if not any(one.any() for one in islands):
        return every
    firm = [_without(one, labels > 0) for one, labels in zip(every, islands, strict=True)]
    counted = [one.cells.heights for one in firm]
    grounds = _each_filled(firm, inside, monitor)
    expected = join_dates(grounds, counted, inside > 0, size_m, monitor).grounds
    return [
        _without(one, contradicted(one.cells.heights, labels, expected, number, size_m))
        for number, (one, labels) in enumerate(zip(every, islands, strict=True))
    ]


def _without(epoch: _Epoch, dropped: Mask) -> _Epoch:
    """An epoch without the points of some cells."""
    if not dropped.any():
        return epoch
    counts = np.where(dropped, 0, epoch.cells.counts).astype(np.int32)
    heights = np.where(dropped, np.nan, epoch.cells.heights)
    return replace(epoch, cells=replace(epoch.cells, counts=counts, heights=heights))


@dataclass(frozen=True)
class _Tie:
    """Two sides, how they lie to each other, how many were measured, and how surely filled in."""

    sides: tuple[Side, Side]
    registration: Registration | None
    epochs: int
    spread: Floats
    others: tuple[EpochGround, ...] = ()


def _grid_of(
    sides: tuple[Side, Side], size_m: float, boundary: shapely.Geometry | None
) -> CellGrid:
    """Cells over what both sides have, and some metres round a boundary."""
    low, high, height = checks.common_box(sides, boundary, _MARGIN_M)
    # Coarse cells must not lie across the edge of the work by chance of its corner.
    step = size_m * cells_of_hole(size_m)
    first = np.floor(low / step + _ON_CORNER) * step
    return grid_over((first[0], first[1]), (high[0], high[1]), size_m, height)


def _cells_of(side: Side, grid: CellGrid, monitor: Monitor) -> GroundCells | None:
    if not isinstance(side, EpochGround):
        return None
    cells = ground_cells(side, grid, monitor)
    checks.check_points(side, cells)
    return cells


def _registration(cells: list[GroundCells | None]) -> Registration | None:
    before, after = cells
    if before is None or after is None:
        return None
    checks.check_heights(before, after)
    times = cells_of_hole(before.grid.size_m)
    one, other = (coarse_means(cells.heights, times) for cells in (before, after))
    return registration_of(one, other, times * before.grid.size_m)


def _designed(side: Side, grid: CellGrid) -> SideHeights | None:
    return None if isinstance(side, EpochGround) else designed_surface(side, grid)


def _inside(
    cells: list[GroundCells | None],
    designs: list[SideHeights | None],
    grid: CellGrid,
    boundary: shapely.Geometry | None,
) -> NDArray[np.float32]:
    """Share of each cell that counts; without a boundary where both sides are, holes and all."""
    if boundary is not None:
        return inside_shares(boundary, grid)
    from scipy.ndimage import binary_closing, binary_fill_holes

    common = np.ones((grid.rows, grid.columns), np.bool_)
    for counted, designed in zip(cells, designs, strict=True):
        if counted is not None:
            reach = max(1, round(_CLOSED_M / grid.size_m))
            padded = np.pad(counted.is_counted, reach)
            closed = binary_closing(padded, np.ones((3, 3), np.bool_), iterations=reach)
            common &= binary_fill_holes(closed)[reach:-reach, reach:-reach]
        elif designed is not None:
            common &= np.isfinite(designed.heights)
    return common.astype(np.float32)


def _change(grid: CellGrid, surfaces: list[SideHeights], inside: NDArray[np.float32]) -> ChangeGrid:
    before, after = surfaces
    return ChangeGrid(
        grid,
        before.heights.astype(np.float32),
        after.heights.astype(np.float32),
        before.is_measured & after.is_measured,
        inside,
    )


def _result_of(
    change: ChangeGrid,
    tie: _Tie,
    asked: tuple[VolumeParameters, VolumeScope],
    monitor: Monitor,
) -> VolumeResult:
    parameters, within = asked
    filled, certain = is_filled(change), is_certain(change)
    spread = volume_spread(change, certain, tie.spread, tie.registration, tie.epochs)
    measured = change_sums(change, filled, change.is_measured & certain)
    cell_m2 = change.grid.size_m**2
    area_m2 = float(change.inside.sum(dtype=np.float64)) * cell_m2
    seen_m2 = float(change.inside[change.is_measured].sum(dtype=np.float64)) * cell_m2
    other = OtherMethod(0.0, 0.0)
    if parameters.method == GRID:
        whole = change_sums(change, filled, certain)
        cut, fill = whole.cut_m3, whole.fill_m3
    else:
        other = volume_by(parameters, change, tie.sides, monitor, within)
        cut, fill = other.cut_m3, other.fill_m3
    # In this order: the negative of no earth at all is −0.0, which would be printed so.
    volumes = Volumes(
        cut_m3=max(0.0, cut),
        fill_m3=max(0.0, fill),
        area_m2=area_m2,
        unmeasured_area_m2=max(area_m2 - seen_m2, 0.0),
        uncertainty_m3=spread.stated_m3,
        measured_cut_m3=max(0.0, measured.cut_m3),
        measured_fill_m3=max(0.0, measured.fill_m3),
        left_out_area_m2=_left_out_m2(change),
    )
    notes = (
        *(note for side in tie.sides for note in checks.notes_of(side)),
        *checks.notes_on(tie.registration),
        *checks.notes_on_gaps(volumes),
        *checks.notes_on_others(tie.others),
        *other.notes,
    )
    return VolumeResult(
        volumes,
        parameters.method,
        change.grid.size_m,
        change,
        tie.registration,
        notes,
        other.line,
        other.between,
    )


def _left_out_m2(change: ChangeGrid) -> float:
    lacking = change.inside[~np.isfinite(change.change_m)].sum(dtype=np.float64)
    return float(lacking) * change.grid.size_m**2
