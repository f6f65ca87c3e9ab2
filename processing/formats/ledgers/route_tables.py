"""The head of the road's ledger (道路台帳調書) as tables: a row a route, and a row a width.

What no drawing tells, such as the date on which a route was designated, has its column and stays
empty for a person to fill in.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from processing.core.text import Text
from processing.formats.ledgers.ledger_columns import TableStyle, guard_text, header
from processing.map.catalogue import Catalogue
from processing.map.routes.road_alignment import RoadAlignment
from processing.map.routes.route import station_words
from processing.map.routes.route_summary import (
    CHANGE_M,
    RoadStructure,
    RouteSummary,
    WidthStretch,
)

_DIGITS = 2
_BRIDGES = frozenset({"road_bridge", "road_bridge_area"})
_TUNNELS = frozenset({"road_tunnel"})

_MOST_BESIDE, _MOST_COLUMNS = 6, 16
"""Routes beside each other on a page, and columns that can be read on one."""

Cell = tuple[str, bool]
"""What stands there, and whether it is a number."""


@dataclass(frozen=True)
class RouteTable:
    """A table of routes.

    Attributes
    ----------
    id : str
        In the name of its file.
    title : Text
        Of its sheet.
    headers : tuple of str
    rows : tuple of tuple of Cell
    """

    id: str
    title: Text
    headers: tuple[str, ...]
    rows: tuple[tuple[Cell, ...], ...]

    def for_paper(self) -> RouteTable:
        """As it is printed: few rows of many columns are a form with an item a line.

        So the type is as large as on other sheets, whose columns fit a page.
        """
        if len(self.rows) > _MOST_BESIDE or len(self.headers) <= _MOST_COLUMNS:
            return self
        items = zip(self.headers, *self.rows, strict=True)
        first, *others = ((((item, False), *cells)) for item, *cells in items)
        return RouteTable(self.id, self.title, tuple(words for words, _ in first), tuple(others))


def route_tables(
    summaries: Sequence[RouteSummary], catalogue: Catalogue, style: TableStyle
) -> tuple[RouteTable, ...]:
    """The routes, and the stretches of equal width where any is known."""
    if not summaries:
        return ()
    rows = [_route_cells(one, catalogue, style) for one in summaries]
    tables = [_table("routes", Text("Routes", "路線調書"), rows, style)]
    widths = [_width_cells(one, style) for each in summaries for one in each.stretches]
    if widths:
        tables.append(_table("widths", Text("Widths", "幅員別調書"), widths, style))
    return tuple(tables)


_Titled = tuple[tuple[str, Text, str], Cell]


def _table(
    id_: str, title: Text, rows: Sequence[Sequence[_Titled]], style: TableStyle
) -> RouteTable:
    headers = tuple(header(*named, style.language) for named, _ in rows[0])
    return RouteTable(id_, title, headers, tuple(tuple(cell for _, cell in row) for row in rows))


def _words(id_: str, title: Text, words: str = "") -> _Titled:
    return (id_, title, ""), (guard_text(words), False)


def _number(style: TableStyle, id_: str, title: Text, value: float, unit: str = "m") -> _Titled:
    return (id_, title, unit), (style.number(value, _DIGITS), True)


def _route_cells(one: RouteSummary, catalogue: Catalogue, style: TableStyle) -> list[_Titled]:
    bridges, tunnels = (_length_of(one.structures, kinds) for kinds in (_BRIDGES, _TUNNELS))
    return [
        _words("route", Text("Route", "路線名"), one.route),
        _words("road_kind", Text("Kind of road", "道路の種類")),
        _words("designated", Text("Designated on", "路線指定・認定年月日")),
        _words("from", Text("From station", "起点（測点）"), station_words(one.start_m)),
        _words("to", Text("To station", "終点（測点）"), station_words(one.end_m)),
        _words("passes", Text("Main places passed", "主要な経過地")),
        _words("in_service", Text("Sections in service", "供用開始区間・年月日")),
        _number(style, "length_m", Text("Length", "延長"), one.end_m - one.start_m),
        _number(style, "bridges_m", Text("of it bridges", "うち橋梁延長"), bridges),
        _number(style, "tunnels_m", Text("of it tunnels", "うちトンネル延長"), tunnels),
        _number(style, "no_width_m", Text("of it without width", "うち幅員不明"), one.unknown_m),
        *_areas(one, style),
        *_alignment(one, style),
        _words("railways", Text("Railway crossings", "鉄道等との交差")),
        _words("tolls", Text("Toll sections", "有料区間")),
        _words("shared", Text("Shared works", "兼用工作物")),
        _words("structures", Text("Bridges, tunnels, crossings", "橋・トンネル・横断施設"),
               _structures(one, catalogue, style)),
        _words("occupants", Text("Main occupations", "主要な占用物件"),
               _occupants(one.occupants, catalogue, style)),
        _words("note", Text("Note", "備考")),
    ]  # fmt: skip


def _areas(one: RouteSummary, style: TableStyle) -> list[_Titled]:
    square_metre = "㎡" if style.language == "ja" else "m2"
    return [
        _number(style, id_, title, one.total(id_), square_metre)
        for id_, title in (
            ("road_area_m2", Text("Road area", "道路部面積")),
            ("carriageway_area_m2", Text("Carriageway area", "うち車道面積")),
            ("footway_area_m2", Text("Footway area", "うち歩道面積")),
            ("surfaced_area_m2", Text("Surfaced area", "舗装面積（車道・歩道）")),
        )
    ]


def _alignment(one: RouteSummary, style: TableStyle) -> list[_Titled]:
    bends = [section.alignment for section in one.sections]
    return [
        _number(style, "least_width_m", Text("Smallest carriageway width", "最小車道幅員"),
                one.least_width_m),
        _number(style, "least_radius_m", Text("Smallest radius", "最小曲線半径"),
                _extreme(min, bends, lambda bend: bend.least_radius_m)),
        _number(style, "tight_curve_m", Text("Curves below 30 m", "半径30 m未満の延長"),
                math.fsum(bend.tight_m for bend in bends)),
        _number(style, "steepest_percent", Text("Steepest gradient", "最急縦断勾配"),
                _extreme(max, bends, lambda bend: bend.steepest_percent), "%"),
        _number(style, "steep_m", Text("Gradient 8 % and more", "勾配8 %以上の延長"),
                math.fsum(bend.steep_m for bend in bends)),
    ]  # fmt: skip


def _extreme(
    choose: Callable[[Sequence[float]], float],
    bends: Sequence[RoadAlignment],
    value: Callable[[RoadAlignment], float],
) -> float:
    known = [one for one in map(value, bends) if not math.isnan(one)]
    return choose(known) if known else math.nan


def _length_of(structures: Sequence[RoadStructure], kinds: frozenset[str]) -> float:
    """How much of a route its structures of some kinds cover, however often they are drawn."""
    covered, end = 0.0, -math.inf
    for one in sorted((one for one in structures if one.kind in kinds), key=_start):
        covered += max(0.0, one.end_m - max(one.start_m, end))
        end = max(end, one.end_m)
    return covered


def _start(one: RoadStructure) -> float:
    return one.start_m


def _structures(one: RouteSummary, catalogue: Catalogue, style: TableStyle) -> str:
    language = style.language or "en"
    said = []
    for each in one.structures:
        name = each.name or catalogue[each.kind].name.in_language(language)
        said.append(f"{name} {station_words(each.start_m)}～{station_words(each.end_m)}")
    return _joined(said, style)


def _occupants(counts: Mapping[str, int], catalogue: Catalogue, style: TableStyle) -> str:
    language = style.language or "en"
    kinds = (kind for kind in catalogue if kind.id in counts)
    return _joined(
        [f"{kind.name.in_language(language)} {counts[kind.id]}" for kind in kinds], style
    )


def _joined(words: Sequence[str], style: TableStyle) -> str:
    return ("、" if style.language == "ja" else ", ").join(words)


def _width_cells(one: WidthStretch, style: TableStyle) -> list[_Titled]:
    low = math.floor(one.first_m / CHANGE_M + 1e-9) * CHANGE_M
    square_metre = "㎡" if style.language == "ja" else "m2"
    return [
        _words("route", Text("Route", "路線名"), one.route),
        _words("from", Text("From station", "測点（自）"), station_words(one.start_m)),
        _words("to", Text("To station", "測点（至）"), station_words(one.end_m)),
        _number(style, "length_m", Text("Length", "延長"), one.length_m),
        _words("width_class", Text("Class of width (m)", "幅員区分（m）"),
               f"{low:.1f}～{low + CHANGE_M:.1f}"),
        _number(style, "carriageway_m", Text("Carriageway width", "車道幅員"), one.first_m),
        _number(style, "least_m", Text("Smallest", "最小"), one.least_m),
        _number(style, "greatest_m", Text("Largest", "最大"), one.greatest_m),
        _number(style, "road_width_m", Text("Road width", "道路部幅員"), one.road_m),
        _number(style, "area_m2", Text("Carriageway area", "車道面積"), one.area_m2, square_metre),
        _words("note", Text("Note", "備考")),
    ]  # fmt: skip
