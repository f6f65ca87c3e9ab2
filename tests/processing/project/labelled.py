"""Projects with a small drive whose points can be labelled."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.labels.label_column import labels_of
from processing.map.change import Change
from processing.map.label_change import label_changes
from processing.project.importing.importing import ImportRequest, import_drives
from processing.project.project import Project
from processing.recording.drive import Drive
from tests.builders import simulated_drive, write_laz, write_trajectory_csv

PAINT = Text("Label points", "点のラベル")


def labelled_project(folder: Path, *, length_m: float = 2.0) -> Path:
    """A closed project with one drive without labels."""
    street = simulated_drive(1, length_m=length_m)
    points = write_laz(street, folder / "street.laz")
    trajectory = write_trajectory_csv(street, folder / "trajectory.csv")
    return project_of(folder / "街路.zuka", ImportRequest((points,), (trajectory,)))


def project_of(folder: Path, request: ImportRequest) -> Path:
    """A closed project with the drives of an import."""
    with closing(Project.create(folder, "EPSG:6677")) as project:
        made = import_drives(request, project.temporary_folder(), SilentMonitor())
        project.adopt_drives(made)
    return folder


def all_labels(drive: Drive) -> NDArray[np.uint8]:
    return labels_of(drive, np.arange(drive.count))


def painting(drive: Drive, points: object, code: int) -> Change:
    """The change that gives points of a drive a label."""
    rising = np.unique(np.asarray(points, dtype=np.int64))
    return Change(labels=label_changes(drive.id, rising, labels_of(drive, rising), code))


def paint(project: Project, points: object, code: int, drive: int = 0) -> None:
    project.features.apply(PAINT, painting(project.drives[drive], points, code))
