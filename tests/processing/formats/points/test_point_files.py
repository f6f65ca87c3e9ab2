"""PLY, PCD, E57, PTX and text give points as integers of 0.1 mm, whatever their spelling."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.core.errors import BadFile
from processing.formats.points.delivered.point_chunk import PointChunk, PointFileInfo
from processing.formats.points.point_files import read_chunks, read_info, read_sample
from tests.delivered_files import make_las, ply_bytes

_POINTS = np.array([[100.5, 200.25, 3.125], [101.5, 201.25, 4.125], [102.5, 202.25, 5.125]])


def _read(path: Path) -> tuple[PointFileInfo, NDArray[np.float64], PointChunk]:
    """The facts, the coordinates in metres, and the only chunk."""
    info = read_info(path)
    chunk = next(read_chunks(path))
    xyz = chunk.columns["xyz"] * np.array(info.scale) + np.array(info.offset)
    assert info.count == chunk.count
    np.testing.assert_allclose(xyz.min(axis=0), info.lowest, atol=1e-4)
    return info, xyz, chunk


@pytest.mark.parametrize("form", ["ascii", "binary_little_endian", "binary_big_endian"])
def test_a_ply_of_any_order_gives_times_echoes_and_origins(tmp_path: Path, form: str) -> None:
    path = tmp_path / "歩道.ply"
    path.write_bytes(ply_bytes(form, count=40))
    info, xyz, chunk = _read(path)
    columns = chunk.columns
    along = 649_000.0 + 0.5 * np.arange(40)
    assert info.format == "PLY"
    assert all(float(value).is_integer() for value in info.offset)
    np.testing.assert_allclose(xyz[:, 0], along, atol=1e-4)
    np.testing.assert_allclose(xyz[:, 1:], [[6_840_020.25, 45.0]] * 40, atol=1e-4)
    np.testing.assert_allclose(columns["origin"][:, 0], along)
    np.testing.assert_allclose(columns["origin"][0], [649_000.0, 6_840_018.0, 47.0])
    np.testing.assert_allclose(columns["time"], 54_160.0 + 0.001 * np.arange(40))
    assert set(columns["number_of_returns"]) == {2}
    # Decibels: one range for all files, or a drive's brightness would jump between them.
    first, last = (65_535 * (100 + decibels) / 200 for decibels in (-20.0, 5.0))
    assert abs(int(columns["intensity"][0]) - first) <= 1
    assert abs(int(columns["intensity"][-1]) - last) <= 1
    assert (np.diff(columns["intensity"].astype(int)) > 0).all()


def test_the_range_of_the_intensity_is_that_of_the_whole_file(tmp_path: Path) -> None:
    path = tmp_path / "a.ply"
    path.write_bytes(ply_bytes(count=40))
    whole = next(read_chunks(path)).columns["intensity"]
    parts = [chunk.columns["intensity"] for chunk in read_chunks(path, 7)]
    np.testing.assert_array_equal(np.concatenate(parts), whole)


def test_a_changed_file_is_read_anew(tmp_path: Path) -> None:
    path = tmp_path / "a.xyz"
    path.write_text("0 0 0\n1 1 1\n")
    assert read_info(path).count == 2
    path.write_text("0 0 0\n1 1 1\n2 2 2\n")
    assert read_info(path).count == 3


@pytest.mark.parametrize(
    "text",
    [
        "100.5 200.25 3.125\n101.5 201.25 4.125\n102.5 202.25 5.125\n",
        "100.5,200.25,3.125\r\n101.5,201.25,4.125\r\n102.5,202.25,5.125",
        "100.5\t200.25\t3.125\n\n101.5\t201.25\t4.125\n102.5\t202.25\t5.125\n\n",
        "3\n100.5 200.25 3.125 7 1 2 3\n101.5 201.25 4.125 8 1 2 3\n102.5 202.25 5.125 9 1 2 3\n",
        "X;Y;Z\n100.5;200.25;3.125\n101.5;201.25;4.125\n102.5;202.25;5.125\n",
        "//X Y Z\n100.5 200.25 3.125\n101.5 201.25 4.125\n102.5 202.25 5.125\n",
        "# 点群\n100.5 200.25 3.125\n# 注記\n101.5 201.25 4.125\n102.5 202.25 5.125\n",
    ],
)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "cp932"])
def test_text_points_are_read_with_any_separator_header_and_encoding(
    tmp_path: Path, text: str, encoding: str
) -> None:
    path = tmp_path / "点.xyz"
    path.write_bytes(text.encode(encoding))
    info, xyz, _ = _read(path)
    assert info.format == "text"
    np.testing.assert_allclose(xyz, _POINTS, atol=1e-4)


def test_a_header_names_the_columns_in_any_order(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text(
        "点番,Intensity,Z,Y,X,R,G,B\n1,300,3,2,1,255,0,128\n2,40,6,5,4,0,1,2\n", "cp932"
    )
    info, xyz, chunk = _read(path)
    np.testing.assert_allclose(xyz, [[1, 2, 3], [4, 5, 6]], atol=1e-4)
    np.testing.assert_array_equal(chunk.columns["intensity"], [300, 40])
    np.testing.assert_array_equal(chunk.columns["color"][0], [65_535, 0, 128 * 257])
    assert info.has_color


def test_negative_intensities_are_mapped_to_16_bits(tmp_path: Path) -> None:
    path = tmp_path / "a.pts"
    path.write_text("2\n0 0 0 -2048 1 2 3\n1 1 1 2047 4 5 6\n")
    columns = next(read_chunks(path)).columns
    np.testing.assert_array_equal(columns["intensity"], [0, 65_535])
    np.testing.assert_array_equal(columns["color"], np.array([[1, 2, 3], [4, 5, 6]]) * 257)


@pytest.mark.parametrize("storage", ["ascii", "binary"])
def test_a_pcd_gives_points_and_packed_colours(tmp_path: Path, storage: str) -> None:
    path = tmp_path / "a.pcd"
    points = np.zeros(3, dtype=[("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("rgb", "<u4")])
    points["x"], points["y"], points["z"] = _POINTS.T
    points["rgb"] = 0x0A141E
    header = (
        "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\n"
        f"WIDTH 3\nHEIGHT 1\nPOINTS 3\nDATA {storage}\n"
    ).encode()
    text = "\n".join(" ".join(str(value) for value in point) for point in points).encode()
    path.write_bytes(header + (points.tobytes() if storage == "binary" else text))
    _, xyz, chunk = _read(path)
    np.testing.assert_allclose(xyz, _POINTS, atol=1e-4)
    np.testing.assert_array_equal(chunk.columns["color"][0], np.array([10, 20, 30]) * 257)


def test_a_pcd_may_have_remarks_empty_lines_and_fields_of_several_values_before_the_place(
    tmp_path: Path,
) -> None:
    path = tmp_path / "a.pcd"
    header = (
        "# .PCD v0.7\n# FIELDS a b c\n\nVERSION 0.7\nFIELDS normal x y z\nSIZE 4 4 4 4\n"
        "TYPE F F F F\nCOUNT 3 1 1 1\nWIDTH 3\nHEIGHT 1\n\nPOINTS 3\nDATA ascii\n"
    )
    rows = [" ".join(map(str, (0.0, 0.0, 1.0, *row))) for row in _POINTS.tolist()]
    path.write_text(header + "\n".join(rows) + "\n")
    _, xyz, _ = _read(path)
    np.testing.assert_allclose(xyz, _POINTS, atol=1e-4)
    path.write_text(header.replace("DATA ascii", "DATA folded") + "\n".join(rows) + "\n")
    with pytest.raises(BadFile):
        read_info(path)


def test_a_ptx_is_moved_by_its_pose_and_cells_without_return_are_left_out(tmp_path: Path) -> None:
    path = tmp_path / "a.ptx"
    scan = "2\n2\n{x} 0 0\n1 0 0\n0 1 0\n0 0 1\n0 1 0 0\n-1 0 0 0\n0 0 1 0\n{x} 20 30 1\n"
    points = "1 0 0 0.5 255 0 0\n0 0 0 0.5 0 0 0\n0 2 0 1.0 0 255 0\n0 0 3 0.0 0 0 255\n"
    path.write_text(scan.format(x=10) + points + scan.format(x=100) + points)
    info = read_info(path)
    assert (info.count, info.format) == (6, "PTX")
    first = np.array([[10, 21, 30], [8, 20, 30], [10, 20, 33]])
    for chunk, shift in zip(read_chunks(path), (0, 90), strict=True):
        xyz = chunk.columns["xyz"] * np.array(info.scale) + np.array(info.offset)
        np.testing.assert_allclose(xyz, first + np.array([shift, 0, 0]), atol=1e-4)


def test_an_e57_gives_its_scans_where_they_stood(tmp_path: Path) -> None:
    import pye57

    path = tmp_path / "a.e57"
    file = pye57.E57(str(path), mode="w")
    half = np.sqrt(0.5)
    for shift in (0.0, 100.0):
        data = {
            "cartesianX": np.array([1.0, 0.0]),
            "cartesianY": np.array([0.0, 2.0]),
            "cartesianZ": np.array([0.0, 1.0]),
            "intensity": np.array([0.25, 0.75], dtype=np.float32),
            "colorRed": np.array([255, 0], dtype=np.uint8),
            "colorGreen": np.array([0, 255], dtype=np.uint8),
            "colorBlue": np.array([0, 0], dtype=np.uint8),
        }
        turn, position = np.array([half, 0, 0, half]), np.array([shift, 0.0, 5.0])
        file.write_scan_raw(data, rotation=turn, translation=position)
    file.close()
    info = read_info(path)
    chunks = list(read_chunks(path))
    integers = np.concatenate([chunk.columns["xyz"] for chunk in chunks])
    xyz = integers * np.array(info.scale) + np.array(info.offset)
    wanted = [[0, 1, 5], [-2, 0, 6], [100, 1, 5], [98, 0, 6]]
    np.testing.assert_allclose(xyz, wanted, atol=1e-4)
    np.testing.assert_array_equal(chunks[0].columns["intensity"], [16_384, 49_151])
    np.testing.assert_array_equal(chunks[0].columns["color"], [[65_535, 0, 0], [0, 65_535, 0]])


def test_the_reader_is_chosen_by_content_not_by_name(tmp_path: Path) -> None:
    path = tmp_path / "wrong.ply"
    make_las(path.with_suffix(".laz"))
    path.with_suffix(".laz").rename(path)
    assert read_info(path).format == "LAZ"
    path.write_bytes(ply_bytes())
    assert read_info(path).format == "PLY"


def test_a_sample_of_a_text_file_holds_its_first_and_with_times_its_last_points(
    tmp_path: Path,
) -> None:
    path = tmp_path / "a.xyz"
    path.write_text("x y z time\n" + "".join(f"{i} 0 0 {i}\n" for i in range(1000)))
    sample = read_sample(path, 50)["xyz"][:, 0]
    assert sample[-1] - sample[0] == round(999 / 0.0001)
    path.write_text("".join(f"{i} 0 0\n" for i in range(1000)))
    sample = read_sample(path, 50)["xyz"][:, 0]
    assert sample[-1] - sample[0] == round(99 / 0.0001)


def test_points_farther_apart_than_integers_reach_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.xyz"
    path.write_text("0 0 0\n500000000 0 0\n")
    with pytest.raises(BadFile, match=r"a\.xyz"):
        read_info(path)
