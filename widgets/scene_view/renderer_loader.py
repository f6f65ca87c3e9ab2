"""RendererLoader: imports VTK beside the window's thread, once the view is on the screen."""

from __future__ import annotations

import importlib
import threading

from PySide6.QtCore import QObject, Signal

from processing.core.library_loading import LIBRARY_LOADING


class RendererLoader(QObject):
    """Tells when the modules of the 3D view are there.

    It has no parent: its thread may be importing while the view goes away.

    Signals
    -------
    ready()
        Sent from another thread, so received through the window's event queue.
    """

    ready = Signal()

    def __init__(self) -> None:
        super().__init__()
        self._thread: threading.Thread | None = None
        self._is_closed = False

    def start(self) -> None:
        """Begin, unless it has begun."""
        if self._thread is None:
            self._thread = threading.Thread(target=self._load, name="scene import", daemon=True)
            self._thread.start()

    def close(self) -> None:
        """Wait for the import, which can't be stopped; nothing is told afterwards."""
        self._is_closed = True
        if self._thread is not None:
            self._thread.join()

    def _load(self) -> None:
        try:
            with LIBRARY_LOADING:
                importlib.import_module("widgets.scene_view.points.cloud")
        finally:
            # Where this failed, the view imports again on its own thread, and the error is told.
            if not self._is_closed:
                self.ready.emit()
