"""A small project that holds a file of every kind that a project can hold."""

from __future__ import annotations

from contextlib import closing
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.map.catalogue import Geometry
from processing.map.change import Change
from processing.map.feature import Feature, PointReference, Vertex
from processing.project.evaluation.truth_making import truth_as_it_stands
from processing.project.evaluation.truth_store import Truth, TruthStore, new_truth_id
from processing.project.project import Project
from processing.project.work_details import WorkDetails
from processing.project.work_store import WorkStore
from processing.recording.camera_images.calibration import CameraOffset
from tests.builders import simulated_drive, write_laz
from tests.processing.project.labelled import labelled_project, paint
from tests.processing.project.test_steps_of_results import STEPS, run

_DRAW = Text("Draw", "作図")
_STEPS = ("a column", "ground", "a volume", "a picture", "images")


def make_full_project(folder: Path) -> Path:
    """A closed project with a drive, results, labels, a truth, a volume, pictures and a map."""
    write_laz(simulated_drive(length_m=2.0, start_time_s=405_000.0), folder / "later.laz")
    made = labelled_project(folder)
    with closing(Project.open(made)) as project:
        drive = project.drives[0]
        line = tuple(
            Vertex((float(x), float(y), float(z)), PointReference(drive.id, point))
            for point, (x, y, z) in zip((5, 900), drive.xyz(np.array([5, 900])), strict=True)
        )
        curb = Feature("l", "curb_lower", Geometry.LINE, line, {"height_m": 0.15, "note": "縁石"})
        sign = Feature("s", "sign", Geometry.POINT, line[:1])
        centre = Feature("c", "road_center", Geometry.LINE, line, {"route": "市道1号線"})
        project.features.apply(_DRAW, Change(added=(curb, sign, centre)))
        for name in _STEPS:
            for step in STEPS[name][0]:
                step(project)
        run(project, "noise")
        paint(project, np.arange(50, 400), 2)
        drive.keep_camera_offsets({"camera": CameraOffset(roll_deg=0.1)})
        WorkStore(project.settings).keep_details(WorkDetails(work="道路台帳"))
        made_truth = truth_as_it_stands(project.drives, project.temporary_folder(), SilentMonitor())
        truth = Truth(new_truth_id(), Text.same("目視"), made_truth.known, datetime.now(UTC))
        TruthStore(project.settings).add(truth, made_truth.folders, project.drive)
    return made
