"""Wires told from points by construction: side by side, held at a pole, before a wall."""

from __future__ import annotations

import numpy as np
import pytest

from processing.core.arrays import Floats
from processing.core.monitor import SilentMonitor
from processing.methods.road.wires.solid_cells import SolidCells, solid_keys
from processing.methods.road.wires.spans import WireSpan, spans_of
from processing.methods.road.wires.wire_confidence import chance_of, facts_of
from processing.methods.road.wires.wire_points import WirePoints, points_on_lines

NOISE_M = 0.004
NOTHING = SolidCells([])


def cable(start: Floats, end: Floats, sag_m: float, points: int = 400) -> Floats:
    """Points along a hanging cable."""
    random = np.random.default_rng(points)
    share = np.sort(random.uniform(0.0, 1.0, points))[:, None]
    path: Floats = start + share * (end - start)
    path[:, 2] -= sag_m * (4 * share * (1 - share))[:, 0]
    return np.asarray(path + random.normal(0.0, NOISE_M, path.shape))


def on_lines(*parts: Floats, solid: SolidCells = NOTHING) -> WirePoints:
    local = np.concatenate(parts)
    none = np.zeros(len(local), np.int64)
    return points_on_lines(local, none, np.arange(len(local)), solid, SilentMonitor())


def spans(found: WirePoints) -> list[WireSpan]:
    return sorted(spans_of(found, SilentMonitor()), key=lambda one: -one.long_m)


def test_cables_that_hang_closer_than_their_free_room_are_told_apart() -> None:
    low, high = 6.0, 6.06
    pair = [
        cable(np.array([0.0, 0.0, one]), np.array([28.0, 0.0, one]), 0.5) for one in (low, high)
    ]
    found = spans(on_lines(*pair))
    assert len(found) == 2
    heights = sorted(float(one.at(one.along(np.array([[14.0, 0.0]])))[0, 2]) for one in found)
    assert heights == pytest.approx([low - 0.5, high - 0.5], abs=0.01)
    assert min(one.long_m for one in found) > 27.0


def test_a_row_of_cables_loses_none_of_them() -> None:
    row = [
        cable(np.array([0.0, 0.0, 5.0 + one]), np.array([28.0, 0.0, 5.0 + one]), 0.5, 500)
        for one in (0.0, 0.07, 0.14)
    ]
    assert [one.long_m > 27.0 for one in spans(on_lines(*row))] == [True] * 3


@pytest.mark.parametrize("few", [1.0, 0.15])
def test_spans_that_meet_at_an_angle_are_two_wires(few: float) -> None:
    # The second span has fewer points: a vehicle that waited under the first one.
    pole, bend = np.array([0.0, 0.0, 7.0]), np.radians(8.0)
    far = pole + 22.0 * np.array([np.cos(bend), np.sin(bend), 0.0])
    first = cable(pole - [25.0, 0.0, 0.0], pole, 0.5, 3_000)
    second = cable(pole, far, 0.4, int(3_000 * few))
    found = spans(on_lines(first, second))
    assert [round(one.long_m) for one in found] == [25, 22]
    ends = found[1].at(np.array([found[1].start_m, found[1].end_m]))
    assert np.linalg.norm(ends - far, axis=1).min() < 0.1


def test_a_wire_is_followed_to_its_pole_through_what_crowds_it() -> None:
    wire = cable(np.array([0.0, 0.0, 6.0]), np.array([30.0, 0.0, 6.0]), 0.5, 600)
    random = np.random.default_rng(5)
    crowd = random.uniform((28.2, -0.6, 5.4), (30.0, 0.6, 6.6), (700, 3))
    found = spans(on_lines(wire, crowd))
    assert found[0].long_m == pytest.approx(30.0, abs=0.4)


def test_a_line_on_a_wall_is_less_sure_than_the_same_in_the_air() -> None:
    line = cable(np.array([0.0, 0.15, 6.0]), np.array([8.0, 0.15, 6.0]), 0.05, 120)
    east, up = np.meshgrid(np.arange(0.0, 8.0, 0.05), np.arange(3.5, 9.0, 0.05))
    wall = np.column_stack([east.ravel(), np.full(east.size, 0.4), up.ravel()])
    solid = SolidCells([solid_keys(wall, np.ones(len(wall), np.bool_))])
    free, walled = (spans(on_lines(line, solid=one))[0] for one in (NOTHING, solid))
    assert facts_of(walled, solid).walled == 1.0
    assert facts_of(free, NOTHING).walled == 0.0
    assert chance_of(facts_of(walled, solid)) < 0.2 * chance_of(facts_of(free, NOTHING))


def test_what_is_a_metre_off_is_not_beside_a_line() -> None:
    place = np.array([[0.0, 0.0, 5.0]])
    solid = SolidCells([solid_keys(place, np.ones(1, np.bool_))])
    asked = np.array([[0.2, 0.0, 5.0], [0.0, -1.0, 5.0], [0.0, 0.0, 5.2], [2.0, 2.0, 9.0]])
    assert solid.share_beside(asked) == 0.5
    assert solid.share_beside(asked[:0]) == 0.0
