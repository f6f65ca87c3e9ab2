"""Noise found in a project is a layer of labels, one step; by the command line a new file."""

from __future__ import annotations

from argparse import Namespace
from pathlib import Path

import laspy
import numpy as np
import pytest
from numpy.typing import NDArray
from pytestqt.qtbot import QtBot

from app.cli.run import command
from app.document.document import Document
from processing.core.text import Text
from processing.labels.label_column import labels_of
from processing.map.change import Change
from processing.map.label_change import LabelChange
from processing.project.importing.importing import ImportRequest
from processing.recording.drive import Drive
from processing.tools.noise import NoiseParameters
from tests.builders import write_laz, write_trajectory_csv
from tests.noisy_street import NoisyStreet, noisy_street

WAIT_MS = 30_000
SIGN = 65


@pytest.fixture(scope="module")
def scene() -> NoisyStreet:
    made = noisy_street(7, length_m=6.0)
    made.drive.columns["classification"][:] = np.arange(made.drive.count) % 5
    made.drive.columns["classification"][:50] = 18
    return made


@pytest.fixture
def delivery(scene: NoisyStreet, tmp_path: Path) -> ImportRequest:
    cloud = write_laz(scene.drive, tmp_path / "左.laz")
    return ImportRequest((cloud,), (write_trajectory_csv(scene.drive, tmp_path / "軌跡.csv"),))


def find_noise(document: Document, qtbot: QtBot, **parameters: float | str) -> Text:
    """Run the tool; gives what was told."""
    reported: list[Text] = []
    document.reported.connect(reported.append)
    (drive,) = document.drives()
    with qtbot.waitSignal(document.reported, timeout=WAIT_MS):
        document.start_run("noise", drive.id, NoiseParameters(**parameters))  # type: ignore[arg-type] - by name
    return reported[-1]


def all_labels(drive: Drive) -> NDArray[np.uint8]:
    return labels_of(drive, np.arange(drive.count))


def paint(document: Document, points: NDArray[np.int64], code: int) -> None:
    (drive,) = document.drives()
    after = np.full(points.size, code, np.uint8)
    change = LabelChange.of(drive.id, points, labels_of(drive, points), after)
    assert document.apply(Text.same("paint"), Change(labels=(change,)))


def test_noise_is_a_layer_of_labels_that_one_undo_takes_back(
    street: Document, scene: NoisyStreet, qtbot: QtBot
) -> None:
    (drive,) = street.drives()
    delivered = np.array(drive.columns["classification"])
    reported = find_noise(street, qtbot)
    labels = all_labels(drive)
    assert set(np.unique(labels)) == {0, 7, 18}
    is_noise = scene.noise > 0
    assert ((labels > 0) == is_noise)[50:].mean() > 0.99
    assert reported.en == f"Noise: {(labels > 0).sum():,} points classified"
    # What was delivered as noise has that class already.
    np.testing.assert_array_equal(drive.columns["classification"], delivered)
    (run,) = street.runs()
    assert (run.tool, run.parameters["method"]) == ("noise", "combined")
    assert street.undo()
    assert not all_labels(drive).any()
    assert street.redo()
    np.testing.assert_array_equal(all_labels(drive), labels)


def test_labels_by_hand_stay_and_those_of_an_earlier_run_are_taken_back(
    street: Document, scene: NoisyStreet, qtbot: QtBot
) -> None:
    (drive,) = street.drives()
    noise = np.flatnonzero(scene.noise == 7)[:40]
    paint(street, noise, SIGN)
    find_noise(street, qtbot, method="radius", neighbours=2000)
    by_radius = all_labels(drive)
    assert (by_radius[50:] > 0).all()
    reported = find_noise(street, qtbot)
    labels = all_labels(drive)
    assert (labels[noise] == SIGN).all()
    assert (labels > 0).mean() < 0.1
    assert "taken back" in reported.en
    assert street.undo()
    np.testing.assert_array_equal(all_labels(drive), by_radius)


def test_noise_painted_by_hand_stays_whatever_a_run_says(
    street: Document, scene: NoisyStreet, qtbot: QtBot
) -> None:
    (drive,) = street.drives()
    find_noise(street, qtbot, method="radius", neighbours=2)
    road = np.flatnonzero((scene.noise == 0) & (all_labels(drive) == 0))[1000:1040]
    paint(street, road, 7)
    find_noise(street, qtbot, method="radius", neighbours=1)
    assert (all_labels(drive)[road] == 7).all()


def test_points_painted_while_the_tool_runs_keep_what_was_painted(
    street: Document, scene: NoisyStreet, qtbot: QtBot
) -> None:
    (drive,) = street.drives()
    find_noise(street, qtbot)
    before = all_labels(drive)
    assert street.undo()
    noise = np.flatnonzero(before > 0)[:20]
    reported: list[Text] = []
    street.reported.connect(reported.append)
    street.start_run("noise", drive.id, NoiseParameters())
    # The job's result comes on this thread, so what is painted now is painted before it comes.
    paint(street, noise, SIGN)
    qtbot.waitUntil(lambda: bool(reported), timeout=WAIT_MS)
    labels = all_labels(drive)
    assert (labels[noise] == SIGN).all()
    rest = np.setdiff1d(np.arange(drive.count), noise)
    np.testing.assert_array_equal(labels[rest], before[rest])


@pytest.mark.parametrize("method", ["combined", "radius", "statistical"])
def test_the_command_line_keeps_order_places_and_all_other_classes(
    scene: NoisyStreet, delivery: ImportRequest, tmp_path: Path, method: str
) -> None:
    output = tmp_path / "out.laz"
    (source,) = delivery.inputs
    arguments = Namespace(
        columns="",
        tool="noise",
        inputs=[source],
        trajectory=list(delivery.trajectories),
        images=[],
        crs="",
        set=[f"method={method}", "neighbours=30"],
        output=output,
    )
    assert command(arguments) == 0
    given, found = laspy.read(source), laspy.read(output)
    for name in ("X", "Y", "Z", "gps_time", "intensity"):
        np.testing.assert_array_equal(given[name], found[name])
    before, after = np.asarray(given.classification), np.asarray(found.classification)
    changed = before != after
    assert changed.any()
    assert set(np.unique(after[changed])) <= {7, 18}
    assert {path.name for path in tmp_path.iterdir()} == {"左.laz", "軌跡.csv", "out.laz"}
