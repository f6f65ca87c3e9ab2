"""What the header of a text file says is understood for certain or asked about, never guessed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from processing.core.errors import BadFile, OutOfRange
from processing.formats.points.point_files import columns_needed, read_chunks, read_info
from processing.formats.points.text.column_words import PASSED_OVER, POSITION
from processing.formats.points.text.text_header import ColumnsNeeded, read_heading

XYZ, XYZI = ("x", "y", "z"), ("x", "y", "z", "intensity")
COLOURED = ("x", "y", "z", "red", "green", "blue")

UNDERSTOOD = [
    ("# x y z", "10 20 30", XYZ),
    ("# x y z intensity", "10 20 30 40", XYZI),
    ("#File format: x y z label", "10 20 30 2", ("x", "y", "z", "classification")),
    ("Easting,Northing,Altitude,Intensity", "10,20,30,40", XYZI),
    ("% East North Height Reflectance", "10 20 30 40", XYZI),
    ("; N E H", "10 20 30", ("y", "x", "z")),
    ("// Z\tY\tX", "10\t20\t30", ("z", "y", "x")),
    ("X,Y,Z,R,G,B", "10,20,30,1,2,3", COLOURED),
    ("# x,y,z,Red,Green,Blue", "10 20 30 1 2 3", COLOURED),
    ('"X";"Y";"Z";"GPS time"', "10;20;30;5", ("x", "y", "z", "gpstime")),
    ("x[m] y[m] z[m]", "10 20 30", XYZ),
    ("x (m), y (m), z (m)", "10, 20, 30", XYZ),
    ("easting_m,northing_m,height_m", "10,20,30", XYZ),
    ("X座標,Y座標,標高,反射強度", "10,20,30,40", XYZI),
    ("Ｘ座標（北）,Ｙ座標（東）,標高（m）", "10,20,30", ("y", "x", "z")),
    ("点番,X(北),Y(東),標高", "1,10,20,30", (PASSED_OVER, "y", "x", "z")),
    ("点名,X,Y,Z", "KBM1,10,20,30", (PASSED_OVER, "x", "y", "z")),
    ("id no x y z", "1 2 10 20 30", (PASSED_OVER, PASSED_OVER, "x", "y", "z")),
    ("x,y,z,nx,ny,nz", "1,2,3,0,0,1", (*XYZ, *[PASSED_OVER] * 3)),
    ("x,y,z,Amplitude,Reflectance", "1,2,3,4,5", (*XYZ, PASSED_OVER, "intensity")),
    ("# made by scanner 7\n# x y z intensity", "10 20 30 40", XYZI),
    ("# 点群\n# 計測日 2024", "10 20 30", XYZ),
    ("# Easting Northing Elevation i r g b", "1 2 3 4 5 6 7", (*XYZI, *COLOURED[3:])),
]

NOT_UNDERSTOOD = [
    ("# x y z", "10 20 30 40"),
    ("# x y z intensity", "10 20 30"),
    ("x,y,z", "10,20,30,40"),
    ("a,b,c", "10,20,30"),
    ("# lon lat height", "139 35 30"),
    ("x[mm],y[mm],z[mm]", "10,20,30"),
    ("x y z h", "10 20 30 40"),
    ("E,N,X,Y,Z", "1,2,3,4,5"),
    ("measured by x y z", "1 2 3 4 5"),
    ("# x y z\n# y x z", "1 2 3"),
    ("X,Y", "1,2,3"),
    ("", "KBM1 10 20 30"),
]


def _file(folder: Path, header: str, row: str, encoding: str = "utf-8") -> Path:
    path = folder / "点.csv"
    path.write_bytes(f"{header}\n{row}\n{row}\n".lstrip("\n").encode(encoding))
    return path


@pytest.mark.parametrize(("header", "row", "columns"), UNDERSTOOD)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "cp932"])
def test_a_header_that_names_every_column_is_followed(
    tmp_path: Path, header: str, row: str, columns: tuple[str, ...], encoding: str
) -> None:
    path = _file(tmp_path, header, row, encoding)
    assert read_heading(path).columns == columns
    info = read_info(path)
    words = row.replace(",", " ").replace(";", " ").split()
    found = [float(words[columns.index(axis)]) for axis in POSITION]
    np.testing.assert_allclose(info.lowest, found)
    assert info.count == 2


@pytest.mark.parametrize(("header", "row"), NOT_UNDERSTOOD)
def test_a_header_that_leaves_a_doubt_is_asked_about(tmp_path: Path, header: str, row: str) -> None:
    path = _file(tmp_path, header, row)
    with pytest.raises(ColumnsNeeded) as refused:
        read_info(path)
    assert "--columns" in refused.value.remedy.en
    needed = columns_needed([path])
    assert needed is not None
    assert needed.path == path


@pytest.mark.parametrize(("header", "row"), NOT_UNDERSTOOD)
def test_an_answer_settles_it(tmp_path: Path, header: str, row: str) -> None:
    path = _file(tmp_path, header, row)
    words = row.replace(",", " ").split()
    columns = tuple([PASSED_OVER] * (len(words) - 3) + ["Northing", "Easting", "height"])
    info = read_info(path, columns=columns)
    y, x, z = (float(word) for word in words[-3:])
    np.testing.assert_allclose(info.lowest, [x, y, z])
    assert info.columns_taken == (*[PASSED_OVER] * (len(words) - 3), "y", "x", "z")
    assert columns_needed([path], columns) is None


@pytest.mark.parametrize(
    "columns", [("x", "y"), ("x", "y", "z"), ("x", "x", "y", "z"), ("x", "y", "z", "blarg")]
)
def test_an_answer_that_does_not_fit_is_refused(tmp_path: Path, columns: tuple[str, ...]) -> None:
    path = _file(tmp_path, "# x y z", "10 20 30 40")
    with pytest.raises(OutOfRange):
        read_info(path, columns=columns)


@pytest.mark.parametrize(
    ("row", "columns"),
    [
        ("1 2 3", XYZ),
        ("1 2 3 4", XYZI),
        ("1 2 3 4 5 6", COLOURED),
        ("1 2 3 4 5 6 7", (*XYZI, *COLOURED[3:])),
    ],
)
def test_what_columns_without_a_header_are_taken_for_is_told(
    tmp_path: Path, row: str, columns: tuple[str, ...]
) -> None:
    assert read_info(_file(tmp_path, "", row)).columns_taken == columns


@pytest.mark.parametrize("row", ["1,,3,4", ",2,3,4", "1\t\t3\t4", "1;;3;4"])
def test_an_empty_cell_never_moves_the_others(tmp_path: Path, row: str) -> None:
    with pytest.raises(BadFile):
        read_info(_file(tmp_path, "", f"1 2 3 4\n{row}"))


@pytest.mark.parametrize("row", ["1,5;2,5;3,5", "1,5 2,5 3,5", "1,5\t2,5\t3,5\t4"])
def test_decimal_commas_are_refused(tmp_path: Path, row: str) -> None:
    with pytest.raises(BadFile, match="decimal commas"):
        read_info(_file(tmp_path, "", row))


def test_a_name_with_a_blank_below_a_column_of_names_is_refused(tmp_path: Path) -> None:
    with pytest.raises(BadFile):
        read_info(_file(tmp_path, "点名,X,Y,Z", "KBM1,10,20,30\nKBM 2,10,20,30"))


_NAMES = {
    "x": ["x", "X", "Easting", "east"],
    "y": ["y", "Y", "Northing", "north"],
    "z": ["z", "Z", "height", "Elevation", "altitude"],
    "intensity": ["intensity", "Reflectance", "i"],
    "classification": ["class", "classification", "label"],
}


@given(
    st.permutations(list(_NAMES)), st.sampled_from([" ", ",", "\t", ";"]), st.randoms(), st.data()
)
def test_what_numpy_writes_with_a_header_is_read_back(
    tmp_path_factory: pytest.TempPathFactory, order, divider, chance, data
) -> None:
    count = data.draw(st.integers(0, 2))
    kept = [name for name in order if name in POSITION or (count := count - 1) >= 0]
    header = divider.join(chance.choice(_NAMES[name]) for name in kept)
    values = np.round(np.random.default_rng(len(header)).uniform(1, 99, (5, len(kept))))
    path = tmp_path_factory.mktemp("numpy") / "points.txt"
    np.savetxt(path, values, header=header, delimiter=divider, comments=chance.choice(["# ", ""]))
    info, (chunk,) = read_info(path), read_chunks(path)
    xyz = chunk.columns["xyz"] * np.array(info.scale) + np.array(info.offset)
    for axis, name in enumerate(POSITION):
        np.testing.assert_allclose(xyz[:, axis], values[:, kept.index(name)], atol=1e-4)
    for name in set(kept) - set(POSITION):
        np.testing.assert_array_equal(chunk.columns[name], values[:, kept.index(name)])
