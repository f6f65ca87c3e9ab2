"""A program killed while it labels points: opening makes the labels what the history says."""

from __future__ import annotations

import random
import shutil
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest

from processing.labels.label_column import write_labels
from processing.project.project import Project
from tests.journeys.test_kill_moments import killed
from tests.processing.project.drawn import tree_of
from tests.processing.project.labelled import all_labels, labelled_project, paint

PAINTING = """
import random, sys
from pathlib import Path
import numpy as np
from processing.core.monitor import SilentMonitor
from processing.project.store import label_filing
from processing.project.project import Project
from tests.processing.project.labelled import PAINT, painting
label_filing.MANY_POINTS = 1500
project = Project.open(Path(sys.argv[1]))
drives = {drive.id: drive for drive in project.drives}
choice = random.Random(sys.argv[2])
count = project.drives[0].count
while True:
    wish = choice.random()
    if wish < 0.2:
        # The import is a step too, and what there is to paint on.
        if project.history.position > 1:
            project.features.undo()
    elif wish < 0.35:
        project.features.redo()
    else:
        first, code = choice.randrange(count - 1), choice.choice([0, 2, 6, 11, 67])
        last = min(count, first + choice.randrange(1, 4000))
        points = np.arange(first, last, choice.randint(1, 3))
        try:
            wish = painting(project.drives[0], points, code).labels
            into = project.label_folder()
            change = label_filing.labels_as_change(
                wish, into, drives.__getitem__, SilentMonitor()
            )
            project.features.apply(PAINT, change)
        except ValueError:
            raise SystemExit("the labels are not those of the history")
    print("step", flush=True)
"""


_IMPORTED = 1
"""Steps of a street on which nothing was painted."""


@pytest.fixture(scope="module")
def street(tmp_path_factory) -> Path:
    return labelled_project(tmp_path_factory.mktemp("street"))


def replayed(project: Project) -> np.ndarray:
    """The labels that the stored changes make, one after the other, from none."""
    labels = np.zeros(project.drives[0].count, np.uint8)
    for position in range(1, project.history.position + 1):
        step = project.history._change(position)
        filed = () if step.filed is None else step.filed.changes()
        for change in (*step.labels, *filed):
            points = change.unpacked_points()
            np.testing.assert_array_equal(labels[points], change.codes_before())
            labels[points] = change.codes_after()
    return labels


@pytest.mark.parametrize("seed", range(4))
def test_killed_again_and_again_the_labels_are_what_the_history_makes(street, tmp_path, seed):
    folder = Path(shutil.copytree(street, tmp_path / "a.zuka"))
    choice = random.Random(seed)  # noqa: S311 - moments, not secrets
    for round_ in range(4):
        steps, late_us = choice.randint(3, 25), choice.uniform(0, 3000)
        killed(PAINTING, folder, f"{seed}-{round_}", steps=steps, late_us=late_us)
        before = tree_of(folder)
        with closing(Project.open(folder, writing=False)) as project:
            seen, wanted = all_labels(project.drives[0]), replayed(project)
            np.testing.assert_array_equal(seen, wanted)
        assert tree_of(folder) == before
        with closing(Project.open(folder)) as project:
            np.testing.assert_array_equal(all_labels(project.drives[0]), wanted)
            while project.history.position > _IMPORTED:
                assert project.features.undo()
            assert not all_labels(project.drives[0]).any()
            while project.features.redo():
                pass
            np.testing.assert_array_equal(all_labels(project.drives[0]), replayed(project))


@pytest.mark.parametrize("wanted", ["apply", "undo", "redo"])
@pytest.mark.parametrize("written", [0, 700, 1500])
def test_killed_between_database_and_file_the_step_is_completed(street, tmp_path, wanted, written):
    folder = Path(shutil.copytree(street, tmp_path / "a.zuka"))
    points = np.arange(500, 2000)
    with closing(Project.open(folder)) as project:
        paint(project, np.arange(1000), 2)
        without = all_labels(project.drives[0])
        paint(project, points, 11)
        with_it = all_labels(project.drives[0])
        if wanted != "apply":
            project.features.undo()
        if wanted == "redo":
            project.features.redo()
        before, after = (with_it, without) if wanted == "undo" else (without, with_it)
        # What a kill leaves: the database knows, of the file only a part was written.
        half = points[written:]
        write_labels(project.drives[0], half, before[half])
    with closing(Project.open(folder, writing=False)) as project:
        np.testing.assert_array_equal(all_labels(project.drives[0]), after)
    for _ in range(2):
        with closing(Project.open(folder)) as project:
            np.testing.assert_array_equal(all_labels(project.drives[0]), after)
