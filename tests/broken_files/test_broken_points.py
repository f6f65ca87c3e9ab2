"""Damaged point files end in points or in one sentence that names the file and a remedy."""

from __future__ import annotations

import io
import os
import struct
from pathlib import Path

import laspy
import lazrs
import numpy as np
import pytest

from processing.core.errors import BadFile, MissingInput, UserError
from processing.core.monitor import SilentMonitor
from processing.formats.points.las.decoder_panics import is_panic, panics_unprinted
from processing.formats.points.las.las_header import read_header
from processing.formats.points.las_results import write_results
from processing.formats.points.point_files import read_chunks, read_info, read_sample
from tests.broken_files.damage import check_refusal, flipped, outcome, overwritten
from tests.delivered_files import make_las, ply_bytes

_FLIPS = 150


def _read_all(path: Path) -> int:
    read_info(path)
    read_sample(path, 50)
    return sum(chunk.count for chunk in read_chunks(path))


def _refusal(path: Path) -> UserError:
    error = outcome(lambda: _read_all(path), path)
    assert error is not None
    return error


@pytest.mark.parametrize("ending", ["las", "laz"])
def test_a_file_cut_at_any_byte_is_refused(tmp_path: Path, ending: str) -> None:
    path = tmp_path / f"道路.{ending}"
    make_las(path, count=3)
    whole = path.read_bytes()
    for size in range(len(whole)):
        path.write_bytes(whole[:size])
        # Three points are all there when only the record after them is cut.
        if outcome(lambda: _read_all(path), path) is None:
            assert ending == "laz"
            pytest.fail(f"{size} of {len(whole)} bytes were taken for the whole file")


def test_a_cut_las_names_the_point_where_it_ends(tmp_path: Path) -> None:
    path = tmp_path / "a.las"
    make_las(path, count=100)
    data = path.read_bytes()
    path.write_bytes(data[: read_header(path).points_at + 30 * 40 + 7])
    error = _refusal(path)
    assert "point 41 of 100" in error.what.en
    assert "100点のうち41点目" in error.what.ja


@pytest.mark.parametrize("point_format", [0, 1, 3, 4, 6, 7, 10])
@pytest.mark.parametrize("ending", ["las", "laz"])
def test_flipped_bits_end_in_points_or_in_a_sentence(
    tmp_path: Path, point_format: int, ending: str, capfd: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / f"a.{ending}"
    make_las(path, point_format=point_format, count=300, with_extra=True)
    data = path.read_bytes()
    results = [
        outcome(lambda: _read_all(path), path)
        for damaged in (*flipped(data, _FLIPS, 1), *overwritten(data, _FLIPS // 3, 2))
        if path.write_bytes(damaged)
    ]
    assert any(results)
    assert "panicked" not in capfd.readouterr().err


@pytest.mark.parametrize(
    ("byte", "form", "value"),
    [
        (247, "<Q", 10**12),
        (247, "<Q", 2**64 - 1),
        (96, "<I", 2**32 - 1),
        (96, "<I", 0),
        (94, "<H", 65535),
        (100, "<I", 2**32 - 1),
        (104, "<B", 0x80 | 99),
        (105, "<H", 0),
        (105, "<H", 65535),
        (235, "<Q", 2**63),
        (131, "<d", 0.0),
        (131, "<d", np.nan),
        (139, "<d", np.inf),
        (155, "<d", np.nan),
        (163, "<d", 1e300),
        (24, "<B", 2),
        (25, "<B", 9),
    ],
)
@pytest.mark.parametrize("ending", ["las", "laz"])
def test_a_header_that_lies_is_refused_without_allocating(
    tmp_path: Path, byte: int, form: str, value: float, ending: str
) -> None:
    path = tmp_path / f"a.{ending}"
    make_las(path, count=100)
    data = bytearray(path.read_bytes())
    data[byte : byte + struct.calcsize(form)] = struct.pack(form, value)
    if byte == 235:
        data[243:247] = struct.pack("<I", 3)
    path.write_bytes(data)
    assert isinstance(_refusal(path), BadFile)


def test_a_record_longer_than_the_file_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.las"
    make_las(path)
    data = bytearray(path.read_bytes())
    data[375 + 20 : 375 + 22] = b"\xff\xff"
    path.write_bytes(data)
    assert "record 1 of" in _refusal(path).what.en


@pytest.mark.parametrize(
    ("position", "value"),
    [(0, 1), (0, 99), (2, 7), (12, 0), (12, 7), (12, 2**31), (32, 60_000), (34, 99), (36, 29)],
)
def test_a_compressor_record_that_lies_is_refused(
    tmp_path: Path, position: int, value: int
) -> None:
    path = tmp_path / "a.laz"
    make_las(path, count=300)
    data = bytearray(path.read_bytes())
    record = data.index(b"laszip encoded") + 52
    form = "<I" if position == 12 else "<H"
    data[record + position : record + position + struct.calcsize(form)] = struct.pack(form, value)
    path.write_bytes(data)
    error = outcome(lambda: _read_all(path), path)
    # One chunk of 300 points is whole whatever larger size the record gives to chunks.
    assert (error is None) == (value == 2**31)


@pytest.mark.parametrize("value", [0, -1, -2, 2**62, 400])
def test_a_chunk_table_elsewhere_is_refused(tmp_path: Path, value: int) -> None:
    path = tmp_path / "a.laz"
    make_las(path)
    data = bytearray(path.read_bytes())
    start = read_header(path).points_at
    data[start : start + 8] = struct.pack("<q", value)
    path.write_bytes(data)
    _refusal(path)


@pytest.mark.parametrize("chunks", [0, 2, 1000, 2**32 - 1])
def test_a_chunk_table_with_another_number_of_chunks_is_refused(
    tmp_path: Path, chunks: int
) -> None:
    path = tmp_path / "a.laz"
    make_las(path)
    data = bytearray(path.read_bytes())
    table = struct.unpack_from("<q", data, read_header(path).points_at)[0]
    data[table + 4 : table + 8] = struct.pack("<I", chunks)
    path.write_bytes(data)
    assert "chunk table" in _refusal(path).what.en


def test_layers_longer_than_their_chunk_are_refused_before_decoding(tmp_path: Path) -> None:
    path = tmp_path / "a.laz"
    make_las(path, count=300)
    data = bytearray(path.read_bytes())
    sizes = read_header(path).points_at + 8 + 30 + 4
    data[sizes : sizes + 4] = struct.pack("<I", 2**32 - 1)
    path.write_bytes(data)
    assert "Points 1 to 300" in _refusal(path).what.en


@pytest.mark.parametrize("value", [2**31 - 1, -(2**31), 1_900_000_000])
def test_a_coordinate_far_outside_is_told_with_its_point(tmp_path: Path, value: int) -> None:
    path = tmp_path / "a.las"
    make_las(path, count=100)
    data = bytearray(path.read_bytes())
    position = read_header(path).points_at + 30 * 40 + 4
    data[position : position + 4] = struct.pack("<i", value)
    path.write_bytes(data)
    error = _refusal(path)
    assert "Y of point 41" in error.what.en


def test_what_a_panicking_decoder_prints_is_kept_from_the_terminal(
    capfd: pytest.CaptureFixture[str],
) -> None:
    record = bytearray(lazrs.LazVlr.new_for_compression(6, 0).record_data())
    record[12:16] = b"\xff" * 4
    raised: BaseException | None = None
    with panics_unprinted(), panics_unprinted():
        os.write(2, b"before\n")
        try:
            lazrs.LasZipDecompressor(io.BytesIO(struct.pack("<q", -1)), bytes(record)).seek(5)
        except BaseException as error:  # noqa: BLE001 - a panic is no Exception
            raised = error
        os.write(2, b"after\n")
    assert raised is not None
    printed = capfd.readouterr().err
    assert printed == "before\nafter\n"
    assert is_panic(raised) or isinstance(raised, lazrs.LazrsError)


@pytest.mark.parametrize("form", ["ascii", "binary_little_endian", "binary_big_endian"])
def test_a_damaged_ply_ends_in_points_or_in_a_sentence(tmp_path: Path, form: str) -> None:
    path = tmp_path / "a.ply"
    data = ply_bytes(form, count=20)
    for damaged in (*flipped(data, _FLIPS, 3), *(data[:size] for size in range(0, len(data), 7))):
        path.write_bytes(damaged)
        outcome(lambda: _read_all(path), path)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (b"vertex 20", b"vertex 99999999999"),
        (b"vertex 20", b"vertex -1"),
        (b"vertex 20", b"vertex many"),
        (b"element vertex", b"element edge"),
        (b"property float32 x\n", b""),
        (b"float32 x\n", b"float99 x\n"),
        (b"float32 z\n", b"float32 y\n"),
        (b"end_header", b"end_of_it"),
        (b"binary_little_endian", b"binary_middle_endian"),
        (b"Pos 649000.000000", b"Pos east"),
    ],
)
def test_a_ply_header_that_lies_is_refused(tmp_path: Path, old: bytes, new: bytes) -> None:
    path = tmp_path / "a.ply"
    data = ply_bytes(count=20)
    assert old in data
    path.write_bytes(data.replace(old, new, 1))
    _refusal(path)


def test_signalling_nans_warn_of_nothing(tmp_path: Path) -> None:
    path = tmp_path / "a.ply"
    data = bytearray(ply_bytes(count=20))
    first = data.index(b"end_header\n") + len(b"end_header\n")
    for start in range(first, first + 20 * 38, 38):
        data[start : start + 8] = b"\x01\0\0\0\0\0\xf0\x7f"
        data[start + 8 : start + 12] = data[start + 34 : start + 38] = b"\x01\0\x80\x7f"
    path.write_bytes(data)
    assert _read_all(path) == 0


@pytest.mark.parametrize(
    ("text", "line"),
    [("1 2 3\n4 5 six\n7 8 9\n", 2), ("1 2 3\n\n4 5\n", 3), ("x,y,z\n1,2,3\n1,2,\n", 3)],
)
def test_a_text_line_that_is_no_point_is_named(tmp_path: Path, text: str, line: int) -> None:
    path = tmp_path / "点群.csv"
    path.write_text(text)
    error = _refusal(path)
    assert f"line {line}" in error.where.en
    assert f"{line}行目" in error.where.ja


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"\0" * 5000,
        b"LASF",
        b"ply",
        b"ASTM-E57",
        b"VERSION 0.7\n",
        b"2\n2\n0 0 0\n1 0 0\n",
        "観測手簿\n".encode("cp932"),
        b"a,b,c\n1,2,3\n",
        b"1 2\n3 4\n",
        b"\x89PNG\r\n\x1a\n" + bytes(100),
        b"x" * 100_000,
    ],
)
def test_what_is_no_point_file_is_refused(tmp_path: Path, data: bytes) -> None:
    path = tmp_path / "何か.las"
    path.write_bytes(data)
    _refusal(path)


def test_random_bytes_behind_every_magic_are_refused(tmp_path: Path) -> None:
    random = np.random.default_rng(0)
    path = tmp_path / "a.bin"
    for magic in (b"LASF", b"ply\n", b"ASTM-E57", b"VERSION 0.7\n", b""):
        for _ in range(20):
            path.write_bytes(magic + random.bytes(3000))
            _refusal(path)


def test_a_damaged_e57_is_refused_and_left_where_it_is(tmp_path: Path) -> None:
    import pye57

    path = tmp_path / "a.e57"
    file = pye57.E57(str(path), mode="w")
    values = np.random.default_rng(0).normal(0, 10, (3, 400))
    names = ("cartesianX", "cartesianY", "cartesianZ")
    file.write_scan_raw(dict(zip(names, values, strict=True)))
    file.close()
    data = path.read_bytes()
    refused = 0
    for damaged in (*flipped(data, 60, 4), *(data[:size] for size in range(0, len(data), 997))):
        path.write_bytes(damaged)
        refused += outcome(lambda: _read_all(path), path) is not None
        assert path.read_bytes() == damaged
    assert refused > 60


@pytest.mark.parametrize("read", [read_info, lambda path: read_sample(path, 5), _read_all])
def test_a_missing_file_and_a_folder_are_told(tmp_path: Path, read: object) -> None:
    assert callable(read)
    with pytest.raises(MissingInput) as refusal:
        read(tmp_path / "無い.las")
    check_refusal(refusal.value, tmp_path / "無い.las")
    with pytest.raises(UserError) as refusal:
        read(tmp_path)
    check_refusal(refusal.value, tmp_path)


def test_results_for_a_damaged_input_leave_nothing_behind(tmp_path: Path) -> None:
    path = tmp_path / "a.laz"
    make_las(path, count=300)
    data = bytearray(path.read_bytes())
    sizes = read_header(path).points_at + 8 + 30 + 4
    data[sizes : sizes + 4] = struct.pack("<I", 2**32 - 1)
    path.write_bytes(data)
    results = {"classification": np.ones(300, dtype=np.uint8)}
    error = outcome(lambda: write_results(path, tmp_path / "b.laz", results, SilentMonitor()), path)
    assert error is not None
    assert list(tmp_path.iterdir()) == [path]


def test_a_file_of_one_point_a_chunk_is_not_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.laz"
    make_las(path, count=1)
    assert _read_all(path) == len(laspy.read(path)) == 1
