"""The truth of a delivered file, taken from a file that a person chooses in the window."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PySide6.QtWidgets import QFileDialog
from pytestqt.qtbot import QtBot

from app.classes.truth_evaluations import TruthEvaluations
from app.window.window_parts import WindowParts
from processing.project.importing.import_request import ImportRequest
from tests.builders import write_laz, write_trajectory_csv
from tests.noisy_street import noisy_street

WAIT_MS = 30_000


def test_a_chosen_truth_is_listed_and_asked_for_beside_the_project(
    parts: WindowParts, qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[tuple[str, str]] = []
    chosen = ""

    def choose(_parent: object, _title: str, folder: str, kinds: str) -> tuple[str, str]:
        asked.append((folder, kinds))
        return chosen, ""

    monkeypatch.setattr(QFileDialog, "getOpenFileName", choose)
    bar, evaluations = parts.class_panel.truths, parts.of(TruthEvaluations)
    bar.loading_requested.emit()
    assert not asked  # nothing is open that a truth could be about

    street = noisy_street(7, length_m=2.0)
    np.savez(tmp_path / "truth.npz", code=street.noise)
    cloud = write_laz(street.drive, tmp_path / "street.laz")
    way = write_trajectory_csv(street.drive, tmp_path / "trajectory.csv")
    parts.document.create(tmp_path / "work" / "p.zuka", "EPSG:6677")
    with qtbot.waitSignal(parts.document.shared.map_changes.drives_changed, timeout=WAIT_MS):
        parts.document.import_files(ImportRequest((cloud,), (way,)))
    bar.loading_requested.emit()
    assert asked[0][0] == str(tmp_path / "work")
    assert all(f"*{ending}" in asked[0][1] for ending in (".npy", ".npz", ".laz"))
    assert not evaluations.truths()  # the dialog was closed without a choice

    chosen = str(tmp_path / "truth.npz")
    with qtbot.waitSignal(evaluations.truth_made, timeout=WAIT_MS):
        bar.loading_requested.emit()
    (truth,) = evaluations.truths()
    assert truth.points == street.noise.size
    assert bar.truth == truth.id
