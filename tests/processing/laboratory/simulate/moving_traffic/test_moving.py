"""Traffic of a pass: nobody drives through anybody, and time alone decides who comes."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.moving_traffic.moving import MOST_INSTANCES, movers_of
from processing.laboratory.simulate.moving_traffic.walking import Walks
from processing.laboratory.simulate.scanning.simulated_passes import Driving, SimulatedPass, pass_of
from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.scene.things import Mover
from processing.laboratory.simulate.street.styles import HIGHWAY, RURAL, STYLES, URBAN
from processing.laboratory.simulate.traffic.lanes import TrafficLane
from processing.laboratory.simulate.traffic.parked_vehicles import Footprint

OWN_HALF_M = (2.4, 0.9)


def pass_along(street: Street, number: int = 0) -> SimulatedPass:
    speed = float(np.mean(street.style.speed_m_s))
    return pass_of(street, number, Driving(speed, stops=True, drift_m=0.0))


def footprint(mover: Mover, time_s: float) -> Footprint | None:
    """Where its widest part is, by chainage and offset; mirrors are left out."""
    if not mover.from_s <= time_s <= mover.to_s:
        return None
    at, aside = (float(one) for one in mover.direction_at(time_s))
    reach = np.abs(mover.mesh.vertices).max(axis=0)
    wide = min(float(reach[1]), 1.25) - (0.16 if reach[1] > 0.7 else 0.0)
    return Footprint(at, aside, mover.turn_rad, float(reach[0]), wide)


@pytest.mark.parametrize("number", [0, 1])
@pytest.mark.parametrize("style", STYLES)
def test_no_mover_drives_through_another_or_the_recording_vehicle(style: str, number: int) -> None:
    met = 0
    for seed in range(2):
        street = Street(seed + 2, STYLES[style], 60.0)
        driven = pass_along(street, number)
        movers = movers_of(street, driven)
        lane = street.plans[0].lane_offset_m(0) * (-1 if number else 1)
        for time in np.arange(0.0, driven.duration_s, 2.3).tolist():
            there = [one for mover in movers if (one := footprint(mover, time)) is not None]
            met += len(there)
            own = Footprint(float(driven.chainage_at(np.array(time))), lane, 0.0, *OWN_HALF_M)
            assert not any(own.touches(one) for one in there)
            near = [one for one in there if abs(one.x - own.x) < 160]
            for one, other in combinations(near, 2):
                if abs(one.x - other.x) < 13:
                    assert not one.touches(other), (seed, time, one, other)
    assert met > 20


def test_a_longer_recording_begins_like_a_shorter_one() -> None:
    short, long = Street(4, URBAN, 60.0), Street(4, URBAN, 180.0)
    one, other = (
        _seen(movers_of(street, pass_along(street)), pass_along(short).duration_s * 0.8, short)
        for street in (short, long)
    )
    assert one.shape[0] > 3
    np.testing.assert_allclose(one, other, atol=1e-6)


def _seen(movers: list[Mover], time_s: float, street: Street) -> Floats:
    """Chainages, offsets and headings of what is near at a time."""
    own = float(pass_along(street).chainage_at(np.array(time_s)))
    rows = []
    for mover in movers:
        at, aside = (float(one) for one in mover.direction_at(time_s))
        if mover.from_s <= time_s <= mover.to_s and abs(at - own) < 140:
            rows.append((at, aside, mover.turn_rad, float(mover.mesh.vertices.sum())))
    return np.array(sorted(rows))


def test_oncoming_traffic_keeps_coming() -> None:
    street = Street(7, HIGHWAY, 1500.0)
    driven = pass_along(street)
    oncoming = [one for one in movers_of(street, driven) if one.speed_m_s < 0]
    for start in np.arange(5.0, driven.duration_s - 30, 20.0).tolist():
        assert any(one.from_s < start + 30 and one.to_s > start for one in oncoming)
    assert all(one.offset_m < 0 and one.turn_rad == np.pi for one in oncoming)


def test_every_mover_has_its_own_number_and_label() -> None:
    street = Street(2, URBAN, 90.0)
    movers = movers_of(street, pass_along(street))
    numbers = [np.unique(one.mesh.instance).tolist() for one in movers]
    assert numbers == [[row] for row in range(1, len(movers) + 1)]
    assert len(movers) < MOST_INSTANCES
    assert all((one.mesh.label == 64).all() for one in movers)
    back = movers_of(street, pass_along(street, 1))
    assert min(int(one.mesh.instance[0]) for one in back) == MOST_INSTANCES + 1


def test_companions_wait_with_the_recording_vehicle() -> None:
    found = 0
    for seed in range(5):
        street = Street(seed, RURAL, 30.0)
        driven = pass_along(street)
        for one in movers_of(street, driven):
            if one.course is not None:
                times = np.linspace(0, driven.duration_s * 0.99, 50)
                gap = np.abs(one.direction_at(times)[0] - driven.chainage_at(times))
                assert np.ptp(gap) < 3.5
                found += 1
    assert found > 3


def test_people_walk_on_walks_only() -> None:
    walkers = 0
    for seed in range(2):
        street = Street(seed, URBAN, 60.0)
        driven = pass_along(street)
        for one in movers_of(street, driven):
            if one.kind not in ("person", "bicycle") or one.aside_m_s:
                continue
            times = np.linspace(max(0, one.from_s), min(driven.duration_s, one.to_s), 9)
            at, aside = one.direction_at(times)
            for s, o in zip(at.tolist(), aside.tolist(), strict=True):
                plan = street.plans[street.within(s, s)[0]]
                walk = plan.side(1 if o > 0 else -1).band("walk")
                assert walk is not None
                assert walk.inner_m < abs(o) < walk.outer_m
                walkers += 1
    assert walkers > 50


def test_people_cross_the_whole_road_when_nothing_comes() -> None:
    crossing = 0
    for seed in (1, 6):
        street = Street(seed, URBAN, 120.0)
        driven = pass_along(street)
        plan = street.plans[0]
        for one in movers_of(street, driven):
            if one.aside_m_s:
                crossing += 1
                _, aside = one.direction_at([one.from_s, one.to_s])
                assert sorted(np.sign(aside).tolist()) == [-1, 1]
                assert np.abs(aside).max() < max(plan.left.edge_m, plan.right.edge_m)
                times = np.linspace(one.from_s, min(one.to_s, driven.duration_s), 9)
                away = np.abs(driven.chainage_at(times) - one.direction_at(times)[0])
                assert away.min() > 5
    assert crossing > 1


def test_people_keep_clear_of_posts_and_trees_on_wide_walks() -> None:
    wide = 0
    for seed in range(12):
        street = Street(seed, URBAN, 60.0)
        walks = Walks(seed, street.plans)
        for plan in street.plans:
            walk = plan.left.band("walk")
            if walk is None or plan.left.strip_m or walk.outer_m - walk.inner_m < 2.6:
                continue
            wide += 1
            middle = np.array([(plan.start_m + plan.end_m) / 2])
            for offset in (walk.inner_m + 0.7, walk.inner_m + 1.0, walk.outer_m - 0.5):
                lane = TrafficLane("walkers", 0, offset, 1.0, 0.0, 3.0, 1.0, {"person": 1.0}, 1.3)
                assert not walks.has_room(lane, middle).any()
    assert wide > 3
