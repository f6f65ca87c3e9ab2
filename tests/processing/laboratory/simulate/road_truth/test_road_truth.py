"""Truth of roads and of what hangs over them is that of what was built."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.road_truth.clearance_evidence import (
    ClearanceEvidence,
    read_places,
)
from processing.laboratory.simulate.road_truth.true_roads import (
    read_true_roads,
    true_roads,
    write_true_roads,
)
from processing.laboratory.simulate.scanning.returns import Returns
from processing.laboratory.simulate.scene.things import Thing
from processing.laboratory.simulate.street.styles import URBAN

ORIGIN = np.array([1000.0, 2000.0, 30.0])


@pytest.fixture(scope="module")
def street() -> Street:
    return Street(9581, URBAN, 20.0)


def test_widths_reach_to_the_feet_of_the_curbs(street: Street, tmp_path: Path) -> None:
    rows = true_roads(street, 20.0, ORIGIN)
    feet = [
        one.xyz
        for row in street.within(0.0, 20.0)
        for one in street.section(row).truth
        if one.file == "curbs" and one.facts["edge"] == "lower"
    ]
    places = np.concatenate(feet)[:, :2] + ORIGIN[:2]
    for one in rows:
        if not one.is_open:
            centre = np.array([one.easting_m, one.northing_m])
            nearest = np.hypot(*(places - centre).T).min()
            assert nearest == pytest.approx(min(one.left_m, one.right_m), abs=0.15)
            assert 0.5 < one.left_percent < 4.0
    write_true_roads(tmp_path / "road.csv", rows)
    again = read_true_roads(tmp_path / "road.csv")
    assert len(again) == len(rows)
    assert again[3].left_m == pytest.approx(rows[3].left_m, abs=1e-4)
    assert again[3].is_open == rows[3].is_open


def returns_at(street: Street, places: list[tuple[float, float, float]], instance: int) -> Returns:
    s, o, above = np.array(places, np.float64).T
    xyz = street.alignment.at(s, o, street.ground_height(s, o) + above)
    count = len(places)
    ones = np.ones(count, np.uint8)
    return Returns(
        np.arange(count), np.zeros(count), xyz, np.ones(count), ones, ones,
        np.full(count, 5, np.uint8), np.full(count, instance * 256, np.int64),
    )  # fmt: skip


def test_things_are_told_at_their_lowest_over_the_carriageway(
    street: Street, tmp_path: Path
) -> None:
    evidence = ClearanceEvidence(street, 20.0)
    evidence.count(returns_at(street, [(5.0, 1.0, 3.0), (6.0, 1.0, 3.5), (6.0, 30.0, 2.0)], 1))
    evidence.count(returns_at(street, [(9.0, 2.0, 0.5), (9.0, 2.0, 1.5)], 2))
    evidence.count(returns_at(street, [(12.0, 2.0, 1.5)], 3))
    things = {1: Thing(1, "tree"), 2: Thing(2, "pole"), 3: Thing(3, "car")}
    evidence.write(tmp_path, things, ORIGIN, "urn:ogc:def:crs:EPSG::6677")
    tree, pole = read_places(tmp_path / "clearance.geojson")
    assert (tree["type"], tree["points"]) == ("tree", 2)
    assert tree["lowest_m"] == pytest.approx(3.0, abs=0.01)
    assert (tree["from_m"], tree["to_m"]) == pytest.approx((5.0, 6.0), abs=0.05)
    assert not tree["is_standing"]
    assert pole["is_standing"]
