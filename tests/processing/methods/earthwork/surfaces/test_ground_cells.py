"""Mean heights of cells: strays in shadows and blades of grass are no ground; truth by formula."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import SilentMonitor
from processing.methods.earthwork.surfaces.ground_cells import GroundCells, grid_over, ground_cells
from processing.methods.earthwork.surfaces.sides import EpochGround, GroundBlock
from tests.processing.methods.earthwork.grounds import ORIGIN, flat, scan_of

Floats = NDArray[np.float64]


def cells_of(epoch: EpochGround, size_m: float = 0.2) -> GroundCells:
    east, north = float(ORIGIN[0]), float(ORIGIN[1])
    grid = grid_over((east, north), (east + 20.0, north + 20.0), size_m, float(ORIGIN[2]))
    return ground_cells(epoch, grid, SilentMonitor())


def with_points(epoch: EpochGround, xyz: Floats) -> EpochGround:
    return replace(epoch, blocks=lambda: [*epoch.blocks(), GroundBlock(xyz + ORIGIN, 0)])


def test_a_few_points_in_a_shadow_are_no_ground_even_at_its_likely_height() -> None:
    def seen(x: Floats, y: Floats) -> NDArray[np.bool_]:
        return np.hypot(x - 10.0, y - 10.0) > 2.5

    chance = np.random.default_rng(3)
    strays = np.column_stack([chance.uniform(8.5, 11.5, (40, 2)), chance.normal(0, 0.02, 40)])
    epoch = with_points(scan_of(flat, per_m2=2000, noise_m=0.003, keep=seen), strays)
    shadow = cells_of(epoch).counts[43:57, 43:57]

    assert (shadow > 0).mean() < 0.02


def test_ground_seen_thinly_from_afar_stays() -> None:
    def near(x: Floats, y: Floats) -> NDArray[np.bool_]:
        return np.hypot(x - 10.0, y - 10.0) > 2.5

    chance = np.random.default_rng(4)
    far = np.column_stack([chance.uniform(0.0, 20.0, (30_000, 2)), np.zeros(30_000)])
    epoch = with_points(scan_of(flat, per_m2=2000, noise_m=0.003, keep=near), far)

    assert (cells_of(epoch).counts[43:57, 43:57] > 0).mean() > 0.9


def test_blades_of_grass_lift_a_cell_by_less_than_they_did() -> None:
    def blades(x: Floats, y: Floats) -> Floats:
        chance = np.random.default_rng(5)
        on_blade = (x > 10.0) & (chance.random(x.size) < 0.6)
        return np.where(on_blade, np.minimum(chance.exponential(0.04, x.size), 0.12), 0.0)

    cells = cells_of(scan_of(blades, per_m2=2000, noise_m=0.006))
    bare, grown = (np.nanmean(cells.heights[:, part]) for part in (slice(5, 45), slice(55, 95)))
    lifted = 0.6 * 0.04 * (1.0 - np.exp(-3.0))

    assert abs(bare) < 0.001
    assert -0.002 < grown < 0.5 * lifted


def test_rough_bare_ground_stays_where_it_is() -> None:
    def rough(x: Floats, _: Floats) -> Floats:
        return np.where(x > 10.0, 0.02, 0.004) * np.random.default_rng(6).normal(size=x.size)

    cells = cells_of(scan_of(rough, per_m2=2000, noise_m=0.003))

    assert abs(np.nanmean(cells.heights[:, 55:95])) < 0.002


def test_single_points_hanging_in_a_hole_of_sparse_ground_are_no_ground() -> None:
    def seen(x: Floats, y: Floats) -> NDArray[np.bool_]:
        return np.hypot(x - 10.0, y - 10.0) > 3.0

    hanging = np.array([[10.1, 10.1, 1.5], [11.5, 10.1, 2.0], [10.1, 8.5, 0.9]])
    epoch = with_points(scan_of(flat, per_m2=10, noise_m=0.003, keep=seen), hanging)

    assert (cells_of(epoch).counts[40:60, 40:60] == 0).all()


def test_ground_that_is_sparse_everywhere_stays() -> None:
    # Scan lines 1.2 m apart with a point every 0.6 m, as at the far end of a coarse scan.
    x, y = (one.ravel() for one in np.meshgrid(np.arange(0.3, 20, 0.6), np.arange(0.5, 20, 1.2)))
    points = np.column_stack([x, y, 0.02 * x]) + ORIGIN
    scan = scan_of(flat, per_m2=10, noise_m=0.0)
    lines = cells_of(replace(scan, blocks=lambda: [GroundBlock(points, 0)]))

    assert (lines.counts > 0).sum() > 0.95 * x.size
