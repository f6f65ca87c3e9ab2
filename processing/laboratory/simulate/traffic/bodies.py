"""Bodies of what parks, drives and walks: triangles by material, in a frame of their own."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import (
    Floats,
    Mesh,
    MeshBuilder,
    TriangleShape,
    box,
    place_shape,
    tube,
)

MOVING_OBJECT = 64
"""Class code of vehicles, bicycles and people."""

TrafficPart = tuple[TriangleShape, Material | NDArray[np.uint8]]

_WHEEL_SIDES = 14


@dataclass(frozen=True)
class TrafficBody:
    """What stands on the ground, before it has a place.

    Attributes
    ----------
    kind : str
        In a word: ``car``, ``truck``, ``person``.
    parts : tuple of (Shape, material)
        In its own frame: x forward, y left, z up, m, about the place on the ground under its
        middle; the material of all triangles, or of each.
    length_m, width_m, height_m : float
        Of the box around it; mirrors reach beyond its width.
    """

    kind: str
    parts: tuple[TrafficPart, ...]
    length_m: float
    width_m: float
    height_m: float

    def mesh(self, instance: int) -> Mesh:
        """Its triangles as one thing, all of piece 0, in its own frame."""
        builder = MeshBuilder()
        for shape, material in self.parts:
            builder.add(shape, material, MOVING_OBJECT, instance)
        return builder.mesh()


def wheel(where: tuple[float, float], radius_m: float, wide_m: float) -> list[TrafficPart]:
    """A tyre with its disc that stands on the ground.

    Parameters
    ----------
    where : (float, float)
        x and y of its middle, m.
    """
    x, y = where
    half = wide_m / 2
    across = np.array([[x, y - half, radius_m], [x, y + half, radius_m]])
    tyre = tube(across, np.full(2, radius_m), _WHEEL_SIDES)
    disc = tube(across + np.array([[0, -0.008, 0], [0, 0.008, 0]]), np.full(2, radius_m * 0.64), 10)
    return [(tyre, Material.RUBBER), (disc, Material.STEEL)]


def loft_body(rings: Floats) -> TriangleShape:
    """A body through closed rings of places, its ends shut: (stations, places, 3) float64.

    The triangles are in the order of stations, then of places; two each; then both ends.
    """
    count, width = rings.shape[:2]
    here = np.arange(width)
    beside = np.roll(here, -1)
    first = (np.arange(count - 1) * width)[:, None]
    one = np.stack([first + here, first + beside, first + width + here], axis=-1)
    other = np.stack([first + beside, first + width + beside, first + width + here], axis=-1)
    sides = np.stack([one, other], axis=2).reshape(-1, 3)
    middles = rings[[0, -1]].mean(axis=1)
    back = np.column_stack([np.full(width, count * width), beside, here])
    front = np.column_stack([np.full(width, count * width + 1), here, beside])
    front[:, 1:] += (count - 1) * width
    return np.concatenate([rings.reshape(-1, 3), middles]), np.concatenate([sides, back, front])


def scale_shape(shape: TriangleShape, factors: tuple[float, float, float]) -> TriangleShape:
    """A shape with its three axes scaled about its origin."""
    return shape[0] * np.array(factors), shape[1]


def shift_shape(shape: TriangleShape, where: tuple[float, float, float]) -> TriangleShape:
    """A shape at another place."""
    return place_shape(shape, where, 0.0)


def block(middle: tuple[float, float, float], size: tuple[float, float, float]) -> TriangleShape:
    """A box about its middle."""
    low = [m - s / 2 for m, s in zip(middle, size, strict=True)]
    high = [m + s / 2 for m, s in zip(middle, size, strict=True)]
    return box(low, high)


def ball(middle: tuple[float, float, float], radii: tuple[float, float, float]) -> TriangleShape:
    """A rounded lump about its middle: five rings of eight places."""
    at = np.linspace(-0.96, 0.96, 5)
    path = np.column_stack([np.zeros(5), np.zeros(5), at])
    shape = tube(path, np.sqrt(1 - at**2) + 0.05, 8)
    return shift_shape(scale_shape(shape, radii), middle)


def rod(path: Iterable[Iterable[float]], radius_m: float, sides: int = 6) -> TriangleShape:
    """A round rod through places."""
    positions = np.array([list(one) for one in path], np.float64)
    return tube(positions, np.full(len(positions), radius_m), sides)
