"""TileActors: one cloud of coloured points in the scene per tile."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from vtkmodules.vtkCommonCore import vtkCommand
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper, vtkRenderer
from vtkmodules.vtkRenderingOpenGL2 import vtkOpenGLRenderWindow

from widgets.scene_view.rendering.scene_tile import DrawnTile, SceneTile, TileId
from widgets.scene_view.rendering.vtk_arrays import as_vtk, cloud_of

_PROGRAM_POINT_SIZE = 0x8642  # OpenGL's name for sizes that the vertex shader decides
_SPACING_SHARE = 0.9
_POSITION_CODE = "//VTK::PositionVC::Impl"
_SIZE_CODE = f"""{_POSITION_CODE}
  gl_PointSize = clamp(sizeFactor / gl_Position.w, sizeLeast, sizeMost);
"""


@dataclass(frozen=True)
class PointSizes:
    """How large points are drawn, device pixels.

    A point is as large as the gap to its neighbours, so that near surfaces look closed.

    Attributes
    ----------
    least, most : float
    focal_px : float
        Pixels per metre, one metre in front of the camera.
    """

    least: float = 2.0
    most: float = 5.0
    focal_px: float = 1000.0


class TileActors:
    """The tiles in a renderer, those drawn and those kept for the next movement.

    Parameters
    ----------
    renderer : vtkRenderer
    """

    def __init__(self, renderer: vtkRenderer) -> None:
        self._renderer = renderer
        self._actors: dict[TileId, _TileActor] = {}
        self._shown: frozenset[TileId] = frozenset()
        self._sizes = PointSizes()
        self._observers = [
            renderer.AddObserver(vtkCommand.StartEvent, self._on_renderer_start),
            renderer.AddObserver(vtkCommand.EndEvent, self._on_renderer_end),
        ]

    @property
    def shown(self) -> tuple[DrawnTile, ...]:
        """The tiles that are drawn."""
        return tuple(self._actors[tile].drawn for tile in self._shown)

    @property
    def points_shown(self) -> int:
        """How many points are drawn."""
        return sum(one.tile.points.size for one in self.shown)

    @property
    def tiles(self) -> dict[TileId, SceneTile]:
        """All tiles that are there."""
        return {id_: actor.drawn.tile for id_, actor in self._actors.items()}

    @property
    def bounds(self) -> tuple[NDArray[np.float32], NDArray[np.float32]] | None:
        """Lowest and highest place of what is drawn, m from the origin; None when nothing is."""
        shown = [one for one in self.shown if one.tile.points.size]
        if not shown:
            return None
        low = np.min([one.low for one in shown], axis=0)
        return low, np.max([one.high for one in shown], axis=0)

    def put(self, tile: SceneTile, colours: NDArray[np.uint8]) -> None:
        """Add a tile, hidden, or give one that is there new colours.

        Parameters
        ----------
        colours : (n, 3) uint8
            The tile's own, or with some points marked.
        """
        there = self._actors.get(tile.id)
        if there is not None and np.array_equal(there.drawn.tile.points, tile.points):
            there.recolour(tile, colours)
            return
        self.remove(tile.id)
        actor = _TileActor(tile, colours)
        actor.set_sizes(self._sizes)
        actor.actor.SetVisibility(tile.id in self._shown)
        self._actors[tile.id] = actor
        self._renderer.AddActor(actor.actor)

    def show(self, tiles: Collection[TileId]) -> bool:
        """Draw exactly these of the tiles that are there; says whether others were drawn."""
        shown = frozenset(tile for tile in tiles if tile in self._actors)
        if shown == self._shown:
            return False
        for tile in self._shown ^ shown:
            if tile in self._actors:
                self._actors[tile].actor.SetVisibility(tile in shown)
        self._shown = shown
        return True

    def keep_only(self, tiles: Collection[TileId]) -> None:
        """Remove all others."""
        for tile in [tile for tile in self._actors if tile not in tiles]:
            self.remove(tile)

    def remove(self, id_: TileId) -> None:
        """Take a tile out, if it is there."""
        actor = self._actors.pop(id_, None)
        if actor is not None:
            self._renderer.RemoveActor(actor.actor)
            self._shown -= {id_}

    def set_sizes(self, sizes: PointSizes) -> bool:
        """Draw points so large; says whether they were of another size before."""
        if sizes == self._sizes:
            return False
        self._sizes = sizes
        for actor in self._actors.values():
            actor.set_sizes(sizes)
        return True

    def close(self) -> None:
        """Remove all tiles and let go of the renderer."""
        self.keep_only(())
        for observer in self._observers:
            self._renderer.RemoveObserver(observer)
        self._observers.clear()

    def _on_renderer_start(self, *_: object) -> None:
        window = self._renderer.GetRenderWindow()
        if isinstance(window, vtkOpenGLRenderWindow):
            window.GetState().vtkglEnable(_PROGRAM_POINT_SIZE)

    def _on_renderer_end(self, *_: object) -> None:
        # Other layers have fixed sizes.
        window = self._renderer.GetRenderWindow()
        if isinstance(window, vtkOpenGLRenderWindow):
            window.GetState().vtkglDisable(_PROGRAM_POINT_SIZE)


class _TileActor:
    """The actor of a tile."""

    def __init__(self, tile: SceneTile, colours: NDArray[np.uint8]) -> None:
        empty = np.zeros(3, np.float32)
        low = tile.local_xyz.min(axis=0) if tile.points.size else empty
        high = tile.local_xyz.max(axis=0) if tile.points.size else empty
        self.drawn = DrawnTile(tile, low, high)
        self._data = cloud_of(tile.local_xyz)
        self.recolour(tile, colours)
        mapper = vtkPolyDataMapper()
        mapper.SetInputData(self._data)
        self.actor = vtkActor()
        self.actor.SetMapper(mapper)
        self.actor.GetProperty().LightingOff()
        self.actor.GetShaderProperty().AddVertexShaderReplacement(
            _POSITION_CODE,
            True,  # noqa: FBT003 - VTK takes no keyword: before its own replacements
            _SIZE_CODE,
            False,  # noqa: FBT003 - VTK takes no keyword: only the first place
        )

    def set_sizes(self, sizes: PointSizes) -> None:
        # Uniforms, not numbers in the code: all tiles then share one compiled program.
        uniforms = self.actor.GetShaderProperty().GetVertexCustomUniforms()
        factor = _SPACING_SHARE * self.drawn.tile.spacing_m * sizes.focal_px
        uniforms.SetUniformf("sizeFactor", factor)
        uniforms.SetUniformf("sizeLeast", sizes.least)
        uniforms.SetUniformf("sizeMost", sizes.most)

    def recolour(self, tile: SceneTile, colours: NDArray[np.uint8]) -> None:
        self.drawn = replace(self.drawn, tile=tile)
        self._data.GetPointData().SetScalars(as_vtk(colours))
