"""What stands beside each other in ImageViews: an image, the line above it, its settings."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QToolButton, QVBoxLayout, QWidget

from processing.recording.kinds import ImageKind
from widgets.image_view.view import ImageView
from widgets.pictures.image_view_settings import ImageViewSettings
from widgets.shared.image_orientation import ImageOrientation
from widgets.shared.view_settings import ViewSettings


@dataclass(frozen=True)
class ShownImage:
    """What an image beside the main one shows."""

    drive_id: str
    kind: ImageKind
    attribute: str
    orientation: ImageOrientation


class PaneHeader(QWidget):
    """The line above an image that says what it shows.

    Signals
    -------
    closed()
        The image isn't wanted any longer.
    """

    closed = Signal()

    def __init__(self, choice: ImageViewSettings) -> None:
        super().__init__()
        choice.let_shrink()
        self.close_button = QToolButton(self)
        self.close_button.setText("✕")
        self.close_button.setAutoRaise(True)
        self.close_button.setToolTip(self.tr("Close this image"))
        self.close_button.clicked.connect(self.closed)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(8, 2, 4, 2)
        layout.addWidget(choice, 1, Qt.AlignmentFlag.AlignLeft)
        layout.addWidget(self.close_button)


class Pane(QWidget):
    """An image under its header."""

    def __init__(self, view: ImageView, header: PaneHeader) -> None:
        super().__init__()
        self.view = view
        self.header = header
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        layout.addWidget(header)
        layout.addWidget(view, 1)


@dataclass(frozen=True, eq=False)
class SecondaryImage:
    """An image beside the main one, and the settings of its own."""

    pane: Pane
    settings: ViewSettings

    @property
    def view(self) -> ImageView:
        """The image itself."""
        return self.pane.view

    @property
    def shown(self) -> ShownImage:
        """What it shows."""
        settings = self.settings
        return ShownImage(
            settings.drive_id,
            settings.image_kind,
            settings.look.attribute,
            settings.image_orientation,
        )

    def show_image(self, shown: ShownImage) -> None:
        """Show this from now on."""
        self.settings.change_look(attribute=shown.attribute)
        self.settings.orient_image(shown.orientation)
        self.settings.show_image(shown.drive_id, shown.kind)
