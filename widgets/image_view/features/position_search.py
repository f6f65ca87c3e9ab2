"""PositionSearch: nearest points of vertices that rest on another drive, found in idle moments."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QObject, QTimer, Signal

from widgets.image_view.features.feature_positions import FeaturePositions

_SEARCH_S = 0.008
_SEARCH_EVERY_MS = 10


class PositionSearch(QObject):
    """Searches a few milliseconds at a time while anything is to be found.

    Parameters
    ----------
    positions : FeaturePositions
    near : callable
        Gives easting and northing about which features come first; None to wait.

    Signals
    -------
    found()
        Some feature got its place.
    ended()
        Nothing is left to be found.
    """

    found = Signal()
    ended = Signal()

    def __init__(
        self,
        positions: FeaturePositions,
        near: Callable[[], tuple[float, float] | None],
        parent: QObject | None = None,
    ) -> None:
        super().__init__(parent)
        self._positions = positions
        self._near = near
        self._timer = QTimer(self, interval=_SEARCH_EVERY_MS)
        self._timer.timeout.connect(self._on_timer_timeout)

    def go_on(self) -> None:
        """Search if something is to be found, rest if not."""
        if self._positions.is_searching:
            self._timer.start()
        else:
            self._timer.stop()

    def _on_timer_timeout(self) -> None:
        near = self._near()
        if near is not None and self._positions.search(_SEARCH_S, near):
            self.found.emit()
        self.go_on()
        if not self._positions.is_searching:
            self.ended.emit()
