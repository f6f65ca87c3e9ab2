"""A street of ten metres that was driven twice, the second time back, some decimetres aside."""

from __future__ import annotations

from contextlib import closing
from dataclasses import replace
from pathlib import Path

import numpy as np

from processing.core.monitor import SilentMonitor
from processing.project.importing.importing import ImportRequest, import_drives
from processing.project.project import Project
from processing.recording.vehicle_path.trajectory import Trajectory
from tests.builders import SimulatedDrive, simulated_drive, write_laz, write_trajectory_csv

ASIDE_MM = np.array([150, -250, 20])
LATER_S = 3_000.0


def driven_back(street: SimulatedDrive) -> SimulatedDrive:
    """The same places measured in the opposite order, later and a little aside."""
    last = float(street.trajectory.time[-1] + street.trajectory.time[0])
    columns = {name: values[::-1].copy() for name, values in street.columns.items()}
    columns["xyz"] = (columns["xyz"] + ASIDE_MM).astype(np.int32)
    columns["time"] = last - columns["time"] + LATER_S
    way = street.trajectory
    angles = way.roll_pitch_heading_deg[::-1] + np.array([0.0, 0.0, 180.0])
    return replace(
        street,
        columns=columns,
        trajectory=Trajectory(
            time=last - way.time[::-1] + LATER_S,
            xyz=way.xyz[::-1] + ASIDE_MM / 1000.0,
            roll_pitch_heading_deg=angles,
            has_attitude=True,
        ),
    )


def make_street_twice(folder: Path) -> Path:
    """A project ``street.zuka`` beside its ``delivery``; its drives are ``there`` and ``back``."""
    there = simulated_drive(length_m=10.0)
    with closing(Project.create(folder / "street.zuka", "EPSG:6677")) as project:
        for name, street in (("there", there), ("back", driven_back(there))):
            delivery = folder / "delivery" / name
            delivery.mkdir(parents=True)
            request = ImportRequest(
                (write_laz(street, delivery / f"{name}.laz"),),
                (write_trajectory_csv(street, delivery / "trajectory.csv"),),
            )
            into = project.temporary_folder()
            project.adopt_drives(import_drives(request, into, SilentMonitor()))
    return folder / "street.zuka"
