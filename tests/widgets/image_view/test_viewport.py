"""The viewport: what is where on the screen, without a window."""

from __future__ import annotations

import numpy as np
import pytest

from widgets.image_view.orientation.oriented_image import Span
from widgets.image_view.orientation.viewport import Viewport

STREET = Viewport(1600, 900, (1300.0, 1000.0), stretch=6.0, zoom=0.9, centre=(300, 500), top=20)


def test_picture_to_screen_and_back_is_the_same_place() -> None:
    (x, y), *_ = STREET.to_screen(np.array([[123.25, 456.75]])).tolist()
    assert STREET.to_picture(x, y) == pytest.approx((123.25, 456.75))
    assert STREET.position_of(123.25, 456.75) == pytest.approx((x, y))


def test_the_centre_is_in_the_middle_below_the_top() -> None:
    assert STREET.to_picture(800, 20 + 450) == pytest.approx((300, 500))


@pytest.mark.parametrize("factor", [1.25, 0.8, 3.0])
def test_zooming_keeps_what_is_under_the_mouse(factor: float) -> None:
    before = STREET.to_picture(1000, 300)
    zoomed = STREET.zoomed(factor, 1000, 300)
    assert zoomed.zoom == pytest.approx(STREET.zoom * factor)
    assert zoomed.to_picture(1000, 300) == pytest.approx(before)


def test_everything_is_in_the_window() -> None:
    span = STREET.with_everything(6.0).span
    assert span.left <= 0
    assert span.right >= 1300
    assert span.top <= 0
    assert span.bottom >= 1000


def test_a_long_road_keeps_a_part_of_the_windows_height() -> None:
    road = Viewport(1600, 900, (200_000.0, 1000.0)).with_everything(6.0)
    assert road.zoom_u * 200_000 == pytest.approx(0.98 * 1600)
    assert road.zoom_v * 1000 == pytest.approx(0.3 * 900)


def test_the_start_fills_the_height_and_begins_at_the_left_edge() -> None:
    start = STREET.with_start()
    assert start.span.left == pytest.approx(0)
    assert start.zoom_v * 1000 == pytest.approx(900)


def test_a_pan_moves_the_picture_with_the_mouse() -> None:
    moved = STREET.panned(100, -30)
    assert moved.position_of(300, 500)[0] == pytest.approx(STREET.position_of(300, 500)[0] + 100)
    assert moved.position_of(300, 500)[1] == pytest.approx(STREET.position_of(300, 500)[1] - 30)


def test_the_picture_cannot_be_pushed_out_of_the_window() -> None:
    assert STREET.panned(1e9, 0).centre[0] == 0
    assert STREET.panned(-1e9, 0).centre[0] == 1300


def test_one_to_one_is_one_both_ways() -> None:
    one = STREET.one_to_one()
    assert (one.zoom_u, one.zoom_v) == (1.0, 1.0)


def test_zooming_has_ends() -> None:
    near = far = STREET
    for _ in range(100):
        near, far = near.zoomed(1.25, 800, 400), far.zoomed(0.8, 800, 400)
    assert near.zoom <= 64
    assert far.zoom_u * 1300 >= 0.4 * 1600


def test_another_window_size_keeps_the_middle() -> None:
    assert STREET.sized(400, 300, 20).to_picture(200, 170) == pytest.approx((300, 500))


def test_what_is_too_large_for_the_window_is_shrunk_to_fit() -> None:
    held = STREET.holding(Span(0, 0, 1300, 1000))
    assert held.span.left <= 0
    assert held.span.right >= 1300
    assert STREET.holding(Span(10, 10, 12, 12)).zoom == STREET.zoom
