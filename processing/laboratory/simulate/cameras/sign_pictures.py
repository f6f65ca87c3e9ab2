"""What is painted on plates: plain pictures by the plate's shape, as roads in Japan have them.

Colours and layouts follow 道路標識、区画線及び道路標示に関する命令 (1960), without letters.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats, Integers, Mesh

LinearColours = NDArray[np.float32]

_WHITE, _BLACK = (236, 236, 232), (34, 34, 36)
_RED, _BLUE = (192, 32, 40), (24, 70, 160)
_YELLOW, _GREEN = (244, 190, 24), (16, 110, 78)
_PLATE_LABEL = 64


@dataclass(frozen=True)
class _Face:
    """A plate seen from its front.

    Attributes
    ----------
    middle : (3,) float64
        Of its outline.
    across, upward : (3,) float64
    half : (float, float)
        Half its width and height, m.
    """

    middle: Floats
    across: Floats
    upward: Floats
    half: tuple[float, float]
    shape: str


def paint_signs(mesh: Mesh, triangles: Integers, positions: Floats, colours: LinearColours) -> None:
    """Paint the pixels that show faces of signs.

    Parameters
    ----------
    mesh : Mesh
    triangles : (n,) int64
        Rows of the mesh that pixels show.
    positions : (n, 3) float64
        Where, in the frame of the mesh.
    colours : (n, 3) float32
        0–255; changed in place.
    """
    is_face = mesh.material[triangles] == Material.SIGN_FACE
    rows = np.flatnonzero(is_face)
    if rows.size == 0:
        return
    own = mesh.instance[triangles[rows]]
    is_vehicle = mesh.label[triangles[rows]] == _PLATE_LABEL
    colours[rows[is_vehicle]] = _WHITE
    faces = np.flatnonzero(mesh.material == Material.SIGN_FACE)
    for instance in np.unique(own[~is_vehicle]).tolist():
        seen = rows[own == instance]
        face = _face_of(mesh, faces[mesh.instance[faces] == instance])
        away = positions[seen] - face.middle
        u, v = away @ face.across / face.half[0], away @ face.upward / face.half[1]
        colours[seen] = _picture(face, np.asarray(u), np.asarray(v), instance)


def _face_of(mesh: Mesh, rows: Integers) -> _Face:
    """Middle, axes and shape of a plate, from the area of its triangles."""
    corners = mesh.vertices[mesh.triangles[rows]]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal = normals[np.argmax(np.linalg.norm(normals, axis=1))]
    across = np.array([-normal[1], normal[0], 0.0])
    if np.linalg.norm(across) < 1e-9 * np.linalg.norm(normal):
        across = np.array([1.0, 0.0, 0.0])
    across /= np.linalg.norm(across)
    upward = np.cross(normal / np.linalg.norm(normal), across)
    upward *= 1.0 if upward[2] >= 0 else -1.0
    u, v = corners @ across, corners @ upward
    low, high = (u.min(), v.min()), (u.max(), v.max())
    half = max((high[0] - low[0]) / 2, 1e-3), max((high[1] - low[1]) / 2, 1e-3)
    centre = np.array([(high[0] + low[0]) / 2, (high[1] + low[1]) / 2])
    depth = normal / np.linalg.norm(normal)
    middle = across * centre[0] + upward * centre[1] + depth * float((corners @ depth).mean())
    areas = np.linalg.norm(normals, axis=1) / 2
    share = float(areas.sum()) / (4 * half[0] * half[1])
    above = float((areas * (v.mean(axis=1) - centre[1])).sum() / areas.sum()) / half[1]
    return _Face(middle, across, upward, half, _shape_of(half, share, above))


def _shape_of(half: tuple[float, float], share: float, above: float) -> str:
    """The shape of a plate by the share of its box that it fills, and where its weight lies."""
    if share < 0.66:
        return "triangle" if abs(above) > 0.15 else "diamond"
    if share < 0.9:
        return "pentagon" if above < -0.06 else "circle"
    return "square" if 0.75 < half[0] / half[1] < 1.33 else "rectangle"


def _picture(face: _Face, u: Floats, v: Floats, instance: int) -> NDArray[np.uint8]:
    """Colours of places on a plate; u to the right and v up, −1 to 1."""
    variant = (instance * 2654435761 >> 8) % 4
    painters = {
        "circle": _circle,
        "triangle": _triangle,
        "diamond": _diamond,
        "pentagon": _pentagon,
        "square": _square,
        "rectangle": _rectangle,
    }
    out = np.empty((u.size, 3), np.uint8)
    painters[face.shape](u, v, variant, out)
    return out


def _circle(u: Floats, v: Floats, variant: int, out: NDArray[np.uint8]) -> None:
    """A speed limit, no parking, a way to go, or no entry."""
    r = np.hypot(u, v)
    if variant == 0:
        out[:] = _WHITE
        digits = (np.abs(v) < 0.38) & (np.abs(np.abs(u) - 0.28) < 0.2)
        out[digits & ~((np.abs(np.abs(u) - 0.28) < 0.08) & (np.abs(v) < 0.24))] = _BLUE
        out[(r > 0.76) & (r < 0.96)] = _RED
    elif variant == 1:
        out[:] = _BLUE
        out[(r > 0.74) | (np.abs(u + v) < 0.18)] = _RED
    elif variant == 2:
        out[:] = _BLUE
        out[(np.abs(u) < 0.13) & (v > -0.6) & (v < 0.35)] = _WHITE
        out[(v > 0.2) & (v < 0.65) & (np.abs(u) < (0.65 - v) * 0.9)] = _WHITE
    else:
        out[:] = _RED
        out[(np.abs(v) < 0.17) & (np.abs(u) < 0.7)] = _WHITE
    out[r > 0.965] = _WHITE


def _triangle(u: Floats, v: Floats, variant: int, out: NDArray[np.uint8]) -> None:
    """Stop, or slow down: point downwards."""
    out[:] = _WHITE if variant == 3 else _RED
    inner = (v < 0.9) & (np.abs(u) * 2 < v + 0.86)
    out[~inner] = _WHITE if variant != 3 else _RED
    letters = (np.abs(v - 0.42) < 0.17) & (np.abs(u) < 0.5) & (np.abs(np.sin(u * 9)) > 0.3)
    out[letters] = _BLUE if variant == 3 else _WHITE


def _diamond(u: Floats, v: Floats, variant: int, out: NDArray[np.uint8]) -> None:
    """A warning."""
    r = np.abs(u) + np.abs(v)
    out[:] = _YELLOW
    out[(r > 0.84) & (r < 0.92)] = _BLACK
    if variant < 2:
        out[(np.abs(u - 0.12 * np.sin(v * 5)) < 0.07) & (np.abs(v) < 0.42)] = _BLACK
    else:
        out[(np.abs(u) < 0.07) & (np.abs(v) < 0.4)] = _BLACK
        out[(np.abs(v - 0.05) < 0.06) & (np.abs(u) < 0.32)] = _BLACK


def _pentagon(u: Floats, v: Floats, variant: int, out: NDArray[np.uint8]) -> None:
    """A crossing, or a school's way."""
    out[:] = _BLUE if variant < 3 else _YELLOW
    inner = (np.abs(u) < 0.6) & (v > -0.7) & (v < 0.6 - np.abs(u))
    out[inner] = _WHITE
    figure = (np.abs(u) < 0.09) & (np.abs(v + 0.05) < 0.4)
    out[figure | (inner & (v < -0.45) & (np.abs(np.sin(u * 12)) > 0.7))] = _BLACK


def _square(u: Floats, v: Floats, variant: int, out: NDArray[np.uint8]) -> None:
    """What is allowed here, or what a place is."""
    out[:] = _GREEN if variant == 3 else _BLUE
    out[np.maximum(np.abs(u), np.abs(v)) > 0.93] = _WHITE
    if variant == 0:
        out[(np.abs(u + 0.2) < 0.11) & (np.abs(v) < 0.6)] = _WHITE
        ring = np.hypot(u, v - 0.25)
        out[(ring < 0.38) & (ring > 0.17) & (u > -0.2)] = _WHITE
    else:
        out[(v < 0.55) & (v > -0.55) & (np.abs(u) < (0.6 - v) * 0.4)] = _WHITE


def _rectangle(u: Floats, v: Floats, variant: int, out: NDArray[np.uint8]) -> None:
    """A guide, or what a plate below another one says."""
    if variant < 2:
        out[:] = _BLUE if variant else _GREEN
        lines = _WHITE
    else:
        out[:] = _WHITE
        lines = _BLACK
    written = (np.abs(np.abs(v) - 0.42) < 0.2) & (np.abs(u) < 0.8)
    out[written & (np.sin(u * 23 + np.sign(v) * 2) * np.sin(u * 7.3 + 1) > -0.15)] = lines
    out[np.maximum(np.abs(u), np.abs(v)) > 0.95] = lines
