"""Squares of the right size and colour, the nearer ones in front."""

from __future__ import annotations

import numpy as np
import pytest

from processing.section import raster
from processing.section.raster import paint_points

RED, BLUE = (200, 10, 10), (10, 10, 200)


def painted(pixels: list[tuple[float, float]], depths: list[float], side_px: int) -> np.ndarray:
    out = np.zeros((9, 12, 3), np.uint8)
    colours = np.array([RED, BLUE][: len(pixels)], np.uint8)
    paint_points(np.array(pixels, float), np.array(depths), colours, side_px, out)
    return out


@pytest.mark.parametrize("side_px", [1, 2, 3, 5])
def test_a_point_is_a_square_about_its_pixel(side_px: int) -> None:
    out = painted([(6.2, 4.7)], [0.0], side_px)
    filled = np.argwhere(out.any(axis=2))
    assert len(filled) == side_px**2
    assert tuple(out[4, 6]) == RED


@pytest.mark.parametrize("depths", [[-0.1, 0.4], [0.1, -0.4]])
def test_what_is_nearer_to_the_plane_is_in_front(depths: list[float]) -> None:
    assert tuple(painted([(5.5, 4.5), (5.5, 4.5)], depths, 3)[4, 5]) == RED


def test_points_outside_and_without_a_place_are_left_out() -> None:
    out = painted([(np.nan, 4.0), (-50.0, 1e9)], [0.0, 0.0], 3)
    assert not out.any()


def test_a_point_at_the_border_is_cut_off() -> None:
    assert np.count_nonzero(painted([(0.2, 0.2)], [0.0], 3).any(axis=2)) == 4


def test_the_kernel_does_the_same_uncompiled() -> None:
    out, nearest = np.zeros((9, 12, 3), np.uint8), np.full((9, 12), np.inf, np.float32)
    positions, colours = np.array([[6.2, 4.7]]), np.array([RED], np.uint8)
    raster._paint_kernel.py_func(positions, np.zeros(1), colours, 3, nearest, out)  # type: ignore[attr-defined]
    assert (out == painted([(6.2, 4.7)], [0.0], 3)).all()
