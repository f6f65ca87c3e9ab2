"""Pulse folders: every echo at its place and time, pulses without an echo leave a gap in time."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from processing.core.errors import BadFile
from processing.formats.points.point_files import read_chunks, read_info

INTERVAL_S = 4e-6
START_S = 1_000.0


def write_folder(folder: Path, theta: np.ndarray, echoes: np.ndarray, ranges: np.ndarray) -> None:
    """One second's file of each attribute, as the scanner's software writes them."""
    for attribute, values in (
        ("pulse-float32-theta", theta.astype("<f4")),
        ("pulse-uint8-n_echo", echoes.astype("u1")),
        ("echo-float32-range", ranges.astype("<f4")),
        ("echo-float32-reflectance", np.linspace(-20, 5, ranges.size).astype("<f4")),
    ):
        path = folder / attribute / "100.bin"
        path.parent.mkdir(parents=True)
        values.tofile(path)
    times = folder / "pulse-linear-time" / "100.txt"
    times.parent.mkdir()
    times.write_text(f"{theta.size} entries {START_S} + {INTERVAL_S} pulse_index\n")


@pytest.fixture
def turn() -> tuple[np.ndarray, np.ndarray]:
    """One turn of 360 pulses; those that look up have no echo, every tenth other has two."""
    theta = np.radians(np.arange(-180, 180) + 0.5)
    echoes = np.where(np.abs(theta - 1.0) < 0.8, 0, 1)
    echoes[::10] *= 2
    return theta, echoes


def test_echoes_lie_on_their_rays_with_the_sky_upwards(tmp_path, turn):
    theta, echoes = turn
    write_folder(tmp_path, theta, echoes, np.full(echoes.sum(), 5.0))
    info = read_info(tmp_path)
    (chunk,) = read_chunks(tmp_path)
    assert (info.format, info.count) == ("pulse folder", echoes.sum())
    xyz = chunk.columns["xyz"] * np.array(info.scale) + np.array(info.offset)
    assert np.abs(np.linalg.norm(xyz, axis=1) - 5.0).max() < 2e-4
    # Nothing returns from within 0.8 rad of straight up.
    assert xyz[:, 2].max() < 5.0 * np.cos(0.8 - 0.02)


def test_times_are_those_of_the_pulses_and_echoes_share_their_pulse(tmp_path, turn):
    theta, echoes = turn
    write_folder(tmp_path, theta, echoes, np.full(echoes.sum(), 5.0))
    columns = next(iter(read_chunks(tmp_path))).columns
    pulses = np.rint((columns["time"] - START_S) / INTERVAL_S).astype(int)
    assert pulses.tolist() == np.repeat(np.arange(echoes.size), echoes).tolist()
    assert columns["number_of_returns"].tolist() == np.repeat(echoes, echoes).tolist()
    doubles = columns["number_of_returns"] == 2
    assert columns["return_number"][doubles].tolist() == [1, 2] * (doubles.sum() // 2)


@pytest.mark.parametrize("attribute", ["echo-float32-range", "pulse-float32-theta"])
def test_a_cut_file_is_refused_with_its_place(tmp_path, turn, attribute):
    theta, echoes = turn
    write_folder(tmp_path, theta, echoes, np.full(echoes.sum(), 5.0))
    path = tmp_path / attribute / "100.bin"
    for cut in (1, 4):
        path.write_bytes(path.read_bytes()[:-cut])
        with pytest.raises(BadFile) as refusal:
            list(read_chunks(tmp_path))
        assert str(tmp_path) in refusal.value.where.en


def test_a_missing_attribute_is_named(tmp_path, turn):
    theta, echoes = turn
    write_folder(tmp_path, theta, echoes, np.full(echoes.sum(), 5.0))
    (tmp_path / "echo-float32-range" / "100.bin").unlink()
    (tmp_path / "echo-float32-range").rmdir()
    with pytest.raises(BadFile, match="range"):
        read_info(tmp_path)
