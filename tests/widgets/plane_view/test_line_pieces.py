"""Lines on the screen: cut to the window, thinned, dashed."""

from __future__ import annotations

import numpy as np
import pytest

from widgets.plane_view.line_pieces import as_lines, clip_pieces, dash_pieces, thin_pieces

LOW, HIGH = np.array([0.0, 0.0]), np.array([100.0, 50.0])


def cut(*piece: float) -> tuple[list[float], float] | None:
    pieces, numbers, starts = clip_pieces(np.array([piece]).reshape(1, 2, 2), LOW, HIGH)
    if not len(pieces):
        return None
    assert numbers.tolist() == [0]
    return pieces[0].ravel().tolist(), float(starts[0])


def test_a_piece_inside_stays_whole() -> None:
    assert cut(10, 10, 20, 30) == ([10, 10, 20, 30], 0)
    assert cut(10, 10, 10, 10) == ([10, 10, 10, 10], 0)


def test_a_piece_that_leaves_the_window_is_cut_at_its_edge() -> None:
    assert cut(-100, 10, 200, 10) == ([0, 10, 100, 10], 100)
    assert cut(50, -1e6, 50, 25) == ([50, 0, 50, 25], 1e6)


def test_a_piece_beside_the_window_is_left_out_also_where_its_box_touches_it() -> None:
    assert cut(-10, 10, -5, 40) is None
    assert cut(90, -30, 130, 10) is None


def test_a_piece_without_a_place_is_left_out() -> None:
    assert cut(np.nan, np.nan, 10, 10) is None


def test_pieces_keep_their_numbers() -> None:
    pieces = np.array([[[-9, -9], [-5, -5]], [[1, 1], [2, 2]], [[3, 3], [4, 4]]], dtype=float)
    _, numbers, _ = clip_pieces(pieces, LOW, HIGH)
    assert numbers.tolist() == [1, 2]


def test_thinning_drops_what_is_shorter_than_a_pixel_and_leaves_no_gap() -> None:
    positions = np.column_stack([np.linspace(0, 20, 201), np.zeros(201)])
    pieces = np.stack([positions[:-1], positions[1:]], axis=1)
    assert len(thin_pieces(pieces, 2.0)) == 10
    kept = thin_pieces(pieces, 1.0)
    assert len(kept) == 20
    assert (kept[1:, 0] == kept[:-1, 1]).all()
    assert (kept[0, 0].tolist(), kept[-1, 1].tolist()) == ([0, 0], [20, 0])


def test_dashes_go_on_over_the_corners_of_a_line() -> None:
    """Eight pixels of line, five of nothing, whatever the line is made of."""
    pieces = np.array([[[0, 0], [30, 0]], [[30, 0], [30, 30]]], dtype=float)
    dashes = dash_pieces(pieces, np.array([0.0, 30.0]))
    lengths = np.hypot(*(dashes[:, 1] - dashes[:, 0]).T)
    assert dashes[:3].reshape(-1, 4).tolist() == [[0, 0, 8, 0], [13, 0, 21, 0], [26, 0, 30, 0]]
    assert dashes[3].ravel().tolist() == [30, 0, 30, 4]
    assert lengths.sum() == pytest.approx(8 * 4 + 8)
    assert dash_pieces(np.empty((0, 2, 2)), np.empty(0)).shape == (0, 2, 2)


def test_a_piece_within_a_gap_has_no_dash() -> None:
    assert len(dash_pieces(np.array([[[0.0, 0.0], [2.0, 0.0]]]), np.array([9.0]))) == 0


def test_lines_are_those_of_the_pieces() -> None:
    (line,) = as_lines(np.array([[[1.0, 2.0], [3.0, 4.0]]]))
    assert (line.x1(), line.y1(), line.x2(), line.y2()) == (1, 2, 3, 4)
    assert as_lines(np.empty((0, 2, 2))) == []
