"""Bodies of lids and gratings as 3D faces, which every CAD program has read since R12."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from processing.map.solids import FaceIndices, Solid

BODY_SUFFIX = "_立体"
"""Behind the layer of the outlines: who wants a plan switches this layer off."""


def add_body(
    space: Any,  # an ezdxf layout; ezdxf is not typed here
    solid: Solid,
    attributes: Mapping[str, Any],
) -> list[Any]:
    """Draw top and sides of a body; the bottom, which nobody sees, is left out.

    Edges between the triangles of one top are invisible.

    Parameters
    ----------
    attributes : mapping
        What all faces have in common: layer, colour.

    References
    ----------
    Autodesk, DXF reference, 3DFACE: group 70, bits 1 to 8 are invisible edges.
    """
    count = len(solid.positions) // 2
    faces = []
    for face in (*solid.top, *solid.sides):
        # A face of three corners has the third twice.
        positions = [tuple(solid.positions[at].tolist()) for at in (*face, face[-1])[:4]]
        drawn = space.add_3dface(positions, dxfattribs=dict(attributes))
        drawn.dxf.invisible_edges = _invisible(face, count)
        faces.append(drawn)
    return faces


def _invisible(face: FaceIndices, count: int) -> int:
    """The edges of a face that are none of the body, as bits."""
    hidden = 0
    if len(face) == 3:
        for number, (start, end) in enumerate(zip(face, face[1:] + face[:1], strict=True)):
            if (end - start) % count != 1:
                # The third edge is between the doubled corner and the first: the fourth bit.
                hidden |= 8 if number == 2 else 1 << number
    return hidden
