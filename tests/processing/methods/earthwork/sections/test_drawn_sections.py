from __future__ import annotations

import math

import numpy as np
import pytest

from processing.core.monitor import SilentMonitor
from processing.methods.earthwork.sections.cross_sections import SectionLayout
from processing.methods.earthwork.sections.drawn_sections import (
    drawn_line,
    station_name,
    volumes_between,
)
from processing.methods.earthwork.sections.end_areas import end_area_volume, prismoidal_volume
from processing.methods.earthwork.sections.height_surfaces import LevelSurface

LINE = SectionLayout(np.array([[0.0, 0.0], [30.0, 0.0], [50.0, 20.0]]), 5.0, interval_m=10.0)
GROUNDS = (LevelSurface(10.0), LevelSurface(11.0))


def test_volumes_between_sections_sum_to_the_volume() -> None:
    for method in (end_area_volume, prismoidal_volume):
        volume = method(LINE, GROUNDS, SilentMonitor())
        between = volumes_between(volume)
        assert len(between) == len(volume.sections) - 1
        assert sum(fill for _, fill in between if not math.isnan(fill)) == pytest.approx(
            volume.fill_m3
        )


def test_a_section_that_is_halfway_only_tells_no_volume() -> None:
    between = volumes_between(prismoidal_volume(LINE, GROUNDS, SilentMonitor()))
    assert all(math.isnan(cut) for cut, _ in between[::2])
    assert not any(math.isnan(cut) for cut, _ in between[1::2])


def test_sections_are_drawn_as_they_were_measured() -> None:
    volume = end_area_volume(LINE, GROUNDS, SilentMonitor())
    drawn = drawn_line(volume, LINE, "中心線")
    assert [one.station_m for one in drawn.sections] == [one.station_m for one in volume.sections]
    assert drawn.sections[1].name == "No.0+10.00"
    assert drawn.sections[2].fill_m2 == pytest.approx(10.0)
    np.testing.assert_array_equal(drawn.sections[0].after, volume.sections[0].after)


@pytest.mark.parametrize(
    ("station", "name"),
    [(0.0, "No.0"), (20.0, "No.1"), (19.9999, "No.1"), (25.0, "No.1+5.00"), (59.99, "No.2+19.99")],
)
def test_stations_are_named_by_stakes(station: float, name: str) -> None:
    assert station_name(station) == name
