"""Outlines on scan lines: the plate that lines were cut from is the one that is found."""

from __future__ import annotations

import numpy as np
import pytest

from processing.core.arrays import Floats
from processing.core.monitor import SilentMonitor
from processing.methods.road.signs.fit_kernels import (
    LINE,
    OPEN_END,
    OPEN_START,
    SIGMA_M,
    chord_of,
    cost_of,
    fit_kernel,
    overlap_kernel,
)
from processing.methods.road.signs.plate_fit import (
    Fit,
    FittedPlate,
    fit_plates,
    hangs_below,
    is_board_below,
)
from processing.methods.road.signs.sign_shapes import (
    RECTANGLE,
    SignShape,
    outline_of,
    shape_of,
    standard_shapes,
)

SPACING_M = 0.02
TURN_M = 0.09
ALONG = np.array([np.cos(1.2), np.sin(1.2)])


def lines_on(shape: SignShape, middle: tuple[float, float], hidden_m: float = np.inf) -> Floats:
    """Scan lines over a plate, pulses 2 cm apart; beyond a height leaves hide it."""
    across = np.array([-ALONG[1], ALONG[0]])
    random = np.random.default_rng(2)
    found = []
    for offset in np.arange(-1.5, 1.5, TURN_M):
        line = np.zeros(LINE)
        line[:2], line[2:4] = offset * across - 3 * ALONG, ALONG
        enters, leaves = chord_of(outline_of(shape), line, np.array([*middle, 0.0]))
        pulses = np.arange(enters + random.uniform(0, SPACING_M), leaves, SPACING_M)
        seen = pulses[line[1] + pulses * ALONG[1] < hidden_m] if leaves > enters else pulses[:0]
        if seen.size < 2:
            continue
        line[:2] += seen[0] * ALONG
        line[4:6] = seen[-1] - seen[0], SPACING_M
        line[OPEN_START], line[OPEN_END] = 1.0, float(seen.size == pulses.size)
        found.append(line)
    return np.array(found)


def fitted(lines: Floats) -> Fit:
    return fit_plates(lines, np.empty((0, LINE)), standard_shapes(), SilentMonitor())


@pytest.mark.parametrize(
    "shape",
    [shape_of("circle", 0.6), shape_of("circle", 0.4), shape_of("triangle", 0.8),
     shape_of("diamond", 0.45), shape_of("square", 0.9), shape_of("pentagon", 0.6)],
    ids=lambda one: f"{one.shape} {one.size_m}",
)  # fmt: skip
def test_a_plate_is_found_with_its_shape_and_size(shape: SignShape) -> None:
    plates = fitted(lines_on(shape, (0.13, -0.21))).plates
    assert [one.shape for one in plates] == [shape]
    assert plates[0].pose[:2] == pytest.approx([0.13, -0.21], abs=0.01)


def test_a_rectangle_is_as_wide_and_high_as_it_is() -> None:
    plates = fitted(lines_on(SignShape(RECTANGLE, 1.2, 0.75), (0.0, 0.0))).plates
    assert len(plates) == 1
    assert plates[0].shape.shape == RECTANGLE
    assert plates[0].shape.size_m == pytest.approx(1.2, abs=0.03)
    assert plates[0].shape.high_m == pytest.approx(0.75, abs=0.03)


def test_a_plate_half_behind_leaves_keeps_its_size() -> None:
    plates = fitted(lines_on(shape_of("circle", 0.6), (0.0, 0.0), hidden_m=0.05)).plates
    assert [one.shape for one in plates] == [shape_of("circle", 0.6)]
    assert plates[0].pose[:2] == pytest.approx([0.0, 0.0], abs=0.02)


def test_plates_side_by_side_and_below_are_told_apart() -> None:
    circle, square = shape_of("circle", 0.6), shape_of("square", 0.6)
    beside = np.concatenate([lines_on(circle, (-0.33, 0.0)), lines_on(square, (0.33, 0.0))])
    assert {one.shape for one in fitted(beside).plates} == {circle, square}
    small = SignShape(RECTANGLE, 0.4, 0.2)
    below = np.concatenate([lines_on(circle, (0.0, 0.0)), lines_on(small, (0.0, -0.44))])
    upper, lower = fitted(below).plates
    assert upper.shape == circle
    assert hangs_below(lower, upper)
    assert lower.shape.size_m == pytest.approx(0.4)


def test_beside_what_can_be_no_sign_nothing_is_looked_for() -> None:
    circle, square = shape_of("circle", 0.6), shape_of("square", 0.6)
    lines = np.concatenate([lines_on(circle, (-0.33, 0.0)), lines_on(square, (0.33, 0.0))])
    asked: list[SignShape] = []

    def never(plate: FittedPlate, explained: float) -> bool:
        assert explained < 1.0
        asked.append(plate.shape)
        return False

    nothing = np.empty((0, LINE))
    fit = fit_plates(lines, nothing, standard_shapes(), SilentMonitor(), is_hopeful=never)
    assert asked
    assert len(fit.plates) == 1
    assert fit.cost > fitted(lines).cost


def test_a_disc_over_a_board_of_its_width_is_told_from_it_through_the_post_before_both() -> None:
    disc, board = shape_of("circle", 0.4), SignShape(RECTANGLE, 0.4, 0.85)
    stack = np.concatenate([lines_on(disc, (0.0, 0.68)), lines_on(board, (0.0, 0.0))])
    lower, upper = sorted(fitted(without_strip(stack)).plates, key=lambda one: one.pose[1])
    assert upper.shape == disc
    assert lower.shape.high_m == pytest.approx(0.85, abs=0.03)
    assert is_board_below(lower, upper)
    assert not is_board_below(upper, lower)


def without_strip(lines: Floats) -> Floats:
    """Lines without what an upright post of 8 cm hides."""
    found = []
    for line in lines:
        to_strip = (np.array([-0.04, 0.04]) - line[0]) / line[2]
        for start, stop, hidden in (
            (0.0, to_strip[0], OPEN_END),
            (to_strip[1], line[4], OPEN_START),
        ):
            part = line.copy()
            first, last = max(start, 0.0), min(stop, line[4])
            if last - first < SPACING_M:
                continue
            part[:2] += first * part[2:4]
            part[4] = last - first
            if (last < line[4]) if hidden == OPEN_END else (first > 0.0):
                part[hidden] = 0.0
            found.append(part)
    return np.array(found)


def test_kernels_say_the_same_as_plain_functions() -> None:
    circle = shape_of("circle", 0.6)
    lines, pose = lines_on(circle, (0.0, 0.0)), np.array([0.02, 0.01, 0.0])
    assert cost_of(outline_of(circle), lines, pose, SIGMA_M, np.inf) > 0
    other = pose.copy()
    cost = fit_kernel(outline_of(circle), lines, np.array([0.01, 0.002]), SIGMA_M, pose)
    plain = fit_kernel.py_func(  # type: ignore[attr-defined]  # numba keeps the plain function
        outline_of(circle), lines, np.array([0.01, 0.002]), SIGMA_M, other
    )
    assert cost == pytest.approx(plain)
    assert pose == pytest.approx(other)
    assert np.hypot(*pose[:2]) < 0.01


def test_a_stop_is_asked_before_every_set_of_plates_is_looked_for() -> None:
    asked: list[int] = []

    class Counting(SilentMonitor):
        def check(self) -> None:
            asked.append(1)

    above = lines_on(shape_of("circle", 0.6), (0.0, 0.5))
    below = lines_on(shape_of("square", 0.6), (0.0, -0.5))
    lines = np.concatenate([above, below])
    fit_plates(lines, np.empty((0, LINE)), standard_shapes(), Counting())
    assert len(asked) > len(fitted(lines).plates)


def test_two_discs_beside_each_other_are_two_though_a_post_ends_between_them() -> None:
    left, right = (lines_on(shape_of("circle", 0.6), (side, 0.0)) for side in (-0.35, 0.35))
    post = lines_on(SignShape(RECTANGLE, 0.08, 0.9), (0.0, -0.6))
    plates = fitted(np.concatenate([left, right, post])).plates
    discs = sorted(one.pose[0] for one in plates if one.shape == shape_of("circle", 0.6))
    assert discs == pytest.approx([-0.35, 0.35], abs=0.02)


def test_outlines_tell_how_deep_they_lie_in_each_other() -> None:
    disc, square = outline_of(shape_of("circle", 0.6)), outline_of(shape_of("square", 0.6))
    origin = np.zeros(3)
    assert overlap_kernel(disc, origin, disc, np.array([0.5, 0.0, 0.0])) == pytest.approx(0.1)
    assert overlap_kernel(disc, origin, square, np.array([0.0, 0.7, 0.0])) == pytest.approx(-0.1)
    assert overlap_kernel(square, origin, square, np.array([0.55, 0.0, 0.0])) == pytest.approx(0.05)
