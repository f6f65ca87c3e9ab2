"""A program killed at any moment of its drawing or importing."""

from __future__ import annotations

import random
import signal
import subprocess
import sys
import time
from contextlib import closing

import pytest

from processing.project.project import Project
from tests.processing.project.drawn import (
    LABEL,
    features_of,
    new_project,
    replayed_history,
    tree_of,
)

# Adds, moves, removes, takes back and does again, in steps of several features.
DRAWING = """
import random, sys
from pathlib import Path
from processing.map.change import Change, Replacement
from processing.project.project import Project
from tests.processing.project.drawn import LABEL, curb, features_of, sign
project = Project.open(Path(sys.argv[1]))
choice = random.Random(sys.argv[2])
number = choice.getrandbits(60)
while True:
    features = list(project.features.all())
    wish = choice.random()
    if wish < 0.15:
        project.features.undo()
    elif wish < 0.25:
        project.features.redo()
    else:
        number += 5
        choice.shuffle(features)
        moved = features[:3]
        project.features.apply(LABEL, Change(
            added=tuple(curb(f"{number + n}", vertices=choice.randint(2, 60)) for n in range(3)),
            replaced=tuple(
                Replacement(one, one.with_vertices(one.vertices[::-1])) for one in moved
            ),
            removed=tuple(features[3:5]),
        ))
    print("step", flush=True)
"""


def killed(code: str, *arguments: object, steps: int, late_us: float) -> None:
    """Run code, and kill it so many steps and microseconds after its start."""
    command = [sys.executable, "-c", code, *map(str, arguments)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as running:
        assert running.stdout is not None
        for _ in range(steps):
            assert running.stdout.readline() == "step\n"
        moment = time.perf_counter() + late_us / 1e6
        while time.perf_counter() < moment:
            pass
        running.send_signal(signal.SIGKILL)


@pytest.mark.parametrize("seed", range(4))
def test_killed_again_and_again_the_map_is_what_its_history_makes(tmp_path, seed):
    folder = new_project(tmp_path / "a.zuka")
    choice = random.Random(seed)  # noqa: S311 - moments, not secrets
    position = 0
    for round_ in range(4):
        steps, late_us = choice.randint(3, 25), choice.uniform(0, 2000)
        killed(DRAWING, folder, f"{seed}-{round_}", steps=steps, late_us=late_us)
        before = tree_of(folder)
        with closing(Project.open(folder, writing=False)) as project:
            seen, position = features_of(project), project.history.position
        assert tree_of(folder) == before
        with closing(Project.open(folder)) as project:
            assert features_of(project) == seen
            assert project.history.position == position
            assert features_of(project) == replayed_history(folder)
    with closing(Project.open(folder)) as project:
        while project.features.undo():
            pass
        assert len(project.features) == 0
        while project.features.redo():
            pass
        assert features_of(project) == replayed_history(folder)
        assert project.history.undo_label == (LABEL if project.history.position else None)


CREATING = """
import sys
from pathlib import Path
from processing.project.project import Project
print("step", flush=True)
Project.create(Path(sys.argv[1]), "EPSG:6677")
print("step", flush=True)
sys.stdin.read()
"""


@pytest.mark.parametrize("late_us", [0, 200, 1000, 3000, 8000, 15000, 30000])
def test_killed_while_it_is_made_a_project_is_whole_or_can_be_made_again(tmp_path, late_us):
    folder = tmp_path / "a.zuka"
    killed(CREATING, folder, steps=1, late_us=late_us)
    if (folder / "project.gpkg").exists():
        project = Project.open(folder)
    else:
        project = Project.create(folder, "EPSG:6677")
    with closing(project):
        assert project.crs == "EPSG:6677"
        assert len(project.features) == 0
