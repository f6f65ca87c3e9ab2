"""Ground of simulated landscapes from the air, as the page shows it."""

from __future__ import annotations

from processing.laboratory.accuracy.filters.landscape_ground import (
    FLIGHTS,
    Flight,
    landscape_rows,
)
from processing.laboratory.simulate.airborne.landscapes import KINDS


def test_every_kind_of_landscape_that_is_hard_for_filters_is_flown_over() -> None:
    # A village is easy ground: only classes are learnt from it.
    assert set(FLIGHTS) == set(KINDS) - {"village"}


def test_the_ground_of_a_river_and_an_embankment_is_found() -> None:
    flights = {"river": Flight(150.0, 3.2), "embankment": Flight(150.0, 3.2)}
    head, river, embankment, mean = landscape_rows(flights, [7])
    assert head[:4] == ["kind", "spacing", "points", "adaptive, total"]
    for row in (river, embankment):
        assert int(row[2].replace(",", "")) > 1000
        assert float(row[3].removesuffix(" %")) < 4
    assert mean[0] == "**mean**"
    assert len(mean) == len(head)
