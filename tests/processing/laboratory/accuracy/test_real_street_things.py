"""Scoring things of streets that were labelled by hand, on made points whose labels are exact."""

from __future__ import annotations

from pathlib import Path

import laspy
import numpy as np
from numpy.typing import NDArray

from processing.laboratory.accuracy.real_street_things import (
    DATA_SETS,
    HEADING,
    SearchedStreet,
    ThingScore,
    found_things,
    main,
    wire_points,
)
from processing.tools.tool import Candidate

OAKLAND = DATA_SETS[0]
POLE, WALL, NOBODY_NAMED, WIRE = 1103, 1401, 1001, 1100
UNKNOWN = np.array([-1])


def upright(east: float, count: int, high_m: float = 4.0) -> NDArray[np.float64]:
    """Points on the axis of something upright."""
    return np.column_stack([np.full(count, east), np.zeros(count), np.linspace(0, high_m, count)])


def street(things: dict[int, NDArray[np.float64]], **found: list[Candidate]) -> SearchedStreet:
    """A street of points by their labels."""
    label = np.repeat([*things], [len(one) for one in things.values()])
    candidates = {name: tuple(some) for name, some in found.items()}
    return SearchedStreet(OAKLAND, np.concatenate([*things.values()]), label, candidates)


def pole_at(east: float) -> Candidate:
    return Candidate("pole", "point", np.array([[east, 0.0, 0.0]]), UNKNOWN, 0.9)


def told(found: ThingScore) -> tuple[list[int], list[bool], int]:
    return found.points.tolist(), found.found.tolist(), found.wrong


def test_things_are_paired_one_to_one_and_what_stands_on_something_else_is_false() -> None:
    poles = np.concatenate([upright(0.0, 30), upright(10.0, 60), upright(20.0, 19)])
    things = {POLE: poles, WALL: upright(30.0, 50), NOBODY_NAMED: upright(40.0, 50)}
    candidates = [pole_at(0.2), pole_at(0.4), pole_at(20.0), pole_at(30.1), pole_at(40.0)]
    # The second stands on a pole that has one, the third on too few points, the last on nobody's.
    assert told(found_things(street(things, poles=candidates), "poles")) == (
        [30, 60],
        [True, False],
        1,
    )


def test_a_pole_under_a_plate_is_not_false_and_what_stands_in_foliage_is_told() -> None:
    things = {1111: upright(0.0, 50), 1300: upright(10.0, 50), WALL: upright(20.0, 50)}
    candidates = [pole_at(0.1), pole_at(10.0), pole_at(20.0)]
    poles = found_things(street(things, poles=candidates), "poles")
    assert (poles.wrong, poles.in_leaves) == (2, 1)
    trunks = found_things(street(things, trunks=candidates), "trunks")
    assert (trunks.wrong, trunks.in_leaves) == (3, 1)


def test_low_things_are_none_but_for_signs() -> None:
    low = upright(0.0, 40, high_m=0.5)
    assert told(found_things(street({POLE: low}, poles=[]), "poles"))[0] == []
    assert told(found_things(street({1111: low}, signs=[]), "signs"))[0] == [40]


def test_wires_count_by_their_points_and_by_length() -> None:
    along = np.linspace(0.0, 20.0, 201)
    true = np.column_stack([along, np.zeros(201), np.full(201, 6.0)])
    line = np.array([[0.0, 0.1, 6.0], [10.0, 0.1, 6.0]])
    wire = Candidate("wire", "line", line, np.full(2, -1), 0.9)
    on_wall = np.array([[0.0, 30.0, 3.0], [10.0, 30.0, 3.0]])
    other = Candidate("wire", "line", on_wall, np.full(2, -1), 0.9)
    wall = true + np.array([0.0, 30.0, -3.0])
    found = wire_points(street({WIRE: true, WALL: wall}, wires=[wire, other]))
    assert found.labelled == 201
    assert abs(found.hit - 102) <= 2
    assert (found.wrong, found.all) == (100, 200)


def test_the_page_tells_of_a_street_on_which_nothing_stands(tmp_path: Path) -> None:
    rng = np.random.default_rng(3)
    header = laspy.LasHeader(point_format=0, version="1.2")
    header.scales = np.full(3, 0.001)
    cloud = laspy.LasData(header)
    cloud.x, cloud.y = rng.uniform(0, 30, (2, 20_000))
    cloud.z = rng.normal(0, 0.005, 20_000)
    folder = tmp_path / "street_oakland"
    (folder / "truth").mkdir(parents=True)
    cloud.write(folder / "piece.las")
    (folder / "piece.las").rename(folder / "piece.laz")
    np.savez(folder / "truth" / "piece.npz", label=np.full(20_000, 1202))
    page = tmp_path / "page.md"
    page.write_text(f"{HEADING}\nold\n", "utf-8")
    assert main([str(tmp_path), "--markdown", str(page)]) == 0
    words = page.read_text("utf-8")
    assert "| street_oakland | poles | 0, 0, 0 | 0.0 % | 0 | 0 of 0 | 0 of 0 | 0 of 0 |" in words
    assert "| street_oakland | 0 | – | 0 m | 0 m |" in words
