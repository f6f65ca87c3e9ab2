"""Six classes of a flight whose truth is known, with its waveforms and from points alone."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.core.monitor import SilentMonitor
from processing.laboratory.simulate.flights import simulate_flight
from processing.laboratory.simulate.requests import FlightRequest
from processing.project.importing.import_request import ImportRequest
from processing.project.importing.importing import import_drives
from processing.recording.columns.source_order import sources_of
from processing.recording.drive import Drive
from processing.scoring.points.confusion_matrix import ConfusionMatrix
from processing.scoring.points.six_classes import SIX, as_six_classes, six_class_score
from processing.tools.running.runner import RunRequest, columns_of, run_together
from processing.tools.waveform_classify import WaveformClassifyParameters


@pytest.fixture(scope="module")
def flight(tmp_path_factory: pytest.TempPathFactory) -> tuple[Drive, NDArray[np.uint8]]:
    """A village of a seed that nothing was learnt from; its first strip."""
    folder = tmp_path_factory.mktemp("上空")
    request = FlightRequest(seed=7301, style="village", length_m=70.0, density=6.0)
    simulate_flight(request, folder / "flight", SilentMonitor())
    delivered = ImportRequest((folder / "flight" / "in" / "flight.las",))
    made = import_drives(delivered, folder / "drives", SilentMonitor())
    drive = Drive(made[0])
    _, indices = sources_of(drive.columns, drive.info.source_runs, 0, drive.count, sources=1)
    return drive, np.load(folder / "flight" / "truth" / "truth.npz")["label"][indices]


@pytest.mark.parametrize(("uses_waveforms", "word"), [(True, "by waveforms"), (False, "alone")])
def test_a_flight_gets_six_classes_with_and_without_waveforms(
    flight: tuple[Drive, NDArray[np.uint8]], tmp_path: Path, *, uses_waveforms: bool, word: str
) -> None:
    drive, labels = flight
    parameters = WaveformClassifyParameters(uses_waveforms=uses_waveforms)
    request = RunRequest("waveform-classify", drive, parameters)
    result = run_together(request, SilentMonitor(), into=tmp_path / "classes")
    columns = columns_of(result.columns[0])
    found, sure = np.array(columns["classification"]), np.array(columns["confidence"])
    assert set(np.unique(found)) <= set(SIX)
    assert (sure > 0).all()
    assert (sure <= 1).all()
    score = six_class_score(ConfusionMatrix.of(as_six_classes(labels), found))
    assert score.class_of("2").f_measure > 0.8
    assert score.class_of("5").f_measure > 0.8
    assert word in result.note.en


def test_less_sure_points_become_other(
    flight: tuple[Drive, NDArray[np.uint8]], tmp_path: Path
) -> None:
    request = RunRequest("waveform-classify", flight[0], WaveformClassifyParameters(0.9))
    result = run_together(request, SilentMonitor(), into=tmp_path / "sure")
    columns = columns_of(result.columns[0])
    is_other = np.array(columns["classification"]) == 1
    assert np.array_equal(is_other, np.array(columns["confidence"]) < 0.9)


def test_plants_of_any_height_are_one_class_and_vehicles_are_not_scored() -> None:
    true = np.array([3, 4, 5, 2, 64, 14], np.uint8)
    found = np.array([5, 5, 3, 2, 2, 13], np.uint8)
    score = six_class_score(ConfusionMatrix.of(true, found))
    assert score.class_of("5").f_measure == 1.0
    assert score.class_of("14").f_measure == 1.0
    assert score.class_of("2").hits + score.class_of("2").misses == 1
