"""A window killed with the button down: everything but the gesture under way is there."""

from __future__ import annotations

import shutil
import signal
import subprocess
import sys
from contextlib import closing
from pathlib import Path

import pytest

from processing.project.project import Project
from tests.processing.project.drawn import features_of, replayed_history

# Draws lines, then holds one of their vertices, or has clicked some places of another line.
HOLDING = """
import sys
from pathlib import Path
from PySide6.QtCore import QPoint, Qt
from tests.properties.operator_input import Operator
home, what = Path(sys.argv[1]), sys.argv[2]
operator = Operator(home, home / "street.zuka")
view, document = operator.view, operator.parts.document
document.shared.snap.choose_modes(frozenset())
middle = view.rect().center()
for number in range(3):
    operator.trigger("tool-line")
    for step in range(3):
        operator.click(middle + QPoint(60 * step - 90, 40 * number - 40))
    operator.key(Qt.Key.Key_Return)
assert len(operator.features()) == 3
if what == "drag":
    spot = operator.spot_on_vertex(operator.features()[0], 1)
    operator.trigger("tool-edit")
    operator.press(spot)
    operator.move(spot + QPoint(20, 10), button=Qt.MouseButton.LeftButton)
else:
    operator.trigger("tool-line")
    for step in range(3):
        operator.click(middle + QPoint(50 * step - 90, 70))
operator.settle()
assert document.shared.sketch.drawing is not None
print("held", flush=True)
while True:
    operator.settle()
"""


@pytest.mark.parametrize("what", ["drag", "line"])
def test_killed_in_a_gesture_the_project_has_all_steps_that_were_done(
    sample_project: Path, tmp_path: Path, what: str
) -> None:
    folder = Path(shutil.copytree(sample_project, tmp_path / "street.zuka"))
    command = [sys.executable, "-c", HOLDING, str(tmp_path), what]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as window:
        assert window.stdout is not None
        assert window.stdout.readline() == "held\n"
        window.send_signal(signal.SIGKILL)
    with closing(Project.open(folder)) as project:
        assert len(project.features) == 3
        assert project.history.position == 1 + 3  # the import is a step too
        assert all(len(line.vertices) == 3 for line in project.features.all())
        assert features_of(project) == replayed_history(folder)
        for _ in range(3):
            assert project.features.undo() is not None
        assert len(project.features) == 0
