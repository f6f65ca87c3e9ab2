"""What a feature's geometry tells: length, area, height difference, number of vertices."""

from __future__ import annotations

import numpy as np

from processing.project.catalogue import Geometry
from processing.project.feature import Feature
from processing.text import Text
from widgets.parts.number_field import coordinate

_LENGTH = Text("Length", "延長")
_PERIMETER = Text("Perimeter", "周長")
_AREA = Text("Area in plan", "水平面積")
_RISE = Text("Height difference", "比高")
_VERTICES = Text("Vertices", "頂点数")
_AXES = (Text.same("E"), Text.same("N"), Text.same("H"))


def facts_of(feature: Feature) -> tuple[tuple[Text, str], ...]:
    """Names and values with units, in the order in which they are shown.

    Lengths are measured in space, areas in plan (the shoelace formula about the first vertex, so
    that large coordinates don't cost digits).
    """
    xyz = np.array([vertex.xyz for vertex in feature.vertices], dtype=np.float64).reshape(-1, 3)
    if feature.geometry is Geometry.POINT:
        values = xyz[0].tolist() if len(xyz) else []
        return tuple(
            (axis, f"{coordinate(value)} m") for axis, value in zip(_AXES, values, strict=False)
        )
    is_area = feature.geometry is Geometry.AREA
    ring = np.vstack([xyz, xyz[:1]]) if is_area else xyz
    length_m = float(np.linalg.norm(np.diff(ring, axis=0), axis=1).sum())
    facts = [(_PERIMETER if is_area else _LENGTH, f"{length_m:,.3f} m")]
    if is_area:
        facts.append((_AREA, f"{_area_m2(xyz):,.3f} m²"))
    rise_m = float(np.ptp(xyz[:, 2])) if len(xyz) else 0.0
    facts.append((_RISE, f"{rise_m:,.3f} m"))
    facts.append((_VERTICES, f"{len(xyz):,}"))
    return tuple(facts)


def _area_m2(xyz: np.ndarray[tuple[int, int], np.dtype[np.float64]]) -> float:
    if len(xyz) < 3:
        return 0.0
    x, y = (xyz[:, :2] - xyz[0, :2]).T
    return float(abs(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)) / 2)
