"""What a feature is in the extended DM: which elements, on which sheets."""

from __future__ import annotations

import math
import unicodedata
from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise

from processing.formats.drawings.dxf_labels import LABEL_HEIGHT_M, label_of
from processing.formats.shift_jis import ShiftJisText
from processing.formats.survey.dm_records import LEVEL, MOST_PLACES, NO_DATE, DmElement, DmNote
from processing.formats.survey.line_arcs import line_parts
from processing.formats.survey.map_sheets import SHEET_X_MM, SHEET_Y_MM, MapSheet, sheet_at
from processing.formats.survey.sheet_cuts import PlaceMm, cut_area, cut_line
from processing.map.catalogue import FeatureKind, Geometry
from processing.map.feature import Feature, Position

SheetElement = tuple[MapSheet, DmElement]

_FIGURES = {
    "slope_top": 11,
    "slope_foot": 12,
    "bridge_rail": 21,
    "bridge_pier": 22,
    "bridge_post": 23,
    "guard_rail": 26,
    "guard_pipe": 27,
}
"""Figure type (図形区分) by kind, where several kinds share a code."""

_FACING_CODES = frozenset({"2241", "2242", "2243", "2244", "2246", "2247"})
"""Boards, signs and signals: their post's foot and where they face (E6)."""

_WIRED_CODES = frozenset({"4119", "4132", "4142"})
"""Poles: E6 with the directions of their wires, E5 without."""

_ROUND_CODES = frozenset({"4101", "4111", "4121", "4131", "4141", "4151", "4161"})
"""Manholes: a circle (E3) where their diameter is known, E5 where not."""

_STRUCTURE_CODES = frozenset({"2203", "2211"})
"""Bridges: their heights are not those of the ground."""

_HEIGHT_CODES = frozenset({"7101", "7102", "7103", "7105", "7106", "7311", "7312"})
"""Contours and spot heights: their element says the height as a number too."""

_CONTROL_POINT_CODES = frozenset({"7304", "7306"})
_NOTE_LAYER = "81"
_HEIGHT_NOTE, _ROUTE_NOTE, _NOTE = "8173", "8121", "8181"
_CENTRE_LINE = "2505"

_ARM_MM = 3000
"""From a post's foot to the place that says its direction: one of the fixed lengths in files."""

_LABEL_MM = LABEL_HEIGHT_M * 1000 / LEVEL


def elements_of(
    zone: int, kind: FeatureKind, feature: Feature, texts: ShiftJisText
) -> Iterator[SheetElement]:
    """The elements of a feature of a kind that has a code, cut at the edges of sheets.

    Raises
    ------
    OutOfRange
        No sheet of the zone has it.
    """
    places = _places(feature)
    surveyed = _surveyed(feature)
    if not kind.dm_code.startswith(_NOTE_LAYER):
        for sheet, element in _drawn(zone, kind, feature, places):
            yield (
                sheet,
                replace(
                    element,
                    figure=_FIGURES.get(kind.id, 0),
                    on_structure=kind.dm_code in _STRUCTURE_CODES,
                    value=_value(kind, feature, places),
                    surveyed=surveyed,
                ),
            )
    note = _note(zone, kind, feature, texts)
    if note is not None:
        sheet, element = note
        yield sheet, replace(element, surveyed=surveyed)


def _places(feature: Feature) -> tuple[PlaceMm, ...]:
    return tuple(_place(vertex.xyz) for vertex in feature.vertices)


def _place(position: Position) -> PlaceMm:
    easting, northing, height = position
    return round(northing * 1000), round(easting * 1000), round(height * 1000)


def _drawn(
    zone: int, kind: FeatureKind, feature: Feature, places: tuple[PlaceMm, ...]
) -> Iterator[SheetElement]:
    match feature.geometry:
        case Geometry.POINT:
            sheet = sheet_at(zone, *places[0][:2])
            yield sheet, _point(sheet, kind, feature, places[0])
        case Geometry.LINE:
            for sheet, part in cut_line(zone, places):
                if kind.dm_code == _CENTRE_LINE:
                    yield from _straights_and_arcs(sheet, kind.dm_code, part)
                    continue
                for start in range(0, len(part) - 1, MOST_PLACES - 1):
                    piece = part[start : start + MOST_PLACES]
                    yield sheet, DmElement("E2", kind.dm_code, piece, has_heights=True)
        case Geometry.AREA:
            for sheet, part in cut_area(zone, _without_repeats(places)):
                ring = (*part, part[0])
                yield sheet, DmElement("E1", kind.dm_code, ring, has_heights=True)


def _straights_and_arcs(
    sheet: MapSheet, code: str, part: tuple[PlaceMm, ...]
) -> Iterator[SheetElement]:
    """A centre line as it is staked out: straight (E2) and on arcs (E4), from start to end."""
    for is_arc, places in line_parts(part):
        if is_arc and all(_is_on(sheet, place) for place in places):
            yield sheet, DmElement("E4", code, places, has_heights=True)
            continue
        for start in range(0, len(places) - 1, MOST_PLACES - 1):
            piece = places[start : start + MOST_PLACES]
            yield sheet, DmElement("E2", code, piece, has_heights=True)


def _without_repeats(places: tuple[PlaceMm, ...]) -> tuple[PlaceMm, ...]:
    kept = [end for start, end in pairwise((places[-1], *places)) if start != end]
    return tuple(kept) if len(kept) > 2 else places


def _point(sheet: MapSheet, kind: FeatureKind, feature: Feature, foot: PlaceMm) -> DmElement:
    code = kind.dm_code
    if code in _FACING_CODES or code in _WIRED_CODES:
        arms = [_arm(sheet, foot, one) for one in _directions(kind, feature)]
        pairs = tuple(place for end in arms if end is not None for place in (foot, end))
        if pairs:
            return DmElement("E6", code, pairs)
    radius = _number(feature, "diameter_m") * 500
    if code in _ROUND_CODES and radius >= 1:
        around = _on_circle(foot, radius)
        if all(_is_on(sheet, place) for place in around):
            return DmElement("E3", code, around, has_heights=True)
    return DmElement("E5", code, (foot,))


def _directions(kind: FeatureKind, feature: Feature) -> list[float]:
    """Clockwise from north, degrees."""
    if kind.dm_code in _WIRED_CODES:
        words = str(feature.attributes.get("wires_deg") or "").split("/")
        return [float(one) for one in words if _is_number(one)]
    values = (feature.attributes.get(name) for name in ("facing_deg", "direction_deg"))
    found = (float(one) for one in values if isinstance(one, (int, float)) and math.isfinite(one))
    return list(found)[:1]


def _arm(sheet: MapSheet, foot: PlaceMm, direction_deg: float) -> PlaceMm | None:
    """The place in a direction; nearer to the foot where the sheet ends before it."""
    ahead = math.radians(direction_deg)
    for share in range(10, 0, -1):
        length = _ARM_MM * share / 10
        x, y = round(length * math.cos(ahead)), round(length * math.sin(ahead))
        end = (foot[0] + x, foot[1] + y, foot[2])
        if _is_on(sheet, end):
            return end
    return None


def _on_circle(centre: PlaceMm, radius: float) -> tuple[PlaceMm, ...]:
    x, y, z = centre
    size = round(radius)
    return (x, y + size, z), (x + size, y, z), (x, y - size, z)


def _is_on(sheet: MapSheet, place: PlaceMm) -> bool:
    south, west = sheet.south_west_mm
    return 0 <= place[0] - south <= SHEET_X_MM and 0 <= place[1] - west <= SHEET_Y_MM


def _value(kind: FeatureKind, feature: Feature, places: tuple[PlaceMm, ...]) -> int:
    if kind.dm_code in _HEIGHT_CODES:
        return places[0][2]
    number = str(feature.attributes.get("number") or "")
    is_number = kind.dm_code in _CONTROL_POINT_CODES and number.isascii() and number.isdigit()
    return int(number) if is_number and len(number) < 8 else 0


def _note(
    zone: int, kind: FeatureKind, feature: Feature, texts: ShiftJisText
) -> SheetElement | None:
    """The words that the drawing writes beside a feature, or that a note is."""
    label = label_of(kind, feature)
    words = "" if label is None else _of_one_width(texts.fitted(label.words))
    if label is None or not words:
        return None
    size_m = LABEL_HEIGHT_M
    width_m = size_m * sum(1.0 if _is_wide(one) else 0.5 for one in words)
    left = 0.0 if label.align.endswith("LEFT") else width_m / 2
    below = size_m / 2 if label.align.startswith("MIDDLE") else 0.0
    turn = math.radians(label.rotation_deg)
    x, y, z = label.position
    x -= left * math.cos(turn) - below * math.sin(turn)
    y -= left * math.sin(turn) + below * math.cos(turn)
    sheet = sheet_at(zone, *_place(feature.vertices[0].xyz)[:2])
    corner = _within(sheet, _place((x, y, z)))
    code = kind.dm_code if kind.dm_code.startswith(_NOTE_LAYER) else _note_code(kind)
    note = DmNote(words, round(label.rotation_deg) % 360, _LABEL_MM)
    return sheet, DmElement("E7", code, (corner,), note=note)


def _note_code(kind: FeatureKind) -> str:
    if kind.dm_code in _HEIGHT_CODES:
        return _HEIGHT_NOTE
    return _ROUTE_NOTE if kind.dm_code == _CENTRE_LINE else _NOTE


def _within(sheet: MapSheet, place: PlaceMm) -> PlaceMm:
    """Words begin on the sheet of their feature."""
    south, west = sheet.south_west_mm
    x = min(max(place[0], south), south + SHEET_X_MM)
    return x, min(max(place[1], west), west + SHEET_Y_MM), place[2]


def _of_one_width(words: str) -> str:
    """Words of narrow letters alone as they are, others all in wide ones, as a note must be."""
    if not any(map(_is_wide, words)):
        return words
    joined = unicodedata.normalize("NFKC", words)  # narrow kana with their marks
    wide = "".join(
        chr(ord(one) + 0xFEE0) if "!" <= one <= "~" else "\u3000" if one == " " else one
        for one in joined
    )
    return "".join(one if _is_wide(one) else "〓" for one in wide)


def _is_wide(one: str) -> bool:
    return len(one.encode("cp932", "replace")) == 2


def _surveyed(feature: Feature) -> str:
    date = str(feature.attributes.get("survey_date") or "")
    return date[2:4] + date[5:7] if len(date) == 10 and date[:4].isdigit() else NO_DATE


def _number(feature: Feature, name: str) -> float:
    value = feature.attributes.get(name)
    return float(value) if isinstance(value, (int, float)) and math.isfinite(value) else 0.0


def _is_number(words: str) -> bool:
    try:
        return math.isfinite(float(words))
    except ValueError:
        return False
