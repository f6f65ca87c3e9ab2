"""Bodies of what parks, drives and walks: triangles by material, in a frame of their own."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.simulate.materials import Material
from processing.simulate.mesh import Floats, Mesh, MeshBuilder, Shape, box, placed, tube

MOVING_OBJECT = 64
"""Class code of vehicles, bicycles and people."""

Part = tuple[Shape, Material | NDArray[np.uint8]]

_WHEEL_SIDES = 14


@dataclass(frozen=True)
class Body:
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
    parts: tuple[Part, ...]
    length_m: float
    width_m: float
    height_m: float

    def mesh(self, instance: int) -> Mesh:
        """Its triangles as one thing, all of piece 0, in its own frame."""
        builder = MeshBuilder()
        for shape, material in self.parts:
            builder.add(shape, material, MOVING_OBJECT, instance)
        return builder.mesh()


def wheel(where: tuple[float, float], radius_m: float, wide_m: float) -> list[Part]:
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


def lofted(rings: Floats) -> Shape:
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


def stretched(shape: Shape, factors: tuple[float, float, float]) -> Shape:
    """A shape with its three axes scaled about its origin."""
    return shape[0] * np.array(factors), shape[1]


def shifted(shape: Shape, where: tuple[float, float, float]) -> Shape:
    """A shape at another place."""
    return placed(shape, where, 0.0)


def block(middle: tuple[float, float, float], size: tuple[float, float, float]) -> Shape:
    """A box about its middle."""
    low = [m - s / 2 for m, s in zip(middle, size, strict=True)]
    high = [m + s / 2 for m, s in zip(middle, size, strict=True)]
    return box(low, high)


def ball(middle: tuple[float, float, float], radii: tuple[float, float, float]) -> Shape:
    """A rounded lump about its middle: five rings of eight places."""
    at = np.linspace(-0.96, 0.96, 5)
    path = np.column_stack([np.zeros(5), np.zeros(5), at])
    shape = tube(path, np.sqrt(1 - at**2) + 0.05, 8)
    return shifted(stretched(shape, radii), middle)


def rod(path: Iterable[Iterable[float]], radius_m: float, sides: int = 6) -> Shape:
    """A round rod through places."""
    places = np.array([list(one) for one in path], np.float64)
    return tube(places, np.full(len(places), radius_m), sides)
