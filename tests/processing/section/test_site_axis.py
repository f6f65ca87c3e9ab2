"""Where nobody drove, sections stand on the longer middle line of the site."""

from __future__ import annotations

from dataclasses import dataclass, field
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.section.site_axis import site_axis

HEADING_DEG = 30.0


@dataclass
class DriveCloud:
    """What the axis asks of a drive: places in metres."""

    positions: NDArray[np.float64]
    info: SimpleNamespace = field(default_factory=SimpleNamespace)

    @property
    def count(self) -> int:
        return len(self.positions)

    def xyz(self, points: slice) -> NDArray[np.float64]:
        return self.positions[points].copy()


def levee(seed: int, low: float, high: float) -> DriveCloud:
    """A band 24 m wide along a heading, with a few points ten kilometres off."""
    random = np.random.default_rng(seed)
    along, across = random.uniform(low, high, 40_000), random.uniform(-12, 12, 40_000)
    angle = np.radians(90 - HEADING_DEG)
    east = 500.0 + along * np.cos(angle) - across * np.sin(angle)
    north = -800.0 + along * np.sin(angle) + across * np.cos(angle)
    positions = np.column_stack([east, north, random.normal(20, 0.1, 40_000)])
    positions[::4000] += 10_000.0
    return DriveCloud(positions)


def test_the_axis_leads_along_the_middle_of_all_stations_together() -> None:
    axis = site_axis([levee(1, -60.0, 10.0), levee(2, -5.0, 60.0)])
    assert axis is not None
    assert axis.stations.length_m == pytest.approx(120.0, abs=3.0)
    cut = axis.stations.cut_at(axis.stations.length_m / 2, 1.0, axis.half_length_m)
    assert axis.half_length_m == pytest.approx(14.0 + 1.0, abs=0.5)
    np.testing.assert_allclose(cut.middle[:2], (500.0, -800.0), atol=3.0)
    heading = np.degrees(np.arctan2(*cut.normal))
    assert heading == pytest.approx(HEADING_DEG, abs=1.0)


def test_a_cloud_without_extent_has_no_axis() -> None:
    assert site_axis([]) is None
    assert site_axis([DriveCloud(np.empty((0, 3)))]) is None
    assert site_axis([DriveCloud(np.full((10, 3), 7.0))]) is None


def test_ten_points_in_a_row_have_one() -> None:
    positions = np.column_stack([np.arange(10.0), np.zeros(10), np.zeros(10)])
    axis = site_axis([DriveCloud(positions)])
    assert axis is not None
    assert 6.0 < axis.stations.length_m <= 9.0
