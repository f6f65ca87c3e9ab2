"""A program killed in the middle of a review: every decision that was made is there."""

from __future__ import annotations

import signal
import subprocess
import sys
from contextlib import closing
from pathlib import Path

import pytest

from processing.map.feature import Status
from processing.project.project import Project
from processing.project.review.review_state import read_review_state
from tests.processing.project.candidates import found_lines
from tests.processing.project.drawn import new_project

JUDGING = """
import sys
from pathlib import Path
from PySide6.QtCore import QCoreApplication
from PySide6.QtGui import QGuiApplication
application = QGuiApplication(["zuka", "-platform", "offscreen"])
from app.document.document import Document
from app.jobs.jobs import JobQueue
from app.review.review import Review
from processing.project.review.review_state import ReviewOrder
document = Document(JobQueue())
review = Review(document)
document.open(Path(sys.argv[1]))
(run,) = document.runs()
review.open((run.id,), ReviewOrder.CONFIDENCE)
number = 0
while review.current is not None:
    number += 1
    print(review.current.id, flush=True)
    review.accept() if number % 3 else review.reject()
"""


@pytest.mark.parametrize("steps", [1, 4, 23, 60])
def test_what_was_judged_before_a_kill_is_judged_and_the_rest_waits(
    tmp_path: Path, steps: int
) -> None:
    made = found_lines(400)
    folder = new_project(tmp_path / "p.zuka")
    with closing(Project.open(folder)) as project:
        project.features.apply(made.run.summary, made.change, run=made.run)
    command = [sys.executable, "-c", JUDGING, str(folder)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as running:
        assert running.stdout is not None
        seen = [running.stdout.readline().strip() for _ in range(steps)]
        running.send_signal(signal.SIGKILL)
        seen += running.stdout.read().split()
    order = sorted(made.change.added, key=lambda one: one.provenance.confidence)
    with closing(Project.open(folder)) as project:
        decided = [
            one.id for one in order if project.features.get(one.id).status is not Status.CANDIDATE
        ]
        shown = read_review_state(project.settings).feature
    ids = [one.id for one in order]
    assert decided == ids[: len(decided)]
    assert len(seen) - 1 <= len(decided) <= len(seen)
    assert shown in ids[max(len(decided) - 1, 0) : len(decided) + 1]
