"""SolidActors: lids and gratings as bodies in the scene, thousands of them as one mesh.

They are seen through, so that an operator still sees the points by which a lid is judged, and lie
above the cloud like the lines round them: what is found is never hidden by what it rests on.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper, vtkRenderer

from processing.core.arrays import Colours, Floats, Integers
from processing.map.solids import FaceIndices, Solid, solid_of
from widgets.feature_drawing.feature_shapes import FeatureShape
from widgets.feature_drawing.feature_style import FeatureStyle
from widgets.scene_view.rendering.vtk_arrays import as_vtk, faces_of, positions_of

_BARRED = "gutter_grating"
_PITCH_M = 0.04  # of the bars that are drawn; real ones are nearer, and would blur
_FEWEST_BARS, _MOST_BARS = 3, 60
_GAP_SHARE = 0.35
_DARKER = 4
_ACCEPTED, _CHOSEN = 0.62, 0.85
_DOUBTFUL, _SURE = 0.15, 0.5  # candidates without any confidence, and with all of it
_AMBIENT, _DIFFUSE = 0.35, 0.65


@dataclass(frozen=True)
class StyledSolid:
    """A feature that is the top of a body, and how it is to look."""

    shape: FeatureShape
    style: FeatureStyle
    thickness_m: float


@dataclass(frozen=True)
class _Mesh:
    """The faces of a body, whatever their colours.

    Attributes
    ----------
    corners : (k,) int64
        Places of the faces, one face after the other.
    sizes : (faces,) int64
    is_gap : (faces,) bool
        Between the bars of a grating.
    """

    positions: Floats
    corners: Integers
    sizes: Integers
    is_gap: NDArray[np.bool_]


class SolidActors:
    """Draws bodies.

    Parameters
    ----------
    renderer : vtkRenderer
        A layer between the cloud and the lines.
    """

    def __init__(self, renderer: vtkRenderer) -> None:
        self._renderer = renderer
        self._actor: vtkActor | None = None
        self._made: dict[str, tuple[FeatureShape, float, _Mesh | None]] = {}

    @property
    def count(self) -> int:
        """Faces that are drawn."""
        if self._actor is None:
            return 0
        return int(self._actor.GetMapper().GetInput().GetNumberOfPolys())

    def show(self, bodies: Sequence[StyledSolid]) -> None:
        """Draw exactly these."""
        if self._actor is not None:
            self._renderer.RemoveActor(self._actor)
            self._actor = None
        meshes = self._meshes(bodies)
        drawn = [(body, one) for body, one in zip(bodies, meshes, strict=True) if one is not None]
        if drawn:
            colours = np.array([_colour(body) for body, _ in drawn], dtype=np.uint8)
            self._actor = _actor_of([mesh for _, mesh in drawn], colours)
            self._renderer.AddActor(self._actor)

    def clear(self) -> None:
        """Draw nothing."""
        self.show(())

    def _meshes(self, bodies: Sequence[StyledSolid]) -> list[_Mesh | None]:
        """The bodies' shapes; those of before where nothing but their looks has changed."""
        made = {}
        for body in bodies:
            id_ = body.shape.feature.id
            known = self._made.get(id_)
            if known is None or known[0] is not body.shape or known[1] != body.thickness_m:
                known = body.shape, body.thickness_m, _mesh(body)
            made[id_] = known
        self._made = made
        return [made[body.shape.feature.id][2] for body in bodies]


def _mesh(body: StyledSolid) -> _Mesh | None:
    solid = solid_of(body.shape.local_xyz, body.thickness_m)
    if solid is None:
        return None
    positions, top = solid.positions, list(solid.top)
    is_barred = body.shape.feature.kind == _BARRED and len(solid.positions) == 8
    if is_barred:
        positions, top = _make_bars(solid)
    faces = [*top, *solid.sides, *solid.bottom]
    is_gap = np.zeros(len(faces), dtype=np.bool_)
    is_gap[1 : len(top) : 2] = is_barred
    return _Mesh(
        positions,
        np.array([corner for face in faces for corner in face], dtype=np.int64),
        np.array([len(face) for face in faces], dtype=np.int64),
        is_gap,
    )


def _colour(body: StyledSolid) -> tuple[int, int, int, int]:
    red, green, blue = body.style.rgb
    return round(red * 255), round(green * 255), round(blue * 255), round(_opacity(body) * 255)


def _opacity(body: StyledSolid) -> float:
    if body.style.has_vertices:
        return _CHOSEN
    if not body.style.is_dashed:
        return _ACCEPTED
    confidence = min(max(body.shape.feature.provenance.confidence, 0.0), 1.0)
    return _DOUBTFUL + (_SURE - _DOUBTFUL) * confidence


def _make_bars(solid: Solid) -> tuple[Floats, list[FaceIndices]]:
    """The top as bars across its longer side, with gaps between them."""
    corners = solid.positions[:4]
    if np.linalg.norm(corners[1] - corners[0]) < np.linalg.norm(corners[2] - corners[1]):
        corners = np.roll(corners, -1, axis=0)
    long_m = float(np.linalg.norm(corners[1] - corners[0]))
    bars = min(max(round(long_m / _PITCH_M), _FEWEST_BARS), _MOST_BARS)
    # From bar to gap to bar: it begins and ends with half a bar.
    middles = (np.arange(bars) + 0.5) / bars
    half = _GAP_SHARE / bars / 2
    cuts = np.concatenate([[0.0], np.sort(np.concatenate([middles - half, middles + half])), [1.0]])
    near = corners[0] + cuts[:, None] * (corners[1] - corners[0])
    far = corners[3] + cuts[:, None] * (corners[2] - corners[3])
    first, count = len(solid.positions), len(cuts)
    faces: list[FaceIndices] = [
        (first + at, first + at + 1, first + count + at + 1, first + count + at)
        for at in range(count - 1)
    ]
    return np.concatenate([solid.positions, near, far]), faces


def _actor_of(meshes: Sequence[_Mesh], colours: Colours) -> vtkActor:
    counts = np.array([len(mesh.positions) for mesh in meshes])
    starts = np.repeat(np.cumsum(counts) - counts, [mesh.corners.size for mesh in meshes])
    data = vtkPolyData()
    data.SetPoints(positions_of(np.concatenate([mesh.positions for mesh in meshes])))
    corners = np.concatenate([mesh.corners for mesh in meshes])
    data.SetPolys(faces_of(corners + starts, np.concatenate([mesh.sizes for mesh in meshes])))
    of_faces = np.repeat(colours, [mesh.sizes.size for mesh in meshes], axis=0)
    of_faces[np.concatenate([mesh.is_gap for mesh in meshes]), :3] //= _DARKER
    data.GetCellData().SetScalars(as_vtk(of_faces))
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(data)
    actor = vtkActor()
    actor.SetMapper(mapper)
    look = actor.GetProperty()
    look.SetAmbient(_AMBIENT)
    look.SetDiffuse(_DIFFUSE)
    # A closed body that is seen through would show its far sides over its near ones.
    look.BackfaceCullingOn()
    look.SetInterpolationToFlat()
    return actor
