"""A template drawn once follows a curb of known shape along a bend."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pytest

from processing.core.errors import Cancelled, Unsuitable
from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.methods.templates.fit import FitSettings, TemplatePath, fit_along, fit_at
from processing.methods.templates.fitted_lines import fitted_lines
from processing.methods.templates.preview import preview_at
from processing.methods.templates.slab import SectionFrame
from processing.recording.drive import Drive
from tests.builders import simulated_drive
from tests.processing.methods.templates.curb_street import (
    CURB,
    CURB_AT_M,
    CURB_FRAME,
    CURB_HEIGHT_M,
    CURVE,
    LENGTH_M,
    LOW_M,
    TOP_M,
    WALL_FOOT,
    WALL_FRAME,
    frame_at,
    imported,
    off_edge,
    recorded,
    stations,
)

SETTINGS = FitSettings()
EMPTY_ABOVE = ((-0.1, 0.25), (0.1, 0.25), (0.1, 0.5), (-0.1, 0.5))


class CancelledSoon:
    """Cancels after some checks."""

    def __init__(self, checks: int) -> None:
        self.left = checks

    def report(self, fraction: float, text: Text | None = None) -> None:
        """Take note of nothing."""

    def check(self) -> None:
        self.left -= 1
        if self.left < 0:
            raise Cancelled


@pytest.fixture(scope="module")
def street(tmp_path_factory: pytest.TempPathFactory) -> Drive:
    return recorded(tmp_path_factory.mktemp("street"))


@pytest.fixture(scope="module")
def walk(street: Drive) -> TemplatePath:
    return fit_along(street, CURB, CURB_FRAME, SETTINGS, SilentMonitor())


def test_lines_lie_within_a_centimetre_of_both_edges_along_the_whole_street(
    street: Drive, walk: TemplatePath
) -> None:
    upper, lower = fitted_lines(street, walk, SETTINGS, SilentMonitor())
    assert (upper.edge, lower.edge) == ("upper", "lower")
    for line, height in ((upper, TOP_M), (lower, LOW_M)):
        assert off_edge(line.xyz, height).max() < 0.01
        along = stations(line.xyz)[0]
        assert along.max() - along.min() > LENGTH_M - 4.0
        assert (np.diff(along) > 0).all()
        assert line.confidence > 0.95
        assert line.scores.size == pytest.approx(line.length_m, abs=1.5)


def test_a_line_between_its_vertices_is_as_near_as_at_them(
    street: Drive, walk: TemplatePath
) -> None:
    upper, _ = fitted_lines(street, walk, SETTINGS, SilentMonitor())
    between = (upper.xyz[1:] + upper.xyz[:-1]) / 2
    assert off_edge(between, TOP_M).max() < 0.012


def test_vertices_rest_on_measured_points_that_are_near(street: Drive, walk: TemplatePath) -> None:
    upper, _ = fitted_lines(street, walk, SETTINGS, SilentMonitor())
    rests = upper.points >= 0
    assert rests.mean() > 0.8
    away = np.linalg.norm(street.xyz(upper.points[rests]) - upper.xyz[rests], axis=1)
    assert away.max() <= 0.05


def test_a_start_beside_the_edge_finds_it(street: Drive) -> None:
    beside = SectionFrame(
        CURB_FRAME.position + np.array([0.12, -0.08, 0.05]), CURB_FRAME.heading_rad + 0.1
    )
    start = fit_at(street, CURB, beside, SETTINGS)
    assert start.score > 0.95
    assert off_edge(start.frame.position[None], TOP_M).max() < 0.01


def test_a_template_of_the_left_side_follows_the_right_one_mirrored(street: Drive) -> None:
    right = frame_at(15.0, -CURB_AT_M, TOP_M)
    found = fit_along(street, CURB, right, SETTINGS, SilentMonitor())
    assert found.template == CURB.mirrored()
    fits = found.scores >= SETTINGS.least_score
    assert fits.sum() > 20
    assert off_edge(found.positions[fits], TOP_M, -CURB_AT_M).max() < 0.015


def test_a_gap_of_three_metres_is_bridged_and_its_score_is_low(tmp_path: Path) -> None:
    drive = recorded(tmp_path, without=(18.0, 21.0))
    walk = fit_along(drive, CURB, frame_at(10.0, CURB_AT_M, TOP_M), SETTINGS, SilentMonitor())
    upper, _ = fitted_lines(drive, walk, SETTINGS, SilentMonitor())
    along = stations(upper.xyz)[0]
    assert along.max() > LENGTH_M - 4.0
    # Inside the bend a metre of curb is more than a metre of road.
    metre = along.min() + np.arange(upper.scores.size) / (1.0 - CURVE * CURB_AT_M)
    in_gap = (metre > 18.4) & (metre < 19.6)
    assert in_gap.sum() == 1
    assert upper.scores[in_gap].max() < 0.3
    assert upper.scores[metre < 16.0].min() > 0.95
    assert off_edge(upper.xyz, TOP_M).max() < 0.01


def test_a_gap_longer_than_the_longest_one_splits_the_line(tmp_path: Path) -> None:
    drive = recorded(tmp_path, without=(18.0, 21.0))
    settings = dataclasses.replace(SETTINGS, longest_gap_m=1.5)
    walk = fit_along(drive, CURB, frame_at(10.0, CURB_AT_M, TOP_M), settings, SilentMonitor())
    lines = fitted_lines(drive, walk, settings, SilentMonitor())
    before, after = (line for line in lines if line.edge == "upper")
    assert stations(before.xyz)[0].max() < 18.5
    assert stations(after.xyz)[0].min() > 20.5
    alone = dataclasses.replace(settings, search_m=0.0)
    walk = fit_along(drive, CURB, frame_at(10.0, CURB_AT_M, TOP_M), alone, SilentMonitor())
    assert len(fitted_lines(drive, walk, alone, SilentMonitor())) == 2


def test_the_empty_zone_rejects_a_wall_of_the_same_height(street: Drive) -> None:
    strict = dataclasses.replace(WALL_FOOT, empty=(EMPTY_ABOVE,))
    assert fit_at(street, WALL_FOOT, WALL_FRAME, SETTINGS).score > 0.9
    assert fit_at(street, strict, WALL_FRAME, SETTINGS).score < SETTINGS.least_score
    lower = frame_at(15.0, CURB_AT_M, LOW_M)
    assert fit_at(street, strict, lower, SETTINGS).score > 0.9
    with pytest.raises(Unsuitable, match="doesn't fit"):
        fit_along(street, strict, WALL_FRAME, SETTINGS, SilentMonitor())


def test_a_level_piece_of_road_is_no_curb(street: Drive) -> None:
    middle = frame_at(15.0, 1.5, 0.0)
    assert fit_at(street, CURB, middle, SETTINGS).score < SETTINGS.least_score
    with pytest.raises(Unsuitable, match="doesn't fit"):
        fit_along(street, CURB, middle, SETTINGS, SilentMonitor())


def test_where_nothing_is_measured_the_score_is_zero(street: Drive) -> None:
    nowhere = SectionFrame(CURB_FRAME.position + np.array([0.0, 0.0, 50.0]), 0.0)
    assert fit_at(street, CURB, nowhere, SETTINGS).score == 0.0


@pytest.mark.parametrize("checks", [0, 1, 7, 40])
def test_cancelling_leaves_nothing(street: Drive, checks: int) -> None:
    before = {path.name: path.stat().st_mtime_ns for path in street.folder.iterdir()}
    with pytest.raises(Cancelled):
        fit_along(street, CURB, CURB_FRAME, SETTINGS, CancelledSoon(checks))
    assert {path.name: path.stat().st_mtime_ns for path in street.folder.iterdir()} == before


def test_a_cloud_without_revolutions_is_followed_too(tmp_path: Path) -> None:
    straight = simulated_drive(
        3, pulses_per_revolution=1200.0, length_m=12.0, lost_share=0.0, range_noise_m=0.0
    )
    drive = imported(tmp_path, straight, is_bare=True)
    assert drive.revolutions is None
    frame = SectionFrame(CURB_FRAME.position, np.pi / 2)
    frame.position[:] = [-11_034.0, -35_014.0, 125.0 + TOP_M]
    walk = fit_along(drive, CURB, frame, SETTINGS, SilentMonitor())
    fits = walk.scores >= SETTINGS.least_score
    assert fits.sum() > 10
    assert np.abs(walk.positions[fits, 0] + 11_034.0).max() < 0.01
    assert np.abs(walk.positions[fits, 2] - 125.0 - TOP_M).max() < 0.01


def test_a_preview_shows_points_in_the_axes_of_the_template_as_it_was_drawn(street: Drive) -> None:
    for across in (CURB_AT_M, -CURB_AT_M):
        shown = preview_at(street, CURB, frame_at(15.0, across, TOP_M), SETTINGS)
        assert shown.start.score > 0.95
        assert shown.is_mirrored == (across < 0)
        on_road = shown.points[:, 0] > 0.05
        assert shown.points[on_road, 1].max() < -CURB_HEIGHT_M + 0.03
        assert shown.points[~on_road & (shown.points[:, 0] < -0.05), 1].min() > -0.02
