"""Classes of a flight whose truth is known; what is a flight and what a street."""

from __future__ import annotations

from pathlib import Path

import laspy
import numpy as np
import pytest
from numpy.typing import NDArray

from processing.core.errors import Unsuitable
from processing.core.monitor import SilentMonitor
from processing.labels.label_column import make_column, write_labels
from processing.laboratory.simulate.airborne.flight import fly_over
from processing.laboratory.simulate.airborne.landscapes import landscape_of
from processing.laboratory.simulate.airborne.power_lines import HIGH, power_line
from processing.methods.classes.aerial_cells import is_from_air, spacing_m
from processing.operations.learn import learn
from processing.project.importing.import_request import ImportRequest
from processing.project.importing.importing import import_drives
from processing.recording.columns.source_order import sources_of
from processing.recording.drive import Drive
from processing.scoring.points.class_scores import class_score
from processing.scoring.points.confusion_matrix import ConfusionMatrix
from processing.tools.classify import ClassifyParameters
from processing.tools.running.runner import RunRequest, columns_of, run_together

SPACING_M = 0.6


@pytest.fixture(scope="module")
def flight(tmp_path_factory: pytest.TempPathFactory) -> tuple[Drive, NDArray[np.uint8]]:
    """A village under a power line, of a seed that nothing was learnt from."""
    folder = tmp_path_factory.mktemp("flight")
    land = landscape_of("village", 4303, 100.0)
    parts = [fly_over(land, 4303, SPACING_M, (0.03, 0.02))]
    parts.append(power_line(land, 4303, SPACING_M, HIGH))
    xyz, codes, number, returns = (
        np.concatenate([getattr(one, name) for one in parts])
        for name in ("xyz", "codes", "number", "returns")
    )
    header = laspy.LasHeader(point_format=6, version="1.4")
    header.offsets, header.scales = xyz.min(axis=0), np.full(3, 0.001)
    points = laspy.LasData(header)
    points.x, points.y, points.z = xyz.T
    points.return_number, points.number_of_returns = number, returns
    points.write(folder / "上空.laz")
    delivered = ImportRequest((folder / "上空.laz",))
    (drive,) = import_drives(delivered, folder / "drives", SilentMonitor())
    imported = Drive(drive)
    _, indices = sources_of(
        imported.columns, imported.info.source_runs, 0, imported.count, sources=1
    )
    return imported, codes[indices]


def test_a_flight_is_told_by_how_far_apart_its_points_lie(
    flight: tuple[Drive, NDArray[np.uint8]],
) -> None:
    drive, codes = flight
    # Two strips: each square of the spacing holds two pulses, and some more returns.
    assert spacing_m([drive]) == pytest.approx(100.0 / np.sqrt(codes.size), rel=0.15)
    assert is_from_air(drive)


def test_a_flight_is_classified_and_the_result_says_by_which_model(
    flight: tuple[Drive, NDArray[np.uint8]], tmp_path: Path
) -> None:
    drive, codes = flight
    request = RunRequest("classify", drive, ClassifyParameters())
    result = run_together(request, SilentMonitor(), into=tmp_path / "air")
    found = np.array(columns_of(result.columns[0])["classification"])
    score = class_score(ConfusionMatrix.of(codes, found))
    assert score.class_of("2").f_measure > 0.97
    assert score.class_of("5").f_measure > 0.85
    assert score.class_of("6").f_measure > 0.85
    assert score.class_of("14").f_measure > 0.8
    assert "from the air" in result.note.en
    assert "上空" in result.note.ja


def test_corrections_of_a_flight_are_refused_and_kept(
    flight: tuple[Drive, NDArray[np.uint8]], tmp_path: Path
) -> None:
    drive, _ = flight
    make_column(drive)
    points = np.arange(0, drive.count, 10)
    write_labels(drive, points, np.full(points.size, 6, np.uint8))
    with pytest.raises(Unsuitable) as refusal:
        learn([drive], tmp_path / "model", SilentMonitor())
    assert "from the air" in refusal.value.line("en")
    assert not (tmp_path / "model").exists()
    assert np.asarray(drive.columns["label"])[points].tolist() == [6] * points.size


def test_a_handful_of_points_is_no_flight(tmp_path: Path) -> None:
    header = laspy.LasHeader(point_format=6, version="1.4")
    points = laspy.LasData(header)
    points.x, points.y, points.z = np.arange(5.0), np.zeros(5), np.zeros(5)
    points.write(tmp_path / "five.laz")
    delivered = ImportRequest((tmp_path / "five.laz",))
    (folder,) = import_drives(delivered, tmp_path / "drives", SilentMonitor())
    drive = Drive(folder)
    assert not is_from_air(drive)
    request = RunRequest("classify", drive, ClassifyParameters(looks_for_things=False))
    result = run_together(request, SilentMonitor(), into=tmp_path / "few")
    assert np.array(columns_of(result.columns[0])["classification"]).shape == (5,)
