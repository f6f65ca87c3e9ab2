"""Signs that are hard to see: half behind leaves, from behind, side by side on one post."""

from __future__ import annotations

import math

import numpy as np
import pytest

from processing.laboratory.simulate.roadside.sign_plates import PlateShape
from processing.laboratory.simulate.scene.mesh import TriangleShape, box
from processing.recording.drive import Drive
from processing.tools.tool import Candidate
from tests.processing.methods.road.bad_recordings import (
    HEAD_45,
    ORIGIN,
    DrivenRecording,
    RunOutcome,
    delivered,
    facing_along,
    imported,
    road_along,
    straight,
    told_by,
)
from tests.processing.tools.test_signs import KnownPlate, known, post, shine

LENGTH_M = 34.0
Y = 5.5
LEAFY = known("circle", 0.6, (8.0, Y, 2.5))
SHAPES: tuple[PlateShape, ...] = ("triangle", "diamond", "pentagon")
SIZES = (0.8, 0.6, 0.6)
FRONTS = tuple(
    known(shape, size, (12.0 + 4 * number, Y, 2.6))
    for number, (shape, size) in enumerate(zip(SHAPES, SIZES, strict=True))
)
BACKS = tuple(
    known(shape, size, (14.0 + 4 * number, Y, 2.6), 270.0)
    for number, (shape, size) in enumerate(zip(SHAPES, SIZES, strict=True))
)
BESIDE = (known("square", 0.6, (26.0, Y - 0.33, 2.5)), known("square", 0.6, (26.0, Y + 0.33, 2.5)))
ON_WALL = known("diamond", 0.6, (24.0, Y, 2.5))
"""Its plate is 2 cm before the wall, so that all scan lines go on beyond its rim."""

WALL = box((23.8, 4.0, 0.0), (23.98, 7.0, 4.0))
PLATES = (LEAFY, *FRONTS, *BACKS, *BESIDE, ON_WALL)


def leaves(plate: KnownPlate, *, seed: int = 3) -> list[TriangleShape]:
    """Leaves of 4 cm between the scanner and the half of a plate that is nearer to the road.

    The head looks back under 45°: what hides a place stands as far before it as nearer to the road.
    """
    random = np.random.default_rng(seed)
    found = []
    for _ in range(110):
        before = random.uniform(0.1, 0.4)
        x, z = plate.middle[0] + before, plate.middle[2] + random.uniform(-0.32, 0.32)
        y = plate.middle[1] - before - random.uniform(0.0, 0.32)
        found.append(box((x - 0.002, y - 0.02, z - 0.02), (x + 0.002, y + 0.02, z + 0.02)))
    return found


@pytest.fixture(scope="module")
def drives(tmp_path_factory: pytest.TempPathFactory) -> tuple[Drive, ...]:
    way, folder = straight(LENGTH_M), tmp_path_factory.mktemp("hard")
    scene = (
        road_along(LENGTH_M),
        *(one.shape for one in PLATES),
        *leaves(LEAFY),
        *(post(one.middle[0] - 0.06, Y, 2.9) for one in (LEAFY, *FRONTS)),
        *(post(one.middle[0] + 0.06, Y, 2.9) for one in BACKS),
        post(25.94, Y, 2.85),
        WALL,
        box((11.0, -6.1, 0.0), (20.0, -5.4, 1.83)),
    )
    request = delivered(
        DrivenRecording(way, facing_along(way), scene, head=HEAD_45, pulses=3_000), folder
    )
    shine(request.inputs[0], PLATES)
    return imported(folder, request)


@pytest.fixture(scope="module")
def told(drives: tuple[Drive, ...], tmp_path_factory: pytest.TempPathFactory) -> RunOutcome:
    return told_by("signs", drives, tmp_path_factory.mktemp("found"))


def sign_at(told: RunOutcome, plate: KnownPlate) -> Candidate:
    place = plate.centroid + ORIGIN
    (found,) = (one for one in told.candidates if math.dist(one.xyz[0], place) < 0.2)
    return found


def check(told: RunOutcome, plate: KnownPlate, within_m: float = 0.03) -> None:
    found = sign_at(told, plate)
    assert found.attributes["shape"] == plate.plate.shape
    assert found.attributes["size_m"] == pytest.approx(plate.plate.size_m, rel=0.1)
    assert math.dist(found.xyz[0], plate.centroid + ORIGIN) < within_m
    facing = found.attributes["facing_deg"]
    assert isinstance(facing, float)
    assert abs((facing - plate.facing_deg + 180) % 360 - 180) < 3.0


def test_a_plate_half_behind_leaves_is_found_whole(
    drives: tuple[Drive, ...], told: RunOutcome
) -> None:
    flat = drives[0].xyz(slice(0, drives[0].count)) - ORIGIN - LEAFY.middle
    on = flat[(np.abs(flat[:, 0]) < 0.015) & (np.hypot(flat[:, 1], flat[:, 2]) < 0.3)]
    behind, open_half = int((on[:, 1] < 0).sum()), int((on[:, 1] > 0).sum())
    assert behind < 0.5 * open_half
    check(told, LEAFY)


@pytest.mark.parametrize("number", range(len(SHAPES)), ids=SHAPES)
def test_the_back_of_a_sign_says_the_same_as_its_front(told: RunOutcome, number: int) -> None:
    for plate in (FRONTS[number], BACKS[number]):
        check(told, plate)
    assert sign_at(told, FRONTS[number]).attributes["front_seen"] is True
    assert sign_at(told, BACKS[number]).attributes["front_seen"] is False


def test_plates_side_by_side_on_one_post_are_two(told: RunOutcome) -> None:
    for plate in BESIDE:
        check(told, plate)
        assert sign_at(told, plate).attributes["plates"] == 2


def test_a_plate_on_a_wall_is_found_by_where_it_stops_shining(told: RunOutcome) -> None:
    check(told, ON_WALL)


def test_leaves_and_a_machine_are_no_signs(told: RunOutcome) -> None:
    assert len(told.candidates) == len(PLATES)
