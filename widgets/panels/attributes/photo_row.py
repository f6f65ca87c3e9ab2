"""PhotoRow: the picture of a feature that was cut out of a camera image."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QPixmap
from PySide6.QtWidgets import QLabel, QSizePolicy, QWidget

_SIDE_PX = 200
"""Of the largest picture: as wide as the panel's fields, and no higher."""

_MOST_ENLARGED = 4
"""Of a small plate: its pixels may be seen, its symbol is told all the same."""


class PhotoRow(QLabel):
    """A picture, as large as there is room and use for.

    Parameters
    ----------
    side_px : int
        Of the largest picture.
    """

    def __init__(self, parent: QWidget | None = None, *, side_px: int = _SIDE_PX) -> None:
        super().__init__(parent)
        self.setAccessibleName(self.tr("Picture"))
        self.setAlignment(Qt.AlignmentFlag.AlignHCenter)
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self._side_px = side_px
        self._path: Path | None = None

    @property
    def path(self) -> Path | None:
        """The file that is shown."""
        return self._path

    def show_photo(self, path: Path | None) -> bool:
        """Show a file's picture; says whether there is one."""
        if path != self._path:
            self._path = path
            picture = QPixmap() if path is None else QPixmap(str(path))
            self.setPixmap(_fitted(picture, self._side_px))
        return not self.pixmap().isNull()


def _fitted(picture: QPixmap, side_px: int) -> QPixmap:
    if picture.isNull():
        return picture
    room = QSize(side_px, side_px).boundedTo(picture.size() * _MOST_ENLARGED)
    return picture.scaled(
        room, Qt.AspectRatioMode.KeepAspectRatio, Qt.TransformationMode.SmoothTransformation
    )
