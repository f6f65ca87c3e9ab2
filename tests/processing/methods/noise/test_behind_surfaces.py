"""Points behind surfaces: a scanner's beams traced onto ground whose shape is known."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.methods.noise.beams.behind_surfaces import behind_surfaces

Floats = NDArray[np.float64]
STAND = np.array([-12_380.0, -36_680.0, 7.5])
STEP_DEG = 0.1


def beams() -> Floats:
    """Directions of a scanner's beams to the east: (n, 3), upright sweeps."""
    turns = np.radians(np.arange(-30.0, 30.0, STEP_DEG))
    falls = np.radians(np.arange(-40.0, 20.0, STEP_DEG))
    turn, fall = (grid.ravel() for grid in np.meshgrid(turns, falls, indexing="ij"))
    level = np.cos(fall)
    return np.column_stack([level * np.cos(turn), level * np.sin(turn), np.sin(fall)])


def ranges_to_a_step(directions: Floats) -> Floats:
    """How far beams go over ground 1.7 m below, up a wall of 2.5 m at 9 m, to 30 m; inf: sky."""
    with np.errstate(divide="ignore"):
        ground = np.where(
            directions[:, 2] < 0.0, 1.7 / np.maximum(-directions[:, 2], 1e-12), np.inf
        )
    wall = 9.0 / directions[:, 0]
    ranges = np.where(ground * directions[:, 0] < 9.0, ground, np.inf)
    is_wall = (wall * directions[:, 2] <= 0.8) & np.isinf(ranges)
    ranges[is_wall] = wall[is_wall]
    ranges[ranges > 30.0] = np.inf
    return ranges


def test_echoes_behind_the_ground_are_found_and_the_ground_stays() -> None:
    directions = beams()
    chance = np.random.default_rng(1)
    true = ranges_to_a_step(directions) + 0.004 * chance.normal(size=len(directions))
    is_echo = (chance.random(len(directions)) < 0.04) & (true > 2.0)
    ranges = np.where(is_echo, true + 0.3 + chance.exponential(1.0, len(directions)), true)
    hit = np.isfinite(true)
    found = behind_surfaces(STAND + directions[hit] * ranges[hit, None], STAND)

    assert found[is_echo[hit]].mean() > 0.8
    assert found[~is_echo[hit]].mean() < 1e-3


def test_ground_beneath_a_boom_and_beyond_a_crest_is_not_behind_a_surface() -> None:
    directions = beams()
    ranges = np.where(directions[:, 2] < -0.04, 1.7 / np.maximum(-directions[:, 2], 1e-12), np.inf)
    is_boom = (np.abs(np.degrees(np.arcsin(directions[:, 2])) + 6.0) < 1.0) & (ranges > 6.0)
    ranges[is_boom] = 6.0
    hit = np.isfinite(ranges)
    found = behind_surfaces(STAND + directions[hit] * ranges[hit, None], STAND)

    assert found.mean() < 1e-3


def test_ground_seen_through_grass_is_not_behind_a_surface() -> None:
    directions = beams()
    directions = directions[directions[:, 2] < -0.05]
    chance = np.random.default_rng(2)
    ground = -1.7 / directions[:, 2]
    is_through = chance.random(len(directions)) < 0.12
    ranges = np.where(is_through, ground, ground - chance.uniform(0.0, 0.6, len(directions)))
    found = behind_surfaces(STAND + directions * ranges[:, None], STAND)

    assert found[is_through].mean() < 0.02


@pytest.mark.parametrize("count", [0, 1, 50])
def test_a_few_points_and_points_without_coordinates_are_behind_nothing(count: int) -> None:
    xyz = STAND + 5.0 * beams()[:count]
    xyz[1:3] = np.nan

    assert not behind_surfaces(xyz, STAND).any()
