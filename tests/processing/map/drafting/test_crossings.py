"""Where lines meet: themselves, one another, and what the cursor may snap to."""

from __future__ import annotations

import numpy as np
import pytest

from processing.map.drafting.crossings import crosses_itself, line_positions
from tests.processing.map.drafting.positions import CORNER, local, positions


def _crossing(*given: tuple[float, float], is_closed: bool) -> tuple[float, float] | None:
    found = crosses_itself(positions(*given), is_closed=is_closed)
    return None if found is None else tuple(np.round(np.array(found) - CORNER[:2], 6).tolist())


def test_a_bow_tie_crosses_itself_in_its_middle() -> None:
    assert _crossing((0, 0), (2, 2), (2, 0), (0, 2), is_closed=True) == (1, 1)
    assert _crossing((0, 0), (2, 2), (2, 0), (0, 2), is_closed=False) == (1, 1)


def test_simple_lines_and_rings_dont_cross_themselves() -> None:
    square = ((0, 0), (2, 0), (2, 2), (0, 2))
    assert _crossing(*square, is_closed=True) is None
    assert _crossing(*square, is_closed=False) is None
    assert _crossing(*square, square[0], is_closed=False) is None
    assert _crossing((0, 0), (4, 0), (4, 2), (2, 2), (2, 0), is_closed=False) is None
    assert _crossing((0, 0), (4, 0), (4, 0), (4, 4), is_closed=True) is None
    assert _crossing((0, 0), (1, 0), is_closed=True) is None
    assert _crossing((0, 0), is_closed=False) is None


def test_the_closing_side_counts_only_in_a_ring() -> None:
    hook = ((0, 0), (4, 0), (4, 4), (1, 4), (1, -2))
    assert _crossing(*hook, is_closed=False) == (1, 0)
    late = ((0, 0), (4, 0), (4, 4), (6, 4), (6, -2), (2, -2), (2, -1))
    assert _crossing(*late, is_closed=False) is None
    assert _crossing(*late, (5, 5), is_closed=False) is not None
    only_closing = ((0, 0), (0, 4), (2, 4), (2, 1), (4, 1), (4, 3), (6, 3), (6, 0.5), (3, 2))
    assert _crossing(*only_closing, is_closed=False) == (4, 1.5)
    assert _crossing(*only_closing[:4], (4, 4), is_closed=False) is None
    assert _crossing(*only_closing[:4], (4, 4), is_closed=True) == (2, 2)


def test_a_ring_that_touches_or_runs_over_itself_is_told() -> None:
    assert _crossing((0, 0), (4, 0), (2, 2), (2, 0), (0, 2), is_closed=True) is not None
    over = ((0, 0), (4, 0), (4, 2), (3, 2), (3, 0), (1, 0), (1, 2), (0, 2))
    assert _crossing(*over, is_closed=True) is not None


def test_ten_thousand_vertices_that_cross_once_are_found() -> None:
    angles = np.linspace(0, 2 * np.pi, 10_000, endpoint=False)
    ring = [(100 * np.cos(a), 100 * np.sin(a)) for a in angles]
    assert _crossing(*ring, is_closed=True) is None
    ring[5000], ring[5003] = ring[5003], ring[5000]
    assert _crossing(*ring, is_closed=True) is not None


def test_lines_that_cross_everywhere_answer_with_the_first() -> None:
    random = np.random.default_rng(0)
    scribble = [tuple(position) for position in random.uniform(0, 10, (3000, 2))]
    found = _crossing(*scribble, is_closed=False)
    assert found is not None
    assert 0 <= found[0] <= 10


def _found(near, lines, reach=0.5, from_=None) -> list[tuple[str, tuple[float, ...], float]]:
    (cursor,) = positions(near)
    start = None if from_ is None else positions(from_)[0]
    given = line_positions(cursor, [positions(*line) for line in lines], reach, from_=start)
    return [
        (one.what, tuple(local([one.xyz])[0].round(6).tolist()), round(one.distance_m, 6))
        for one in given
    ]


def test_the_nearest_place_of_a_line_has_the_lines_height() -> None:
    assert _found((5, 0.3, 0.5), [((0, 0, 0), (10, 0, 1))]) == [("line", (5, 0, 0.5), 0.3)]


def test_a_vertex_stands_for_the_line_that_it_ends() -> None:
    found = _found((9.9, 0.1, 0), [((0, 0, 0), (10, 0, 0))])
    assert ("vertex", (10, 0, 0), 0.141421) in found
    assert found[0] == ("line", (9.9, 0, 0), 0.1)
    assert [what for what, position, _ in found if position == (10, 0, 0)] == ["vertex"]


def test_two_lines_cross_at_the_height_nearer_to_the_cursor() -> None:
    lines = [((0, 0, 0), (10, 0, 0)), ((5, -5, 0.3), (5, 5, 0.3))]
    low, high = _found((5.1, 0.1, 0.05), lines), _found((5.1, 0.1, 0.25), lines)
    assert ("intersection", (5, 0, 0.0), 0.141421) in low
    assert ("intersection", (5, 0, 0.3), 0.141421) in high


def test_places_on_another_level_are_no_candidates() -> None:
    assert _found((5, 0.1, 6), [((0, 0, 0), (10, 0, 0))]) == []
    assert _found((5, 0.1, 0.4), [((0, 0, 0), (10, 0, 0))]) != []


def test_a_line_is_offered_beyond_its_end_with_its_slope() -> None:
    line = ((0, 0, 0), (10, 0, 0.2))
    assert _found((12, 0.1, 0.24), [line]) == [("extension", (12, 0, 0.24), 0.1)]
    assert _found((-1, 0.1, 0), [line]) == [("extension", (-1, 0, -0.02), 0.1)]
    assert _found((15.6, 0.0, 0.3), [line], reach=0.5) == []
    ring = ((0, 0), (4, 0), (4, 4), (0, 0))
    assert [what for what, *_ in _found((-0.3, -0.3), [ring])] == ["vertex"]


def test_continuations_cross_lines_and_each_other() -> None:
    lines = [((0, 0), (10, 0)), ((12, 2), (12, 6))]
    assert ("intersection", (12, 0, 0), 0.141421) in _found((12.1, 0.1), lines)
    lines = [((0, 0), (10, 0)), ((12, -6), (12, 6))]
    assert ("intersection", (12, 0, 0), 0.141421) in _found((12.1, 0.1), lines)


def test_the_foot_of_the_perpendicular_is_offered_inside_a_line() -> None:
    line = [((0, 0), (10, 0))]
    found = _found((5.2, 0.1), line, from_=(5, 7))
    assert ("perpendicular", (5, 0, 0), 0.223607) in found
    assert all(what != "perpendicular" for what, *_ in _found((0.1, 0.1), line, from_=(-5, 7)))


def test_points_and_empty_maps_have_their_places() -> None:
    assert _found((0, 0), []) == []
    assert _found((0.1, 0), [((0, 0, 0),)]) == [("vertex", (0, 0, 0), 0.1)]
    assert _found((50, 50), [((0, 0), (1, 0))]) == []


def test_the_nearest_comes_first() -> None:
    found = _found((5.1, 0.2), [((0, 0), (5, 0), (10, 0)), ((0, 1), (10, 1))], reach=2.0)
    gaps = [distance for *_, distance in found]
    assert gaps == sorted(gaps)
    assert gaps[0] == pytest.approx(0.2)
