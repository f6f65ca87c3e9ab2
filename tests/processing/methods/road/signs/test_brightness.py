"""What is bright to a scanner: faces of signs are, whatever else stands at their range."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.methods.road.signs.brightness import CLASSES, brightness_of

NEAR, MIDDLE, FAR = 1, 3, 5
FACE = 65_535


def diffuse(count: int, level: float, seed: int) -> NDArray[np.uint16]:
    """Intensities of things with reflectances from 0.1 to 0.6 (m = 0.35)."""
    random = np.random.default_rng(seed)
    return (level * random.uniform(0.1, 0.6, count) / 0.35).astype(np.uint16)


def test_a_range_at_which_signs_are_most_of_what_stands_has_bright_faces() -> None:
    faces = np.full(2_000, FACE, np.uint16)
    intensity = np.concatenate([diffuse(9_000, 8_000, 1), diffuse(500, 7_000, 2), faces])
    classes = np.repeat([MIDDLE, FAR, FAR], [9_000, 500, 2_000])
    bounds = brightness_of(intensity, classes).bounds()
    assert 14_000 < bounds[FAR] < FACE
    assert (bounds[MIDDLE] > 14_000).all()


def test_a_scale_of_decibels_has_bright_faces_too() -> None:
    # Some scanners give hundredths of a decibel about 3,000: a face is 15 dB brighter than a wall.
    things = 3_000 + 100 * np.log10(diffuse(9_000, 8_000, 3) / 8_000.0)
    bounds = brightness_of(things.astype(np.uint16), np.full(9_000, MIDDLE)).bounds()
    assert things.max() < bounds[MIDDLE] < 3_000 + 150


def test_a_range_with_few_points_takes_the_limit_of_the_one_beside_it() -> None:
    intensity = np.concatenate([diffuse(9_000, 8_000, 4), np.full(400, 900, np.uint16)])
    bounds = brightness_of(intensity, np.repeat([MIDDLE, NEAR], [9_000, 400])).bounds()
    assert bounds[NEAR] == pytest.approx(bounds[MIDDLE])


def test_without_intensity_nothing_is_bright() -> None:
    none = np.zeros(5_000, np.uint16)
    assert np.isinf(brightness_of(none, np.full(5_000, MIDDLE)).bounds()).all()
    assert len(brightness_of(none, np.full(5_000, MIDDLE)).bounds()) == CLASSES


def test_a_wall_far_away_is_not_bright_where_all_else_that_stands_there_is_dark() -> None:
    # Brightness falls with the range; far away panes and tyres are most of what stands.
    ranges = [1, 2, 3, 4]
    things = [diffuse(6_000, 8_000 / 1.5**number, 5 + number) for number in ranges]
    panes = np.full(3_000, 300, np.uint16)
    wall = np.full(1_000, 0.6 / 0.35 * 8_000 / 1.5**FAR, np.uint16)
    intensity = np.concatenate([*things, panes, wall])
    classes = np.repeat([*ranges, FAR], [6_000] * 4 + [4_000])
    bounds = brightness_of(intensity, classes).bounds()
    assert wall.max() < bounds[FAR] < 4 * wall.max()
