"""RendererLoader: imports VTK beside the window's thread, once the view is on the screen."""

from __future__ import annotations

import importlib
import threading

from PySide6.QtCore import QCoreApplication, QObject, Qt, Signal
from PySide6.QtGui import QSurfaceFormat
from PySide6.QtOpenGLWidgets import QOpenGLWidget
from PySide6.QtWidgets import QWidget

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


def prepare_graphics() -> None:
    """Say how pictures of the 3D view are made; to be called before there is an application.

    Pictures of one window need one format, so the interactor's is set here. Contexts are shared, so
    that a picture lives on when its view is moved into another window.
    """
    QCoreApplication.setAttribute(Qt.ApplicationAttribute.AA_ShareOpenGLContexts)
    wanted = QSurfaceFormat()
    wanted.setRenderableType(QSurfaceFormat.RenderableType.OpenGL)
    wanted.setProfile(QSurfaceFormat.OpenGLContextProfile.CoreProfile)
    wanted.setVersion(3, 2)
    wanted.setRedBufferSize(8)
    wanted.setGreenBufferSize(8)
    wanted.setBlueBufferSize(8)
    wanted.setAlphaBufferSize(8)
    wanted.setDepthBufferSize(8)
    wanted.setStencilBufferSize(0)
    wanted.setSamples(0)
    QSurfaceFormat.setDefaultFormat(wanted)


def reserve_graphics(parent: QWidget) -> QOpenGLWidget:
    """A hidden widget by which the window is made for OpenGL from the start.

    Without it Qt would make the window anew, and it would flash, when the 3D picture is put into it
    later.
    """
    hidden = QOpenGLWidget(parent)
    hidden.hide()
    return hidden
