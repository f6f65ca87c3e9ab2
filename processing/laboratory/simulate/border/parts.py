"""Parts of buildings and of what stands in yards: bodies, roofs, windows, by few triangles.

All in the frame of a lot: x along the street, y away from it, z up from the ground, m.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats, Integers, TriangleShape, box, plate

BorderPart = tuple[TriangleShape, Material]
Interval = tuple[float, float]

BELOW_M = 0.8
"""How far bodies reach below the ground where they stand, so that none floats on a slope."""

_FRAME_M = 0.05  # of a window, around the glass
_PROUD_M = 0.03  # how far a window's frame stands before its wall


@dataclass(frozen=True)
class BoxPart:
    """An upright body with a rectangle for its plan: from and to on each axis, m."""

    x: Interval
    y: Interval
    z: Interval

    @property
    def wide_m(self) -> float:
        """Along the street."""
        return self.x[1] - self.x[0]

    @property
    def deep_m(self) -> float:
        """Away from the street."""
        return self.y[1] - self.y[0]

    def shape(self) -> TriangleShape:
        """Its box."""
        return block(self.x, self.y, self.z)


def block(x: Interval, y: Interval, z: Interval) -> TriangleShape:
    """A box from its extents."""
    return box((x[0], y[0], z[0]), (x[1], y[1], z[1]))


def merge_parts(shapes: Iterable[TriangleShape]) -> TriangleShape:
    """Several shapes as one."""
    parts = list(shapes)
    starts = np.cumsum([0, *(len(one[0]) for one in parts)])
    vertices: Floats = np.concatenate([one[0] for one in parts])
    triangles: Integers = np.concatenate(
        [one[1] + at for one, at in zip(parts, starts[:-1], strict=True)]
    )
    return vertices, triangles


def slab(outline: Floats, thick_m: float) -> TriangleShape:
    """A plate with a thickness below it, from the corners of its top in order: (n, 3)."""
    count = len(outline)
    low = outline - [0.0, 0.0, thick_m]
    top, bottom = plate(outline), plate(low)
    one = np.arange(count)
    other = (one + 1) % count
    rim = np.concatenate(
        [
            np.column_stack([one, other, other + count]),
            np.column_stack([one, other + count, one + count]),
        ]
    )
    return (
        np.concatenate([outline, low]),
        np.concatenate([top[1], bottom[1][:, ::-1] + count, rim]),
    )


def gable_roof(
    body: BoxPart, eaves_m: float, pitch: float, thick_m: float
) -> tuple[TriangleShape, TriangleShape]:
    """Two slopes about a ridge along the longer side (切妻), and the gables' walls below them."""
    (u0, u1), (v0, v1), is_turned = _long_way(body)
    middle, rise, z = (v0 + v1) / 2, pitch * (v1 - v0) / 2, body.z[1] + 0.02
    slopes = []
    for edge in (v0 - eaves_m, v1 + eaves_m):
        low = z - pitch * eaves_m
        ends = [(u0 - eaves_m, edge, low), (u1 + eaves_m, edge, low)]
        ends += [(u1 + eaves_m, middle, z + rise), (u0 - eaves_m, middle, z + rise)]
        slopes.append(slab(np.add(ends, [0.0, 0.0, thick_m]), thick_m))
    gables = [
        plate(np.array([(u, v0, z - 0.02), (u, v1, z - 0.02), (u, middle, z + rise)]))
        for u in (u0, u1)
    ]
    return _turned(merge_parts(slopes), is_turned), _turned(merge_parts(gables), is_turned)


def hip_roof(body: BoxPart, eaves_m: float, pitch: float, thick_m: float) -> TriangleShape:
    """Four slopes that meet in a ridge or a point (寄棟), over a soffit."""
    (u0, u1), (v0, v1), is_turned = _long_way(body)
    u0, u1, v0, v1 = u0 - eaves_m, u1 + eaves_m, v0 - eaves_m, v1 + eaves_m
    half, middle, z = (v1 - v0) / 2, (v0 + v1) / 2, body.z[1] + thick_m
    top = z + pitch * half
    ridge = np.array([[u0 + half, middle, top], [u1 - half, middle, top]])
    low = np.array([[u0, v0, z], [u1, v0, z], [u1, v1, z], [u0, v1, z]])
    faces = [
        np.array([low[0], low[1], ridge[1], ridge[0]]),
        np.array([low[2], low[3], ridge[0], ridge[1]]),
        np.array([low[1], low[2], ridge[1]]),
        np.array([low[3], low[0], ridge[0]]),
    ]
    return _turned(merge_parts([slab(low, thick_m), *(plate(one) for one in faces)]), is_turned)


def shed_roof(
    body: BoxPart, eaves_m: float, pitch: float, thick_m: float
) -> tuple[TriangleShape, TriangleShape]:
    """One slope that rises away from the street (片流れ), and the walls up to it."""
    x0, x1 = body.x[0] - eaves_m, body.x[1] + eaves_m
    z = body.z[1] + 0.02

    def level(y: float) -> float:
        return z + pitch * (y - body.y[0])

    y0, y1 = body.y[0] - eaves_m, body.y[1] + eaves_m
    outline = [(x0, y0, level(y0)), (x1, y0, level(y0)), (x1, y1, level(y1)), (x0, y1, level(y1))]
    low, high = body.z[1], level(body.y[1])
    walls = [
        plate(np.array([(x, body.y[0], low), (x, body.y[1], low), (x, body.y[1], high)]))
        for x in body.x
    ]
    rear = body.y[1]
    walls += [
        plate(
            np.array(
                [
                    (body.x[0], rear, low),
                    (body.x[1], rear, low),
                    (body.x[1], rear, high),
                    (body.x[0], rear, high),
                ]
            )
        )
    ]
    return slab(np.add(outline, [0.0, 0.0, thick_m]), thick_m), merge_parts(walls)


def _long_way(body: BoxPart) -> tuple[Interval, Interval, bool]:
    """The body's extents along and across its longer side, and whether x and y are changed."""
    if body.wide_m >= body.deep_m:
        return body.x, body.y, False
    return body.y, body.x, True


def _turned(shape: TriangleShape, is_turned: bool) -> TriangleShape:  # noqa: FBT001 (a fact of the body)
    vertices, triangles = shape
    return (vertices[:, [1, 0, 2]] if is_turned else vertices), triangles


def windows(positions: Floats, size: Interval, face_y: float) -> list[BorderPart]:
    """Windows in a wall towards the street: frames that stand out a little, glass in them.

    Parameters
    ----------
    positions : (n, 2) float64
        x of each one's middle and z of its sill, m.
    size : (float, float)
        Width and height, m.
    face_y : float
        Where the wall is.
    """
    if len(positions) == 0:
        return []
    wide, high = size
    frames, panes = [], []
    for x, z in positions:
        frames.append(
            block(
                (x - wide / 2 - _FRAME_M, x + wide / 2 + _FRAME_M),
                (face_y - _PROUD_M, face_y + 0.01),
                (z - _FRAME_M, z + high + _FRAME_M),
            )
        )
        y = face_y - _PROUD_M - 0.004
        panes.append(
            plate(
                np.array(
                    [
                        (x - wide / 2, y, z),
                        (x + wide / 2, y, z),
                        (x + wide / 2, y, z + high),
                        (x - wide / 2, y, z + high),
                    ]
                )
            )
        )
    return [(merge_parts(frames), Material.PAINTED_METAL), (merge_parts(panes), Material.GLASS)]


def side_windows(positions: Floats, size: Interval, face_x: float) -> list[BorderPart]:
    """Windows in a wall square to the street; ``positions`` are y and z, the wall looks to −x."""
    turned = []
    for (vertices, triangles), material in windows(positions, size, 0.0):
        there = np.column_stack([vertices[:, 1] + face_x, vertices[:, 0], vertices[:, 2]])
        turned.append(((there, triangles), material))
    return turned
