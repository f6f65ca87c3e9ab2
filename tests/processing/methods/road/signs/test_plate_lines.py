"""Scan lines flat on a plane: how far they are clear, and which turns say that no plate was met."""

from __future__ import annotations

import numpy as np
import pytest

from processing.methods.road.signs.fit_kernels import CLEAR_END, CLEAR_START, OPEN_START, V
from processing.methods.road.signs.piece_kernels import (
    BEFORE,
    BEHIND,
    COUNT,
    FIRST,
    FREE,
    FROM,
    HIDDEN,
    LAST,
    PIECE,
    SPACING,
    TO,
    VIEW,
)
from processing.methods.road.signs.plate_groups import PlateGroup, group_of
from processing.methods.road.signs.plate_lines import empty_lines, lines_of
from processing.methods.road.signs.scan_pieces import ScanPieces


def pieces_at(
    spans: list[tuple[int, float, float]], codes: list[tuple[int, int]]
) -> tuple[ScanPieces, PlateGroup]:
    """Level pieces on an upright plane: the turn of each, from where to where; 10 cm a turn."""
    values = np.zeros((len(spans), PIECE))
    for number, (turn, start, end) in enumerate(spans):
        values[number, FROM : FROM + 3] = (start, 0.0, 0.1 * turn)
        values[number, TO : TO + 3] = (end, 0.0, 0.1 * turn)
        values[number, [FIRST, LAST]] = 1000 * turn + 100 * start, 1000 * turn + 100 * end
    values[:, [BEFORE, BEHIND]] = codes
    values[:, COUNT], values[:, SPACING], values[:, VIEW + 1] = 10, 0.01, 1.0
    none = np.zeros(len(spans), np.int64)
    turns = np.array([turn for turn, _, _ in spans])
    pieces = ScanPieces(values, none, turns, np.zeros(len(spans)), none > 0)
    group = group_of(values, np.arange(len(spans)))
    assert group is not None
    return pieces, group


def test_a_line_is_clear_up_to_where_its_turn_meets_the_plane_again() -> None:
    spans = [(0, 0.0, 0.5), (1, 0.0, 0.2), (1, 0.3, 0.5), (2, 0.0, 0.5)]
    pieces, group = pieces_at(spans, [(FREE, FREE)] * 4)
    lines = lines_of(pieces, group)
    assert lines[1, CLEAR_END] == pytest.approx(0.1)
    assert lines[2, CLEAR_START] == pytest.approx(0.1)
    assert lines[[0, 0, 1, 3], [CLEAR_START, CLEAR_END, CLEAR_START, CLEAR_END]].tolist() == [0] * 4


@pytest.mark.parametrize(
    ("first", "count"), [((FREE, FREE), 2), ((HIDDEN, FREE), 2), ((HIDDEN, HIDDEN), 1)]
)
def test_beside_a_turn_that_lies_between_nearer_things_nothing_is_known(
    first: tuple[int, int], count: int
) -> None:
    spans = [(turn, 0.0, 0.5) for turn in range(4)]
    pieces, group = pieces_at(spans, [first] + [(FREE, FREE)] * 3)
    empty = empty_lines(pieces, group, lines_of(pieces, group))
    assert len(empty) == count
    assert (empty[:, OPEN_START] < 0).all()
    assert 0.25 in np.abs(empty[:, V]).round(3)
