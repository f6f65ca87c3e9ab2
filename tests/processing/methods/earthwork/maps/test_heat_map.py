from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from processing.methods.earthwork.maps.heat_map import (
    SHARE_CLASSES,
    ColourClass,
    change_classes,
    change_colours,
    change_limit,
    class_numbers,
    on_paper,
    share_colours,
)


def lightness(rgb: tuple[int, int, int]) -> float:
    """CIE L*."""
    share = np.array(rgb) / 255
    linear = np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)
    luminance = float(linear @ [0.2126, 0.7152, 0.0722])
    return 116 * float(np.cbrt(luminance)) - 16


def without_green_cones(rgb: tuple[int, int, int]) -> np.ndarray:
    """What a deuteranope sees (Viénot, Brettel and Mollon 1999), 0 to 255."""
    red, green, blue = (np.array(rgb) / 255) ** 2.2
    seen = np.array([0.29275 * red + 0.70725 * green] * 2 + [-0.02234 * red + 0.02234 * green])
    seen[2] += blue
    return 255 * np.clip(seen, 0, 1) ** (1 / 2.2)


@pytest.mark.parametrize("classes", [change_classes(1.0), SHARE_CLASSES])
def test_every_class_has_a_grey_of_its_own(classes: tuple[ColourClass, ...]) -> None:
    greys = sorted(lightness(one.rgb) for one in classes)
    assert np.diff(greys).min() > 4


@pytest.mark.parametrize("classes", [change_classes(1.0), SHARE_CLASSES])
def test_classes_differ_for_eyes_that_don_t_tell_red_from_green(
    classes: tuple[ColourClass, ...],
) -> None:
    seen = [without_green_cones(one.rgb) for one in classes]
    apart = [np.abs(a - b).max() for i, a in enumerate(seen) for b in seen[:i]]
    assert min(apart) > 12


def test_lower_is_blue_and_higher_is_red_in_both_scales() -> None:
    for classes in (change_classes(1.0), SHARE_CLASSES):
        for one in classes:
            red, _, blue = one.rgb
            if one.high <= 0:
                assert blue > red
            if one.low >= 0:
                assert red > blue


def test_steps_of_the_share_lie_at_50_80_and_100_percent() -> None:
    values = np.array([[-101, -100, -81, -79, -51, -49, -1, 1, 49, 51, 79, 81, 100, 101]])
    numbers = class_numbers(values.astype(np.float32), SHARE_CLASSES)
    assert numbers.tolist() == [[0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6, 7]]


def test_what_is_nothing_is_transparent_and_all_else_is_not() -> None:
    colours = share_colours(np.array([[np.nan, 0.0, np.inf]], np.float32))
    assert colours[..., 3].tolist() == [[0, 255, 255]]
    assert tuple(colours[0, 2, :3]) == SHARE_CLASSES[-1].rgb


@given(st.floats(-5.0, 5.0, width=32), st.sampled_from([0.02, 0.5, 1.0, 2.0]))
def test_a_change_has_the_colour_of_the_class_that_holds_it(value: float, limit: float) -> None:
    colour = tuple(change_colours(np.array([[value]], np.float32), limit)[0, 0, :3])
    holds = [
        one
        for one in change_classes(limit)
        if np.float32(one.low) <= np.float32(value) <= np.float32(one.high)
    ]
    assert colour in [one.rgb for one in holds]


@pytest.mark.parametrize(
    ("largest", "limit"), [(0.0, 0.02), (0.03, 0.05), (0.9, 1.0), (1.0, 1.0), (1.1, 2.0), (7.0, 10)]
)
def test_the_limit_is_the_next_round_number(largest: float, limit: float) -> None:
    assert change_limit(np.full((3, 3), largest, np.float32)) == pytest.approx(limit)


def test_a_limit_is_found_without_any_change() -> None:
    assert change_limit(np.full((2, 2), np.nan, np.float32)) > 0


def test_classes_up_to_nothing_are_refused() -> None:
    with pytest.raises(ValueError, match="classes up to 0"):
        change_classes(0.0)


def test_labels_say_both_ends_in_both_languages() -> None:
    classes = change_classes(1.0)
    assert classes[0].label(2, "m").ja == "−1.00 m 未満"
    assert classes[-1].label(2, "m").en == "above +1.00 m"
    assert classes[4].label(2, "m").en == "−0.05 … +0.05 m"
    assert SHARE_CLASSES[3].label(0, "%").ja == "−50 … 0 %"


def test_lines_are_drawn_over_what_was_not_measured_and_nowhere_else() -> None:
    values = np.full((16, 32), 0.3, np.float32)
    values[:, 24:] = np.nan
    is_measured = np.ones(values.shape, bool)
    is_measured[:, 8:] = False
    picture = on_paper(change_colours(values, 1.0), is_measured)
    assert len(np.unique(picture[:, :8].reshape(-1, 3), axis=0)) == 1
    assert len(np.unique(picture[:, 8:24].reshape(-1, 3), axis=0)) == 2
    assert (picture[:, 24:] == 255).all()
