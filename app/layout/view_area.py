"""ViewArea: the middle of the window, the image and beside it the docks of the other views."""

from __future__ import annotations

from dataclasses import dataclass, field

from PySide6.QtCore import QByteArray, Qt
from PySide6.QtWidgets import QSplitter, QWidget

from app.layout.view_docks import ViewDocks, ViewLayout

_SHARES_OF = 1000


@dataclass(frozen=True)
class AreaLayout:
    """How the views stand, in Qt's own words; empty for their usual places.

    Attributes
    ----------
    shares : QByteArray
        Of image and docks.
    docks : QByteArray
    is_apart : bool
        Whether the docks are a window of their own.
    is_image_hidden : bool
    """

    shares: QByteArray = field(default_factory=QByteArray)
    docks: QByteArray = field(default_factory=QByteArray)
    is_apart: bool = False
    is_image_hidden: bool = False


class ViewArea(QSplitter):
    """Image above docks, or beside them.

    Parameters
    ----------
    image : QWidget
    docks : ViewDocks
    """

    def __init__(self, image: QWidget, docks: ViewDocks) -> None:
        super().__init__(Qt.Orientation.Vertical)
        self._image = image
        self._docks = docks
        self.addWidget(image)
        self.addWidget(docks)
        self._share(0.5)
        docks.came_back.connect(self._on_docks_came_back)

    @property
    def is_beside(self) -> bool:
        """Whether image and docks stand beside each other."""
        return self.orientation() == Qt.Orientation.Horizontal

    @property
    def is_apart(self) -> bool:
        """Whether the docks are a window of their own."""
        return self._docks.is_apart

    def stand_side_by_side(self, *, beside: bool) -> None:
        """Put image and docks beside each other, or one above the other."""
        self.setOrientation(Qt.Orientation.Horizontal if beside else Qt.Orientation.Vertical)

    def place(self, layout: ViewLayout) -> None:
        """Stand in a layout."""
        share = self._docks.place(layout)
        self._take_apart(is_apart=layout is ViewLayout.TWO_SCREENS)
        self._image.setVisible(share > 0)
        if layout is not ViewLayout.TWO_SCREENS:
            self._share(share)

    def show_apart(self, *, is_shown: bool) -> None:
        """Show the docks that are a window of their own, or hide them with the work."""
        if self._docks.is_apart:
            self._docks.setVisible(is_shown)

    def keep(self) -> AreaLayout:
        """How it stands, for :meth:`restore`."""
        return AreaLayout(
            self.saveState(), self._docks.saveState(), self.is_apart, self._image.isHidden()
        )

    def take_in(self) -> None:
        """Have the docks here again, so that they go when this goes."""
        self._take_apart(is_apart=False)

    def restore(self, layout: AreaLayout) -> None:
        """Stand as kept."""
        if not layout.docks.isEmpty():
            self._docks.restore(layout.docks)
        self._take_apart(is_apart=layout.is_apart)
        self._image.setVisible(layout.is_apart or not layout.is_image_hidden)
        if not layout.shares.isEmpty():
            self.restoreState(layout.shares)

    def _take_apart(self, *, is_apart: bool) -> None:
        if is_apart:
            self._docks.go_apart(self.window())
        elif self._docks.is_apart:
            self._docks.setParent(self, Qt.WindowType.Widget)
            self.insertWidget(1, self._docks)
            self._docks.show()

    def _share(self, of_image: float) -> None:
        first = round(_SHARES_OF * of_image)
        self.setSizes([first, _SHARES_OF - first])

    def _on_docks_came_back(self) -> None:
        self._take_apart(is_apart=False)
        self._share(0.5)
