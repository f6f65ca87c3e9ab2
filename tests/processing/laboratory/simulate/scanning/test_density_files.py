"""A density map on disk: the picture has the map's colours, the table its figures."""

from __future__ import annotations

import csv

import numpy as np
import pytest

from processing.core.errors import OutOfRange
from processing.laboratory.simulate.scanning.density import DensityMap, density_map, survey_of
from processing.laboratory.simulate.scanning.density_files import (
    LEAST,
    MOST,
    density_colours,
    density_picture,
    write_density,
)
from processing.laboratory.simulate.scanning.sensors import SENSORS


@pytest.fixture(scope="module")
def found() -> DensityMap:
    return density_map(survey_of(SENSORS["zf9012"], 30.0))


def test_colours_grow_lighter_with_the_density_and_end_at_the_scales_ends() -> None:
    shades = density_colours(np.geomspace(LEAST, MOST, 50)).sum(axis=1).astype(int)
    assert (np.diff(shades) >= 0).all()
    np.testing.assert_array_equal(density_colours([LEAST / 9, 0.0]), density_colours([LEAST] * 2))
    np.testing.assert_array_equal(density_colours(MOST * 9), density_colours(MOST))


def test_what_is_left_of_the_vehicle_is_left_in_the_picture(found: DensityMap) -> None:
    one_sided = DensityMap(
        found.survey,
        found.across_m,
        found.up_m,
        np.where(found.across_m > 0, MOST, LEAST),
        found.spacing_m,
        found.wall,
    )
    picture = density_picture(one_sided, "")
    bright, dark = density_colours([MOST, LEAST])
    road = picture[600]
    is_bright, is_dark = (road == bright).all(axis=1), (road == dark).all(axis=1)
    assert np.flatnonzero(is_bright).mean() < np.flatnonzero(is_dark).mean()


def test_the_table_holds_the_figures_of_the_map(found: DensityMap, tmp_path) -> None:
    write_density(tmp_path / "d.csv", found, "")
    with (tmp_path / "d.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == found.across_m.size
    told = [float(row["road_points_per_m2"]) for row in rows]
    np.testing.assert_allclose(told, found.road, rtol=1e-4)
    across = [float(row["between_points_m"]) * float(row["between_lines_m"]) for row in rows]
    np.testing.assert_allclose(1 / np.array(across), found.road, rtol=1e-3)  # it has one head
    assert rows[200]["wall_3_m_points_per_m2"] == ""
    assert float(rows[0]["wall_3_m_points_per_m2"]) == pytest.approx(found.wall[29, 0], rel=1e-4)


def test_a_picture_is_written_whole_and_other_endings_are_refused(found, tmp_path) -> None:
    write_density(tmp_path / "d.png", found, "Z+F PROFILER 9012, 30 km/h")
    assert (tmp_path / "d.png").read_bytes()[:4] == b"\x89PNG"
    with pytest.raises(OutOfRange, match="Pictures and tables"):
        write_density(tmp_path / "d.pdf", found, "")
    assert [path.name for path in tmp_path.iterdir()] == ["d.png"]
