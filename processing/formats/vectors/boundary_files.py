"""Boundaries that a volume is computed within, from what offices draw them with."""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from processing.core.arrays import Floats
from processing.core.errors import (
    BadFile,
    OutOfRange,
    Unsuitable,
    UserError,
    report_as_user_error,
    use_one_of,
)
from processing.core.japanese_text import read_text
from processing.core.text import Text
from processing.formats.drawings.drawn_outlines import outlines_of_dxf
from processing.formats.format import Content, function_of
from processing.formats.registry import FORMATS
from processing.formats.vectors.geojson_shapes import WHERE, read_collection, shapes_of, system_of
from processing.map.catalogue import Geometry

_LEAST_AREA_M2 = 1e-4
_POSITION = re.compile(r"\[(\S+) (\S+)\]")
_LAYERED = "|".join(
    re.escape(ending) for one in FORMATS.read(Content.AREAS) if one.layers for ending in one.endings
)
_WITH_LAYER = re.compile(rf"(.+(?:{_LAYERED}))#(.+)", re.IGNORECASE | re.DOTALL)
_AGAIN = Text(
    "Draw the boundary as a closed polygon and save it as GeoJSON, GeoPackage or DXF.",
    "境界を閉じたポリゴンで作図し、GeoJSON・GeoPackage・DXFで保存してください。",
)


@dataclass(frozen=True)
class Boundary:
    """An area on the ground, which may have several parts and holes.

    Attributes
    ----------
    rings : tuple of (n, 2) float64
        Easting and northing, m; the first place is not repeated. Rings don't cross each other: a
        place lies inside where an odd number of them goes round it. Outlines run anticlockwise,
        holes clockwise.
    crs : str
        ``EPSG:n`` as the file names it; empty where it doesn't.
    polygons : int
        How many the file has; the area is all of theirs.
    """

    rings: tuple[Floats, ...]
    crs: str
    polygons: int


def file_and_layer(words: str) -> tuple[Path, str]:
    """A boundary's file and its layer: ``FILE``, or ``FILE#LAYER`` of a drawing or GeoPackage."""
    named = _WITH_LAYER.fullmatch(words)
    if named is None or Path(words).exists():
        return Path(words), ""
    return Path(named[1]), named[2]


def boundary_layers(path: Path) -> tuple[str, ...]:
    """The layers of a drawing or GeoPackage that have polygons; none of GeoJSON, which has none.

    Raises
    ------
    BadFile, OutOfRange, MissingInput, NoSpace
        As :func:`read_boundary`.
    """
    layers = FORMATS.format_to_read(path, Content.AREAS).layers
    found: tuple[str, ...] = function_of(layers)(path) if layers else ()
    return found


def layers_of_geopackage(path: Path) -> tuple[str, ...]:
    """Give the layers of a GeoPackage that have polygons."""
    return tuple(_layers_of_geopackage(path)[0])


def layers_of_dxf(path: Path) -> tuple[str, ...]:
    """Give the layers of a drawing that have closed outlines."""
    return tuple(outlines_of_dxf(path).by_layer)


def read_boundary(path: Path, *, crs: str = "", layer: str = "") -> Boundary:
    """The area that the polygons of a file cover together.

    Parameters
    ----------
    path : Path
        ``.geojson`` (``.json``), ``.gpkg`` or ``.dxf``, by the ending. In a drawing closed
        polylines are polygons, and one within another is a hole, as hatches take it; points,
        lines and open polylines beside them are passed over.
    crs : str
        ``EPSG:n`` that the boundary must be in, where both are known; empty for any.
    layer : str
        Of a drawing or GeoPackage that has polygons on several.

    Raises
    ------
    BadFile
        It is damaged, or not what its ending says.
    OutOfRange
        The ending says another format, or there is no such layer.
    Unsuitable
        It has no polygon, has some on several layers, is in another reference system, or an
        outline crosses itself or holds no area.
    MissingInput, NoSpace
        It can't be read.
    """
    read = FORMATS.format_to_read(path, Content.AREAS).reader(Content.AREAS)
    polygons, own = read(path, layer)
    if not polygons:
        raise Unsuitable(
            Text("The file has no closed polygon.", "閉じたポリゴンがありません。"),
            Text.same(str(path)),
            _AGAIN,
        )
    if own and crs and not _is_same_system(own, crs):
        raise _other_system(path, own, crs)
    for number, polygon in enumerate(polygons, 1):
        _require_simple(polygon, path, number)
    return Boundary(_rings_of(polygons), own, len(polygons))


# Any: polygons of shapely, which is imported where it is used.
def areas_of_geojson(path: Path, _layer: str) -> tuple[list[Any], str]:
    """Give the polygons of a GeoJSON, which has no layers, and its system."""
    import shapely

    text = read_text(path)
    try:
        whole, members = read_collection(text)
        shapes = [
            shape
            for number, member in enumerate(members, 1)
            for shape in shapes_of(member.get("geometry"), number)
        ]
        own = system_of(whole, shapes)
    except BadFile as error:
        # The reader speaks of a clipboard and a map to paste into.
        position = Text(
            error.where.en.removeprefix(WHERE.en), error.where.ja.removeprefix(WHERE.ja)
        )
        raise BadFile(
            error.what, Text(f"{path}{position.en}", f"{path}{position.ja}"), _AGAIN
        ) from error
    rings: list[list[Floats]] = []
    for shape in shapes:
        ring = np.array(shape.positions, dtype=np.float64)[:, :2]
        if shape.is_hole:  # it follows its outline
            rings[-1].append(ring)
        elif shape.geometry is Geometry.AREA:
            rings.append([ring])
    return [shapely.Polygon(outline, holes) for outline, *holes in rings], own


def areas_of_geopackage(path: Path, layer: str) -> tuple[list[Any], str]:
    """Give the polygons of a layer of a GeoPackage, and its system."""
    found, systems = _layers_of_geopackage(path)
    chosen = _chosen_layer(path, found, layer)
    return found.get(chosen, []), systems.get(chosen, "")


def _layers_of_geopackage(path: Path) -> tuple[dict[str, list[Any]], dict[str, str]]:
    """Polygons, and the reference system, of each layer that has polygons."""
    import pyogrio
    import pyogrio.raw
    import shapely
    from pyogrio.errors import DataLayerError, DataSourceError

    with report_as_user_error(path), path.open("rb"):
        # The library's own words for a missing file, or a name that is no text, help nobody.
        str(path).encode()
    found: dict[str, list[Any]] = {}
    systems: dict[str, str] = {}
    try:
        with warnings.catch_warnings():
            # Of GDAL, about what other programs left out of the file: what counts is what it reads.
            warnings.simplefilter("ignore", RuntimeWarning)
            for name, shape_type in pyogrio.list_layers(path):
                if shape_type is None:  # a table, such as that of styles
                    continue
                facts, _, shapes, _ = pyogrio.raw.read(path, layer=name, columns=[])
                parts = shapely.get_parts(shapely.force_2d(shapely.from_wkb(shapes)))
                areas = [part for part in _flatten_parts(parts) if not part.is_empty]
                if areas:
                    found[name], systems[name] = areas, facts["crs"] or ""
    except (DataLayerError, DataSourceError, shapely.errors.GEOSException) as error:
        raise BadFile(
            Text(
                "The file is no GeoPackage, or is damaged.", "GeoPackageではないか、壊れています。"
            ),
            Text.same(str(path)),
            _AGAIN,
        ) from error
    return found, systems


def _flatten_parts(parts: Iterable[Any]) -> Iterable[Any]:
    import shapely

    for part in parts:
        if part.geom_type == "Polygon":
            yield part
        elif part.geom_type in ("MultiPolygon", "GeometryCollection"):
            yield from _flatten_parts(shapely.get_parts(part))


def areas_of_dxf(path: Path, layer: str) -> tuple[list[Any], str]:
    """Give the polygons of a layer of a drawing, and its system."""
    import shapely

    drawing = outlines_of_dxf(path)
    outlines = drawing.by_layer.get(_chosen_layer(path, drawing.by_layer, layer), [])
    drawn = [shapely.Polygon(outline) for outline in outlines]
    for number, polygon in enumerate(drawn, 1):
        _require_simple(polygon, path, number)
    distinct: list[Any] = []
    for polygon in sorted(drawn, key=lambda one: -float(one.area)):
        if not any(polygon.equals(other) for other in distinct):
            distinct.append(polygon)
    return _nest_outlines(distinct), drawing.crs


def _nest_outlines(outlines: list[Any]) -> list[Any]:
    """Outlines, the largest first, as polygons: what lies within an outline is its hole."""
    import shapely

    depths = [
        sum(shapely.contains_properly(outer, inner) for outer in outlines[:number])
        for number, inner in enumerate(outlines)
    ]
    polygons = []
    for outline, depth in zip(outlines, depths, strict=True):
        holes = [
            inner.exterior
            for inner, deeper in zip(outlines, depths, strict=True)
            if deeper == depth + 1 and shapely.contains_properly(outline, inner)
        ]
        if depth % 2 == 0:
            polygons.append(shapely.Polygon(outline.exterior, holes))
    return polygons


def _chosen_layer(path: Path, found: Mapping[str, list[Any]], layer: str) -> str:
    if layer and layer not in found:
        raise OutOfRange(
            Text(
                "No layer of this name has a polygon.", "この名前のレイヤにポリゴンがありません。"
            ),
            Text.same(f"{path}, {layer}"),
            use_one_of(found),
        )
    if len(found) > 1 and not layer:
        raise Unsuitable(
            Text(
                "The file has polygons on several layers: {names}.",
                "複数のレイヤにポリゴンがあります（{names}）。",
            ).filled(names=", ".join(found)),
            Text.same(str(path)),
            Text(
                "Write the name of the boundary's layer behind the file: {example}.",
                "境界のレイヤ名をファイル名の後に書いてください（例：{example}）。",
            ).filled(example=f"{path.name}#{next(iter(found))}"),
        )
    return layer or next(iter(found), "")


def _require_simple(polygon: Any, path: Path, number: int) -> None:
    import shapely

    reason = str(shapely.is_valid_reason(polygon))
    at = _POSITION.search(reason)
    where = Text(f"{path}, polygon {number}", f"{path}、{number}番目のポリゴン")
    if at is not None:
        position = f"E {float(at[1]):.3f}, N {float(at[2]):.3f}"
        where = Text(f"{where.en}, {position}", f"{where.ja}、{position}")
    if not bool(np.isfinite(shapely.get_coordinates(polygon)).all()):
        what = Text("A corner is no place.", "座標として使えない頂点があります。")
    elif not float(polygon.convex_hull.area) > _LEAST_AREA_M2:
        what = Text("The boundary holds no area.", "境界に面積がありません。")
    elif polygon.is_valid:
        return
    elif "elf-intersection" in reason:
        what = Text(
            "The boundary crosses or touches itself.",
            "境界線が自分自身と交差または接触しています。",
        )
    else:
        what = Text(
            "Holes of the boundary lie outside it or over each other.",
            "境界の穴が境界の外にあるか、互いに重なっています。",
        )
    raise Unsuitable(what, where, _AGAIN)


def _rings_of(polygons: list[Any]) -> tuple[Floats, ...]:
    import shapely

    union = shapely.orient_polygons(shapely.union_all(polygons))
    return tuple(
        shapely.get_coordinates(ring)[:-1]
        for part in shapely.get_parts(union)
        for ring in (part.exterior, *part.interiors)
    )


def _is_same_system(one: str, other: str) -> bool:
    from pyproj import CRS
    from pyproj.exceptions import CRSError

    if one == other:
        return True
    try:
        plans = [CRS.from_user_input(name).to_2d() for name in (one, other)]
    except CRSError:
        return False
    first, second = (plan.sub_crs_list[0] if plan.is_compound else plan for plan in plans)
    return bool(first.equals(second, ignore_axis_order=True))


def _other_system(path: Path, own: str, crs: str) -> UserError:
    from pyproj import CRS
    from pyproj.exceptions import CRSError

    try:
        name = CRS.from_user_input(own).name
    except CRSError:
        name = own
    return Unsuitable(
        Text(
            "The boundary is in another reference system ({own}) than {crs}.",
            "境界の座標参照系（{own}）が {crs} と異なります。",
        ).filled(own=name, crs=crs),
        Text.same(str(path)),
        Text("Save the boundary in {crs}.", "境界を {crs} に変換して保存してください。").filled(
            crs=crs
        ),
    )
