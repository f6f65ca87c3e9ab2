"""The watch over windows in ``tests/conftest.py``: it must fail a test that leaves one behind."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from tests.house_rules.sources import ROOT

LEAVES_ONE = """
from PySide6.QtWidgets import QWidget
from tests.conftest import no_window_left

kept = []

def test_that_leaves_a_window(qapp):
    kept.append(QWidget(windowTitle="Street"))

def test_that_closes_its_window(qtbot):
    window = QWidget(windowTitle="Review")
    qtbot.addWidget(window)
    window.show()

def test_whose_window_is_only_garbage(qapp):
    window = QWidget()
    window.itself = window
"""


def test_a_test_that_leaves_a_window_fails_and_others_pass(tmp_path: Path) -> None:
    (tmp_path / "test_windows.py").write_text(LEAVES_ONE, encoding="utf-8")
    answer = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:dash", "-p", "no:cacheprovider", "."],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(ROOT), "QT_QPA_PLATFORM": "offscreen"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert "these windows were left behind: QWidget Street" in answer.stdout, answer.stdout
    assert "3 passed, 1 error" in answer.stdout, answer.stdout
