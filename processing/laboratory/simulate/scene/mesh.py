"""Triangles that know what they are made of and what they belong to."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from processing.laboratory.simulate.scene.materials import Material

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

TriangleShape = tuple[Floats, Integers]
"""Vertices (n, 3) float64, m, and triangles (m, 3) int64."""


@dataclass(frozen=True)
class Mesh:
    """Triangles in the street's frame: x east, y north, z up, m, about the street's origin.

    Attributes
    ----------
    vertices : (n, 3) float64
    triangles : (m, 3) int64
    material : (m,) uint8
        As :class:`~processing.laboratory.simulate.scene.materials.Material`.
    label : (m,) uint8
        The class code of the contract that its points have.
    instance : (m,) int32
        Of the thing that a triangle belongs to.
    piece : (m,) uint8
        Which piece of that thing (2 m of a curb, ten degrees of a trunk, the back of a plate):
        points are counted by thing and piece, so that truth can say what was seen of it.
    """

    vertices: Floats
    triangles: Integers
    material: NDArray[np.uint8]
    label: NDArray[np.uint8]
    instance: NDArray[np.int32]
    piece: NDArray[np.uint8]

    @staticmethod
    def joined(meshes: Iterable[Mesh]) -> Mesh:
        """All triangles of some meshes, in their order."""
        parts = list(meshes)
        if not parts:
            return MeshBuilder().mesh()
        starts = np.cumsum([0, *(one.vertices.shape[0] for one in parts)])
        return Mesh(
            np.concatenate([one.vertices for one in parts]),
            np.concatenate(
                [one.triangles + start for one, start in zip(parts, starts[:-1], strict=True)]
            ),
            np.concatenate([one.material for one in parts]),
            np.concatenate([one.label for one in parts]),
            np.concatenate([one.instance for one in parts]),
            np.concatenate([one.piece for one in parts]),
        )


@dataclass
class MeshBuilder:
    """Collects triangles; each `add` belongs to one thing."""

    _parts: list[Mesh] = field(default_factory=list)

    def add(
        self,
        shape: TriangleShape,
        material: Material | NDArray[np.uint8],
        label: int,
        instance: int,
        *,
        piece: int | Integers = 0,
    ) -> None:
        """Add triangles of one thing.

        Parameters
        ----------
        shape : Shape
            Vertices (n, 3) in the street's frame, m, and triangles (m, 3).
        material : Material or (m,) uint8
        label : int
            Class code of the contract.
        piece : int or (m,) int
            0 to 255.
        """
        vertices, triangles = shape
        count = len(triangles)
        self._parts.append(
            Mesh(
                np.asarray(vertices, np.float64).reshape(-1, 3),
                np.asarray(triangles, np.int64).reshape(-1, 3),
                np.broadcast_to(np.asarray(material, np.uint8), count).copy(),
                np.full(count, label, np.uint8),
                np.full(count, instance, np.int32),
                np.broadcast_to(np.asarray(piece, np.uint8), count).copy(),
            )
        )

    def add_mesh(self, mesh: Mesh) -> None:
        """Add triangles that know everything already."""
        self._parts.append(mesh)

    def mesh(self) -> Mesh:
        """What was collected."""
        if self._parts:
            return Mesh.joined(self._parts)
        empty = np.empty(0, np.uint8)
        none = np.empty((0, 3), np.int64)
        return Mesh(np.empty((0, 3)), none, empty, empty, np.empty(0, np.int32), empty)


def grid(rows: Floats) -> TriangleShape:
    """The surface through rows of places: (r, c, 3) float64; triangles in the rows' order."""
    count, width = rows.shape[:2]
    first = (np.arange(count - 1)[:, None] * width + np.arange(width - 1)).ravel()
    one = np.column_stack([first, first + 1, first + width])
    other = np.column_stack([first + 1, first + width + 1, first + width])
    return rows.reshape(-1, 3), np.stack([one, other], axis=1).reshape(-1, 3)


def tube(path: Floats, radii: Floats, sides: int, *, is_closed: bool = True) -> TriangleShape:
    """A round body along a path.

    Parameters
    ----------
    path : (n, 3) float64
    radii : (n,) float64
        At every place of the path, m.
    is_closed : bool
        Whether both ends are shut by a fan.
    """
    directions = np.gradient(path, axis=0)
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    aside = np.where(np.abs(directions[:, 2:]) > 0.9, [[1.0, 0.0, 0.0]], [[0.0, 0.0, 1.0]])
    first = np.cross(directions, aside)
    first /= np.linalg.norm(first, axis=1)[:, None]
    second = np.cross(directions, first)
    angles = np.linspace(0, 2 * np.pi, sides + 1)
    around = (
        np.cos(angles)[None, :, None] * first[:, None]
        + np.sin(angles)[None, :, None] * (second[:, None])
    )
    rows = path[:, None] + radii[:, None, None] * around
    vertices, triangles = grid(rows)
    if not is_closed:
        return vertices, triangles
    count = vertices.shape[0]
    rim = np.arange(sides)
    low = np.column_stack([np.full(sides, count), rim, rim + 1])
    start = (len(path) - 1) * (sides + 1)
    high = np.column_stack([np.full(sides, count + 1), start + rim, start + rim + 1])
    return np.concatenate([vertices, path[:1], path[-1:]]), np.concatenate([triangles, low, high])


def box(low: Sequence[float], high: Sequence[float]) -> TriangleShape:
    """A box between two corners, in its own frame (see `place_shape`)."""
    x0, y0, z0 = low
    x1, y1, z1 = high
    vertices = np.array(
        [
            [x0, y0, z0],
            [x1, y0, z0],
            [x1, y1, z0],
            [x0, y1, z0],
            [x0, y0, z1],
            [x1, y0, z1],
            [x1, y1, z1],
            [x0, y1, z1],
        ]
    )
    faces = [(0, 2, 1), (0, 3, 2), (4, 5, 6), (4, 6, 7), (0, 1, 5), (0, 5, 4)]
    faces += [(1, 2, 6), (1, 6, 5), (2, 3, 7), (2, 7, 6), (3, 0, 4), (3, 4, 7)]
    return vertices, np.array(faces, np.int64)


def plate(outline: Floats) -> TriangleShape:
    """A convex plane figure from its corners in order: (n, 3) float64."""
    count = len(outline)
    rest = np.arange(1, count - 1)
    return np.asarray(outline, np.float64), np.column_stack([np.zeros_like(rest), rest, rest + 1])


def place_shape(
    shape: TriangleShape, where: Sequence[float] | Floats, heading_rad: float
) -> TriangleShape:
    """A shape whose own x axis points along a heading (anticlockwise from east), at a place."""
    vertices, triangles = shape
    cosine, sine = np.cos(heading_rad), np.sin(heading_rad)
    turn = np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    return vertices @ turn + np.asarray(where, np.float64), triangles
