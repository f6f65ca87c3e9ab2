"""Trajectories as CSV, as POSPac's text and as SBET come out the same, or are refused by line."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from pyproj import CRS, Transformer

from processing.core.errors import BadFile, MissingInput, OutOfRange
from processing.formats.trajectories.trajectory_files import read_trajectory
from tests.delivered_files import TRAJECTORY_HEADER, sbet_bytes, trajectory_rows, trajectory_text


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "cp932", "utf-16"])
@pytest.mark.parametrize("line_end", ["\n", "\r\n"])
def test_a_csv_is_read_in_any_encoding(tmp_path: Path, encoding: str, line_end: str) -> None:
    path = tmp_path / "走行軌跡.csv"
    rows = trajectory_rows()
    path.write_bytes(trajectory_text(rows).replace("\n", line_end).encode(encoding))
    trajectory = read_trajectory(path, "")
    np.testing.assert_allclose(trajectory.time, rows[:, 0])
    np.testing.assert_allclose(trajectory.xyz, rows[:, 1:4])
    np.testing.assert_allclose(trajectory.roll_pitch_heading_deg, rows[:, 4:])
    assert trajectory.has_attitude


def test_other_columns_and_another_order_are_all_right(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    names = ["備考", *reversed(TRAJECTORY_HEADER.split(","))]
    rows = trajectory_rows()
    lines = [",".join(["晴れ", *(f"{v}" for v in row[::-1])]) for row in rows]
    path.write_bytes("\n".join([",".join(names), *lines]).encode("cp932"))
    np.testing.assert_allclose(read_trajectory(path, "").xyz, rows[:, 1:4])


def test_pospac_text_has_northing_before_easting(tmp_path: Path) -> None:
    path = tmp_path / "sbet.txt"
    path.write_text(
        '"GpsTime","Y","X","Z","Roll","Pitch","Azimuth"\n'
        "407106.0,3289429.7,276318.0,538.8,-1.8,2.0,-90.5\n"
        "407106.1,3289429.8,276317.0,538.9,-1.8,2.0,-90.5\n"
    )
    trajectory = read_trajectory(path, "")
    np.testing.assert_allclose(trajectory.xyz[0], [276318.0, 3289429.7, 538.8])
    np.testing.assert_allclose(trajectory.roll_pitch_heading_deg[0], [-1.8, 2.0, -90.5])


def test_of_records_with_the_same_time_the_first_is_kept(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    rows = trajectory_rows(5)
    rows[2, 0] = rows[1, 0]
    path.write_text(trajectory_text(rows))
    np.testing.assert_allclose(read_trajectory(path, "").xyz, rows[[0, 1, 3, 4], 1:4])


def _with_cell(row: int, column: int, cell: str) -> str:
    lines = trajectory_text(trajectory_rows()).split("\n")
    cells = lines[row].split(",")
    cells[column] = cell
    lines[row] = ",".join(cells)
    return "\n".join(lines)


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        (_with_cell(7, 3, "高い"), 8, "height_m"),
        (_with_cell(7, 3, "nan"), 8, "height_m"),
        (_with_cell(7, 1, "inf"), 8, "easting_m"),
        (_with_cell(7, 6, "4000"), 8, "heading_deg"),
        (_with_cell(7, 3, ""), 8, "height_m"),
        (_with_cell(7, 0, "900"), 8, "goes back"),
        (_with_cell(0, 2, "northing"), 1, "northing_m"),
        (trajectory_text(trajectory_rows()) + "1100.0,3", 52, "2 cells"),
        ("", 1, "empty"),
        ("\n\n", 1, "empty"),
    ],
)
def test_damage_is_told_with_its_line(tmp_path: Path, text: str, line: int, words: str) -> None:
    path = tmp_path / "a.csv"
    path.write_bytes(text.encode("cp932"))
    with pytest.raises(BadFile) as refusal:
        read_trajectory(path, "")
    assert f"{path}, line {line}" in refusal.value.where.en
    assert words in refusal.value.what.en
    assert refusal.value.remedy.ja


@pytest.mark.parametrize("count", [0, 1])
def test_fewer_than_two_records_are_refused(tmp_path: Path, count: int) -> None:
    path = tmp_path / "a.csv"
    path.write_text(trajectory_text(trajectory_rows(count)))
    with pytest.raises(BadFile, match="two records"):
        read_trajectory(path, "")


def test_an_sbet_is_projected_and_headed_from_grid_north(tmp_path: Path) -> None:
    path = tmp_path / "sbet.out"
    path.write_bytes(sbet_bytes())
    trajectory = read_trajectory(path, "EPSG:6677")
    system = CRS.from_epsg(6677)
    to_plane = Transformer.from_crs(system.geodetic_crs, system, always_xy=True)
    easting, northing = to_plane.transform(139.5, 35.6)
    np.testing.assert_allclose(trajectory.xyz[0], [easting, northing, 80.0], atol=1e-3)
    # The drive goes to true north, so its course in the plane is the heading that is wanted.
    course = trajectory.xyz[-1, :2] - trajectory.xyz[0, :2]
    wanted = np.degrees(np.arctan2(course[0], course[1])) % 360
    np.testing.assert_allclose(trajectory.roll_pitch_heading_deg[:, 2], wanted, atol=0.01)
    assert abs(wanted - 360 if wanted > 180 else wanted) > 0.1


def test_an_sbet_without_a_reference_system_asks_for_one(tmp_path: Path) -> None:
    path = tmp_path / "sbet.out"
    path.write_bytes(sbet_bytes())
    with pytest.raises(MissingInput, match="--crs"):
        read_trajectory(path, "")


@pytest.mark.parametrize("crs", ["EPSG:4326", "EPSG:1", "nonsense", "EPSG:4978"])
def test_an_sbet_needs_a_plane_system(tmp_path: Path, crs: str) -> None:
    path = tmp_path / "sbet.out"
    path.write_bytes(sbet_bytes())
    with pytest.raises(OutOfRange, match=r"sbet\.out"):
        read_trajectory(path, crs)


@pytest.mark.parametrize(
    ("field", "value"), [(0, np.nan), (0, 1.0), (1, 2.0), (3, 1e9), (7, 9.0), (9, np.inf)]
)
def test_values_that_no_vehicle_has_are_refused_with_their_record(
    tmp_path: Path, field: int, value: float
) -> None:
    path = tmp_path / "sbet.out"
    records = np.frombuffer(sbet_bytes(), "<f8").reshape(-1, 17).copy()
    records[20, field] = value
    path.write_bytes(records.tobytes())
    with pytest.raises(BadFile, match="record 21"):
        read_trajectory(path, "EPSG:6677")
