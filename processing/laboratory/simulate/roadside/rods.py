"""Many thin round bodies at once: cables, branches, stakes, posts."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from processing.laboratory.simulate.scene.mesh import Floats, TriangleShape


def rods(
    paths: Floats, radii: Floats | float, sides: int, *, is_closed: bool = True
) -> TriangleShape:
    """Round bodies along paths of equally many places.

    Parameters
    ----------
    paths : (n, k, 3) float64
        k >= 2.
    radii : (n, k) or (k,) or () float64
        m; a ring's girth is that of the circle, its corners lie a little outside.
    is_closed : bool
        Whether both ends are shut.

    Returns
    -------
    Shape
        Rods one after the other; those of one rod from its beginning on.
    """
    paths = np.asarray(paths, np.float64)
    count, length = paths.shape[:2]
    wide = np.broadcast_to(np.asarray(radii, np.float64), (count, length))
    wide = wide * (np.pi / sides) / np.sin(np.pi / sides)
    directions = (
        np.gradient(paths, axis=1) if length > 2 else np.repeat(np.diff(paths, axis=1), 2, 1)
    )
    directions = directions / np.maximum(np.linalg.norm(directions, axis=2, keepdims=True), 1e-12)
    whole = paths[:, -1] - paths[:, 0]
    is_steep = np.abs(whole[:, 2]) > 0.7 * np.linalg.norm(whole, axis=1)
    aside = np.where(is_steep[:, None], [[1.0, 0.0, 0.0]], [[0.0, 0.0, 1.0]])[:, None]
    first = np.cross(directions, aside)
    first /= np.maximum(np.linalg.norm(first, axis=2, keepdims=True), 1e-12)
    second = np.cross(directions, first)
    angles = np.arange(sides) * (2 * np.pi / sides)
    around = (
        np.cos(angles)[:, None] * first[:, :, None] + np.sin(angles)[:, None] * second[:, :, None]
    )
    rings = paths[:, :, None] + wide[:, :, None, None] * around
    corner = np.arange(sides)
    step = (np.arange(length - 1) * sides)[:, None]
    here, beside = (step + corner).ravel(), (step + (corner + 1) % sides).ravel()
    faces = [
        np.column_stack([here, beside, here + sides]),
        np.column_stack([beside, beside + sides, here + sides]),
    ]
    if is_closed:
        fan = np.arange(1, sides - 1)
        end = (length - 1) * sides
        faces.append(np.column_stack([np.zeros_like(fan), fan + 1, fan]))
        faces.append(np.column_stack([np.full_like(fan, end), end + fan, end + fan + 1]))
    one = np.concatenate(faces)
    all_faces = one[None] + (np.arange(count) * length * sides)[:, None, None]
    return rings.reshape(-1, 3), all_faces.reshape(-1, 3)


def rod(start: Floats, end: Floats, radius_m: float, sides: int = 6) -> TriangleShape:
    """One straight rod between two places, (3,) each."""
    return rods(np.stack([start, end])[None], radius_m, sides)


def join_shapes(shapes: Iterable[TriangleShape]) -> TriangleShape:
    """Several shapes as one, in their order."""
    parts = list(shapes)
    starts = np.cumsum([0, *(len(one[0]) for one in parts)])
    return (
        np.concatenate([one[0] for one in parts]),
        np.concatenate([one[1] + start for one, start in zip(parts, starts[:-1], strict=True)]),
    )


def tilt_shape(shape: TriangleShape, angle_rad: float) -> TriangleShape:
    """A shape turned about its y axis: what looks along x looks up by the angle."""
    cosine, sine = np.cos(angle_rad), np.sin(angle_rad)
    turn = np.array([[cosine, 0.0, sine], [0.0, 1.0, 0.0], [-sine, 0.0, cosine]])
    return shape[0] @ turn, shape[1]
