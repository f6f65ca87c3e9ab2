"""Damaged trajectories and image lists end in values or in one sentence with its place."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from processing.core.errors import MissingInput, UserError
from processing.formats.trajectories.image_list import read_image_list
from processing.formats.trajectories.trajectory_files import read_trajectory
from tests.broken_files.damage import check_refusal, flipped, outcome, overwritten
from tests.delivered_files import sbet_bytes, trajectory_rows, trajectory_text

_IMAGES = (
    "path,time_s,easting_m,northing_m,height_m,omega_deg,phi_deg,kappa_deg,"
    "focal_px,cx_px,cy_px,width_px,height_px,projection\n"
    "画像/a.jpg,10.5,1,2,3,90,0,-30,500,399.5,299.5,800,600,perspective\n"
)
_CELLS = st.lists(st.text(max_size=12), max_size=9).map(",".join)


def _read_trajectory(path: Path) -> object:
    return read_trajectory(path, "EPSG:6677")


@pytest.mark.parametrize(
    ("name", "data"),
    [
        ("軌跡.csv", trajectory_text(trajectory_rows(20)).encode()),
        ("sbet.out", sbet_bytes(20)),
    ],
)
def test_a_damaged_trajectory_ends_in_values_or_in_a_sentence(
    tmp_path: Path, name: str, data: bytes
) -> None:
    path = tmp_path / name
    results = [
        outcome(lambda: _read_trajectory(path), path)
        for damaged in (*flipped(data, 300, 1), *overwritten(data, 100, 2))
        if path.write_bytes(damaged)
    ]
    assert any(results)


@pytest.mark.parametrize("data", [trajectory_text(trajectory_rows(4)).encode(), sbet_bytes(3)])
def test_a_trajectory_cut_at_any_byte_is_whole_records_or_refused(
    tmp_path: Path, data: bytes
) -> None:
    path = tmp_path / "軌跡.out"
    for size in range(len(data)):
        path.write_bytes(data[:size])
        outcome(lambda: _read_trajectory(path), path)


def test_an_sbet_that_ends_inside_a_record_is_refused_with_the_record(tmp_path: Path) -> None:
    path = tmp_path / "sbet.out"
    path.write_bytes(sbet_bytes(20)[:-5])
    error = outcome(lambda: _read_trajectory(path), path)
    assert error is not None
    assert "record 20" in error.where.en


def test_a_damaged_image_list_ends_in_images_or_in_a_sentence(tmp_path: Path) -> None:
    path = tmp_path / "images.csv"
    data = _IMAGES.encode("cp932")
    for damaged in (*flipped(data, 200, 5), *(data[:size] for size in range(len(data)))):
        path.write_bytes(damaged)
        outcome(lambda: read_image_list(path), path)


@given(rows=st.lists(_CELLS, max_size=6), keeps_header=st.booleans())
def test_any_text_is_a_trajectory_or_refused(
    tmp_path_factory: pytest.TempPathFactory, rows: list[str], keeps_header: bool
) -> None:
    path = tmp_path_factory.getbasetemp() / "any.csv"
    header = trajectory_text(trajectory_rows(0))
    text = (header if keeps_header else "") + "\n".join(rows)
    path.write_bytes(text.encode("utf-8", "surrogatepass"))
    outcome(lambda: read_trajectory(path, ""), path)


@pytest.mark.parametrize("read", [_read_trajectory, read_image_list])
def test_a_missing_file_and_a_folder_are_told(
    tmp_path: Path, read: Callable[[Path], object]
) -> None:
    path = tmp_path / "無い.csv"
    with pytest.raises(MissingInput) as refusal:
        read(path)
    check_refusal(refusal.value, path)
    with pytest.raises(UserError) as folder:
        read(tmp_path)
    check_refusal(folder.value, tmp_path)
