"""LAS and LAZ are read as delivered: integers, times, classes, reference system."""

from __future__ import annotations

import struct
from pathlib import Path

import laspy
import numpy as np
import pytest

from processing.formats.points.las.las import read_chunks, read_info
from processing.formats.points.las.las_header import read_header
from processing.formats.points.point_files import read_sample
from tests.delivered_files import make_las


@pytest.mark.parametrize("ending", ["las", "laz"])
@pytest.mark.parametrize("point_format", range(11))
def test_every_point_format_gives_the_integers_that_were_written(
    tmp_path: Path, point_format: int, ending: str
) -> None:
    path = tmp_path / f"街路.{ending}"
    content = make_las(path, point_format=point_format)
    info = read_info(path)
    columns = next(read_chunks(path)).columns
    assert (info.count, info.point_format, info.format) == (500, point_format, ending.upper())
    assert info.scale == (0.001, 0.001, 0.001)
    assert columns["xyz"].dtype == np.int32
    np.testing.assert_array_equal(columns["xyz"], content.xyz)
    np.testing.assert_array_equal(columns["intensity"], content.intensity)
    np.testing.assert_array_equal(columns["classification"], content.classification)
    np.testing.assert_array_equal(columns["scanner"], 2)
    np.testing.assert_array_equal(columns["user_data"], np.arange(500) % 7)
    assert info.has_time == ("time" in columns)
    if info.has_time:
        np.testing.assert_array_equal(columns["time"], content.time)
        assert info.first_time == content.time[0]
    assert info.has_color == ("color" in columns)
    assert (info.waveforms is not None) == (point_format in (4, 5, 9, 10))
    factor = 0.3 if point_format >= 6 else 1.0
    angle = np.arange(500) % 100 if point_format >= 6 else np.arange(500) % 50 - 25
    np.testing.assert_allclose(columns["scan_angle_deg"], angle * factor, atol=1e-4)


def test_colours_come_as_three_channels_of_16_bits(tmp_path: Path) -> None:
    path = tmp_path / "a.laz"
    make_las(path, point_format=7)
    las = laspy.read(path)
    columns = next(read_chunks(path)).columns
    np.testing.assert_array_equal(columns["color"], np.column_stack([las.red, las.green, las.blue]))


@pytest.mark.parametrize("ending", ["las", "laz"])
def test_chunks_joined_are_the_file_whatever_their_size(tmp_path: Path, ending: str) -> None:
    path = tmp_path / f"a.{ending}"
    content = make_las(path, count=120_000)
    chunks = list(read_chunks(path, 50_000))
    assert [chunk.count for chunk in chunks] == [50_000, 50_000, 20_000]
    np.testing.assert_array_equal(np.concatenate([c.columns["xyz"] for c in chunks]), content.xyz)


@pytest.mark.parametrize("ending", ["las", "laz"])
def test_a_sample_is_the_two_ends_of_the_file(tmp_path: Path, ending: str) -> None:
    path = tmp_path / f"a.{ending}"
    content = make_las(path, count=120_000)
    sample = read_sample(path, 100)
    ends = np.concatenate([content.time[:100], content.time[-100:]])
    np.testing.assert_array_equal(sample["time"], ends)


@pytest.mark.parametrize(("point_format", "epsg"), [(1, 6677), (6, 6677), (7, 2451), (3, 32654)])
def test_the_reference_system_is_found_in_geotiff_keys_and_in_wkt(
    tmp_path: Path, point_format: int, epsg: int
) -> None:
    path = tmp_path / "a.las"
    make_las(path, point_format=point_format, epsg=epsg)
    assert read_info(path).crs == f"EPSG:{epsg}"


def test_of_a_compound_system_the_horizontal_part_is_taken(tmp_path: Path) -> None:
    path = tmp_path / "a.las"
    make_las(path, epsg=9518)
    assert read_info(path).crs == "EPSG:4326"


def test_a_file_without_a_reference_system_names_none(tmp_path: Path) -> None:
    path = tmp_path / "a.las"
    make_las(path, epsg=0)
    assert read_info(path).crs == ""


def test_the_clock_is_told_by_the_global_encoding_only(tmp_path: Path) -> None:
    path = tmp_path / "a.las"
    make_las(path, point_format=1)
    assert read_info(path).is_adjusted_standard is None
    data = bytearray(path.read_bytes())
    data[6] |= 1
    path.write_bytes(data)
    assert read_info(path).is_adjusted_standard is True


@pytest.mark.parametrize("time", [np.nan, np.inf, -np.inf, 1e300])
def test_a_time_that_no_clock_can_say_is_nan(tmp_path: Path, time: float) -> None:
    path = tmp_path / "a.las"
    make_las(path, point_format=1, count=3)
    data = bytearray(path.read_bytes())
    position = read_header(path).points_at + 28 + 20
    data[position : position + 8] = struct.pack("<d", time)
    path.write_bytes(data)
    times = next(read_chunks(path)).columns["time"]
    np.testing.assert_array_equal(np.isnan(times), [False, True, False])


def test_a_file_without_points_gives_no_chunks(tmp_path: Path) -> None:
    for ending in ("las", "laz"):
        path = tmp_path / f"a.{ending}"
        make_las(path, count=0)
        assert read_info(path).count == 0
        assert list(read_chunks(path)) == []
        assert read_sample(path, 10) == {}


def test_extra_dimensions_are_named_among_the_attributes(tmp_path: Path) -> None:
    path = tmp_path / "a.laz"
    make_las(path, with_extra=True)
    assert read_info(path).attributes[-1] == "pulse_width"
