"""A program killed while it draws: at most the running step is missing."""

from __future__ import annotations

import random
import signal
import subprocess
import sys

import pytest

from processing.project.project import Project

DRAWING = """
import sys
from pathlib import Path
from processing.map.catalogue import Geometry
from processing.map.change import Change
from processing.map.feature import Feature, Vertex
from processing.project.project import Project
from processing.core.text import Text
project = Project.open(Path(sys.argv[1]))
number = len(project.features)
while True:
    feature = Feature(f"f{number}", "sign", Geometry.POINT, (Vertex((1.0, 2.0, float(number))),))
    project.features.apply(Text("Draw", "作図"), Change(added=(feature,)))
    number += 1
    print(number, flush=True)
"""


@pytest.mark.parametrize("seed", range(6))
def test_after_a_kill_in_the_middle_of_drawing_all_finished_steps_are_there(tmp_path, seed):
    folder = tmp_path / "通り.zuka"
    Project.create(folder, "EPSG:6677").close()
    steps = random.Random(seed).randint(1, 40)  # noqa: S311 - moments, not secrets
    drawing = subprocess.Popen(
        [sys.executable, "-c", DRAWING, folder], stdout=subprocess.PIPE, text=True
    )
    with drawing:
        reported = 0
        while reported < steps:
            reported = int(drawing.stdout.readline())
        drawing.send_signal(signal.SIGKILL)
    project = Project.open(folder)
    drawn = len(project.features)
    # One step may have been finished after the last that was told, one may be cut off.
    assert drawn >= steps
    assert project.history.position == drawn
    undone = 0
    while project.features.undo():
        undone += 1
    assert undone == drawn
    assert len(project.features) == 0
    project.close()
