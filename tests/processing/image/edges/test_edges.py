"""Snapping to edges, bottoms and tops, on streets whose cross-section is known exactly."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from processing.core.arrays import Floats
from processing.image.edges.edge_kernels import (
    BEND,
    CORNER_COLUMNS,
    MOST_CORNERS,
    SectionLimits,
    corners_kernel,
)
from processing.image.edges.edges import edge_beside, highest_point, lowest_point
from processing.image.edges.step_kernels import HEADING, JUMP, STEP, UNKNOWNS, step_kernel
from processing.image.neighbourhoods.points_around import neighbours
from processing.recording.drive import Drive
from tests.processing.image.profiled_streets import (
    LOWER,
    START,
    UPPER,
    ProfiledStreet,
    off_line,
    recorded,
)

DROPPED = ((-2.5, 0.05), (0.0, 0.0), (0.01, 0.02), (1.5, 0.08))


def clicks(drive: Drive, street: ProfiledStreet, corner: Floats, aside_px: int) -> list[int]:
    """Points so many pixels beside an edge, along the middle of the street."""
    xyz, pulses = drive.xyz(slice(0, drive.count)), np.asarray(drive.columns["pulse"])
    line = street.edge(corner)
    chosen = []
    for position in line[150:-150:40]:
        nearest = int(np.linalg.norm(xyz - position, axis=1).argmin())
        beside = np.flatnonzero(pulses == pulses[nearest] + aside_px)
        chosen += [int(point) for point in beside]
    assert chosen
    return chosen


def snapped(drive: Drive, points: list[int]) -> Floats:
    found = [
        position.xyz for point in points if (position := edge_beside(drive, point)) is not None
    ]
    assert len(found) == len(points)
    return np.array(found)


@pytest.mark.parametrize("corner", [LOWER, UPPER], ids=["lower", "upper"])
@pytest.mark.parametrize(
    "street",
    [
        ProfiledStreet(),
        ProfiledStreet(noise_m=0.005, length_m=14.0),
        ProfiledStreet(row_m=0.17, spacing_m=0.05),
        ProfiledStreet(row_m=0.05, spacing_m=0.006),
        ProfiledStreet(curvature=0.15),
        ProfiledStreet(grade=-0.09, heading_rad=3.0),
    ],
    ids=["plain", "noisy", "60 km/h", "dense", "bend of 7 m radius", "steep"],
)
def test_a_click_on_a_curb_edge_goes_to_that_edge(
    tmp_path: Path, street: ProfiledStreet, corner: Floats
) -> None:
    drive = recorded(tmp_path / "drive", street)
    found = snapped(drive, clicks(drive, street, corner, 0))
    off = off_line(found, street.edge(corner))
    # Where noise spoils one edge, the other one of the same curb is the nearest that there is.
    assert (off < 0.02).mean() >= 0.85


@pytest.mark.parametrize("aside_px", [-8, -4, 4, 8])
def test_a_click_up_to_eight_pixels_beside_a_curb_goes_to_an_edge_of_it(
    tmp_path: Path, aside_px: int
) -> None:
    street = ProfiledStreet()
    drive = recorded(tmp_path / "drive", street)
    corner = LOWER if aside_px < 0 else UPPER
    found = snapped(drive, clicks(drive, street, corner, aside_px))
    assert (off_line(found, street.edge(corner)) < 0.02).mean() >= 0.9


@pytest.mark.parametrize("aside_px", [-6, -3, 0, 5])
@pytest.mark.parametrize(
    "street",
    [
        ProfiledStreet(profile=DROPPED, length_m=14.0),
        ProfiledStreet(profile=DROPPED, length_m=14.0, noise_m=0.004),
        ProfiledStreet(profile=DROPPED, length_m=14.0, row_m=0.17, spacing_m=0.05),
        ProfiledStreet(profile=DROPPED, length_m=14.0, curvature=0.08, grade=-0.06),
        ProfiledStreet(
            profile=((-2.5, 0.05), (0.0, 0.0), (0.03, 0.03), (1.5, 0.08)), length_m=14.0
        ),
    ],
    ids=["plain", "noisy", "60 km/h", "steep bend", "platform of 3 cm"],
)
def test_a_dropped_curb_is_an_edge(tmp_path: Path, street: ProfiledStreet, aside_px: int) -> None:
    drive = recorded(tmp_path / "drive", street)
    both = np.vstack([street.edge(np.array(position)) for position in street.profile[1:3]])
    points = clicks(drive, street, LOWER, aside_px)
    found = [
        position.xyz for click in points if (position := edge_beside(drive, click)) is not None
    ]
    assert len(found) >= 0.9 * len(points)
    assert (off_line(np.array(found), both) < 0.02).mean() >= 0.9


@pytest.mark.parametrize(
    "profile",
    [
        ((-2.5, 0.05), (0.0, 0.0), (0.01, 0.10), (1.5, 0.13)),
        ((-2.5, 0.05), (0.0, 0.0), (0.02, 0.20), (1.5, 0.23)),
        ((-2.5, 0.05), (0.0, 0.0), (0.0, 0.15), (1.5, 0.18)),
        ((-2.5, 0.05), (0.0, 0.0), (0.10, 0.12), (1.5, 0.15)),
    ],
    ids=["10 cm", "20 cm", "upright", "bevelled"],
)
def test_both_edges_of_every_form_of_curb_are_met(
    tmp_path: Path, profile: tuple[tuple[float, float], ...]
) -> None:
    street = ProfiledStreet(profile=profile, noise_m=0.005)
    drive = recorded(tmp_path / "drive", street)
    for corner in (np.array(profile[1]), np.array(profile[2])):
        found = snapped(drive, clicks(drive, street, corner, 0))
        assert (off_line(found, street.edge(corner)) < 0.02).mean() >= 0.85


def test_a_rounded_edge_is_where_its_two_surfaces_would_meet(tmp_path: Path) -> None:
    angles = np.radians(np.linspace(180, 90, 8))
    rounding = [(0.03 + 0.03 * np.cos(a), 0.12 + 0.03 * np.sin(a)) for a in angles]
    street = ProfiledStreet(
        profile=((-2.5, 0.05), (0.0, 0.0), *rounding, (1.5, 0.15)), spacing_m=0.02
    )
    drive = recorded(tmp_path / "drive", street)
    corner = np.array([0.0, 0.15])
    found = snapped(drive, clicks(drive, street, corner, 0))
    # The nearest place of the arc is 1.2 cm away from there.
    assert np.median(off_line(found, street.edge(corner))) < 0.022


def test_the_foot_and_the_top_of_a_wall_are_edges(tmp_path: Path) -> None:
    street = ProfiledStreet(profile=((-2.5, 0.0), (0.0, 0.0), (0.0, 0.8), (0.3, 0.8), (1.5, 0.8)))
    drive = recorded(tmp_path / "drive", street)
    for corner in (np.array([0.0, 0.0]), np.array([0.0, 0.8])):
        found = snapped(drive, clicks(drive, street, corner, 2))
        assert (off_line(found, street.edge(corner)) < 0.02).all()


def test_a_ditch_of_twenty_degrees_has_an_edge_at_its_bottom(tmp_path: Path) -> None:
    street = ProfiledStreet(profile=((-1.5, 0.273), (0.0, 0.0), (1.5, 0.273)))
    drive = recorded(tmp_path / "drive", street)
    found = snapped(drive, clicks(drive, street, LOWER, 3))
    assert (off_line(found, street.edge(LOWER)) < 0.02).mean() >= 0.9


@pytest.mark.parametrize("noise_m", [0.002, 0.005])
@pytest.mark.parametrize(
    "profile",
    [
        ((-2.5, 0.0), (1.5, 0.08)),
        ((-2.5, 0.05), (0.0, 0.0), (1.5, 0.03)),
        ((-2.5, 0.04), (-0.5, 0.0), (0.0, -0.025), (0.5, 0.0), (1.5, 0.02)),
        ((-2.5, 0.05), (0.0, 0.0), (0.01, 0.004), (1.5, 0.03)),
    ],
    ids=["plane", "kink", "gutter with a fall of 5 %", "joint of 4 mm"],
)
def test_a_flat_road_has_no_edge(
    tmp_path: Path, noise_m: float, profile: tuple[tuple[float, float], ...]
) -> None:
    street = ProfiledStreet(profile=profile, noise_m=noise_m, length_m=14.0)
    drive = recorded(tmp_path / "drive", street)
    points = [point for aside in (-25, 0, 20) for point in clicks(drive, street, LOWER, aside)]
    assert np.mean([edge_beside(drive, point) is None for point in points]) >= 0.98


def test_leaves_have_no_edge(tmp_path: Path) -> None:
    street = ProfiledStreet(profile=((-1.0, 0.5), (1.0, 0.5)), noise_m=0.08)
    drive = recorded(tmp_path / "drive", street)
    points = clicks(drive, street, np.array([0.0, 0.5]), 0)
    assert np.mean([edge_beside(drive, point) is None for point in points]) >= 0.8


def test_a_lonely_point_has_no_edge_and_is_its_own_lowest(tmp_path: Path) -> None:
    drive = recorded(tmp_path / "drive", ProfiledStreet(row_m=3.0, spacing_m=1.0))
    assert edge_beside(drive, 0) is None
    assert lowest_point(drive, 0, 0.2) == 0


def test_the_lowest_point_is_the_bottom_of_the_gutter_not_a_point_below_it(tmp_path: Path) -> None:
    gutter = ((-1.5, 0.0), (-0.2, 0.0), (-0.15, -0.1), (0.15, -0.1), (0.2, 0.0), (1.5, 0.0))
    street = ProfiledStreet(profile=gutter, noise_m=0.001, grade=0.0, spacing_m=0.02)
    drive = recorded(tmp_path / "drive", street)
    xyz = np.array(drive.columns["xyz"])
    click = clicks(drive, street, np.array([-0.2, 0.0]), 0)[2]
    low = int(neighbours(drive, click, 0.3)[0])
    xyz[low, 2] -= 2_000  # a return 20 cm too low
    drive.columns.add("xyz", xyz)
    drive = Drive(tmp_path / "drive")
    found = lowest_point(drive, click, 0.25)
    assert found != low
    assert abs(drive.xyz(np.array([found]))[0, 2] - START[2] + 0.1) < 0.005


def test_the_highest_point_is_the_top_of_the_wall(tmp_path: Path) -> None:
    street = ProfiledStreet(
        profile=((-2.5, 0.0), (0.0, 0.0), (0.0, 0.3), (0.2, 0.3), (1.5, 0.2)), grade=0.0
    )
    drive = recorded(tmp_path / "drive", street)
    click = clicks(drive, street, np.array([0.0, 0.0]), 0)[3]
    top = drive.xyz(np.array([highest_point(drive, click, 0.4)]))[0]
    assert abs(top[2] - START[2] - 0.3) < 0.02


def test_the_compiled_profile_is_the_plain_one() -> None:
    random = np.random.default_rng(4)
    across = np.concatenate([random.uniform(-0.3, 0, 40), np.zeros(20), random.uniform(0, 0.3, 40)])
    up = np.concatenate([np.zeros(40), random.uniform(0, 0.15, 20), np.full(40, 0.15)])
    local = np.column_stack([random.uniform(-0.4, 0.4, 100), across, up])
    local[:, 1:] += random.normal(0, 0.003, (100, 2))
    limits = SectionLimits(0.5, 0.5, 0.5, 0.004, 0)
    results = []
    plain = corners_kernel.py_func  # type: ignore[attr-defined]
    for kernel in (corners_kernel, plain):
        frame, corners = np.zeros(3), np.zeros((MOST_CORNERS, CORNER_COLUMNS))
        count, price, _ = kernel(local, limits, frame, corners)
        results.append((count, price, corners[:count]))
    assert results[0][0] == results[1][0] == 2
    np.testing.assert_allclose(results[0][2], results[1][2], atol=1e-9)
    assert results[0][2][0, BEND] > 1.4
    assert results[0][2][1, BEND] < -1.4


def test_the_compiled_step_is_the_plain_one() -> None:
    random = np.random.default_rng(4)
    across = random.uniform(-0.3, 0.3, 90)
    up = 0.025 * np.clip(across / 0.03, 0, 1) + random.normal(0, 0.003, 90)
    local = np.column_stack([across, random.uniform(-0.4, 0.4, 90), up])
    plain = step_kernel.py_func  # type: ignore[attr-defined]
    steps = np.zeros((2, UNKNOWNS))
    assert step_kernel(local, 0.4, steps[0]) == STEP
    assert plain(local, 0.4, steps[1]) == STEP
    np.testing.assert_allclose(steps[0], steps[1], atol=1e-6)
    # Seen along the edge with the upper surface on the left, that is southwards.
    assert abs(steps[0, HEADING] - 1.5 * np.pi) < 0.05
    assert abs(steps[0, JUMP] - 0.025) < 0.004
