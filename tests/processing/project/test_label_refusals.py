"""Labels on a full disk: one sentence, and nothing half."""

from __future__ import annotations

import json
import subprocess
import sys
from contextlib import closing

import numpy as np

from processing.project.project import Project
from tests.processing.project.labelled import PAINT, all_labels, labelled_project

# The process may write no file longer than the limit: as on a full disk.
ON_A_FULL_DISK = """
import json, resource, sys
from pathlib import Path
import numpy as np
from processing.core.errors import UserError
from processing.project.project import Project
from tests.processing.project.labelled import all_labels, paint
folder = Path(sys.argv[1])
project = Project.open(folder)
drive = project.drives[0]
soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)

def refused(points, code):
    before, position = all_labels(drive), project.history.position
    try:
        paint(project, points, code)
    except UserError:
        assert (all_labels(drive) == before).all()
        assert project.history.position == position
        return True
    return False

resource.setrlimit(resource.RLIMIT_FSIZE, (1000, hard))
without_column = refused(np.arange(100), 11) and not drive.columns.has("label")
resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
paint(project, np.arange(100), 11)
size = (folder / "project.gpkg").stat().st_size
resource.setrlimit(resource.RLIMIT_FSIZE, (size + 10_000, hard))
random, done = np.random.default_rng(1), 0
while not refused(random.choice(drive.count, 4000, replace=False), 2 + done % 5):
    done += 1
resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
paint(project, np.arange(50), 67)
np.save(sys.argv[2], all_labels(drive))
project.close()
print(json.dumps([without_column, done]))
"""


def test_on_a_full_disk_labels_stay_as_they_are_and_work_goes_on_after(tmp_path):
    folder, kept = labelled_project(tmp_path), tmp_path / "labels.npy"
    command = [sys.executable, "-c", ON_A_FULL_DISK, folder, kept]
    told = subprocess.run(command, capture_output=True, text=True, check=False)
    assert told.returncode == 0, told.stderr
    without_column, done = json.loads(told.stdout)
    assert without_column
    assert done < 1000
    with closing(Project.open(folder)) as project:
        labels = all_labels(project.drives[0])
        np.testing.assert_array_equal(labels, np.load(kept))
        assert (labels[:50] == 67).all()
        while project.history.undo_label == PAINT:
            assert project.features.undo()
        assert not all_labels(project.drives[0]).any()
