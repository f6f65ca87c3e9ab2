"""ChangeSurface: the later ground of a volume, in the colours of its change."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper, vtkRenderer

from processing.core.arrays import Floats
from processing.image.search.clip import Clip
from processing.methods.earthwork.maps.change_grid import ChangeGrid
from processing.methods.earthwork.maps.heat_map import change_classes, class_colours
from widgets.scene_view.rendering.vtk_arrays import as_vtk, faces_of, positions_of
from widgets.shared.shown_volume import VolumeStyle

MOST_FACES = 150_000
"""As many as a program draws in a tenth of a second without a graphics card."""

_ABOVE_M = 0.03
"""Points of the ground lie about it by their noise, and would show through as specks."""

_AMBIENT, _DIFFUSE = 0.55, 0.45
_PALER = 0.45
_CORNERS = 4


@dataclass(frozen=True, eq=False)
class _Faces:
    """Squares between the middles of four cells, every so many cells.

    Attributes
    ----------
    positions : (n, 3) float64
        Of the corners, m from the scene's origin.
    corners : (f, 4) int64
        Of the squares, anticlockwise from above.
    change_m : (f,) float32
    is_measured : (f,) bool
    """

    positions: Floats
    corners: NDArray[np.int64]
    change_m: NDArray[np.float32]
    is_measured: NDArray[np.bool_]


class ChangeSurface:
    """Draws one map among the points, which it hides and is hidden by.

    Parameters
    ----------
    renderer : vtkRenderer
        That of the points.
    """

    def __init__(self, renderer: vtkRenderer) -> None:
        self._renderer = renderer
        self._actor: vtkActor | None = None
        self._made: tuple[ChangeGrid, bytes, Clip | None] | None = None
        self._faces: _Faces | None = None
        self._limit_m = math.nan

    @property
    def count(self) -> int:
        """Faces that are drawn."""
        return 0 if self._actor is None or self._faces is None else len(self._faces.corners)

    def show(
        self, change: ChangeGrid | None, look: VolumeStyle, origin: Floats, clip: Clip | None
    ) -> None:
        """Draw this map like that; None: none.

        Parameters
        ----------
        origin : (3,) float64
            Of the scene, m, project CRS.
        clip : Clip or None
            Which part of space is shown.
        """
        if change is None:
            self.clear()
            return
        wanted = change, origin.tobytes(), clip
        made = self._made
        is_same = made is not None and made[0] is change and made[1:] == wanted[1:]
        if not is_same:
            self.clear()
            self._made, self._faces = wanted, _faces_of(change, origin, clip)
            self._limit_m = math.nan
            self._actor = _actor_of(self._faces)
            self._renderer.AddActor(self._actor)
        if self._actor is not None:
            self._actor.GetProperty().SetOpacity(look.opacity)
        if self._actor is not None and self._faces is not None and look.limit_m != self._limit_m:
            self._limit_m = look.limit_m
            data = self._actor.GetMapper().GetInput()
            data.GetCellData().SetScalars(as_vtk(_colours(self._faces, look.limit_m)))

    def clear(self) -> None:
        """Draw nothing."""
        if self._actor is not None:
            self._renderer.RemoveActor(self._actor)
        self._actor = self._made = self._faces = None


def _faces_of(change: ChangeGrid, origin: Floats, clip: Clip | None) -> _Faces:
    grid = change.grid
    step = max(1, math.ceil(math.sqrt(grid.rows * grid.columns / MOST_FACES)))
    rows, columns = np.arange(0, grid.rows, step), np.arange(0, grid.columns, step)
    cells = np.ix_(rows, columns)
    height = change.after[cells].astype(np.float64)
    is_there = np.isfinite(change.change_m[cells])
    numbers = np.arange(height.size).reshape(height.shape)
    # The lower left corner stands for the square: at its own place in the middle of its cell.
    is_face = is_there[:-1, :-1] & is_there[:-1, 1:] & is_there[1:, :-1] & is_there[1:, 1:]
    east, north = np.meshgrid((columns + 0.5) * grid.size_m, (rows + 0.5) * grid.size_m)
    lift = np.stack([east, north, height + _ABOVE_M], axis=-1).reshape(-1, 3)
    # In float64 first: float32 doesn't hold survey coordinates.
    positions = lift + (grid.origin - origin)
    if clip is not None:
        is_face &= clip.holds(positions + origin).reshape(height.shape)[:-1, :-1]
    south_west = numbers[:-1, :-1][is_face]
    wide = height.shape[1]
    corners = np.stack(
        [south_west, south_west + 1, south_west + wide + 1, south_west + wide], axis=1
    )
    own_m, is_measured = change.change_m[cells], change.is_measured[cells]
    return _Faces(positions, corners, own_m[:-1, :-1][is_face], is_measured[:-1, :-1][is_face])


def _colours(faces: _Faces, limit_m: float) -> NDArray[np.uint8]:
    """(f, 3); what was filled in is nearer to grey."""
    colours = class_colours(faces.change_m, change_classes(limit_m))[:, :3]
    filled = ~faces.is_measured
    grey = colours[filled].mean(axis=1, keepdims=True) * _PALER
    colours[filled] = (colours[filled] * (1 - _PALER) + grey).astype(np.uint8)
    return colours


def _actor_of(faces: _Faces) -> vtkActor:
    data = vtkPolyData()
    data.SetPoints(positions_of(faces.positions))
    sizes = np.full(len(faces.corners), _CORNERS, np.int64)
    data.SetPolys(faces_of(faces.corners.reshape(-1), sizes))
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(data)
    actor = vtkActor()
    actor.SetMapper(mapper)
    # Near ground hides far ground, though the points shine through both.
    actor.ForceOpaqueOn()
    look = actor.GetProperty()
    look.SetAmbient(_AMBIENT)
    look.SetDiffuse(_DIFFUSE)
    look.SetInterpolationToFlat()
    return actor
