"""The columns of a ledger: what stands in a row, how it is called, and in how many digits."""

from __future__ import annotations

import math
import unicodedata
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from processing.core.text import Language, Text
from processing.map.catalogue import AttributeField, Catalogue, Geometry
from processing.map.feature import AttributeValue, Feature, Position
from processing.map.measured_fields import field_of
from processing.map.measures import length_m, plan_area_m2, plan_length_m
from processing.tools.listed.registry import TOOLS

_GUARDED = tuple("=+-@'＝＋－＠")
_UNSEEN = ("Cc", "Cf", "Zl", "Zp", "Cn", "Cs")
_MEASURED_UNITS = frozenset({"m", "㎡", "°"})
_SHAPES = {
    Geometry.POINT: Text("point", "点"),
    Geometry.LINE: Text("line", "線"),
    Geometry.AREA: Text("area", "面"),
}
_DEGREE_DIGITS = 8  # about a millimetre

CellText = Callable[[Feature], str]


def _always(_feature: Feature) -> bool:
    return True


def _never(_feature: Feature) -> bool:
    return False


@dataclass(frozen=True)
class TableStyle:
    """How a table is written.

    Attributes
    ----------
    language : "en", "ja" or None
        Of the headers and the choices' names; None: the columns' ids, for programs.
    encoding : "utf-8" or "cp932"
        UTF-8 is written with its mark, by which spreadsheets know it.
    digits : int
        Decimals of metres: the delivered coordinates' own, usually 3.
    crs : str
        ``EPSG:n`` or empty; a column says it.
    """

    language: Language | None = "ja"
    encoding: str = "utf-8"
    digits: int = 3
    crs: str = ""

    def number(self, value: float, digits: int | None = None) -> str:
        """A number with a dot and its decimals; empty when it is none; never minus zero."""
        if not math.isfinite(value):
            return ""
        words = f"{value:.{self.digits if digits is None else digits}f}"
        return words.removeprefix("-") if float(words) == 0 else words


@dataclass(frozen=True)
class LedgerColumn:
    """A column: its id for programs, its title for people, its unit, its cells.

    Attributes
    ----------
    cell : callable
        What stands in a feature's row, numbers with their decimals.
    is_number : callable
        Whether that is a number, for tables whose cells have types.
    """

    id: str
    title: Text
    unit: str
    cell: CellText
    is_number: Callable[[Feature], bool] = _never

    def header(self, language: Language | None) -> str:
        """What stands in the first row."""
        return header(self.id, self.title, self.unit, language)


POSITION = (
    ("easting_m", Text("Easting (Y)", "東距(Y)"), "m"),
    ("northing_m", Text("Northing (X)", "北距(X)"), "m"),
    ("elevation_m", Text("Height (H)", "標高(H)"), "m"),
)
"""Id, title and unit of a coordinate's three columns."""

FEATURE_ID = Text("Feature ID", "地物ID")


def header(id: str, title: Text, unit: str, language: Language | None) -> str:  # noqa: A002
    """What stands above a column in a language, or its id."""
    if language is None:
        return guard_text(id)
    words = title.in_language(language)
    return guard_text(f"{words} [{unit}]" if unit else words)


def distinct_headers(headers: Sequence[str]) -> list[str]:
    """Headers of which no two are the same: readers find columns by them."""
    distinct: dict[str, None] = {}
    for words in headers:
        own, number = words, 2
        while own in distinct:
            own, number = f"{words} ({number})", number + 1
        distinct[own] = None
    return list(distinct)


def unguarded(text: str) -> str:
    """The text that :func:`guard_text` was given."""
    return text.removeprefix("'")


def guard_text(text: str) -> str:
    """A text that no spreadsheet takes for a formula.

    One apostrophe is put before ``= + - @``, their full-width twins, before line feeds, blanks and
    characters without a picture, which programs pass over, and before an apostrophe itself, so that
    taking one off gives the text back.
    """
    first = text[:1]
    is_passed_over = first.isspace() or unicodedata.category(first or "x") in _UNSEEN
    return f"'{text}" if is_passed_over or text.startswith(_GUARDED) else text


def identity_columns() -> tuple[LedgerColumn, ...]:
    """The feature's id, by which ``vertices.csv`` refers to it."""
    return (LedgerColumn("id", FEATURE_ID, "", lambda feature: guard_text(feature.id)),)


def kind_columns(catalogue: Catalogue, style: TableStyle) -> tuple[LedgerColumn, ...]:
    """What the feature is."""

    def name(feature: Feature) -> str:
        known = feature.kind in catalogue
        name = catalogue[feature.kind].name if known else Text.same(feature.kind)
        return guard_text(name.in_language(style.language or "en"))

    def code(feature: Feature) -> str:
        return catalogue[feature.kind].dm_code if feature.kind in catalogue else ""

    def shape(feature: Feature) -> str:
        return _SHAPES[feature.geometry].in_language(style.language or "en")

    return (
        LedgerColumn("kind", Text("Kind", "種別ID"), "", lambda feature: guard_text(feature.kind)),
        LedgerColumn("kind_name", Text("Name of kind", "種別"), "", name),
        LedgerColumn("dm_code", Text("Class code", "分類コード"), "", code),
        LedgerColumn("geometry", Text("Shape", "形状"), "", shape),
    )


def status_columns(style: TableStyle) -> tuple[LedgerColumn, ...]:
    """Whether a person agreed, and how sure the tool was."""
    names = {
        "candidate": Text("candidate", "候補"),
        "accepted": Text("accepted", "採用"),
        "rejected": Text("rejected", "却下"),
    }

    def status(feature: Feature) -> str:
        value = feature.status.value
        return names[value].in_language(style.language) if style.language else value

    def confidence(feature: Feature) -> str:
        return style.number(feature.provenance.confidence, 3)

    def tool(feature: Feature) -> str:
        made_by = feature.provenance.tool
        known = TOOLS.get(made_by)
        # Scripts read the tool's id; who reads Japanese reads its name.
        name = Text.same(made_by) if known is None else Text(made_by, known.name.ja)
        name = Text("hand", "手動") if made_by == "hand" else name
        return guard_text(name.in_language(style.language or "en"))

    return (
        LedgerColumn("status", Text("Status", "状態"), "", status),
        LedgerColumn("confidence", Text("Confidence", "信頼度"), "", confidence, _always),
        LedgerColumn("tool", Text("Made by", "作成方法"), "", tool),
    )


def place_columns(features: Iterable[Feature], style: TableStyle) -> tuple[LedgerColumn, ...]:
    """First vertex; last vertex and lengths where there are lines, areas where there are areas."""
    shapes = {feature.geometry for feature in features}
    columns = _position_columns("", Text("", ""), style, 0)
    if Geometry.LINE in shapes:
        columns += _position_columns("end_", Text("End ", "終点 "), style, -1)
        columns += (
            _measure("plan_length_m", Text("Plan length", "延長(水平)"), plan_length_m, style),
            _measure("slope_length_m", Text("Slope length", "延長(斜距離)"), length_m, style),
        )
    if Geometry.AREA in shapes:
        columns += (_measure("plan_area_m2", Text("Plan area", "面積"), plan_area_m2, style),)
    if shapes - {Geometry.POINT}:
        count = LedgerColumn(
            "vertices", Text("Vertices", "頂点数"), "", lambda one: str(len(one.vertices)), _always
        )
        columns += (count,)
    return columns


def _position_columns(
    prefix: str, title: Text, style: TableStyle, vertex: int
) -> tuple[LedgerColumn, ...]:
    def cell_of(axis: int) -> CellText:
        def cell(feature: Feature) -> str:
            is_blank = vertex == -1 and feature.geometry is not Geometry.LINE
            return "" if is_blank else style.number(feature.vertices[vertex].xyz[axis])

        return cell

    return tuple(
        LedgerColumn(
            prefix + id_, Text(title.en + name.en, title.ja + name.ja), unit, cell_of(axis), _always
        )
        for axis, (id_, name, unit) in enumerate(POSITION)
    )


def _measure(
    id_: str, title: Text, measure: Callable[[Sequence[Position]], float], style: TableStyle
) -> LedgerColumn:
    is_area = id_.endswith("_m2")
    shape = Geometry.AREA if is_area else Geometry.LINE

    def cell(feature: Feature) -> str:
        if feature.geometry is not shape:
            return ""
        return style.number(measure([vertex.xyz for vertex in feature.vertices]))

    # Shift_JIS has the square metre as one character, and no raised two.
    square_metre = "㎡" if style.language == "ja" else "m2"
    return LedgerColumn(id_, title, square_metre if is_area else "m", cell, _always)


def latitude_columns(features: Sequence[Feature], style: TableStyle) -> tuple[LedgerColumn, ...]:
    """Latitude and longitude on the reference system's own datum; none where it is not known."""
    points = [one for one in features if one.geometry is Geometry.POINT]
    if not style.crs or not points:
        return ()
    from pyproj import CRS, Transformer

    system = CRS.from_user_input(style.crs)
    geodetic = system.geodetic_crs
    if not system.is_projected or geodetic is None:
        return ()
    to_degrees = Transformer.from_crs(system, geodetic.to_2d(), always_xy=True)
    eastings, northings = zip(*(one.vertices[0].xyz[:2] for one in points), strict=True)
    longitudes, latitudes = to_degrees.transform(eastings, northings)
    positions = {
        one.id: position
        for one, position in zip(points, zip(latitudes, longitudes, strict=True), strict=True)
    }

    def cell_of(axis: int) -> CellText:
        def cell(feature: Feature) -> str:
            position = positions.get(feature.id)
            return "" if position is None else style.number(position[axis], _DEGREE_DIGITS)

        return cell

    return (
        LedgerColumn("latitude_deg", Text("Latitude", "緯度"), "°", cell_of(0), _always),
        LedgerColumn("longitude_deg", Text("Longitude", "経度"), "°", cell_of(1), _always),
    )


def crs_column(style: TableStyle) -> LedgerColumn:
    """The reference system, or that it is not known."""
    unknown = Text("unknown", "不明").in_language(style.language or "en")
    return LedgerColumn(
        "crs", Text("Reference system", "座標参照系"), "", lambda _: style.crs or unknown
    )


def fields_of(features: Iterable[Feature], catalogue: Catalogue) -> tuple[AttributeField, ...]:
    """The attributes that features have, each once; those that no catalogue lists by their name."""
    fields: dict[str, AttributeField] = {}
    for feature in features:
        for name in feature.attributes:
            if name not in fields:
                known = field_of(catalogue, feature.kind, name)
                fields[name] = known or AttributeField(name, Text.same(name), "text")
    return tuple(fields.values())


def attribute_column(
    field: AttributeField, catalogue: Catalogue, style: TableStyle
) -> LedgerColumn:
    """An attribute; each kind's own choices are called by their names."""

    def cell(feature: Feature) -> str:
        known = field_of(catalogue, feature.kind, field.id)
        return attribute_cell(feature.attributes.get(field.id), known or field, style)

    def is_number(feature: Feature) -> bool:
        value = feature.attributes.get(field.id)
        return isinstance(value, (int, float)) and not isinstance(value, bool)

    return LedgerColumn(field.id, field.name, field.unit, cell, is_number)


def attribute_cell(value: AttributeValue, field: AttributeField, style: TableStyle) -> str:
    """A value as it stands in a table."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        if field.unit in _MEASURED_UNITS and math.isfinite(value):
            return style.number(value)
        return repr(value) if math.isfinite(value) else ""
    if field.type == "choice" and style.language:
        return guard_text(field.name_of_choice(value).in_language(style.language))
    return guard_text(value)
