"""Epochs of a site: which scans are one survey, on which day, and whether their ground is known."""

from __future__ import annotations

from datetime import date
from pathlib import Path

import numpy as np
import pytest

from processing.core.monitor import SilentMonitor
from processing.labels.label_column import make_column, write_labels
from processing.project.importing.importing import ImportRequest, import_drives
from processing.project.volumes.epochs import epochs_of, has_ground
from processing.project.volumes.volume import SideKind
from processing.recording.drive import Drive
from tests.builders import simulated_drive, write_laz

DAY_S = 86_400.0
APRIL = 1_459_000_000.0  # standard GPS time of the 31st of March 2026, 13:46 UTC


def _epoch(folder: Path, name: str, first_s: float) -> Drive:
    """A small survey whose points were measured within seconds of a time."""
    street = simulated_drive(1, length_m=2.0)
    times = street.columns["time"]
    times[:] = first_s + (times[:] - times[0])
    cloud = write_laz(street, folder / f"{name}.laz")
    into = folder / f"{name}-drives"
    into.mkdir()
    (made,) = import_drives(ImportRequest((cloud,), crs="EPSG:6677"), into, SilentMonitor())
    return Drive(made)


@pytest.fixture(scope="module")
def surveys(tmp_path_factory: pytest.TempPathFactory) -> tuple[Drive, Drive, Drive]:
    """Give a survey of June, one of April, and one whose times count from the week."""
    folder = tmp_path_factory.mktemp("surveys")
    return (
        _epoch(folder, "六月", APRIL + 70 * DAY_S),
        _epoch(folder, "四月", APRIL),
        _epoch(folder, "いつか", 1000.0),
    )


def test_older_surveys_come_first_and_those_without_a_date_last(
    surveys: tuple[Drive, Drive, Drive],
) -> None:
    epochs = epochs_of(surveys)
    assert [epoch.name for epoch in epochs] == ["四月", "六月", "いつか"]
    # 13:46 at Greenwich is 22:46 of the same day in Japan.
    assert [epoch.measured_on for epoch in epochs] == [date(2026, 3, 31), date(2026, 6, 9), None]


def test_an_epoch_is_a_side_that_can_be_found_again(surveys: tuple[Drive, Drive, Drive]) -> None:
    side = epochs_of(surveys)[0].side
    assert side.kind is SideKind.EPOCH
    assert side.drives == (surveys[1].id,)
    assert side.measured_on == date(2026, 3, 31)


def test_ground_is_known_once_points_were_labelled_so(surveys: tuple[Drive, Drive, Drive]) -> None:
    drive = surveys[0]
    assert not has_ground(drive)
    make_column(drive)
    points = np.arange(drive.count // 2)
    write_labels(drive, points, np.full(len(points), 2, np.uint8))
    assert has_ground(drive)
