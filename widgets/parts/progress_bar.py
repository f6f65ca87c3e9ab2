"""ProgressBar: shows how far something is, with the next frame of the window."""

from __future__ import annotations

from PySide6.QtWidgets import QProgressBar


class ProgressBar(QProgressBar):
    """Qt's bar paints at once, and the whole window with its 3D view under it, at each value."""

    def show_value(self, value: int) -> None:
        """Show a value when the window is painted next."""
        if value != self.value():
            self.setUpdatesEnabled(False)
            self.setValue(value)
            self.setUpdatesEnabled(True)
