"""The line of the ground follows what is painted in a section's slab, and is as found elsewhere."""

from __future__ import annotations

import numpy as np
import pytest

from processing.methods.ground.edited_ground import update_ground_lines
from processing.methods.ground.surface_line import SurfaceLine

OFFSETS = np.arange(-10.0, 10.01, 0.5)
FOUND = (SurfaceLine(np.column_stack([OFFSETS, np.zeros_like(OFFSETS)]), is_filled=False),)


def slab(height_of) -> np.ndarray:
    """Points all along, 5 cm from each other, at the heights of a function."""
    offsets = np.arange(-10.0, 10.0, 0.05)
    return np.column_stack([offsets, height_of(offsets), np.zeros_like(offsets)])


def heights(lines, offsets) -> np.ndarray:
    """Of the lines, NaN where there is none."""
    found = np.full(len(offsets), np.nan)
    for line in lines:
        x, y = line.positions.T
        inside = (offsets >= x[0]) & (offsets <= x[-1])
        found[inside] = np.interp(offsets[inside], x, y)
    return found


def test_lines_are_as_found_where_nothing_was_painted():
    section = slab(np.zeros_like)
    was = np.ones(len(section), np.bool_)
    assert update_ground_lines(FOUND, section, was, was) == FOUND


def test_what_was_taken_for_a_thing_and_is_ground_lifts_the_line_there_only():
    section = slab(lambda x: np.where(np.abs(x) < 2, 1.0, 0.0))
    was = section[:, 1] == 0
    lines = update_ground_lines(FOUND, section, np.ones(len(section), np.bool_), was)
    at = np.array([-9.0, -3.0, -1.5, 0.0, 1.5, 3.0, 9.0])
    np.testing.assert_allclose(heights(lines, at), [0, 0, 1, 1, 1, 0, 0], atol=1e-9)
    assert not any(line.is_filled for line in lines)


def test_where_ground_was_painted_away_the_line_is_filled_in_between_its_edges():
    section = slab(lambda x: 0.1 * x)
    found = (SurfaceLine(np.column_stack([OFFSETS, 0.1 * OFFSETS]), is_filled=False),)
    was = np.ones(len(section), np.bool_)
    lines = update_ground_lines(found, section, np.abs(section[:, 0]) > 3, was)
    at = np.linspace(-9.5, 9.5, 40)
    np.testing.assert_allclose(heights(lines, at), 0.1 * at, atol=0.02)
    (filled,) = [line for line in lines if line.is_filled]
    assert filled.positions[0, 0] == pytest.approx(-3.0, abs=0.5)
    assert filled.positions[-1, 0] == pytest.approx(3.0, abs=0.5)


def test_without_any_ground_left_only_the_ends_of_what_was_found_stay():
    section = slab(np.zeros_like)
    was = np.ones(len(section), np.bool_)
    lines = update_ground_lines(FOUND, section, np.zeros(len(section), np.bool_), was)
    assert all(line.is_filled or np.ptp(line.positions[:, 0]) < 1.0 for line in lines)


def test_ground_beyond_the_end_of_the_line_makes_it_longer():
    section = slab(np.zeros_like)
    short = (SurfaceLine(np.array([[-10.0, 0.0], [-1.0, 0.0]]), is_filled=False),)
    was = section[:, 0] < -1
    lines = update_ground_lines(short, section, was | (section[:, 0] > 1), was)
    at = np.array([-5.0, 5.0])
    np.testing.assert_allclose(heights(lines, at), 0.0, atol=1e-9)
    assert max(line.positions[-1, 0] for line in lines) == pytest.approx(10.0, abs=0.3)


def test_of_two_surfaces_above_each_other_the_lower_one_is_the_ground():
    ground, roof = slab(np.zeros_like), slab(lambda x: np.full_like(x, 2.5))
    section = np.concatenate([ground, roof[np.abs(roof[:, 0]) < 2]])
    was = section[:, 1] == 0
    lines = update_ground_lines(FOUND, section, np.ones(len(section), np.bool_), was)
    at = np.linspace(-9.0, 9.0, 50)
    np.testing.assert_allclose(heights(lines, at), 0.0, atol=1e-9)
