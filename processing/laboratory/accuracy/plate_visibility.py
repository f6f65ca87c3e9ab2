"""Where a sign's plate is in a photograph: its outline laid on the picture's own edges."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from processing.core.arrays import Floats
from processing.recording.camera_images.camera import Camera

SEARCH_PX = 4.0
"""So far from its projection a thing is looked for."""

_STEP_PX = 0.25
_ALONG = 160
_LEAST_EDGE = 12.0
_CLEARER = 1.4  # than the outline laid anywhere near
_EAVES = 0.38  # of a house-shaped plate


@dataclass(frozen=True)
class TruePlate:
    """A plate as the truth of a street has it.

    Attributes
    ----------
    xyz : (3,) float64
        Its centroid, m, project CRS.
    outline : (n, 3) float64
        Its corners, or places on its circle.
    normal : (3,) float64
        Outwards.
    shape : str
    points : int
        Measured on it.
    """

    xyz: Floats
    outline: Floats
    normal: Floats
    shape: str
    points: int


def plate_of(feature: dict[str, Any]) -> TruePlate:  # as GeoJSON has it
    """A plate from a feature of ``signs.geojson``."""
    facts = feature["properties"]
    centroid = np.array(feature["geometry"]["coordinates"], dtype=np.float64)
    middle = np.array(facts.get("bbox_centre", centroid), dtype=np.float64)
    facing = np.radians(facts["facing_deg"])
    right = np.array([np.cos(facing), -np.sin(facing), 0.0])
    wide, high = facts["width_m"] / 2, facts["plate_height_m"] / 2
    flat = _flat_outline(facts["shape"])
    outline = middle + flat[:, :1] * wide * right + flat[:, 1:] * high * np.array([0.0, 0.0, 1.0])
    normal = np.array([np.sin(facing), np.cos(facing), 0.0])
    return TruePlate(centroid, outline, normal, facts["shape"], int(facts["points"]))


def plate_in_picture(picture: Floats, camera: Camera, plate: TruePlate) -> Floats | None:
    """How far a plate lies in the picture from where it is projected: (2,) px; None: not found.

    The projected outline is pushed about until the steps of colour across it are strongest.

    Parameters
    ----------
    picture : (h, w, 3) float64
        0 to 255.
    """
    corners = camera.pixels_of(plate.outline)
    if not np.isfinite(corners).all():
        return None
    steps = np.arange(-SEARCH_PX, SEARCH_PX + _STEP_PX / 2, _STEP_PX)
    moves = np.stack(np.meshgrid(steps, steps), axis=-1).reshape(-1, 2)
    return _best_move(picture, *_along_outline(corners), moves)


def line_in_picture(picture: Floats, ends: Floats) -> float | None:
    """How far a line lies in the picture from where it is projected, across it, px.

    Parameters
    ----------
    picture : (h, w, 3) float64
    ends : (2, 2) or (4, 2) float64
        Columns and rows of its ends; of both, where two lines move together.
    """
    parts = ends.reshape(-1, 2, 2)
    way = parts[0, 1] - parts[0, 0]
    across = np.array([-way[1], way[0]]) / max(float(np.hypot(*way)), 1e-9)
    share = (np.arange(_ALONG // 4) + 0.5) / (_ALONG // 4)
    positions = np.vstack([part[0] + share[:, None] * (part[1] - part[0]) for part in parts])
    steps = np.arange(-SEARCH_PX, SEARCH_PX + _STEP_PX / 2, _STEP_PX)
    moves = steps[:, None] * across
    found = _best_move(picture, positions, np.broadcast_to(across, positions.shape), moves)
    return None if found is None else float(found @ across)


def _best_move(picture: Floats, positions: Floats, across: Floats, moves: Floats) -> Floats | None:
    """The move at which steps of colour across are strongest; None unless it stands out."""
    edges = np.array(
        [
            np.linalg.norm(
                _at(picture, positions + move + across) - _at(picture, positions + move - across),
                axis=1,
            ).mean()
            for move in moves
        ]
    )
    best = int(edges.argmax())
    found: Floats = moves[best]
    is_clear = edges[best] > max(_LEAST_EDGE, _CLEARER * float(np.median(edges)))
    return found if is_clear and np.abs(found).max() < SEARCH_PX - _STEP_PX else None


def _flat_outline(shape: str) -> Floats:
    """(n, 2) right and up, in halves of the bounding box."""
    if shape == "circle":
        turn = np.linspace(0, 2 * np.pi, 48, endpoint=False)
        return np.column_stack([np.cos(turn), np.sin(turn)])
    outlines = {
        "triangle": [(-1, 1), (1, 1), (0, -1)],
        "diamond": [(0, 1), (1, 0), (0, -1), (-1, 0)],
        "pentagon": [(-1, -1), (1, -1), (1, _EAVES), (0, 1), (-1, _EAVES)],
    }
    square = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    return np.array(outlines.get(shape, square), dtype=np.float64)


def _along_outline(
    corners: Floats,
) -> tuple[Floats, Floats]:
    """Places along a ring, and unit vectors across it."""
    ring = np.vstack([corners, corners[:1]])
    lengths = np.hypot(*np.diff(ring, axis=0).T)
    along = np.concatenate([[0.0], np.cumsum(lengths)])
    at = (np.arange(_ALONG) + 0.5) * along[-1] / _ALONG
    positions = np.column_stack([np.interp(at, along, axis) for axis in ring.T])
    piece = np.clip(np.searchsorted(along, at, side="right") - 1, 0, lengths.size - 1)
    way = np.diff(ring, axis=0)[piece] / np.maximum(lengths[piece], 1e-9)[:, None]
    return positions, np.column_stack([-way[:, 1], way[:, 0]])


def _at(picture: Floats, positions: Floats) -> Floats:
    """(n, 3) colours between pixels, whose middles are at whole numbers."""
    height, width = picture.shape[:2]
    x = np.clip(positions[:, 0], 0, width - 1.001)
    y = np.clip(positions[:, 1], 0, height - 1.001)
    c, r = x.astype(np.int64), y.astype(np.int64)
    u, v = (x - c)[:, None], (y - r)[:, None]
    top = picture[r, c] * (1 - u) + picture[r, c + 1] * u
    below = picture[r + 1, c] * (1 - u) + picture[r + 1, c + 1] * u
    return np.asarray(top * (1 - v) + below * v)
