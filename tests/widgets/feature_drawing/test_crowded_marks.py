"""Ten thousand marks: those that can be told apart are painted, a few are painted all."""

from __future__ import annotations

import numpy as np

from widgets.feature_drawing.crowded_marks import FEW, marks_to_paint


def test_a_few_marks_are_all_painted_but_those_outside_and_without_a_place():
    pixels = np.array([[10.0, 10.0], [10.5, 10.0], [np.nan, np.nan], [500.0, 10.0], [99.0, 99.0]])
    assert marks_to_paint(pixels, 100, 100).tolist() == [0, 1, 4]


def test_of_many_marks_each_one_painted_or_within_a_few_pixels_of_one():
    random = np.random.default_rng(1)
    pixels = random.uniform(0, 60, (20 * FEW, 2))
    painted = marks_to_paint(pixels, 100, 100)
    assert painted.size < FEW
    away = np.abs(pixels[:, None] - pixels[painted][None]).max(axis=-1).min(axis=1)
    assert away.max() <= 4.0
