"""The mesh of pixels against the same mesh in plain numpy, triangle by triangle."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from processing.core.arrays import Floats
from processing.image.scan_lines.scanline_arrays import MeshLimits
from processing.image.scan_lines.scanline_mesh import SectionMesh, SectionVertices
from processing.image.scan_lines.scanline_rows import RowPoints

Corners = tuple[tuple[int, int], ...]

ROWS, COLUMNS = 24, 30
SPACING_M, LONGEST_M = 0.1, 0.25
LAST = 40


def recorded(seed: int) -> Floats:
    """(rows, columns, 3) across, station and height of a trembling grid; NaN: nothing came back."""
    chance = np.random.default_rng(seed)
    row, column = np.mgrid[:ROWS, :COLUMNS].astype(np.float64)
    positions = np.stack([0.1 * column - 1.5, 0.07 * row + 0.03 * column, 0.02 * column], axis=2)
    positions += chance.normal(0.0, 0.02, positions.shape)
    positions[chance.random((ROWS, COLUMNS)) < 0.15] = np.nan
    return positions


def meshed(positions: Floats, rows_at_once: int = ROWS) -> list[SectionVertices]:
    """The sections as the program makes them, some rows at a time."""
    mesh = SectionMesh(
        COLUMNS, MeshLimits(90.0, 90.0, -9.0, 9.0, SPACING_M, -LAST, LAST, LONGEST_M)
    )
    found = []
    for first in range(0, ROWS, rows_at_once):
        part = positions[first : first + rows_at_once]
        is_there = np.isfinite(part[..., 0])
        row, column = np.nonzero(is_there)
        points = part[is_there]
        before = int(np.isfinite(positions[:first, :, 0]).sum())
        counts = is_there.sum(axis=1)
        ends = np.cumsum(counts)
        table = np.column_stack(
            [
                ends - counts,
                ends,
                np.full(len(part), before),
                np.arange(first, first + len(part)) * COLUMNS,
                np.arange(first, first + len(part)) == 0,
            ]
        ).astype(np.int64)
        arrays = (
            (row + first) * COLUMNS + column,
            np.ascontiguousarray(points),
            np.ascontiguousarray(points[:, [1, 0, 2]]),
            (row + first).astype(np.float64),
            column.astype(np.uint16),
            np.zeros(len(points), np.bool_),
        )
        passed = 0.07 * np.arange(first, first + len(part), dtype=np.float64)
        mesh.add(RowPoints(arrays, table), passed)
        is_last = first + rows_at_once >= ROWS
        found.append(mesh.finished(LAST if is_last else -LAST - 1))
    return found


def triangles(positions: Floats) -> list[Corners]:
    """Corners of all triangles: cells are cut along the shorter diagonal."""
    found: list[Corners] = []
    for r in range(ROWS - 1):
        for c in range(COLUMNS - 1):
            a, b, d, e = (r, c), (r, c + 1), (r + 1, c), (r + 1, c + 1)
            rising, falling = (
                np.linalg.norm(positions[i] - positions[j]) for i, j in ((a, e), (b, d))
            )
            if np.isnan(falling) or rising <= falling:
                both = ((a, b, e), (a, e, d))
            else:
                both = ((a, b, d), (b, e, d))
            for corners in both:
                sides = [positions[i] - positions[j] for i, j in pairwise((*corners, corners[0]))]
                # What is NaN is no shorter.
                if (np.linalg.norm(sides, axis=1) <= LONGEST_M).all():
                    found.append(corners)
    return found


def crossings(positions: Floats) -> Floats:
    """(n, 3) level, across and height where sections cross edges; within a cell no diagonal."""
    edges: dict[Corners, int] = {}
    for corners in triangles(positions):
        for i, j in pairwise((*corners, corners[0])):
            edge = tuple(sorted((i, j)))
            edges[edge] = edges.get(edge, 0) + 1
    found = []
    for (i, j), times in edges.items():
        if i[0] != j[0] and i[1] != j[1] and times == 2:
            continue
        start, length = positions[i][1], positions[j][1] - positions[i][1]
        low, high = sorted((start, start + length))
        for level in range(int(np.floor(low / SPACING_M)) + 1, int(np.floor(high / SPACING_M)) + 1):
            share = (level * SPACING_M - start) / length
            position = positions[i] + share * (positions[j] - positions[i])
            found.append((level, position[0], position[2]))
    return np.array(sorted(found))


@pytest.mark.parametrize("seed", range(4))
def test_sections_are_where_plain_numpy_puts_them(seed: int) -> None:
    positions = recorded(seed)
    (found,) = meshed(positions)
    every = np.column_stack([found.levels, found.across, found.height])
    expected = crossings(positions)
    order = np.lexsort((every[:, 2], every[:, 1], every[:, 0]))
    assert len(every) == len(expected) > 300
    np.testing.assert_allclose(every[order], expected, atol=1e-9)


def test_neighbours_on_a_section_are_of_one_cell() -> None:
    (found,) = meshed(recorded(9))
    away = np.hypot(np.diff(found.across), np.diff(found.height))
    assert away[~found.is_break[1:]].max() <= 2 * LONGEST_M
    assert (np.diff(found.levels)[~found.is_break[1:]] == 0).all()
    assert np.count_nonzero(found.is_break) < 0.2 * found.levels.size


@pytest.mark.parametrize("rows_at_once", [1, 5])
def test_rows_may_come_in_any_number_at_a_time(rows_at_once: int) -> None:
    positions = recorded(3)
    (whole,) = meshed(positions)
    last = meshed(positions, rows_at_once)[-1]
    for name in ("levels", "across", "height", "time", "intensity", "point", "is_break"):
        np.testing.assert_array_equal(getattr(last, name), getattr(whole, name))
