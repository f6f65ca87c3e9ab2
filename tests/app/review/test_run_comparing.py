"""Two runs of a tool are compared in a form, and one of them is kept by a click."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtWidgets import QLabel, QPushButton

from app.window.window_parts import WindowParts
from processing.operations.runs.finished_runs import FinishedRun
from processing.operations.store import store_run
from processing.tools.tool import CandidateResult
from tests.processing.project.candidates import found, line
from widgets.dialogs.compare_runs import CompareRunsForm


def _run(parts: WindowParts, *positions: int) -> str:
    made = found(CandidateResult(tuple(line(position, 0.5) for position in positions)))
    assert parts.document.do_step(
        lambda project: store_run(project, FinishedRun(found=made)).change
    )
    return made.run.id


def test_a_run_is_compared_with_the_one_before_and_that_one_is_kept(
    parts: WindowParts, tmp_path: Path
) -> None:
    document = parts.document
    assert document.create(tmp_path / "p.zuka", "")
    first, second = _run(parts, 0, 10, 20), _run(parts, 0, 10, 50, 60)
    parts.project_tree.comparison_requested.emit(second)
    (form,) = (one for one in parts.window.findChildren(CompareRunsForm) if one.isVisible())
    words = [label.text() for label in form.findChildren(QLabel)]
    assert "3 candidates, 1 of them only here" in words
    assert "4 candidates, 2 of them only here" in words
    names = [form.table.item(row, 0).text() for row in range(form.table.rowCount())]
    assert "Drives" in names
    keep, _ = (one for one in form.findChildren(QPushButton) if "Keep" in one.text())
    keep.click()
    assert {one.provenance.run for one in document.features()} == {first}
    assert document.undo()
    assert {one.provenance.run for one in document.features()} == {second}
