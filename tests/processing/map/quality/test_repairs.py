"""What is mended by rule is not found again, and nothing else changes."""

from __future__ import annotations

import pytest

from processing.map.catalogue import Geometry
from processing.map.catalogue_file import read_catalogue
from processing.map.feature import Feature, Position, Vertex
from processing.map.quality.map_check import check_map
from processing.map.quality.repairs import repair
from resources import path_of

_CATALOGUE = read_catalogue(path_of("catalogue/level500.toml"))


def _line(id_: str, *positions: Position, **own: str) -> Feature:
    return Feature(id_, "road_edge", Geometry.LINE, tuple(map(Vertex, positions)), own)


def _mended(*features: Feature) -> dict[str, Feature]:
    now = {one.id: one for one in features}
    change = repair(check_map(now.values(), _CATALOGUE).findings, now)
    for one in change.removed:
        del now[one.id]
    now.update({pair.after.id: pair.after for pair in change.replaced})
    return now


@pytest.mark.parametrize(
    ("other", "end"),
    [
        (((10.1, 0.1, 5.0), (20.0, 0.0, 5.0)), (10.1, 0.1, 5.0)),  # short of an end
        (((10.2, -5.0, 5.0), (10.2, 5.0, 5.2)), (10.2, 0.0, 5.1)),  # short of the middle
    ],
)
def test_an_end_is_put_onto_what_it_missed(other: tuple[Position, Position], end: Position) -> None:
    now = _mended(_line("a", (0.0, 0.0, 5.0), (10.0, 0.0, 5.0)), _line("b", *other))
    assert now["a"].vertices[-1].xyz == pytest.approx(end)
    assert now["a"].vertices[0].xyz == (0.0, 0.0, 5.0)
    assert now["b"].vertices == tuple(map(Vertex, other))
    assert check_map(now.values(), _CATALOGUE).findings == ()


def test_a_line_that_nearly_closes_is_closed() -> None:
    now = _mended(_line("a", (0, 0, 5), (9, 0, 5), (9, 9, 5), (0, 0.1, 5)))
    assert now["a"].vertices[-1] == now["a"].vertices[0]


def test_of_two_copies_the_fuller_one_stays_and_slips_go() -> None:
    whole = ((0.0, 0.0, 5.0), (10.0, 0.0, 5.0))
    now = _mended(
        _line("bare", *whole),
        _line("full", *whole, route="1"),
        _line("slip", (50, 0, 5), (50, 0, 5)),
    )
    assert set(now) == {"full"}


def test_what_a_person_must_decide_is_left() -> None:
    across = (
        _line("a", (0.0, 0.0, 5.0), (10.0, 10.0, 5.0)),
        _line("b", (0.0, 10.0, 5.0), (10.0, 0.0, 5.0)),
    )
    assert _mended(*across) == {one.id: one for one in across}
