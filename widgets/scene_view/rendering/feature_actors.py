"""FeatureActors: the map's lines and points in the scene, above the cloud.

What is drawn by hand must never be hidden by the points it rests on, so halos, lines and marks each
have a layer of their own over the cloud.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PySide6.QtGui import QColor
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper, vtkRenderer

from processing.core.arrays import Colours, Floats
from processing.map.catalogue import Geometry
from widgets.feature_drawing.feature_shapes import FeatureShape
from widgets.feature_drawing.feature_style import FeatureStyle
from widgets.scene_view.rendering.vtk_arrays import as_vtk, cloud_of, lines_of

_HALO_RGB = (12, 14, 18)
_MARK_PX = 9.0
_VERTEX_PX = 7.0
_DOT_PX = 3.0
_DASH_M, _GAP_M = 0.6, 0.4


@dataclass(frozen=True)
class StyledShape:
    """A feature and how it is to look."""

    shape: FeatureShape
    style: FeatureStyle


@dataclass(frozen=True, eq=False)
class DottedPoints:
    """Measured points of a chosen feature, and the colour of their dots.

    Attributes
    ----------
    local_xyz : (n, 3) float64
        Metres from the view's origin.
    colour : str
        ``#rrggbb``.
    """

    local_xyz: Floats
    colour: str


class FeatureActors:
    """Draws features; all lines of one width are one actor.

    Parameters
    ----------
    halos, lines, marks : vtkRenderer
        Layers, from below.
    """

    def __init__(self, halos: vtkRenderer, lines: vtkRenderer, marks: vtkRenderer) -> None:
        self._halos, self._lines, self._marks = halos, lines, marks
        self._actors: list[tuple[vtkRenderer, vtkActor]] = []
        self._dashes: dict[str, tuple[FeatureShape, Floats]] = {}

    def show(
        self, styled: Sequence[StyledShape], scale: float, dotted: Sequence[DottedPoints] = ()
    ) -> None:
        """Draw exactly these.

        Parameters
        ----------
        scale : float
            Device pixels per Qt pixel.
        dotted : sequence of DottedPoints
            Below lines and marks.
        """
        self.clear()
        self._show_dots(dotted, _DOT_PX * scale)
        shown = {one.shape.feature.id for one in styled}
        self._dashes = {id_: made for id_, made in self._dashes.items() if id_ in shown}
        for width_px, halo_px in sorted({_widths(one.style) for one in styled}):
            alike = [one for one in styled if _widths(one.style) == (width_px, halo_px)]
            positions, colours = self._segments(alike)
            if len(positions):
                halo = _lines_actor(positions, None)
                halo.GetProperty().SetLineWidth((width_px + 2 * halo_px) * scale)
                self._add(self._halos, halo)
                line = _lines_actor(positions, colours)
                line.GetProperty().SetLineWidth(width_px * scale)
                self._add(self._lines, line)
        points = [one for one in styled if one.shape.feature.geometry is Geometry.POINT]
        self._show_marks(points, _MARK_PX * scale, is_round=True)
        chosen = [
            one
            for one in styled
            if one.style.has_vertices and one.shape.feature.geometry is not Geometry.POINT
        ]
        self._show_marks(chosen, _VERTEX_PX * scale, is_round=False)
        self._hollow(chosen, (_VERTEX_PX - 3.0) * scale)

    def clear(self) -> None:
        """Draw nothing."""
        for renderer, actor in self._actors:
            renderer.RemoveActor(actor)
        self._actors.clear()

    def _show_dots(self, dotted: Sequence[DottedPoints], size_px: float) -> None:
        if not dotted:
            return
        positions = np.concatenate([one.local_xyz for one in dotted])
        rgb = np.array([_rgb_of(one.colour) for one in dotted], np.uint8)
        actor = _points_actor(positions, np.repeat(rgb, [len(one.local_xyz) for one in dotted], 0))
        actor.GetProperty().SetPointSize(size_px)
        self._add(self._halos, actor)

    def _show_marks(self, styled: Sequence[StyledShape], size_px: float, *, is_round: bool) -> None:
        if not styled:
            return
        positions = np.concatenate([one.shape.local_xyz for one in styled])
        colours = np.concatenate(
            [np.tile(_rgb(one.style), (len(one.shape.local_xyz), 1)) for one in styled]
        )
        for renderer, extra_px, painted in (
            (self._lines, 4.0, None),
            (self._marks, 0.0, colours),
        ):
            actor = _points_actor(positions, painted)
            actor.GetProperty().SetPointSize(size_px + extra_px)
            actor.GetProperty().SetRenderPointsAsSpheres(is_round)
            self._add(renderer, actor)

    def _hollow(self, styled: Sequence[StyledShape], size_px: float) -> None:
        """Open the squares of vertices that rest on no measured point."""
        inside = [
            position
            for one in styled
            for position, vertex in zip(
                one.shape.local_xyz, one.shape.feature.vertices, strict=True
            )
            if vertex.is_occluded
        ]
        if inside:
            dark = np.tile(np.array(_HALO_RGB, dtype=np.uint8), (len(inside), 1))
            actor = _points_actor(np.array(inside), dark)
            actor.GetProperty().SetPointSize(size_px)
            self._add(self._marks, actor)

    def _segments(self, styled: Sequence[StyledShape]) -> tuple[Floats, Colours]:
        """(k, 2, 3) places and (k, 3) colours of all lines."""
        pieces = [
            self._cut_dashes(one.shape)
            if one.style.is_dashed
            else one.shape.local_xyz[one.shape.segments]
            for one in styled
        ]
        colours = np.array([_rgb(one.style) for one in styled])
        return np.concatenate(pieces), np.repeat(colours, [len(one) for one in pieces], axis=0)

    def _cut_dashes(self, shape: FeatureShape) -> Floats:
        """The dashes of a feature, cut once: thousands are drawn anew whenever one is chosen."""
        id_ = shape.feature.id
        known = self._dashes.get(id_)
        if known is None or known[0] is not shape:
            known = shape, dash_segments(shape.local_xyz, shape.segments)
            self._dashes[id_] = known
        return known[1]

    def _add(self, renderer: vtkRenderer, actor: vtkActor) -> None:
        renderer.AddActor(actor)
        self._actors.append((renderer, actor))


def dash_segments(local_xyz: Floats, ends: NDArray[np.int64]) -> Floats:
    """Segments of a line cut into dashes.

    Parameters
    ----------
    local_xyz : (n, 3) float64
    ends : (m, 2) int64
        Vertices at both ends of each segment, in their order along the line.

    Returns
    -------
    (k, 2, 3) float64
        Both ends of every dash.
    """
    if not len(ends):
        return np.empty((0, 2, 3))
    corners = np.concatenate([local_xyz[ends[:, 0]], local_xyz[ends[-1:, 1]]])
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(corners, axis=0), axis=1))])
    starts = np.arange(0.0, along[-1], _DASH_M + _GAP_M)
    stops = np.minimum(starts + _DASH_M, along[-1])
    # Dashes bend at corners, so they are cut there as well.
    cuts = np.unique(np.concatenate([starts, stops, along]))
    middles = (cuts[:-1] + cuts[1:]) / 2
    is_dash = np.mod(middles, _DASH_M + _GAP_M) < _DASH_M
    positions = np.column_stack([np.interp(cuts, along, axis) for axis in corners.T])
    return np.stack([positions[:-1][is_dash], positions[1:][is_dash]], axis=1)


def _widths(style: FeatureStyle) -> tuple[float, float]:
    # Halos are told apart in quarters of a pixel: every pair of widths is an actor of its own.
    return style.width_px, round(style.halo_px * 4) / 4


def _rgb_of(colour: str) -> tuple[int, int, int]:
    named = QColor(colour)
    return named.red(), named.green(), named.blue()


def _rgb(style: FeatureStyle) -> Colours:
    rgb: Colours = np.rint(np.array(style.rgb) * 255).astype(np.uint8)
    return rgb


def _lines_actor(positions: Floats, colours: Colours | None) -> vtkActor:
    data = lines_of(positions)
    if colours is not None:
        data.GetCellData().SetScalars(as_vtk(colours))
    return _flat_actor(data)


def _points_actor(positions: Floats, colours: Colours | None) -> vtkActor:
    data = cloud_of(positions)
    if colours is not None:
        data.GetPointData().SetScalars(as_vtk(colours))
    return _flat_actor(data)


def _flat_actor(data: vtkPolyData) -> vtkActor:
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(data)
    actor = vtkActor()
    actor.SetMapper(mapper)
    look = actor.GetProperty()
    look.SetColor(*(part / 255 for part in _HALO_RGB))
    look.SetAmbient(1.0)
    look.SetDiffuse(0.0)
    return actor
