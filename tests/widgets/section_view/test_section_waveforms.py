"""Pulses in a section lie along their rays, and their peaks where their returns are."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from processing.section.cut import Cut
from processing.section.points_in_cut import section_points
from tests.waveform_flight import import_flight, write_flight
from widgets.section_view.picture.section_waveforms import waveforms_in


def test_the_highest_sample_of_each_pulse_lies_on_the_ground_or_in_the_crown(
    tmp_path: Path,
) -> None:
    drive = import_flight(write_flight(tmp_path / "a.las", 300).path, tmp_path / "into")
    cut = Cut((0.0, 20.0, 0.0), (1.0, 0.0), 4.0, 25.0)
    points = section_points(drive, cut, 100_000)
    shown = waveforms_in([drive], [points], cut)
    owners = drive.columns["return_number"][points.points] == 1
    assert len(shown) == owners.sum() > 10
    for one in shown:
        height = one.section[int(one.above_base.argmax()), 1]
        assert min(abs(height), abs(height - 3.0)) < 0.1
        assert (np.diff(one.section[:, 1]) < 0).all()
        assert (np.abs(one.section[:, 2]) < 4.0).all()
