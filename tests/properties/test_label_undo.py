"""Labels after any sequence of strokes, undo, redo, restarts: those of the history, exactly."""

from __future__ import annotations

import shutil
import tempfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from processing.core.text import Text
from processing.project.project import Project
from tests.processing.project.labelled import all_labels, labelled_project, paint, painting

STROKES = st.tuples(
    st.integers(0, 3000), st.integers(1, 2000), st.integers(1, 9), st.sampled_from([0, 2, 11, 200])
)
STEPS = st.lists(
    st.tuples(
        st.sampled_from(["paint", "paint", "paint", "undo", "redo", "reopen"]),
        st.lists(STROKES, min_size=1, max_size=3),
    ),
    max_size=12,
)


@pytest.fixture(scope="module")
def street(tmp_path_factory) -> Path:
    return labelled_project(tmp_path_factory.mktemp("street"))


@settings(max_examples=40, deadline=None)
@given(steps=STEPS)
def test_undo_and_redo_give_all_labels_back_also_across_a_restart(street, steps):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(shutil.copytree(street, Path(folder) / "a.zuka"))
        project = Project.open(path)
        states, position = [all_labels(project.drives[0])], 0
        for request, strokes in steps:
            if request == "reopen":
                project.close()
                project = Project.open(path)
            elif request == "undo" and position == 0:
                assert project.history.undo_label == Text("Import street", "street のインポート")
            elif request == "undo":
                assert project.features.undo() is not None
                position -= 1
            elif request == "redo":
                assert (project.features.redo() is not None) == (position + 1 < len(states))
                position = min(len(states) - 1, position + 1)
            else:
                for first, count, step, code in strokes:
                    points = np.arange(first, first + count, step)
                    if painting(project.drives[0], points, code).is_empty:
                        continue
                    paint(project, points, code)
                    after = states[position].copy()
                    after[points] = code
                    states = [*states[: position + 1], after]
                    position += 1
            np.testing.assert_array_equal(all_labels(project.drives[0]), states[position])
        project.close()
