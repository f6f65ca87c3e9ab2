"""SimulateForm: what is to be made and recorded, and about what that will give."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from PySide6.QtCore import QLocale, Qt, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import (
    QDialogButtonBox,
    QFileDialog,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QStackedWidget,
    QTabBar,
    QVBoxLayout,
    QWidget,
)
from typing_extensions import override

from processing.core.text import Language
from processing.laboratory.simulate.forecast import Forecast
from processing.laboratory.simulate.simulations import SIMULATIONS
from widgets.dialogs.program_dialog import ProgramDialog
from widgets.panels.processing.parameter_form import ParameterForm
from widgets.parts.density_view import DensityView
from widgets.parts.plain_buttons import remove_icons

_MINUTE_S = 60.0
_KM_H = 3.6


@dataclass(frozen=True)
class SimulationRequest:
    """What the form asks for.

    Attributes
    ----------
    order : str
        Key of :data:`processing.laboratory.simulate.simulations.SIMULATIONS`.
    request : object
        Of that order's class.
    folder : Path
        For its files; made, or empty.
    """

    order: str
    request: Any  # each order has a class of its own
    folder: Path


class SimulateForm(ProgramDialog):
    """A form beside the window; the window stays usable while it is open.

    Parameters
    ----------
    parent_folder : Path
        In which a folder of the order's own is proposed.
    language : Language

    Signals
    -------
    forecast_wanted(wish: SimulationRequest)
        Other values are set; :meth:`show_forecast` is called when it is known what they give.
    simulation_requested(wish: SimulationRequest)
    help_requested()
    """

    forecast_wanted = Signal(object)
    simulation_requested = Signal(object)
    help_requested = Signal()

    def __init__(
        self, parent_folder: Path, language: Language, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(self.tr("Simulate a recording"))
        self._parent_folder, self._locale = parent_folder, QLocale(language)
        self._is_folder_own = False
        self._needs = 0
        self._what = QTabBar(self)
        self._what.setExpanding(False)
        self._what.setDrawBase(False)
        self._pages = QStackedWidget(self)
        self._forms: dict[str, ParameterForm] = {}
        for order in SIMULATIONS.values():
            self._what.addTab(order.name.in_language(language))
            form = ParameterForm(order.request, language, self)
            form.changed.connect(self._on_values_changed)
            self._forms[order.id] = form
            self._pages.addWidget(_on_top(form))
        self._density = DensityView(language, self)
        self._lines = QLabel(self)
        self._folder = QLineEdit(self)
        self._folder.textEdited.connect(self._on_folder_edited)
        self._estimate, self._trouble = QLabel(self), QLabel(self)
        kinds = QDialogButtonBox.StandardButton
        self._buttons = QDialogButtonBox(kinds.Help | kinds.Cancel, self)
        self._make = self._buttons.addButton(
            self.tr("Create"), QDialogButtonBox.ButtonRole.AcceptRole
        )
        remove_icons(self._buttons)
        self._lay_out()
        self._buttons.accepted.connect(self._on_buttons_accepted)
        self._buttons.rejected.connect(self.close)
        self._buttons.helpRequested.connect(self.help_requested)
        self._what.currentChanged.connect(self._on_what_changed)

    @property
    def request(self) -> SimulationRequest:
        """What is set."""
        order = list(SIMULATIONS)[self._what.currentIndex()]
        return SimulationRequest(
            order, self._forms[order].value(), Path(self._folder.text().strip())
        )

    def form(self, order: str) -> ParameterForm:
        """The fields of an order."""
        return self._forms[order]

    def ask_forecast(self) -> None:
        """Ask what the values give; called once when somebody listens."""
        self._on_values_changed()

    def show_forecast(self, forecast: Forecast, free: int) -> None:
        """Tell about what the values give.

        Parameters
        ----------
        free : int
            Bytes that are free on the disk of the folder.
        """
        self._needs = forecast.size
        reported = self.tr("About {points} points, {size}, from {time} of recording.")
        self._estimate.setText(
            reported.format(
                points=self._locale.toString(_round_value(forecast.points)),
                size=self._locale.formattedDataSize(_round_value(forecast.size), 0),
                time=self._spoken_time(forecast.seconds),
            )
        )
        is_too_much = forecast.size > free
        self._say(
            self.tr("The disk has only {free} left.").format(
                free=self._locale.formattedDataSize(free, 1)
            )
            if is_too_much
            else ""
        )
        self._make.setEnabled(not is_too_much)
        for widget in (self._density, self._lines):
            widget.setVisible(forecast.density is not None)
        if forecast.density is not None:
            self._density.show_density(forecast.density)
            reported = self.tr(
                "Scan lines every {gap} cm at {speed} km/h. What is hidden, and pulses that don't "
                "come back, are not counted."
            )
            survey = forecast.density.survey
            gap, speed = 100 * survey.between_revolutions_m, _KM_H * survey.speed_m_s
            self._lines.setText(reported.format(gap=f"{gap:.1f}", speed=f"{speed:.0f}"))

    def show_refusal(self, reported: str) -> None:
        """Tell why nothing can be made of the values."""
        self._estimate.clear()
        self._say(reported)
        self._make.setEnabled(False)

    @override
    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_F1:
            self.help_requested.emit()
        else:
            super().keyPressEvent(event)

    def _lay_out(self) -> None:
        choose = QPushButton(self.tr("Choose…"), self)
        choose.clicked.connect(self._on_choose_clicked)
        folder = QHBoxLayout()
        folder.addWidget(QLabel(self.tr("Folder"), self))
        folder.addWidget(self._folder, 1)
        folder.addWidget(choose)
        self._lines.setWordWrap(True)
        self._trouble.setWordWrap(True)
        font = self._trouble.font()
        font.setBold(True)
        self._trouble.setFont(font)
        self._trouble.hide()
        beside = QVBoxLayout()
        beside.addWidget(self._density, 1)
        beside.addWidget(self._lines)
        middle = QGridLayout()
        middle.setHorizontalSpacing(16)
        middle.addWidget(self._pages, 0, 0)
        middle.addLayout(beside, 0, 1)
        middle.setColumnStretch(1, 1)
        layout = QVBoxLayout(self)
        layout.addWidget(self._what)
        layout.addLayout(middle, 1)
        layout.addLayout(folder)
        layout.addWidget(self._estimate)
        layout.addWidget(self._trouble)
        layout.addWidget(self._buttons)
        self.resize(980, 560)

    def _spoken_time(self, seconds: float) -> str:
        if seconds < _MINUTE_S:
            return self.tr("{seconds} s").format(seconds=max(1, round(seconds)))
        return self.tr("{minutes} min").format(minutes=round(seconds / _MINUTE_S))

    def _say(self, trouble: str) -> None:
        self._trouble.setText(trouble)
        self._trouble.setVisible(bool(trouble))

    def _propose_folder(self) -> Path:
        """A folder that does not exist yet, named after what is made."""
        request = self.request
        stem = f"{request.order}-{request.request.style}-{request.request.seed}"
        folder, number = self._parent_folder / stem, 2
        while folder.exists():
            folder = self._parent_folder / f"{stem}-{number}"
            number += 1
        return folder

    def _on_what_changed(self, index: int) -> None:
        self._pages.setCurrentIndex(index)
        self._on_values_changed()

    def _on_values_changed(self) -> None:
        if not self._is_folder_own:
            self._folder.setText(str(self._propose_folder()))
        self.forecast_wanted.emit(self.request)

    def _on_folder_edited(self) -> None:
        self._is_folder_own = True
        self.forecast_wanted.emit(self.request)

    def _on_choose_clicked(self) -> None:
        name = QFileDialog.getExistingDirectory(
            self, self.tr("Folder"), str(Path(self._folder.text()).parent)
        )
        if name:
            self._folder.setText(name)
            self._on_folder_edited()

    def _on_buttons_accepted(self) -> None:
        request = self.request
        if not self._folder.text().strip():
            self._say(self.tr("Give a folder for the files."))
        elif request.folder.is_file() or (
            request.folder.is_dir() and any(request.folder.iterdir())
        ):
            self._say(self.tr("The folder is not empty; give the name of a new one."))
        else:
            self.simulation_requested.emit(request)
            self.close()


def _round_value(value: int) -> int:
    """With two digits that count: more would be a promise."""
    digits = max(0, len(str(value)) - 2)
    return round(value, -digits)


def _on_top(form: QWidget) -> QWidget:
    """A form at the upper edge of what is higher than it."""
    page = QWidget()
    column = QVBoxLayout(page)
    column.setContentsMargins(0, 0, 0, 0)
    column.addWidget(form)
    column.addStretch(1)
    return page
