"""Classes of a street whose truth is known, and of what can hardly be classified."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.core.monitor import SilentMonitor
from processing.laboratory.accuracy.road.true_labels import labels_of_drive
from processing.laboratory.simulate.requests import StreetRequest
from processing.laboratory.simulate.streets import simulate_street
from processing.project.importing.import_request import ImportRequest
from processing.project.importing.importing import import_drives
from processing.recording.drive import Drive
from processing.scoring.points.class_scores import class_score
from processing.scoring.points.confusion_matrix import ConfusionMatrix
from processing.tools.classify import CLASSES, ClassifyParameters
from processing.tools.running.runner import RunRequest, columns_of, run


@pytest.fixture(scope="module")
def street(tmp_path_factory: pytest.TempPathFactory) -> tuple[Drive, Path]:
    """A town street of 20 m of a seed that nothing was learnt from, by one head."""
    folder = tmp_path_factory.mktemp("classes")
    request = StreetRequest(seed=3150, length_m=20.0, sensor="vq250", images=False)
    simulate_street(request, folder / "street", SilentMonitor())
    delivered = ImportRequest(
        (folder / "street" / "left.laz",), (folder / "street" / "trajectory.csv",)
    )
    (drive,) = import_drives(delivered, folder / "drives", SilentMonitor())
    return Drive(drive), folder / "street" / "truth"


def classes_of(
    drive: Drive, into: Path, least: float = 0.0
) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
    request = RunRequest("classify", drive, ClassifyParameters(least))
    columns = columns_of(run(request, SilentMonitor(), into=into))
    return np.array(columns["classification"]), np.array(columns["confidence"])


def test_a_street_is_classified_with_a_confidence_that_means_something(
    street: tuple[Drive, Path], tmp_path: Path
) -> None:
    drive, folder = street
    truth = labels_of_drive(drive, folder)
    found, confidence = classes_of(drive, tmp_path / "found")
    assert set(np.unique(found)) <= {1, *CLASSES}
    score = class_score(ConfusionMatrix.of(truth, found))
    # Lower than unseen streets of the same simulator have, in docs/accuracy.md.
    assert score.class_of("ground_and_road").f_measure > 0.93
    assert score.class_of("6").f_measure > 0.9
    assert score.class_of("66").f_measure > 0.5
    right, sure = found == truth, confidence > 0.9
    assert right[sure].mean() > right[~sure].mean() + 0.2


def test_what_is_less_sure_than_asked_becomes_other(
    street: tuple[Drive, Path], tmp_path: Path
) -> None:
    found, confidence = classes_of(street[0], tmp_path / "sure", least=0.8)
    assert set(np.unique(found[confidence < 0.8])) == {1}
    assert (found[confidence >= 0.8] != 1).any()
