"""SideBox: which ground is compared: an epoch of the project, a design from a file, or a level."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from PySide6.QtCore import QCoreApplication, QSignalBlocker, Signal
from PySide6.QtWidgets import QComboBox, QSizePolicy, QWidget

from processing.project.volumes.epochs import Epoch
from processing.project.volumes.volume import ChosenSide, SideKind

_LEVEL = ChosenSide(SideKind.LEVEL)


class SideBox(QComboBox):
    """Lists the epochs, the designs that were opened, and what else can be compared.

    Signals
    -------
    chosen()
        Another ground is chosen, by hand or since the epochs are others.
    design_wanted()
        A design is to be opened; :meth:`take_designs` gives it.
    """

    chosen = Signal()
    design_wanted = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._epochs: tuple[ChosenSide, ...] = ()
        self._designs: list[ChosenSide] = []
        self._side: ChosenSide | None = None
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self.activated.connect(self._on_activated)
        self._fill()

    @property
    def side(self) -> ChosenSide | None:
        """What is chosen; None before there is anything."""
        return self._side

    def show_epochs(self, epochs: Sequence[Epoch], number: int) -> None:
        """List these epochs; what was chosen stays, or else the one of that number is chosen."""
        self._epochs = tuple(epoch.side for epoch in epochs)
        if self._side not in (*self._epochs, *self._designs, _LEVEL):
            self._side = self._epochs[number] if number < len(self._epochs) else None
        self._fill()
        self.chosen.emit()

    def choose(self, side: ChosenSide) -> None:
        """Choose a ground as a kept volume names it."""
        if side.kind is SideKind.LEVEL:
            side = _LEVEL  # its height is a field of the form
        if side.kind is SideKind.DESIGN and side not in self._designs:
            self._designs.append(side)
        self._side = side
        self._fill()
        self.chosen.emit()

    def take_designs(self, path: Path, surfaces: Sequence[str]) -> None:
        """List the surfaces of a file and choose its first one."""
        several = len(surfaces) > 1
        for name in reversed(surfaces):
            title = f"{path.name}: {name}" if several else path.name
            surface = name if several else ""
            self.choose(ChosenSide(SideKind.DESIGN, title, path=str(path), surface=surface))

    def forget_designs(self) -> None:
        """Another project is open, or none."""
        self._designs.clear()
        self._side = None

    def _fill(self) -> None:
        with QSignalBlocker(self):
            self.clear()
            for side in (*self._epochs, *self._designs):
                self.addItem(side_words(side), side)
            self.addItem(self.tr("Level"), _LEVEL)
            self.addItem(self.tr("Design from LandXML…"), None)
            sides = [self.itemData(number) for number in range(self.count() - 1)]
            self.setCurrentIndex(sides.index(self._side) if self._side in sides else -1)

    def _on_activated(self, number: int) -> None:
        side = self.itemData(number)
        if side is None:
            self._fill()  # nothing is chosen before there is a design
            self.design_wanted.emit()
        elif side != self._side:
            self._side = side
            self.chosen.emit()


def side_words(side: ChosenSide) -> str:
    """What a ground is called."""
    if side.kind is SideKind.LEVEL:
        return QCoreApplication.translate("SideBox", "Level {height} m").format(
            height=f"{side.height_m:.3f}"
        )
    if side.measured_on is None:
        return side.name
    return QCoreApplication.translate("SideBox", "{name} ({day})").format(
        name=side.name, day=side.measured_on.isoformat()
    )
