"""SceneRenderer: VTK's picture of the scene with its layers, camera and shading.

Importing this module imports VTK, which takes a second; the view does it after it was shown,
beside the window's thread.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QSize
from PySide6.QtGui import QImage
from PySide6.QtWidgets import QWidget
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLogger, vtkOutputWindow, vtkUnsignedCharArray
from vtkmodules.vtkRenderingCore import vtkRenderer, vtkRenderWindow
from vtkmodules.vtkRenderingOpenGL2 import vtkEDLShading, vtkRenderStepsPass

from widgets.scene_view.rendering.backdrop import BACKGROUND
from widgets.scene_view.rendering.camera import SceneCamera
from widgets.scene_view.rendering.change_surface import ChangeSurface
from widgets.scene_view.rendering.feature_actors import FeatureActors
from widgets.scene_view.rendering.scene_picture import ScenePicture
from widgets.scene_view.rendering.solid_actors import SolidActors
from widgets.scene_view.rendering.tile_actors import PointSizes, TileActors

_NEAREST_M = 0.1
_DEPTH_RATIO = 20_000.0
_LAYERS = 5
_ROOM_M = 1.0  # beyond the points, for what is drawn about them
_MOST_TIMES_LEAST = 6.0  # fills the gaps of a road down to some three metres


class SceneRenderer:
    """Draws layers that share a camera: cloud, bodies, halos, lines, marks.

    They are drawn beside the window and painted like any other view. A picture that OpenGL draws
    into the window itself would make every repaint of every view wait until the graphics driver
    has put the whole window together, which without a graphics card takes ten milliseconds.

    Parameters
    ----------
    parent : QWidget
    reported_frame : callable
        Given the seconds that each frame took, from its beginning until it was painted.
    """

    def __init__(self, parent: QWidget, reported_frame: Callable[[float], None]) -> None:
        # Troubles of the graphics are of no use to a surveyor; on Windows they open a window.
        vtkOutputWindow.GetInstance().SetDisplayModeToNever()
        vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
        self.widget = ScenePicture(parent, self._draw_frame)
        self.widget.frame_painted.connect(reported_frame)
        self._window = vtkRenderWindow()
        self._window.ShowWindowOff()
        self._window.UseOffScreenBuffersOn()
        self._window.SetMultiSamples(0)
        # No copy of a frame for a screen: it is read where it is drawn.
        self._window.SwapBuffersOff()
        self._window.SetNumberOfLayers(_LAYERS)
        self._pixels = vtkUnsignedCharArray()
        self._cloud = vtkRenderer()
        self._layers = [self._cloud, *(vtkRenderer() for _ in range(1, _LAYERS))]
        for number, layer in enumerate(self._layers):
            layer.SetLayer(number)
            layer.SetActiveCamera(self._cloud.GetActiveCamera())
            self._window.AddRenderer(layer)
        colour = [int(BACKGROUND[at : at + 2], 16) / 255 for at in (1, 3, 5)]
        self._cloud.SetBackground(*colour)
        self._shading = vtkEDLShading()
        self._shading.SetDelegatePass(vtkRenderStepsPass())
        self._is_shaded = False
        self._is_closed = False
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
            self.widget.redraw()

    def close(self) -> None:
        """Give everything back; may be called again."""
        if self._is_closed:
            return
        self._is_closed = True
        self.tiles.close()
        self.change.clear()
        self.solids.clear()
        self.features.clear()
        self._set_pass(None)
        # A pass that isn't in use is not released with the window.
        self._window.MakeCurrent()
        self._shading.ReleaseGraphicsResources(self._window)
        for layer in self._layers:
            self._window.RemoveRenderer(layer)
        self._window.Finalize()
        self.widget.close()

    def _draw_frame(self, size_px: QSize) -> QImage:
        """The scene as it is now; nothing once this is closed."""
        if self._is_closed:
            return QImage()
        width, height = size_px.toTuple()
        self._window.SetSize(width, height)
        self._window.Render()
        drawn_buffer, one_eye = 0, 0
        self._window.GetRGBACharPixelData(
            0, 0, width - 1, height - 1, drawn_buffer, self._pixels, one_eye
        )
        # VTK doesn't type this function.
        drawn: NDArray[np.uint8] = vtk_to_numpy(self._pixels)  # type: ignore[no-untyped-call]
        upright = drawn.reshape(height, width, 4)[::-1].copy()  # VTK's first row is the lowest
        frame = QImage(upright.data, width, height, QImage.Format.Format_RGBX8888)
        return frame.convertToFormat(QImage.Format.Format_RGB32)

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


def _corners(low: NDArray[np.float32], high: NDArray[np.float32]) -> NDArray[np.float64]:
    """(8, 3): the corners of a box."""
    choice = np.indices((2, 2, 2)).reshape(3, 8).T
    corners: NDArray[np.float64] = np.where(choice, high, low).astype(np.float64)
    return corners
