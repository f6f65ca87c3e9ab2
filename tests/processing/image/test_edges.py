"""Snapping to edges, bottoms and tops, on streets whose cross-section is known exactly."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.image.edge_kernels import BEND, CORNER_COLUMNS, MOST_CORNERS, corners_kernel
from processing.image.edges import (
    edge_beside,
    highest_point,
    lowest_point,
    neighbours,
    strongest_bend,
)
from processing.points.drive import Drive
from tests.processing.image.profiled_streets import (
    LOWER,
    START,
    UPPER,
    Street,
    off_line,
    recorded,
)

Floats = NDArray[np.float64]


def clicks(drive: Drive, street: Street, corner: Floats, aside_px: int) -> list[int]:
    """Points so many pixels beside an edge, along the middle of the street."""
    xyz, pulses = drive.xyz(slice(0, drive.count)), np.asarray(drive.columns["pulse"])
    line = street.edge(corner)
    chosen = []
    for place in line[150:-150:40]:
        nearest = int(np.linalg.norm(xyz - place, axis=1).argmin())
        beside = np.flatnonzero(pulses == pulses[nearest] + aside_px)
        chosen += [int(point) for point in beside]
    assert chosen
    return chosen


def snapped(drive: Drive, points: list[int]) -> Floats:
    found = [place.xyz for point in points if (place := edge_beside(drive, point)) is not None]
    assert len(found) == len(points)
    return np.array(found)


@pytest.mark.parametrize("corner", [LOWER, UPPER], ids=["lower", "upper"])
@pytest.mark.parametrize(
    "street",
    [
        Street(),
        Street(noise_m=0.005, length_m=14.0),
        Street(row_m=0.17, spacing_m=0.05),
        Street(row_m=0.05, spacing_m=0.006),
        Street(curvature=0.15),
        Street(grade=-0.09, heading_rad=3.0),
    ],
    ids=["plain", "noisy", "60 km/h", "dense", "bend of 7 m radius", "steep"],
)
def test_a_click_on_a_curb_edge_goes_to_that_edge(
    tmp_path: Path, street: Street, corner: Floats
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
    street = Street()
    drive = recorded(tmp_path / "drive", street)
    corner = LOWER if aside_px < 0 else UPPER
    found = snapped(drive, clicks(drive, street, corner, aside_px))
    assert (off_line(found, street.edge(corner)) < 0.02).mean() >= 0.9


def test_a_dropped_curb_of_two_centimetres_is_an_edge(tmp_path: Path) -> None:
    street = Street(profile=((-2.5, 0.05), (0.0, 0.0), (0.01, 0.02), (1.5, 0.08)))
    drive = recorded(tmp_path / "drive", street)
    both = np.vstack([street.edge(np.array(place)) for place in street.profile[1:3]])
    points = clicks(drive, street, LOWER, -3)
    found = [point for click in points if (point := strongest_bend(drive, click)) >= 0]
    assert len(found) >= 0.9 * len(points)
    assert (off_line(drive.xyz(np.array(found)), both) < 0.02).mean() >= 0.8


def test_a_rounded_edge_is_where_its_two_surfaces_would_meet(tmp_path: Path) -> None:
    angles = np.radians(np.linspace(180, 90, 8))
    rounding = [(0.03 + 0.03 * np.cos(a), 0.12 + 0.03 * np.sin(a)) for a in angles]
    street = Street(profile=((-2.5, 0.05), (0.0, 0.0), *rounding, (1.5, 0.15)), spacing_m=0.02)
    drive = recorded(tmp_path / "drive", street)
    corner = np.array([0.0, 0.15])
    found = snapped(drive, clicks(drive, street, corner, 0))
    # The nearest place of the arc is 1.2 cm away from there.
    assert np.median(off_line(found, street.edge(corner))) < 0.022


def test_the_foot_and_the_top_of_a_wall_are_edges(tmp_path: Path) -> None:
    street = Street(profile=((-2.5, 0.0), (0.0, 0.0), (0.0, 0.8), (0.3, 0.8), (1.5, 0.8)))
    drive = recorded(tmp_path / "drive", street)
    for corner in (np.array([0.0, 0.0]), np.array([0.0, 0.8])):
        found = snapped(drive, clicks(drive, street, corner, 2))
        assert (off_line(found, street.edge(corner)) < 0.02).all()


@pytest.mark.parametrize("noise_m", [0.002, 0.004])
def test_a_flat_road_has_no_edge(tmp_path: Path, noise_m: float) -> None:
    street = Street(profile=((-2.5, 0.05), (0.0, 0.0), (1.5, 0.03)), noise_m=noise_m)
    drive = recorded(tmp_path / "drive", street)
    points = [point for aside in (-25, 0, 20) for point in clicks(drive, street, LOWER, aside)]
    assert np.mean([strongest_bend(drive, point) == -1 for point in points]) >= 0.75


def test_leaves_have_no_edge(tmp_path: Path) -> None:
    street = Street(profile=((-1.0, 0.5), (1.0, 0.5)), noise_m=0.08)
    drive = recorded(tmp_path / "drive", street)
    points = clicks(drive, street, np.array([0.0, 0.5]), 0)
    assert np.mean([strongest_bend(drive, point) == -1 for point in points]) >= 0.8


def test_a_lonely_point_has_no_edge_and_is_its_own_lowest(tmp_path: Path) -> None:
    drive = recorded(tmp_path / "drive", Street(row_m=3.0, spacing_m=1.0))
    assert strongest_bend(drive, 0) == -1
    assert lowest_point(drive, 0, 0.2) == 0


def test_the_lowest_point_is_the_bottom_of_the_gutter_not_a_point_below_it(tmp_path: Path) -> None:
    gutter = ((-1.5, 0.0), (-0.2, 0.0), (-0.15, -0.1), (0.15, -0.1), (0.2, 0.0), (1.5, 0.0))
    street = Street(profile=gutter, noise_m=0.001, grade=0.0, spacing_m=0.02)
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
    street = Street(
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
    limits = np.array([0.5, 0.5, 0.5, 0.004, 0.0])
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
