"""What holds for any drawing: constructions, parallels, edits, far from the origin."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from processing.core.errors import OutOfRange
from processing.map.catalogue import Geometry
from processing.map.drafting.constructions import arc_through, rectangle_from, spline_through
from processing.map.drafting.crossings import crosses_itself
from processing.map.drafting.line_edits import (
    close_line,
    join,
    open_area,
    reverse_line,
    simplify_line,
    split_line,
    with_kind,
)
from processing.map.drafting.parallels import distance_to_line, parallel
from processing.map.feature import Feature, PointReference, Vertex
from tests.processing.map.drafting.positions import CORNER, distances_to, kind, local, positions

METRES = st.integers(-20_000, 20_000).map(lambda millimetres: millimetres / 1000)
HEIGHTS = st.integers(-500, 500).map(lambda millimetres: millimetres / 1000)
POSITIONS = st.tuples(METRES, METRES, HEIGHTS)
LINES = st.lists(POSITIONS, min_size=2, max_size=25, unique=True)
CURB, LID = kind("curb", Geometry.LINE), kind("lid", Geometry.AREA)


def measured(given_positions, geometry: Geometry = Geometry.LINE) -> Feature:
    """A feature each of whose vertices rests on a measured point of its own."""
    corners = tuple(
        Vertex(xyz, PointReference("left", number))
        for number, xyz in enumerate(positions(*given_positions))
    )
    return Feature("a", "curb", geometry, corners)


@st.composite
def smooth_lines(draw):
    """Lines of even curvature whose bends are wider than 12 m, a place every half metre."""
    bends = draw(st.lists(st.floats(-1 / 12, 1 / 12), min_size=1, max_size=3))
    headings = np.cumsum(np.repeat(bends, 20) * 0.5)
    steps = 0.5 * np.column_stack([np.cos(headings), np.sin(headings), 0.04 + 0 * headings])
    return positions(*np.concatenate([[[0.0, 0.0, 0.0]], np.cumsum(steps, axis=0)]))


@given(smooth_lines(), st.floats(0.1, 5.0), st.sampled_from([-1, 1]))
def test_a_parallel_of_a_smooth_line_keeps_its_distance_everywhere(line, distance, side):
    copy = parallel(line, side * distance)
    inner = (local(copy)[1:] + local(copy)[:-1]) / 2
    middles = [tuple(position) for position in (inner + CORNER).tolist()]
    for checked in (copy, middles):
        assert distances_to(line, checked) == pytest.approx(distance, abs=2e-3)
    assert np.sign([distance_to_line(line, position) for position in middles]) == pytest.approx(
        side
    )


@given(smooth_lines(), st.floats(0.1, 5.0), st.sampled_from([-1, 1]))
def test_a_parallel_there_and_back_is_the_line_again(line, distance, side):
    back = parallel(parallel(line, side * distance), -side * distance)
    assert local(back)[[0, -1]] == pytest.approx(local(line)[[0, -1]], abs=1e-6)
    assert distances_to(line, back).max() < 1e-6
    assert distances_to(back, line).max() < 1e-6


@settings(max_examples=60)
@given(LINES, st.floats(0.05, 6.0), st.sampled_from([-1, 1]))
def test_a_parallel_of_a_line_that_goes_on_eastwards_has_no_loops(line, distance, side):
    vertices = positions(*sorted(line))
    try:
        copy = parallel(vertices, side * distance)
    except OutOfRange:
        assume(False)
    assert np.isfinite(np.array(copy)).all()
    assert crosses_itself(copy, is_closed=False) is None


@settings(max_examples=60)
@given(LINES, st.floats(0.05, 6.0), st.booleans())
def test_any_line_has_a_parallel_or_is_refused(line, distance, is_closed):
    vertices = positions(*line)
    try:
        copy = parallel(vertices, distance, is_closed=is_closed and len(line) > 2)
    except OutOfRange:
        return
    assert len(copy) >= 2
    assert np.isfinite(np.array(copy)).all()


@given(POSITIONS, POSITIONS, POSITIONS, st.floats(0.001, 0.1))
def test_an_arc_passes_through_its_three_places_within_the_tolerance(one, two, three, tolerance):
    first, second, third = positions(one, two, three)
    arc = arc_through(first, second, third, tolerance)
    assert arc[0] == first
    assert arc[-1] == third
    assert second in arc
    assert np.isfinite(local(arc)).all()


@given(POSITIONS, POSITIONS, POSITIONS)
def test_a_rectangle_has_right_angles_on_the_plane_of_its_places(one, two, three):
    given_positions = positions(one, two, three)
    a, b, c = local(given_positions)
    assume(np.linalg.norm(b - a) > 0.05)
    width = np.linalg.norm(np.cross(b - a, c - a)) / np.linalg.norm(b - a)
    assume(width > 0.05)
    corners = local(rectangle_from(*given_positions))
    sides = np.roll(corners, -1, axis=0) - corners
    lengths = np.linalg.norm(sides, axis=1)
    cosines = (sides * np.roll(sides, -1, axis=0)).sum(axis=1) / (lengths * np.roll(lengths, -1))
    assert np.abs(cosines).max() < 1e-6
    assert lengths[1] == pytest.approx(width, rel=1e-6)
    normal = np.cross(b - a, c - a)
    assert np.abs((corners - a) @ (normal / np.linalg.norm(normal))).max() < 1e-6


@given(st.lists(POSITIONS, max_size=20))
def test_a_spline_passes_through_all_its_places_in_their_order(line):
    vertices = positions(*line)
    curve = spline_through(vertices, 0.05)
    assert np.isfinite(np.array(curve)).all()
    rest = iter(curve)
    changes = [p for n, p in enumerate(vertices) if n == 0 or p != vertices[n - 1]]
    assert all(position in rest for position in changes)


@given(LINES.filter(lambda line: len(line) > 2), st.data())
def test_split_then_join_is_the_line_again(line, data):
    whole = measured(line)
    corner = data.draw(st.integers(1, len(line) - 2))
    parts = split_line(whole, corner, whole.vertices[corner])
    gaps = [
        np.linalg.norm(np.subtract(parts[0].vertices[0].xyz, parts[1].vertices[end].xyz))
        for end in (0, -1)
    ]
    assume(min(gaps) > 0.002)
    assume(
        np.linalg.norm(np.subtract(parts[0].vertices[-1].xyz, parts[1].vertices[-1].xyz)) > 0.002
    )
    assert join(parts) == whole


@given(LINES)
def test_reversing_twice_is_the_identity(line):
    whole = measured(line)
    assert reverse_line(reverse_line(whole)) == whole


@given(LINES, st.floats(0.0, 10.0), st.booleans())
def test_simplifying_stays_within_the_tolerance_and_keeps_vertices(line, tolerance, is_ring):
    assume(not is_ring or len(line) >= 3)
    whole = measured(line, Geometry.AREA if is_ring else Geometry.LINE)
    simpler = simplify_line(whole, tolerance)
    kept = [whole.vertices.index(vertex) for vertex in simpler.vertices]
    assert kept == sorted(kept)
    assert len(kept) >= (3 if is_ring else 2)
    if not is_ring:
        assert {kept[0], kept[-1]} == {0, len(line) - 1}
    xyz = local(vertex.xyz for vertex in simpler.vertices)
    ends = np.roll(xyz, -1, axis=0) if is_ring else xyz[1:]
    starts = xyz if is_ring else xyz[:-1]
    for position in local(vertex.xyz for vertex in whole.vertices):
        steps, away = ends - starts, position - starts
        t = ((away * steps).sum(axis=1) / (steps**2).sum(axis=1)).clip(0, 1)
        assert np.linalg.norm(away - t[:, None] * steps, axis=1).min() <= tolerance + 1e-9
    before = crosses_itself([v.xyz for v in whole.vertices], is_closed=is_ring)
    if before is None:
        assert crosses_itself([v.xyz for v in simpler.vertices], is_closed=is_ring) is None


@given(LINES.filter(lambda line: len(line) > 2), st.data())
def test_no_vertex_that_stays_loses_its_measured_point(line, data):
    whole = measured(line)
    side = data.draw(st.integers(0, len(line) - 2))
    middle = Vertex(tuple(np.mean([whole.vertices[side + n].xyz for n in (0, 1)], 0).tolist()))
    edited = [reverse_line(whole), simplify_line(whole, 0.5), with_kind(whole, LID)]
    edited += [close_line(whole, CURB), open_area(with_kind(whole, LID), CURB, side)]
    if not any(np.linalg.norm(np.subtract(middle.xyz, v.xyz)) < 0.002 for v in whole.vertices):
        edited += split_line(whole, side, middle)
    measured_at = {vertex.xyz: vertex for vertex in whole.vertices}
    for feature in edited:
        for vertex in feature.vertices:
            assert vertex == measured_at.get(vertex.xyz, middle)
