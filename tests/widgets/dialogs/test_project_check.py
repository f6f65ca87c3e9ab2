"""The form of a checked project: a line for each file, and Repair where there is something."""

from __future__ import annotations

from PySide6.QtWidgets import QDialogButtonBox, QPushButton, QTreeWidget

from processing.core.text import Text
from processing.project.checking.findings import CheckReport, FileFinding, FindingState
from widgets.dialogs.project_check import ProjectCheckForm

_WHAT, _REMEDY = Text("Changed.", "変化。"), Text("Repair it.", "修復してください。")


def _repair(form: ProjectCheckForm) -> QPushButton:
    (box,) = form.findChildren(QDialogButtonBox)
    (button,) = (
        one
        for one in box.findChildren(QPushButton)
        if box.buttonRole(one) == QDialogButtonBox.ButtonRole.AcceptRole
    )
    return button


def test_damage_is_listed_and_can_be_repaired(qtbot) -> None:
    findings = (
        FileFinding("drives/a/xyz.bin", _WHAT, _REMEDY),
        FileFinding("drives/a/time.bin", _WHAT, _REMEDY, FindingState.REPAIRED),
    )
    form = ProjectCheckForm(CheckReport(findings, 9), "street", "ja")
    qtbot.addWidget(form)
    form.show()
    (shown,) = form.findChildren(QTreeWidget)
    assert [shown.topLevelItem(n).text(1) for n in range(shown.topLevelItemCount())] == [
        "drives/a/xyz.bin",
        "drives/a/time.bin",
    ]
    assert shown.topLevelItem(0).text(3) == "修復してください。"
    with qtbot.waitSignal(form.repair_requested):
        _repair(form).click()
    assert not form.isVisible()


def test_of_a_whole_project_nothing_is_offered(qtbot) -> None:
    form = ProjectCheckForm(CheckReport((), 9), "street", "en")
    qtbot.addWidget(form)
    form.show()
    assert not _repair(form).isVisible()
