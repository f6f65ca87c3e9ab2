"""SceneRenderer: the VTK window with its layers, camera and shading.

Importing this module imports VTK and pyvista, which takes more than a second; the view does it
after it was shown, beside the window's thread.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QMessageLogContext, QtMsgType, qInstallMessageHandler
from PySide6.QtWidgets import QWidget
from pyvistaqt import QtInteractor
from vtkmodules.vtkCommonCore import vtkCommand, vtkLogger, vtkOutputWindow
from vtkmodules.vtkRenderingCore import vtkRenderer
from vtkmodules.vtkRenderingOpenGL2 import (
    vtkEDLShading,
    vtkGenericOpenGLRenderWindow,
    vtkRenderStepsPass,
)

from widgets.scene_view.rendering.backdrop import BACKGROUND
from widgets.scene_view.rendering.camera import SceneCamera
from widgets.scene_view.rendering.change_surface import ChangeSurface
from widgets.scene_view.rendering.feature_actors import FeatureActors
from widgets.scene_view.rendering.solid_actors import SolidActors
from widgets.scene_view.rendering.tile_actors import PointSizes, TileActors

_NEAREST_M = 0.1
_DEPTH_RATIO = 20_000.0
_LAYERS = 5
_ROOM_M = 1.0  # beyond the points, for what is drawn about them
_FORMAT_AGAIN = "Setting a new default format"
_MOST_TIMES_LEAST = 4.0  # fills the gaps of a road down to some four metres


class SceneRenderer:
    """One interactor with layers that share a camera: cloud, bodies, halos, lines, marks.

    Parameters
    ----------
    parent : QWidget
    reported_frame : callable
        Given the seconds that each frame took, from its beginning until it was on the screen.
    """

    def __init__(self, parent: QWidget, reported_frame: Callable[[float], None]) -> None:
        # Troubles of the graphics are of no use to a surveyor; on Windows they open a window.
        vtkOutputWindow.GetInstance().SetDisplayModeToNever()
        vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
        with _format_taken_as_set():
            self.widget = QtInteractor(parent, auto_update=False, multi_samples=0)
        self._window = vtkGenericOpenGLRenderWindow.SafeDownCast(self.widget.ren_win)
        self._window.SetNumberOfLayers(_LAYERS)
        self._cloud: vtkRenderer = self.widget.renderer
        self._layers: list[vtkRenderer] = [self._cloud]
        for number in range(1, _LAYERS):
            layer = vtkRenderer()
            layer.SetLayer(number)
            layer.SetActiveCamera(self._cloud.GetActiveCamera())
            layer.InteractiveOff()
            self._window.AddRenderer(layer)
            self._layers.append(layer)
        colour = [int(BACKGROUND[at : at + 2], 16) / 255 for at in (1, 3, 5)]
        self._cloud.SetBackground(*colour)
        self._shading = vtkEDLShading()
        self._shading.SetDelegatePass(vtkRenderStepsPass())
        self._is_shaded = False
        self._is_closed = False
        self._began_at = 0.0
        self._reported_frame = reported_frame
        self._observer = self._window.AddObserver(vtkCommand.StartEvent, self._on_window_start)
        self.widget.frameSwapped.connect(self._on_widget_frame_swapped)
        self.tiles = TileActors(self._cloud)
        self.change = ChangeSurface(self._layers[1])
        self.solids = SolidActors(self._layers[1])
        self.features = FeatureActors(*self._layers[2:])

    @property
    def scale(self) -> float:
        """Device pixels per Qt pixel."""
        return float(self.widget.devicePixelRatioF())

    def look(self, camera: SceneCamera) -> None:
        """Look from here."""
        seen = self._cloud.GetActiveCamera()
        _, up, forward = camera.axes
        nearest_m, farthest_m = self._depths(camera)
        # Without perspective VTK's camera stands where it has all before it.
        back_m = max(_NEAREST_M - nearest_m, 0.0) if camera.is_parallel else 0.0
        seen.SetPosition(*(np.array(camera.position) - forward * back_m))
        seen.SetFocalPoint(*camera.focal_point)
        seen.SetViewUp(*up)
        seen.SetViewAngle(camera.angle_deg)
        seen.SetParallelProjection(camera.is_parallel)
        seen.SetParallelScale(camera.height_m / 2)
        far_m = farthest_m + back_m
        near_m = nearest_m + back_m if camera.is_parallel else far_m / _DEPTH_RATIO
        seen.SetClippingRange(max(_NEAREST_M, near_m), far_m)

    def size_points(self, least_px: float, focal_px: float) -> None:
        """Draw points at least so large; both in Qt's pixels."""
        sizes = PointSizes(
            least_px * self.scale, _MOST_TIMES_LEAST * least_px * self.scale, focal_px * self.scale
        )
        if self.tiles.set_sizes(sizes):
            self.redraw()

    def shade(self, *, is_on: bool) -> bool:
        """Draw the cloud with eye-dome lighting, or plain; says whether that is new."""
        if is_on == self._is_shaded:
            return False
        self._is_shaded = is_on
        self._set_pass(self._shading if is_on else None)
        return True

    def redraw(self) -> None:
        """Draw a frame soon."""
        if not self._is_closed:
            self.widget.update()

    def close(self) -> None:
        """Give everything back; may be called again."""
        if self._is_closed:
            return
        self._is_closed = True
        self._window.RemoveObserver(self._observer)
        self.tiles.close()
        self.change.clear()
        self.solids.clear()
        self.features.clear()
        self._set_pass(None)
        # A pass that isn't in use is not released with the window.
        self._window.MakeCurrent()
        self._shading.ReleaseGraphicsResources(self._window)
        for layer in self._layers[1:]:
            self._window.RemoveRenderer(layer)
        self.widget.close()
        # It would keep Python's name for a surface that Qt deletes with the window; whatever Qt
        # makes at the same address later is then taken for that surface.
        self.widget._forget_context()  # type: ignore[no-untyped-call]  # noqa: SLF001 - none is public

    def _set_pass(self, shading: vtkEDLShading | None) -> None:
        # VTK's types forget that no pass means its own way of drawing.
        self._cloud.SetPass(shading)  # type: ignore[arg-type]

    def _depths(self, camera: SceneCamera) -> tuple[float, float]:
        """How far in front of the camera what is drawn begins and ends, m."""
        position, forward = np.array(camera.position), camera.axes[2]
        bounds = self.tiles.bounds
        near_m, far_m = 0.0, camera.distance_m * 2
        if bounds is not None:
            depths = (_corners(*bounds) - position).dot(forward)
            near_m = min(near_m, float(depths.min()) - _ROOM_M)
            far_m = max(far_m, float(depths.max()) * 1.01 + _ROOM_M)
        return near_m, far_m

    def _on_window_start(self, *_: object) -> None:
        self._began_at = time.perf_counter()

    def _on_widget_frame_swapped(self) -> None:
        if self._began_at and not self._is_closed:
            seconds, self._began_at = time.perf_counter() - self._began_at, 0.0
            self._reported_frame(seconds)


@contextmanager
def _format_taken_as_set() -> Iterator[None]:
    """Keep Qt from warning of the interactor's format, which the application has already.

    The interactor asks for it again, and Qt compares it with what the driver gave, which is newer.
    """
    before: Callable[[QtMsgType, QMessageLogContext, str], None] | None = None

    def pass_on(kind: QtMsgType, context: QMessageLogContext, message: str) -> None:
        if _FORMAT_AGAIN in message:
            return
        if before is not None:
            before(kind, context, message)
        else:
            sys.stderr.write(f"{message}\n")

    before = qInstallMessageHandler(pass_on)
    try:
        yield
    finally:
        qInstallMessageHandler(before)


def _corners(low: NDArray[np.float32], high: NDArray[np.float32]) -> NDArray[np.float64]:
    """(8, 3): the corners of a box."""
    choice = np.indices((2, 2, 2)).reshape(3, 8).T
    corners: NDArray[np.float64] = np.where(choice, high, low).astype(np.float64)
    return corners
