"""Normals, shapes and segments of scenes whose answer is known."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.core.errors import Cancelled
from processing.image.images_of_drives import image_of
from processing.image.neighbourhoods.neighbourhood_kernels import (
    PointRows,
    Surfaces,
    neighbourhood_kernel,
)
from processing.image.neighbourhoods.normals import (
    RowLayout,
    oriented_surface_shapes,
    surface_shapes,
)
from processing.image.neighbourhoods.segment_kernels import (
    JoiningRows,
    join_rows_kernel,
    tangents_kernel,
)
from processing.image.neighbourhoods.segments import JoinLimits, connected_segments
from processing.image.rows.grid import PixelGrid
from processing.recording.kinds import ImageKind
from tests.monitors import CancelledAfter
from tests.processing.image.recordings import small_drive

RADIUS_M = 0.2
DISTANCES = JoinLimits(0.3, 2.0, 1.0)


def grid_of(rows: int, columns: int, segments: NDArray[np.int32] | None = None) -> PixelGrid:
    """Rows without a missing point."""
    return PixelGrid(
        row_starts=np.arange(rows + 1, dtype=np.int64) * columns,
        columns=np.tile(np.arange(columns, dtype=np.int32), rows),
        segments=np.zeros(rows, np.int32) if segments is None else segments,
        width=columns,
    )


def plane(rows: int, columns: int, along: list[float], across: list[float]) -> NDArray[np.float64]:
    """Points of a plane far from the origin: steps along a row and from row to row, m."""
    row, column = np.divmod(np.arange(rows * columns), columns)
    corner = np.array([-11_000.0, -35_000.0, 125.0])
    return np.asarray(corner + np.outer(column, along) + np.outer(row, across))


def inside(rows: int, columns: int, margin: int = 9) -> NDArray[np.bool_]:
    """Points away from the borders."""
    row, column = np.divmod(np.arange(rows * columns), columns)
    return (
        (row >= margin) & (row < rows - margin) & (column >= margin) & (column < columns - margin)
    )


@pytest.mark.parametrize(
    ("along", "across", "normal"),
    [
        ([0.02, 0.0, 0.0], [0.0, 0.1, 0.0], [0, 0, 1]),
        ([0.006, 0.0, 0.0], [0.0, 0.15, 0.0], [0, 0, 1]),
        ([0.03, 0.03, 0.0], [0.0, 0.11, 0.0], [0, 0, 1]),
        ([0.3, 0.0, 0.0], [0.0, 0.1, 0.0], [0, 0, 1]),
        ([0.02, 0.0, 0.02], [0.0, 0.1, 0.0], [-1, 0, 1]),
    ],
)
def test_a_plane_is_planar_and_faces_the_scanner_at_any_spacing(
    along: list[float], across: list[float], normal: list[float]
) -> None:
    xyz = plane(60, 80, along, across)
    found = oriented_surface_shapes(xyz, grid_of(60, 80), RADIUS_M)
    middle = inside(60, 80)
    wanted = np.array(normal) / np.linalg.norm(normal)
    np.testing.assert_allclose(found.normals[middle] @ wanted, 1.0, atol=1e-4)
    assert np.median(found.shapes[middle, 1]) > 0.5
    assert found.shapes[middle, 2].max() < 1e-4
    np.testing.assert_allclose(found.shapes[middle].sum(axis=1), 1.0, atol=1e-5)


def test_walls_on_both_sides_of_a_street_face_the_street(tmp_path: Path) -> None:
    drive, street = small_drive(tmp_path / "d")
    image = image_of(drive, ImageKind.TRAJECTORY_REVERSIBLE)
    grid, points = image.grid(range(image.rows))
    xyz = drive.xyz(points)
    found = oriented_surface_shapes(xyz, grid, RADIUS_M)
    to_scanner = street.origin - xyz
    is_known = found.normals.any(axis=1)
    assert is_known.mean() > 0.9
    towards = np.einsum("ij,ij->i", found.normals, to_scanner) > 0
    assert towards[is_known].mean() > 0.98
    is_wall, is_road = street.surface == 3, street.surface == 0
    assert np.median(np.abs(found.normals[is_wall & is_known, 2])) < 0.1
    assert np.median(found.normals[is_road & is_known, 2]) > 0.99


def test_a_road_is_flat_across_the_ends_of_rows() -> None:
    # Rows begin in the middle of straight scan lines, as rows of a street begin below the vehicle.
    revolutions, per_revolution = 60, 100
    xyz = plane(revolutions, per_revolution, [0.02, 0, 0], [0, 0.1, 0])
    starts = np.concatenate(
        [
            [0],
            np.arange(50, revolutions * per_revolution, per_revolution),
            [revolutions * per_revolution],
        ]
    )
    counts = np.diff(starts)
    columns = np.concatenate([np.arange(count) for count in counts]).astype(np.int32)
    columns[:50] += 50
    grid = PixelGrid(
        starts.astype(np.int64), columns, np.zeros(counts.size, np.int32), per_revolution
    )
    shapes = oriented_surface_shapes(xyz, grid, RADIUS_M).shapes.reshape(
        revolutions, per_revolution, 3
    )
    at_fold, elsewhere = shapes[10:-10, 45:55], shapes[10:-10, 25:35]
    np.testing.assert_allclose(at_fold.mean(axis=(0, 1)), elsewhere.mean(axis=(0, 1)), atol=0.05)


def test_a_wire_is_linear_and_has_no_normal() -> None:
    columns = 41
    xyz = plane(1, columns, [0.02, 0.0, 0.0], [0.0, 0.0, 0.0])
    found = oriented_surface_shapes(xyz, grid_of(1, columns), RADIUS_M)
    assert found.shapes[10:-10, 0].min() > 0.99
    assert not found.normals.any()


def test_scattered_points_are_neither_linear_nor_planar() -> None:
    random = np.random.default_rng(4)
    xyz = plane(60, 60, [0.02, 0, 0], [0, 0.1, 0]) + random.normal(0, 0.08, (3600, 3))
    found = oriented_surface_shapes(xyz, grid_of(60, 60), RADIUS_M)
    flat = oriented_surface_shapes(
        plane(60, 60, [0.02, 0, 0], [0, 0.1, 0]), grid_of(60, 60), RADIUS_M
    )
    assert np.median(found.shapes[:, 2]) > 0.1
    assert np.median(flat.shapes[:, 2]) < 1e-4


def test_points_with_too_few_neighbours_have_neither_normal_nor_shape() -> None:
    xyz = plane(3, 3, [50.0, 0, 0], [0, 50.0, 0])
    found = oriented_surface_shapes(xyz, grid_of(3, 3), RADIUS_M)
    assert not found.normals.any()
    assert not found.shapes.any()


def test_rows_after_a_stop_are_no_neighbours() -> None:
    segments = np.repeat([0, 1], 10).astype(np.int32)
    xyz = plane(20, 30, [0.02, 0, 0], [0, 0.05, 0])
    xyz[300:, 2] += 0.1
    found = oriented_surface_shapes(xyz, grid_of(20, 30, segments), RADIUS_M)
    assert np.abs(found.normals[:, 2]).min() > 0.999


def test_chosen_points_get_what_all_points_get() -> None:
    random = np.random.default_rng(2)
    xyz = plane(30, 40, [0.02, 0, 0], [0, 0.1, 0]) + random.normal(0, 0.01, (1200, 3))
    grid = grid_of(30, 40)
    layout = RowLayout(grid.columns, grid.row_starts, np.zeros(30, np.int64), grid.segments)
    everything = surface_shapes(xyz, (1.0, 1.0, 1.0), layout, np.arange(1200), RADIUS_M)
    chosen = np.array([700, -1, 3, 1199, 3, 0])
    some = surface_shapes(xyz, (1.0, 1.0, 1.0), layout, chosen, RADIUS_M)
    wanted = everything.normals[chosen]
    wanted[1] = 0
    np.testing.assert_array_equal(some.normals, wanted)
    # The same as pulses and delivered integers.
    integers = np.rint((xyz - xyz[0]) * 1e6).astype(np.int32)
    pulses = np.arange(1200) + 5000
    layout = RowLayout(pulses, grid.row_starts, 5000 + grid.row_starts[:-1], grid.segments)
    delivered = surface_shapes(integers, (1e-6, 1e-6, 1e-6), layout, chosen, RADIUS_M)
    np.testing.assert_allclose(delivered.shapes, some.shapes, atol=1e-3)


def test_two_boards_apart_are_two_segments_numbered_by_their_first_points() -> None:
    xyz = plane(20, 30, [0.05, 0, 0], [0, 0.1, 0])
    right = np.arange(600) % 30 >= 15
    xyz[right, 0] += 2.0
    segments = connected_segments(xyz, grid_of(20, 30), DISTANCES)
    assert segments.dtype == np.int32
    assert (segments[~right] == 0).all()
    assert (segments[right] == 1).all()


def test_points_are_joined_by_metres_not_by_pixels() -> None:
    xyz = plane(20, 30, [0.05, 0, 0], [0, 0.1, 0])
    xyz[300:, 2] += 5.0
    assert connected_segments(xyz, grid_of(20, 30), DISTANCES).max() == 1


def test_far_surfaces_with_wide_spacing_stay_whole() -> None:
    xyz = plane(20, 30, [0.45, 0, 0], [0, 0.4, 0])
    assert connected_segments(xyz, grid_of(20, 30), DISTANCES).max() == 0
    strict = JoinLimits(0.3, 1.0, 0.3)
    assert connected_segments(xyz, grid_of(20, 30), strict).max() == 599


def test_the_end_of_a_row_joins_the_start_of_the_next() -> None:
    # Each row runs on where the one before ended, and its neighbours across are far away.
    xyz = plane(4, 30, [0.05, 0, 0], [1.5, 0, 0])
    assert connected_segments(xyz, grid_of(4, 30), DISTANCES).max() == 0
    stopped = np.array([0, 0, 1, 1], np.int32)
    assert connected_segments(xyz, grid_of(4, 30, stopped), DISTANCES).max() == 1


def test_nothing_is_joined_over_a_stop() -> None:
    xyz = plane(20, 30, [0.05, 0, 0], [0, 0.1, 0])
    segments = np.repeat([0, 1], 10).astype(np.int32)
    found = connected_segments(xyz, grid_of(20, 30, segments), DISTANCES)
    assert found.tolist() == [0] * 300 + [1] * 300


def test_a_few_missing_columns_do_not_part_a_surface_but_many_do() -> None:
    xyz = plane(10, 30, [0.02, 0, 0], [0, 0.1, 0])
    grid = grid_of(10, 30)
    for lost, parts in ((2, 1), (8, 2)):
        keep = ~np.isin(grid.columns, np.arange(14, 14 + lost))
        thinned = PixelGrid(
            np.arange(11, dtype=np.int64) * (30 - lost), grid.columns[keep], grid.segments, 30
        )
        assert connected_segments(xyz[keep], thinned, DISTANCES).max() + 1 == parts


def wall_and_floor() -> NDArray[np.float64]:
    """Rows that run over 1.5 m of floor and then up a wall."""
    column = np.tile(np.arange(60), 20)
    row = np.repeat(np.arange(20), 60)
    along = np.where(column < 30, column, 30) * 0.05
    up = np.where(column < 30, 0, column - 30) * 0.05
    return np.column_stack([along, row * 0.1, up])


def test_a_surface_ends_at_a_corner_unless_only_distances_count() -> None:
    xyz = wall_and_floor()
    assert connected_segments(xyz, grid_of(20, 60), DISTANCES).max() == 0
    segments = connected_segments(xyz, grid_of(20, 60), JoinLimits(0.3, 2.0, 1.0, 25.0))
    floor, wall = segments.reshape(20, 60)[:, :25], segments.reshape(20, 60)[:, 36:]
    assert len(np.unique(floor)) == 1
    assert len(np.unique(wall)) == 1
    assert floor[0, 0] != wall[0, 0]


def test_cancelling_stops_normals_and_segments() -> None:
    xyz = plane(5, 5, [0.1, 0, 0], [0, 0.1, 0])
    with pytest.raises(Cancelled):
        oriented_surface_shapes(xyz, grid_of(5, 5), RADIUS_M, CancelledAfter())
    with pytest.raises(Cancelled):
        connected_segments(xyz, grid_of(5, 5), DISTANCES, CancelledAfter())


@pytest.mark.parametrize("is_regular", [True, False])
def test_kernels_do_the_same_without_the_compiler(*, is_regular: bool) -> None:
    random = np.random.default_rng(1)
    xyz = plane(6, 12, [0.03, 0, 0], [0, 0.1, 0]) + random.normal(0, 0.01, (72, 3))
    grid = grid_of(6, 12)
    origins = np.zeros(6, np.int64)
    layout = RowLayout(grid.columns, grid.row_starts, origins, grid.segments, is_regular=is_regular)
    compiled = surface_shapes(xyz, (1.0, 1.0, 1.0), layout, np.arange(72), RADIUS_M)
    plain = Surfaces(*(np.empty((72, 3), np.float32) for _ in range(3)))
    rows = PointRows(
        xyz,
        np.ones(3),
        grid.columns,
        grid.row_starts,
        origins,
        grid.segments,
        is_regular=is_regular,
    )
    neighbourhood_kernel.py_func(rows, np.arange(72), RADIUS_M, plain)  # type: ignore[attr-defined]
    np.testing.assert_allclose(plain.shapes, compiled.shapes, atol=1e-5)
    joining = JoiningRows(
        xyz,
        grid.columns,
        grid.row_starts,
        grid.segments,
        np.array([0.3, 2.0, 1.0, 0.9]),
        np.empty(13),
        np.zeros((72, 3), np.float32),
        np.zeros(72, np.bool_),
        np.arange(72),
    )
    tangents_kernel.py_func(joining, 0, 6)  # type: ignore[attr-defined]
    join_rows_kernel.py_func(joining, 0, 6)  # type: ignore[attr-defined]
    found = connected_segments(
        xyz, grid, JoinLimits(0.3, 2.0, 1.0, float(np.degrees(np.arccos(0.9))))
    )
    assert (found == 0).sum() == sum(root_of(joining.parents, i) == 0 for i in range(72))


def root_of(parents: NDArray[np.int64], point: int) -> int:
    while parents[point] != point:
        point = int(parents[point])
    return point
