"""SXF: the drawing of electronic delivery, as SFC (for exchange) and as P21 (the formal form)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from datetime import datetime
from itertools import pairwise

from processing.core.errors import Unsuitable
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.formats.accepted_features import accepted_features
from processing.formats.drawings.dxf_labels import LABEL_HEIGHT_M, Label, label_of
from processing.formats.drawings.sxf_drawing import (
    PAPERS_MM,
    Place,
    SxfCircle,
    SxfDrawing,
    SxfLine,
    SxfStyle,
    SxfText,
)
from processing.formats.drawings.sxf_looks import (
    FRAME_LAYER,
    NOTE_LAYER,
    TITLE_LAYER,
    colour_of,
    layer_of,
    line_type_of,
    width_of,
)
from processing.formats.drawings.sxf_p21 import p21_text
from processing.formats.drawings.sxf_sfc import sfc_text
from processing.formats.drawings.symbol_shapes import symbol_rotation_deg, symbol_shapes
from processing.formats.map_delivery import MapDelivery, Position
from processing.formats.shift_jis import ShiftJisText
from processing.map.catalogue import FeatureKind, Geometry
from processing.map.feature import Feature

_SCALES = (500, 1000, 2500, 5000, 10_000, 25_000)
_MARGIN_MM = 20
"""Between frame and edge of the paper (CAD製図基準: 20 mm for A0 and A1)."""

_TITLE_MM = 3.5
_LABEL_MM = LABEL_HEIGHT_M * 1000 / 500
_POINT_MM = 100.0  # on the ground: the ring of a point whose kind has no symbol
_MOST_TEXT_BYTES = 256
_ORIGIN_STEP_M = 50
_BASES = {"MIDDLE_LEFT": 4, "BOTTOM_CENTER": 2, "MIDDLE_CENTER": 5}
_BLACK = 1
_CHECK_EVERY = 64  # features


def write_sxf_map(delivery: MapDelivery, position: Position, monitor: Monitor) -> None:
    """Write a map that is handed in as one sheet, in both forms; plan, without heights.

    Candidates are left out, which is told.

    The smallest paper that holds it at 1:500, else A0 at the largest usual scale.

    Raises
    ------
    Unsuitable
        No usual scale brings the map on a sheet.

    References
    ----------
    SXF level 2, feature and AP202 forms of version 3.0; CAD製図基準 for layers and margins.
    """
    texts = ShiftJisText()
    features = accepted_features(delivery, Text("SXF drawing", "SXF"))
    drawing, origin = _sheet_of(delivery, features, texts)
    for number, feature in enumerate(features):
        if number % _CHECK_EVERY == 0:
            monitor.check()
            monitor.report(number / len(features) / 2)
        kind = delivery.catalogue[feature.kind]
        _draw(drawing, kind, feature, origin)
        label = label_of(kind, feature)
        if label is not None:
            _draw_label(drawing, kind, label, origin, texts)
    sfc = sfc_text(drawing, f"{delivery.name}.sfc")
    monitor.check()
    p21 = p21_text(drawing, f"{delivery.name}.p21")
    monitor.check()
    position(f"{delivery.name}.sfc").write_bytes(sfc.encode("cp932"))
    position(f"{delivery.name}.p21").write_bytes(p21.encode("ascii"))
    for note in texts.notes:
        delivery.tell(note)


def _sheet_of(
    delivery: MapDelivery, features: Sequence[Feature], texts: ShiftJisText
) -> tuple[SxfDrawing, Place]:
    """An empty sheet for a map with its frame and title; the map's origin, m."""
    xy = [vertex.xyz[:2] for feature in features for vertex in feature.vertices]
    xy = xy or [(0.0, 0.0)]
    low = tuple(min(one[axis] for one in xy) for axis in (0, 1))
    size = tuple(max(one[axis] for one in xy) - low[axis] for axis in (0, 1))
    origin = (_down(low[0]), _down(low[1]))
    paper, scale = _paper_for(size)
    now = datetime.now().astimezone()
    width, height = PAPERS_MM[paper][1], PAPERS_MM[paper][0]
    # The map's middle is the paper's.
    left, below = (
        side / 2 - ((low[axis] - origin[axis]) + size[axis] / 2) * 1000 / scale
        for axis, side in ((0, width), (1, height))
    )
    title = texts.fitted(delivery.name, 100)
    drawing = SxfDrawing(
        title, paper, scale, (left, below), (now.year, now.month, now.day),
        now.strftime("%Y-%m-%dT%H:%M:%S"),
    )  # fmt: skip
    high = (width - _MARGIN_MM, height - _MARGIN_MM)
    corners = ((_MARGIN_MM, _MARGIN_MM), (high[0], _MARGIN_MM), high, (_MARGIN_MM, high[1]))
    frame = SxfStyle(FRAME_LAYER, _BLACK, width=8)
    drawing.on_paper.append(SxfLine(frame, (*corners, corners[0])))
    system = delivery.crs or "座標参照系不明"
    words = (
        f"{title}　縮尺 1:{scale}　{system}　"
        f"部分図の原点 X={origin[1]:.3f} Y={origin[0]:.3f}　{now:%Y-%m-%d}"
    )
    place = (float(_MARGIN_MM), high[1] + _TITLE_MM)
    style = SxfStyle(TITLE_LAYER, _BLACK)
    drawing.on_paper.append(SxfText(style, words, place, _TITLE_MM, _width_of(words, _TITLE_MM)))
    return drawing, origin


def _down(metres: float) -> float:
    return float(math.floor(metres / _ORIGIN_STEP_M) * _ORIGIN_STEP_M)


def _paper_for(size_m: tuple[float, ...]) -> tuple[int, int]:
    """Paper and scale for a map of a width and height."""
    for scale in _SCALES:
        papers = range(len(PAPERS_MM) - 1, -1, -1) if scale == _SCALES[0] else (0,)
        for paper in papers:
            room = (side - 2 * _MARGIN_MM for side in reversed(PAPERS_MM[paper]))
            if all(one * 1000 / scale <= most for one, most in zip(size_m, room, strict=True)):
                return paper, scale
    raise Unsuitable(
        Text(
            f"The map does not fit on a sheet A0 at 1:{_SCALES[-1]}.",
            f"図面が縮尺1:{_SCALES[-1]}のA0用紙に収まりません。",
        ),
        Text.same(f"{size_m[0]:.0f} m × {size_m[1]:.0f} m"),
        Text(
            "Look for features far from the others; nothing was written.",
            "離れた位置にある地物を確認してください。何も書き込まれていません。",
        ),
    )


def _draw(drawing: SxfDrawing, kind: FeatureKind, feature: Feature, origin: Place) -> None:
    style = SxfStyle(layer_of(kind), colour_of(kind), line_type_of(kind), width_of(kind))
    places = tuple(_on_ground(vertex.xyz, origin) for vertex in feature.vertices)
    match feature.geometry:
        case Geometry.POINT:
            _draw_symbol(drawing, kind, style, places[0], symbol_rotation_deg(feature))
        case Geometry.LINE:
            _draw_line(drawing, style, places)
        case Geometry.AREA:
            _draw_line(drawing, style, (*places, places[0]))


def _on_ground(xyz: tuple[float, ...], origin: Place) -> Place:
    """In the partial figure: a millionth of a millimetre is the form's resolution."""
    return round((xyz[0] - origin[0]) * 1000, 6), round((xyz[1] - origin[1]) * 1000, 6)


def _draw_line(drawing: SxfDrawing, style: SxfStyle, places: tuple[Place, ...]) -> None:
    kept = [places[0]]
    kept += [end for start, end in pairwise(places) if start != end]
    if len(kept) > 1:  # no line without length
        drawing.on_map.append(SxfLine(style, tuple(kept)))


def _draw_symbol(
    drawing: SxfDrawing, kind: FeatureKind, style: SxfStyle, place: Place, turned_deg: float
) -> None:
    solid = SxfStyle(style.layer, style.colour, width=style.width)
    if not kind.symbol:
        drawing.on_map.append(SxfCircle(solid, place, _POINT_MM))
        return
    cos, sin = math.cos(math.radians(turned_deg)), math.sin(math.radians(turned_deg))

    def at(x: float, y: float) -> Place:
        east, north = x * cos - y * sin, x * sin + y * cos
        return round(place[0] + east * 1000, 6), round(place[1] + north * 1000, 6)

    for shape in symbol_shapes(kind.symbol):
        points = tuple(at(*point) for point in shape.points)
        if shape.radius:
            drawing.on_map.append(SxfCircle(solid, points[0], shape.radius * 1000))
        else:
            _draw_line(drawing, solid, (*points, points[0]) if shape.is_closed else points)


def _draw_label(
    drawing: SxfDrawing, kind: FeatureKind, label: Label, origin: Place, texts: ShiftJisText
) -> None:
    words = texts.fitted(label.words, _MOST_TEXT_BYTES)
    if not words:
        return
    height = _LABEL_MM * drawing.scale
    place = _on_ground(label.position, origin)
    style = SxfStyle(NOTE_LAYER, colour_of(kind))
    drawing.on_map.append(
        SxfText(
            style,
            words,
            place,
            height,
            _width_of(words, height),
            label.rotation_deg,
            _BASES[label.align],
        )
    )


def _width_of(words: str, height: float) -> float:
    """Kanji are as wide as high, narrow letters half as wide."""
    return height / 2 * len(words.encode("cp932"))
