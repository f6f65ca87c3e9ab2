"""What a given surface has to be before it is measured against, and its outline with holes.

A volume needs one height at each place. Walls give none and are left out; triangles that lie over
each other give two, and only a surveyor knows which is meant: they are refused unless they do no
more than meet badly.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from processing.core.errors import Unsuitable
from processing.core.text import Text
from processing.methods.earthwork.geometry.overlay_kernels import overlap_kernel
from processing.methods.earthwork.geometry.plan_buckets import (
    buckets_of_triangles,
    sort_into_buckets,
)
from processing.methods.earthwork.geometry.same_positions import number_positions
from processing.methods.earthwork.geometry.triangle_surface import TriangleSurface

Floats = NDArray[np.float64]
Numbers = NDArray[np.int64]

_SAME_POSITION_M = 1e-6
"""Corners nearer than this are one: finer than any file's digits."""

_BORNE_SHARE = 1e-4
"""Part of the area that may be covered twice: it changes no volume that is told."""

_BORNE_M2 = 0.01
"""The same for small surfaces: a square of 10 cm."""

_LEAST_HOLE_M2 = 0.01
"""Smaller holes are where triangles meet badly; by judgement, they change no stated volume."""

_LEAST_PART_M2 = 1e-6
"""Smaller parts of an outline are what rounding leaves."""

_READ_AGAIN = Text(
    "Write the surface again in the program that it comes from.",
    "作成元のソフトウェアで面データを出力し直してください。",
)


@dataclass(frozen=True)
class CheckedSurface:
    """A surface that can be measured against.

    Attributes
    ----------
    surface : TriangleSurface
        Without what was left out.
    vertical, repeated : int
        Triangles that were left out: without width in plan, and those that are there already.
    covered_twice_m2 : float
        Seen from above; little.
    notes : tuple of Text
        The same in sentences; empty where there is nothing to tell.
    """

    surface: TriangleSurface
    vertical: int
    repeated: int
    covered_twice_m2: float
    notes: tuple[Text, ...]


def check_surface(surface: TriangleSurface) -> CheckedSurface:
    """A surface as a volume needs it.

    Raises
    ------
    Unsuitable
        No triangle, or only vertical ones; a corner that is not there or is no number; triangles
        that lie over each other by more than they meet badly.
    """
    _check_corners(surface)
    is_repeated = _repeated(surface)
    is_vertical = surface.is_vertical & ~is_repeated
    kept = ~is_repeated & ~is_vertical
    if not kept.any():
        raise Unsuitable(
            Text(
                "The surface has no triangle that is seen from above.",
                "面データに平面積をもつ三角形がありません。",
            ),
            _name_of(surface),
            Text("Choose another surface.", "別の面データを指定してください。"),
        )
    left = surface
    if not kept.all():
        left = TriangleSurface(surface.xyz, surface.corners[kept], surface.name)
    twice = _covered_twice(left)
    vertical, repeated = int(is_vertical.sum()), int(is_repeated.sum())
    notes = []
    if vertical:
        notes.append(
            Text(
                f"{vertical} vertical triangles of the surface bear no volume and were left out.",
                f"面データの鉛直な三角形{vertical}個は、体積をもたないため除外しました。",
            )
        )
    if repeated:
        notes.append(
            Text(
                f"{repeated} triangles that the surface has twice were counted once.",
                f"面データに重複する三角形{repeated}個は、1回だけ数えました。",
            )
        )
    if twice >= _BORNE_M2:
        notes.append(
            Text(
                f"Triangles of the surface overlap at their edges by {twice:.2f} m² in all.",
                f"面データの三角形が辺に沿って合計{twice:.2f} m²重なっています。",
            )
        )
    return CheckedSurface(left, vertical, repeated, twice, tuple(notes))


def outline(surface: TriangleSurface) -> shapely.Geometry:
    """The area that a surface covers, seen from above.

    Returns
    -------
    shapely.Polygon or shapely.MultiPolygon
        With holes where triangles are missing; gaps below 0.01 m², where triangles meet badly,
        are closed. m, project CRS.
    """
    triangles = surface.plan_triangles(np.array([*surface.origin[:2], 0.0]))
    plan = triangles[:, :, :2].reshape(-1, 2)
    corner, first = number_positions(plan, _SAME_POSITION_M)
    corner = corner.reshape(-1, 3)
    sides = np.concatenate([corner[:, [0, 1]], corner[:, [1, 2]], corner[:, [2, 0]]])
    sides.sort(axis=1)
    keys, counts = np.unique(sides[:, 0] * len(plan) + sides[:, 1], return_counts=True)
    ends = np.stack(np.divmod(keys[counts % 2 == 1], len(plan)), axis=1)
    # Made one net first: where a long side lies along two short ones, both would enclose nothing.
    lines = shapely.union_all(shapely.linestrings(plan[first[ends]]))
    covered = shapely.build_area(lines)
    whole = []
    for part in shapely.get_parts(covered):
        holes = [ring for ring in part.interiors if shapely.Polygon(ring).area >= _LEAST_HOLE_M2]
        if part.area >= _LEAST_PART_M2:
            whole.append(shapely.Polygon(part.exterior, holes))
    joined = shapely.orient_polygons(whole[0] if len(whole) == 1 else shapely.MultiPolygon(whole))
    return shapely.transform(joined, lambda positions: positions + surface.origin[:2])


def holes_of(surface: TriangleSurface) -> tuple[shapely.Geometry, ...]:
    """What the outline of a surface encloses but no triangle covers, as polygons, largest first."""
    rings = [ring for part in shapely.get_parts(outline(surface)) for ring in part.interiors]
    holes = [shapely.Polygon(ring) for ring in rings]
    return tuple(sorted(holes, key=lambda hole: -float(hole.area)))


def _check_corners(surface: TriangleSurface) -> None:
    if not len(surface.corners):
        raise Unsuitable(
            Text("The surface has no triangle.", "面データに三角形がありません。"),
            _name_of(surface),
            Text("Choose a surface of triangles (TIN).", "TINの面データを指定してください。"),
        )
    is_unknown = ((surface.corners < 0) | (surface.corners >= len(surface.xyz))).any(axis=1)
    if is_unknown.any():
        raise _flawed(
            surface,
            int(is_unknown.argmax()),
            Text("has a corner that is not there", "存在しない頂点を参照しています"),
        )
    is_broken = ~np.isfinite(surface.xyz[surface.corners]).all(axis=(1, 2))
    if is_broken.any():
        raise _flawed(
            surface,
            int(is_broken.argmax()),
            Text("has a corner whose position is no number", "頂点の座標が数値ではありません"),
        )


def _flawed(surface: TriangleSurface, triangle: int, has: Text) -> Unsuitable:
    return Unsuitable(
        Text(
            "Triangle {number} of the surface {has}.", "面データの{number}番目の三角形は{has}。"
        ).filled(number=triangle + 1, has=has),
        _name_of(surface),
        _READ_AGAIN,
    )


def _name_of(surface: TriangleSurface) -> Text:
    return Text("Surface {name}", "面データ {name}").filled(name=surface.name or "–")


def _repeated(surface: TriangleSurface) -> NDArray[np.bool_]:
    """Triangles whose three corners are those of an earlier one: (t,) bool."""
    positions = surface.xyz[surface.corners.ravel()] - surface.origin
    number, _ = number_positions(positions, _SAME_POSITION_M)
    corners = np.sort(number.reshape(-1, 3), axis=1)
    order = np.lexsort(corners.T)
    is_repeated = np.zeros(len(corners), bool)
    is_repeated[order[1:]] = np.all(np.diff(corners[order], axis=0) == 0, axis=1)
    return is_repeated


def _covered_twice(surface: TriangleSurface) -> float:
    """Area that more than one triangle covers, m²."""
    triangles = surface.plan_triangles(surface.origin)
    buckets = sort_into_buckets(triangles)
    found = np.zeros(4)
    held = (buckets.starts, buckets.triangles)
    overlap_kernel(triangles, held, buckets_of_triangles(buckets), found)
    area, _, east, north = found.tolist()
    if area <= max(_BORNE_SHARE * surface.plan_area_m2(), _BORNE_M2):
        return area
    easting, northing = surface.origin[0] + east, surface.origin[1] + north
    raise Unsuitable(
        Text(
            f"Triangles of the surface lie over each other on {area:.2f} m².",
            f"面データの三角形が{area:.2f} m²にわたって重なっています。",
        ),
        Text(
            "{name}, most at easting {easting:.2f}, northing {northing:.2f}",
            "{name}、最大の箇所は東{easting:.2f} 北{northing:.2f}",
        ).filled(name=_name_of(surface), easting=easting, northing=northing),
        Text(
            "Give a surface with one height at each place, without its lower or inner faces.",
            "各地点の高さが1つに決まる面データ（底面や内側の面を除いたもの）を指定してください。",
        ),
    )


def warm_up() -> None:
    """Compile the kernels."""
    corners = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    check_surface(TriangleSurface(corners, np.array([[0, 1, 2]])))
