"""Volumes between two sides: what lies between them, within what, and how surely."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from processing.core.monitor import Monitor, parts_of
from processing.core.text import Text
from processing.methods.earthwork.geometry.boundary import inside_shares
from processing.methods.earthwork.geometry.volume_scope import EVERYWHERE, VolumeScope
from processing.methods.earthwork.maps.change_grid import ChangeGrid
from processing.methods.earthwork.surfaces.ground_cells import GroundCells, grid_over, ground_cells
from processing.methods.earthwork.surfaces.sides import EpochGround, Side
from processing.methods.earthwork.surfaces.surfaces import (
    SideHeights,
    cells_of_hole,
    coarse_means,
    designed_surface,
    measured_surface,
)
from processing.methods.earthwork.volumes import comparison_checks as checks
from processing.methods.earthwork.volumes.change_sums import change_sums, is_filled
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
) -> VolumeResult:
    """The volume between two sides.

    Raises
    ------
    Unsuitable
        The sides have different systems, or no ground in common; an epoch has hardly a point;
        neither side has an extent; the epochs lie metres apart everywhere.
    OutOfRange
        The boundary lies outside, or the mesh is too fine for so large an area.
    Cancelled
    """
    checks.check_systems(before, after)
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
    surfaces = [
        designed if designed is not None else _measured(side, counted, inside, filling, moved)
        for side, counted, designed, moved in zip(
            (before, after), cells, designs, shifts, strict=True
        )
    ]
    change = _change(grid, surfaces, inside)
    checks.check_common(change, before, after)
    summing.report(0.0, _SUMMING)
    epochs = sum(one is not None for one in cells)
    tie = _Tie((before, after), registration, epochs)
    return _result_of(change, surfaces, tie, (parameters, within), summing)


@dataclass(frozen=True)
class _Tie:
    """Two sides, how they lie to each other, and how many of them were measured."""

    sides: tuple[Side, Side]
    registration: Registration | None
    epochs: int


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


def _measured(
    side: Side,
    cells: GroundCells | None,
    inside: NDArray[np.float32],
    monitor: Monitor,
    shift_m: tuple[float, float, float],
) -> SideHeights:
    if not isinstance(side, EpochGround) or cells is None:
        raise TypeError(side)
    return measured_surface(side, cells, inside > 0, monitor, shift_m)


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
    surfaces: list[SideHeights],
    tie: _Tie,
    asked: tuple[VolumeParameters, VolumeScope],
    monitor: Monitor,
) -> VolumeResult:
    (before, after), (parameters, within) = surfaces, asked
    spread = volume_spread(change, (before, after), tie.registration, tie.epochs)
    filled = is_filled(change)
    measured = change_sums(change, filled, change.is_measured)
    cell_m2 = change.grid.size_m**2
    area_m2 = float(change.inside.sum(dtype=np.float64)) * cell_m2
    seen_m2 = float(change.inside[change.is_measured].sum(dtype=np.float64)) * cell_m2
    has_ground = np.isfinite(change.change_m)
    other = OtherMethod(0.0, 0.0)
    if parameters.method == GRID:
        whole = change_sums(change, filled, has_ground)
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
    )
    notes = (
        *(note for side in tie.sides for note in checks.notes_of(side)),
        *checks.notes_on(tie.registration),
        *checks.notes_on_gaps(change),
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
