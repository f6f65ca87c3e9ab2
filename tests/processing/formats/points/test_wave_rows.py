"""Rows of text with a waveform each become points with waveforms."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from processing.core.errors import BadFile
from processing.core.monitor import SilentMonitor
from processing.formats.points.point_files import read_info
from processing.project.importing.import_request import ImportRequest
from processing.project.importing.importing import import_drives
from processing.recording.drive import Drive
from processing.recording.waveforms import waveforms_of

_SAMPLES = 40
_ROWS = 50


def _rows(first_ns: float = 12.0) -> np.ndarray:
    """Points 1 m apart, each with an echo of its own height at one place and a second behind."""
    random = np.random.default_rng(2)
    times = np.arange(_SAMPLES)
    heights = random.integers(40, 200, _ROWS)
    wave = heights[:, None] * np.exp(-0.5 * ((times - first_ns) / 1.8) ** 2)
    wave += 0.8 * heights[:, None] * np.exp(-0.5 * ((times - 26) / 1.8) ** 2)
    xyz = np.column_stack([1000.0 + np.arange(_ROWS), np.full(_ROWS, -500.25), np.full(_ROWS, 7.5)])
    label = random.choice([2, 5, 11], _ROWS)
    return np.column_stack([xyz, label, np.rint(wave)])


def _write(path: Path, rows: np.ndarray, header: str = "") -> Path:
    np.savetxt(path, rows, fmt="%g", header=header, comments="# " if header else "")
    return path


def _drive(path: Path, tmp_path: Path) -> Drive:
    (folder,) = import_drives(ImportRequest((path,)), tmp_path / "drives", SilentMonitor())
    return Drive(folder)


@pytest.mark.parametrize("header", ["", " ".join(["x y z label", *(f"w{i}" for i in range(40))])])
def test_rows_with_waveforms_keep_points_classes_and_samples(tmp_path: Path, header: str) -> None:
    rows = _rows()
    drive = _drive(_write(tmp_path / "波形.txt", rows, header), tmp_path)
    np.testing.assert_allclose(drive.xyz(np.arange(_ROWS)), rows[:, :3], atol=1e-3)
    assert drive.columns["classification"][:].tolist() == rows[:, 3].astype(int).tolist()
    waveforms = waveforms_of(drive)
    numbers = waveforms.pulse_of(np.arange(_ROWS))
    pulses = waveforms.pulses(numbers)
    volts = pulses.offset[:, None] + pulses.gain[:, None] * waveforms.samples_of(numbers)
    np.testing.assert_allclose(volts, rows[:, 4:], atol=2e-3)
    np.testing.assert_allclose(waveforms.location_ns(np.arange(_ROWS)), 12.0)
    assert pulses.interval_ns == pytest.approx(np.ones(_ROWS))


def test_later_samples_lie_lower(tmp_path: Path) -> None:
    drive = _drive(_write(tmp_path / "rows.txt", _rows()), tmp_path)
    waveforms = waveforms_of(drive)
    pulses = waveforms.pulses(waveforms.pulse_of(np.arange(3)))
    assert (pulses.direction[:, 2] < 0).all()


def test_fractions_and_negative_samples_stay(tmp_path: Path) -> None:
    rows = _rows()
    rows[:, 4:] = np.round(rows[:, 4:] * 0.37 - 1.25, 3)
    path = tmp_path / "cleaned.txt"
    np.savetxt(path, rows, fmt="%.3f", delimiter=",")
    waveforms = waveforms_of(_drive(path, tmp_path))
    numbers = waveforms.pulse_of(np.arange(_ROWS))
    pulses = waveforms.pulses(numbers)
    volts = pulses.offset[:, None] + pulses.gain[:, None] * waveforms.samples_of(numbers)
    np.testing.assert_allclose(volts, rows[:, 4:], atol=2e-3)


def test_a_row_of_another_length_is_named(tmp_path: Path) -> None:
    path = _write(tmp_path / "rows.txt", _rows())
    lines = path.read_text().splitlines()
    lines[16] = " ".join(lines[16].split()[:-3])
    path.write_text("\n".join(lines) + "\n")
    with pytest.raises(BadFile, match="line 17"):
        _drive(path, tmp_path)


def test_points_with_few_attributes_are_no_waveforms(tmp_path: Path) -> None:
    path = _write(tmp_path / "points.txt", _rows()[:, :12])
    assert read_info(path).waveforms is None
