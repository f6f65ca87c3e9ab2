"""ProjectCheckForm: what a check of the project found, and the way to have it repaired."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QDialogButtonBox,
    QHeaderView,
    QLabel,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from processing.core.text import Language
from processing.project.checking.findings import CheckReport, FindingState
from widgets.dialogs.program_dialog import ProgramDialog
from widgets.parts.plain_buttons import remove_icons

_SIZE_PX = (860, 420)
_REPAIRABLE = (FindingState.DAMAGED, FindingState.NOTED)


class ProjectCheckForm(ProgramDialog):
    """A list of files with what is wrong and what to do; it outlives the project's closing.

    Parameters
    ----------
    report : CheckReport
    name : str
        The project's.
    language : Language

    Signals
    -------
    repair_requested
        What can be made again is to be.
    """

    repair_requested = Signal()

    def __init__(
        self, report: CheckReport, name: str, language: Language, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.setWindowTitle(self.tr("Check of {name}").format(name=name))
        self.resize(*_SIZE_PX)
        self._summary = QLabel(self._words(report), self)
        self._summary.setWordWrap(True)
        self._list = QTreeWidget(self)
        self._list.setRootIsDecorated(False)
        self._list.setWordWrap(True)
        self._list.setUniformRowHeights(False)
        self._list.setHeaderLabels(
            [self.tr("State"), self.tr("File"), self.tr("What is wrong"), self.tr("Remedy")]
        )
        states = {
            FindingState.DAMAGED: self.tr("damaged"),
            FindingState.REPAIRED: self.tr("repaired"),
            FindingState.NOTED: self.tr("note"),
        }
        for one in report.findings:
            texts = [one.file, one.what.in_language(language), one.remedy.in_language(language)]
            item = QTreeWidgetItem(self._list, [states[one.state], *texts])
            for column, text in enumerate(texts, start=1):
                item.setToolTip(column, text)
                item.setTextAlignment(column, Qt.AlignmentFlag.AlignTop)
        header = self._list.header()
        header.setSectionResizeMode(QHeaderView.ResizeMode.Interactive)
        for column, width in enumerate((80, 260, 220)):
            header.resizeSection(column, width)
        self._list.setVisible(bool(report.findings))
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close, parent=self)
        buttons.rejected.connect(self.close)
        self._repair = buttons.addButton(self.tr("Repair"), QDialogButtonBox.ButtonRole.AcceptRole)
        self._repair.setVisible(any(one.state in _REPAIRABLE for one in report.findings))
        self._repair.clicked.connect(self._on_repair_clicked)
        remove_icons(buttons)
        layout = QVBoxLayout(self)
        layout.addWidget(self._summary)
        layout.addWidget(self._list, 1)
        layout.addWidget(buttons)

    def _words(self, report: CheckReport) -> str:
        if report.damaged:
            return "\n".join(
                [
                    self.tr("%n file(s) damaged.", "", len(report.damaged)),
                    self.tr(
                        "“Repair” closes the project for a moment and makes again what the"
                        " delivered files still give; map and labels stay as they are."
                    ),
                ]
            )
        if report.repaired:
            return self.tr(
                "%n file(s) repaired; nothing is damaged any more.", "", len(report.repaired)
            )
        return self.tr("%n file(s) checked: nothing is damaged.", "", report.files)

    def _on_repair_clicked(self) -> None:
        self.repair_requested.emit()
        self.close()
