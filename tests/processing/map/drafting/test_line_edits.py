"""Edits of lines and areas: what changes, what stays, what is refused."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from processing.core.errors import Unsuitable
from processing.core.text import Text
from processing.map.catalogue import AttributeField, Geometry
from processing.map.drafting.crossings import crosses_itself
from processing.map.drafting.line_edits import (
    close_line,
    extend_to,
    join,
    move_feature,
    open_area,
    reverse_line,
    simplify_line,
    split_line,
    trim_at,
    with_kind,
)
from processing.map.feature import Feature, PointReference, Status, Vertex
from tests.processing.map.drafting.positions import area, kind, line, local, positions

CURB, LID = kind("curb", Geometry.LINE), kind("lid", Geometry.AREA)


def local_of(feature: Feature) -> list[tuple[float, ...]]:
    return [
        tuple(position) for position in local(v.xyz for v in feature.vertices).round(6).tolist()
    ]


def test_a_line_split_at_a_vertex_shares_that_vertex() -> None:
    whole = line("a", (0, 0), (5, 0), (10, 0))
    first, second = split_line(whole, 0, Vertex(positions((5, 0.0004, 0))[0]))
    assert first.vertices == whole.vertices[:2]
    assert second.vertices == whole.vertices[1:]
    assert first.id == "a"
    assert second.id not in ("a", "")
    assert dataclasses.replace(second, id="a", vertices=first.vertices) == first


def test_a_line_split_inside_a_side_gets_the_place_at_both_ends() -> None:
    whole = line("a", (0, 0), (10, 0))
    position = Vertex(positions((4, 0, 0))[0], PointReference("right", 7))
    first, second = split_line(whole, 0, position)
    assert first.vertices == (whole.vertices[0], position)
    assert second.vertices == (position, whole.vertices[1])


def test_ends_areas_and_points_are_not_split() -> None:
    whole = line("a", (0, 0), (10, 0))
    for position in whole.vertices:
        with pytest.raises(Unsuitable) as refusal:
            split_line(whole, 0, position)
        assert "端点" in refusal.value.line("ja")
    with pytest.raises(Unsuitable):
        split_line(area("b", (0, 0), (1, 0), (1, 1)), 0, Vertex(positions((0.5, 0))[0]))
    with pytest.raises(IndexError):
        split_line(whole, 1, whole.vertices[0])


def test_lines_are_joined_at_their_nearest_ends_in_the_direction_of_the_first() -> None:
    first = line("a", (10, 0), (20, 0))
    before = line("b", (10, 0), (0, 0))
    after = line("c", (30, 0), (20.5, 0))
    joined = join([first, after, before])
    eastings = [position[0] for position in local_of(joined)]
    assert eastings == [0, 10, 20, 20.5, 30]
    assert joined.id == "a"
    assert all(vertex.measured is not None for vertex in joined.vertices)
    near = join([first, after], tolerance_m=0.6)
    assert [position[0] for position in local_of(near)] == [10, 20, 30]


def test_of_two_ends_in_one_place_the_measured_one_stays() -> None:
    first = line("a", (0, 0), (10, 0))
    loose = first.with_vertices((first.vertices[0], Vertex(first.vertices[1].xyz)))
    second = line("b", (10, 0), (20, 0))
    assert join([loose, second]).vertices[1] == second.vertices[0]
    assert join([first, second]).vertices[1] == first.vertices[1]


def test_joined_lines_keep_the_firsts_attributes_and_what_it_lacks() -> None:
    first = dataclasses.replace(
        line("a", (0, 0), (1, 0)),
        attributes={"height_m": 0.2, "note": None},
        status=Status.ACCEPTED,
    )
    second = dataclasses.replace(
        line("b", (1, 0), (2, 0)), attributes={"height_m": 0.1, "note": "縁石", "year": 3}
    )
    assert join([first, second]).attributes == {"height_m": 0.2, "note": "縁石", "year": 3}


def test_a_single_line_joins_to_itself_and_mixed_kinds_are_refused() -> None:
    first = line("a", (0, 0), (1, 0))
    assert join([first]) == first
    with pytest.raises(Unsuitable) as refusal:
        join([first, line("b", (1, 0), (2, 0), kind="wall")])
    assert "種別" in refusal.value.line("ja")
    with pytest.raises(Unsuitable):
        join([first, area("b", (0, 0), (1, 0), (1, 1))])


def test_a_ring_in_two_halves_joins_to_one_closed_line() -> None:
    halves = [line("a", (0, 0), (5, 1), (10, 0)), line("b", (0, 0), (5, -1), (10, 0))]
    joined = join(halves)
    assert len(joined.vertices) == 5
    assert joined.vertices[0].xyz == joined.vertices[-1].xyz


def test_a_line_goes_straight_on_to_another_with_its_slope() -> None:
    own = line("a", (0, 0, 0), (8, 0, 0.8))
    target = line("b", (12, -5, 9), (12, 5, 9))
    longer = extend_to(own, target, "end")
    assert longer.vertices[:2] == own.vertices
    assert local_of(longer)[2] == (12, 0, 1.2)
    back = extend_to(reverse_line(own), target, "start")
    assert local_of(back)[0] == (12, 0, 1.2)
    ring = area("c", (20, -2), (22, -2), (22, 2), (20, 2))
    assert local_of(extend_to(own, ring, "end"))[-1][:2] == (20, 0)


def test_a_line_that_already_ends_there_stays_and_one_that_misses_is_refused() -> None:
    own = line("a", (0, 0), (8, 0))
    assert extend_to(own, line("b", (8, -5), (8, 5)), "end") == own
    for target in (line("c", (12, 1), (12, 5)), line("d", (-4, -5), (-4, 5)), own):
        with pytest.raises(Unsuitable) as refusal:
            extend_to(own, target, "end")
        assert "延長" in refusal.value.line("ja")
    with pytest.raises(Unsuitable):
        extend_to(line("e", (0, 0, 0), (0, 0, 5)), line("b", (8, -5), (8, 5)), "end")


def test_a_line_goes_on_to_a_side_of_its_own() -> None:
    hook = line("a", (0, 0), (10, 0), (10, 5), (5, 5), (5, 2))
    assert local_of(extend_to(hook, hook, "end"))[-1] == (5, 0, 0)


def test_a_line_is_cut_where_another_crosses_it() -> None:
    own = line("a", (0, 0, 0), (10, 0, 1), (20, 0, 1))
    target = line("b", (4, -5), (4, 5))
    (east,) = positions((8, 1))
    kept = trim_at(own, target, east)
    assert local_of(kept) == [(4, 0, 0.4), (10, 0, 1), (20, 0, 1)]
    assert kept.vertices[1:] == own.vertices[1:]
    (west,) = positions((-3, 1))
    assert local_of(trim_at(own, target, west)) == [(0, 0, 0), (4, 0, 0.4)]


def test_between_two_crossings_the_middle_stays_and_a_vertex_on_one_is_used() -> None:
    own = line("a", (0, 0), (10, 0), (20, 0))
    ring = area("b", (4, -1), (10, -1), (10, 1), (4, 1))
    (inside,) = positions((7, 0))
    kept = trim_at(own, ring, inside)
    assert local_of(kept) == [(4, 0, 0), (10, 0, 0)]
    assert kept.vertices[1] == own.vertices[1]


def test_lines_that_dont_cross_are_not_trimmed() -> None:
    own = line("a", (0, 0), (10, 0))
    for target in (line("b", (4, 1), (4, 5)), line("c", (10, -5), (10, 5))):
        with pytest.raises(Unsuitable):
            trim_at(own, target, positions((1, 0))[0])


def test_a_straight_line_is_simplified_to_its_ends_and_a_step_stays() -> None:
    straight = line("a", (0, 0, 0), (3, 0.004, 0), (6, 0, 0), (10, 0, 0))
    assert simplify_line(straight, 0.005).vertices == (straight.vertices[0], straight.vertices[3])
    step = line("b", (0, 0, 0), (5, 0, 0), (5.01, 0, 0.15), (10, 0, 0.15))
    assert simplify_line(step, 0.005).vertices == step.vertices


def test_a_ring_never_falls_below_three_corners() -> None:
    round_lid = area("a", *((np.cos(a), np.sin(a)) for a in np.linspace(0, 6, 40)))
    for tolerance in (0.01, 0.5, 10.0):
        assert len(simplify_line(round_lid, tolerance).vertices) >= 3
    assert len(simplify_line(round_lid, 0.02).vertices) < 30
    triangle = area("b", (0, 0), (1, 0), (0, 1))
    assert simplify_line(triangle, 5.0) == triangle


def test_a_simplified_line_never_crosses_itself() -> None:
    # The bulge reaches around the tip of the other leg; without it they would cross.
    bulge = line("a", (0, 0), (4, 0), (5, 1.2), (6, 0), (10, 0), (10, -3), (5, -3), (5, 0.8))
    for tolerance in (0.1, 1.0, 1.3, 5.0):
        simpler = [vertex.xyz for vertex in simplify_line(bulge, tolerance).vertices]
        assert crosses_itself(simpler, is_closed=False) is None


def test_ten_thousand_vertices_are_simplified() -> None:
    wave = line("a", *((n / 100, np.sin(n / 300)) for n in range(10_000)))
    assert 20 < len(simplify_line(wave, 0.01).vertices) < 1000


def test_moved_vertices_no_longer_rest_on_points() -> None:
    own = line("a", (0, 0, 0), (1, 0, 0))
    other = move_feature(own, (1.0, -2.0, 0.5))
    assert local_of(other) == [(1, -2, 0.5), (2, -2, 0.5)]
    assert all(vertex.measured is None for vertex in other.vertices)
    assert move_feature(own, (0.0, 0.0, 0.0)) == own


def test_another_kind_keeps_the_attributes_that_it_has_too() -> None:
    own = dataclasses.replace(line("a", (0, 0), (1, 0)), attributes={"note": "x", "height_m": 1.0})
    wall = kind("wall", Geometry.LINE, AttributeField("height_m", Text.same("h"), "number"))
    changed = with_kind(own, wall)
    assert (changed.kind, changed.attributes) == ("wall", {"height_m": 1.0})
    assert changed.vertices == own.vertices


def test_lines_become_areas_and_back_where_they_have_three_places() -> None:
    own = line("a", (0, 0), (4, 0), (4, 4))
    ring = with_kind(own, LID)
    assert (ring.geometry, ring.vertices) == (Geometry.AREA, own.vertices)
    outline = with_kind(ring, CURB)
    assert outline.vertices == (*own.vertices, own.vertices[0])
    assert with_kind(outline, LID).vertices == own.vertices
    with pytest.raises(Unsuitable):
        with_kind(line("b", (0, 0), (4, 0)), LID)
    with pytest.raises(Unsuitable) as refusal:
        with_kind(own, kind("sign", Geometry.POINT))
    assert "種別" in refusal.value.line("ja")


def test_a_line_is_closed_as_its_kind_allows() -> None:
    own = line("a", (0, 0), (4, 0), (4, 4))
    assert close_line(own, LID).geometry is Geometry.AREA
    outline = close_line(own, CURB)
    assert outline.vertices == (*own.vertices, own.vertices[0])
    assert close_line(outline, CURB) == outline
    with pytest.raises(Unsuitable):
        close_line(line("b", (0, 0), (4, 0)), CURB)
    with pytest.raises(Unsuitable):
        close_line(area("c", (0, 0), (4, 0), (4, 4)), LID)


def test_a_ring_is_opened_at_the_vertex_that_is_asked_for() -> None:
    ring = area("a", (0, 0), (4, 0), (4, 4))
    assert local_of(open_area(ring, CURB, 1)) == [(4, 0, 0), (4, 4, 0), (0, 0, 0)]
    outline = close_line(line("b", (0, 0), (4, 0), (4, 4)), CURB)
    assert open_area(outline, CURB).vertices == outline.vertices[:-1]
    with pytest.raises(Unsuitable):
        open_area(line("c", (0, 0), (4, 0), (4, 4)), CURB)
    with pytest.raises(Unsuitable):
        open_area(ring, LID)
