"""What of a plane is shown, and how large."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPointF

from widgets.plane_view.viewport import PlaneViewport

VIEWPORT = PlaneViewport(800.0, 600.0, 4.0, (-11_000.0, 35_000.0), exaggeration=2.5)


def test_a_place_goes_to_the_screen_and_back() -> None:
    spot = VIEWPORT.to_plane(123.0, 456.0)
    assert VIEWPORT.to_screen(np.array([spot]))[0] == pytest.approx([123.0, 456.0])
    mapped = VIEWPORT.transform().map(QPointF(*spot))
    assert (mapped.x(), mapped.y()) == pytest.approx((123.0, 456.0))


def test_exaggeration_stretches_downwards_only() -> None:
    spots = VIEWPORT.to_screen(np.array([[-11_000.0, 35_000.0], [-10_999.0, 35_001.0]]))
    assert (spots[1] - spots[0]).tolist() == [4.0, 10.0]


@pytest.mark.parametrize("factor", [0.25, 1.25, 30.0])
def test_zooming_leaves_the_place_under_the_mouse(factor: float) -> None:
    before = VIEWPORT.to_plane(700.0, 50.0)
    zoomed = VIEWPORT.zoomed(factor, 700.0, 50.0)
    assert zoomed.scale == pytest.approx(4.0 * factor)
    assert zoomed.to_plane(700.0, 50.0) == pytest.approx(before)


def test_zooming_has_ends() -> None:
    far, near = VIEWPORT, VIEWPORT
    for _ in range(200):
        far, near = far.zoomed(0.5, 0, 0), near.zoomed(2.0, 0, 0)
    assert 0 < far.scale < near.scale < np.inf


def test_a_push_moves_the_picture_by_pixels() -> None:
    pushed = VIEWPORT.panned(12.0, -30.0)
    spot = np.array([VIEWPORT.to_plane(100.0, 100.0)])
    assert pushed.to_screen(spot)[0] == pytest.approx([112.0, 70.0])


def test_holding_shrinks_only_what_would_not_fit_and_fitting_fills_the_window() -> None:
    small = VIEWPORT.holding(0.0, 0.0, 1.0, 1.0)
    assert (small.scale, small.centre) == (4.0, (0.5, 0.5))
    large = VIEWPORT.holding(0.0, 0.0, 1000.0, 10.0)
    assert large.scale == pytest.approx(0.9 * 800 / 1000)
    fitted = VIEWPORT.fitted(0.0, 0.0, 1.0, 1.0)
    assert fitted.scale_y == pytest.approx(0.9 * 600)
    assert np.isfinite(VIEWPORT.fitted(5.0, 5.0, 5.0, 5.0).scale)


def test_what_is_shown_and_what_is_in_the_middle_part() -> None:
    x, y = VIEWPORT.to_plane(700.0, 300.0)
    assert VIEWPORT.shows(x, y)
    assert not VIEWPORT.shows(x, y, 0.6)
    assert VIEWPORT.shows(*VIEWPORT.centre, 0.1)
    seen = VIEWPORT.seen
    assert (seen.width(), seen.height()) == (200.0, 60.0)


def test_another_size_keeps_the_middle_and_is_never_nothing() -> None:
    sized = VIEWPORT.sized(0.0, 300.0)
    assert (sized.width, sized.height, sized.centre) == (1.0, 300.0, VIEWPORT.centre)
