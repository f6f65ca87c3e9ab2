"""Representatives, balls and the way back, against slow ways of saying the same."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from processing.laboratory.waveform_networks.neighbourhoods import (
    ball_members,
    farthest_points,
    interpolation,
    levels_of,
)
from processing.laboratory.waveform_networks.sizes import NetworkSizes

F32 = NDArray[np.float32]


@st.composite
def clouds(draw: st.DrawFn) -> F32:
    """Points on a grid, so that distances are exact and some are equal."""
    count = draw(st.integers(4, 40))
    numbers = st.lists(st.integers(-6, 6), min_size=3 * count, max_size=3 * count)
    return np.array(draw(numbers), np.float32).reshape(count, 3)


@given(clouds(), st.data())
@settings(max_examples=40, deadline=None)
def test_each_representative_is_the_farthest_from_those_before(
    xyz: F32, data: st.DataObject
) -> None:
    count = data.draw(st.integers(1, len(xyz)))
    first = data.draw(st.integers(0, len(xyz) - 1))
    chosen = farthest_points(xyz, count, first)
    assert chosen[0] == first
    squares = ((xyz[:, None] - xyz[None]) ** 2).sum(axis=2)
    for number in range(1, count):
        nearest = squares[:, chosen[:number]].min(axis=1)
        assert nearest[chosen[number]] == nearest.max()


@given(clouds(), st.floats(0.5, 9), st.integers(1, 8))
@settings(max_examples=40, deadline=None)
def test_balls_hold_the_first_points_within_the_radius(xyz: F32, radius: float, most: int) -> None:
    chosen = np.arange(0, len(xyz), 3)
    members = ball_members(xyz, chosen, radius, most)
    limit = np.float32(radius) * np.float32(radius)
    for centre, found in zip(chosen, members, strict=True):
        inside = np.flatnonzero(((xyz - xyz[centre]) ** 2).sum(axis=1) <= limit)[:most]
        assert found[: inside.size].tolist() == inside.tolist()
        assert (found[inside.size :] == inside[0]).all()


@given(clouds(), st.integers(1, 4))
@settings(max_examples=40, deadline=None)
def test_the_nearest_three_count_by_their_squared_distance(xyz: F32, count: int) -> None:
    centres = np.unique(xyz, axis=0)[:count] + np.float32(0.25)
    nearest, weights = interpolation(xyz, centres)
    squares = ((xyz[:, None].astype(np.float64) - centres[None]) ** 2).sum(axis=2)
    wanted = np.sort(squares, axis=1)[:, :3]
    np.testing.assert_allclose(np.take_along_axis(squares, nearest, 1), wanted, rtol=1e-6)
    inverse = 1 / wanted
    expected = inverse / inverse.sum(axis=1, keepdims=True)
    np.testing.assert_allclose(weights, expected, rtol=1e-4, atol=1e-6)


def test_a_representative_itself_is_interpolated_as_it_is() -> None:
    xyz = np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4]], np.float32)
    nearest, weights = interpolation(xyz, xyz)
    assert nearest[:, 0].tolist() == [0, 1, 2, 3]
    assert weights[:, 0].min() > 0.999_99


def test_the_levels_of_a_patch_lead_down_and_back() -> None:
    xyz = np.random.default_rng(0).uniform(-10, 10, (200, 3)).astype(np.float32)
    sizes = NetworkSizes().scaled(1 / 8, 200)
    levels = levels_of(xyz, sizes, first=7)
    before = xyz
    for level, count, most in zip(levels, sizes.representatives, sizes.members, strict=True):
        assert level.chosen.size == count
        assert level.members.shape == (count, most)
        assert level.nearest.shape == (len(before), 3)
        centres = before[level.chosen]
        np.testing.assert_allclose(level.offsets, before[level.members] - centres[:, None])
        before = centres
    assert levels[0].chosen[0] == 7


def test_published_sizes_shrink_together() -> None:
    sizes = NetworkSizes()
    assert sizes.representatives == (8_192, 4_096, 2_048)
    small = sizes.scaled(1 / 8, 25_000)
    assert small.representatives == (4_096, 2_048, 1_024)
    assert small.maps == (32, 64, 128)
    assert small.radii_m == (1.0, 5.0, 15.0)
    assert small.with_radii(5).radii_m == (5.0, 25.0, 75.0)
    assert sizes.scaled(1, 50_000) == sizes
