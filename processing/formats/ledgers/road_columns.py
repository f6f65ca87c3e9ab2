"""The columns of the road's ledger sheet (道路台帳調書): one row a section between stations."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from processing.core.text import Text
from processing.formats.ledgers.ledger_columns import TableStyle, guard_text
from processing.map.catalogue import Catalogue
from processing.map.routes.road_sections import RoadSection, SideContent
from processing.map.routes.route import station_words

ROAD_LEDGER = Text("Road ledger sheet", "道路台帳調書")
_WIDTH_DIGITS = 2
"""Decimals of widths, lengths and areas in a ledger sheet: those of its stations."""

_COUNTS = (
    ("trees", Text("Street trees", "街路樹")),
    ("signs", Text("Signs", "標識")),
    ("lights", Text("Lights", "照明")),
    ("poles", Text("Poles", "柱")),
    ("inlets", Text("Rain inlets", "雨水桝")),
)


@dataclass(frozen=True)
class RoadColumn:
    """A column: id, title and unit as :func:`header` takes them, and its cells."""

    title: tuple[str, Text, str]
    cell: Callable[[RoadSection], str]
    is_number: bool = True


def road_columns(catalogue: Catalogue, style: TableStyle) -> tuple[RoadColumn, ...]:
    """The columns; measures that the map does not give stay empty."""
    number = _Numbers(style)
    square_metre = "㎡" if style.language == "ja" else "m2"
    return (
        _words("route", Text("Route", "路線名"), lambda one: one.route),
        _words("from", Text("From station", "測点（自）"), lambda one: station_words(one.start_m)),
        _words("to", Text("To station", "測点（至）"), lambda one: station_words(one.end_m)),
        number.of("length_m", Text("Length", "延長"), lambda one: one.length_m),
        number.of("road_width_m", Text("Road width", "道路部幅員"), lambda one: one.start.road_m),
        *number.pair("carriageway", Text("Carriageway", "車道"), lambda one: one.start.carriageway),
        *number.pair("footway", Text("Footway", "歩道"), lambda one: one.start.footway),
        number.of("median_m", Text("Median", "中央帯"), lambda one: one.start.median),
        number.of("carriageway_area_m2", Text("Carriageway area", "車道面積"),
                  lambda one: one.carriageway_area_m2, square_metre),
        number.of("road_area_m2", Text("Road area", "道路部面積"),
                  lambda one: one.road_area_m2, square_metre),
        number.of("footway_area_m2", Text("Footway area", "歩道面積"),
                  lambda one: one.footway_area_m2, square_metre),
        number.of("surfaced_area_m2", Text("Surfaced area", "舗装面積（車道・歩道）"),
                  lambda one: one.surfaced_area_m2, square_metre),
        number.of("least_radius_m", Text("Smallest radius", "最小曲線半径"),
                  lambda one: one.alignment.least_radius_m),
        number.of("tight_curve_m", Text("Curves below 30 m", "半径30 m未満の延長"),
                  lambda one: one.alignment.tight_m),
        number.of("steepest_percent", Text("Steepest gradient", "最急縦断勾配"),
                  lambda one: one.alignment.steepest_percent, "%"),
        number.of("steep_m", Text("Gradient 8 % and more", "勾配8 %以上の延長"),
                  lambda one: one.alignment.steep_m),
        *number.sides("curb", Text("Curb", "縁石"), lambda side: side.curb_m),
        *_gutters(catalogue, style),
        *number.sides("gutter", Text("Gutter", "側溝"), lambda side: side.gutter_m),
        *number.sides("guard_fence", Text("Guard fence", "防護柵"), lambda side: side.guard_m),
        *(column for id_, name in _COUNTS for column in _counts(id_, name)),
        _words("surface", Text("Surface", "路面種別"), lambda one: _joined(one.surfaces, style)),
        _words("bridge", Text("Bridge", "橋梁"), lambda one: _joined(one.bridges, style)),
        _words("note", Text("Note", "備考"), lambda _: ""),
    )  # fmt: skip


@dataclass(frozen=True)
class _Numbers:
    """Columns of measures."""

    style: TableStyle

    def of(
        self, id_: str, title: Text, measure: Callable[[RoadSection], float], unit: str = "m"
    ) -> RoadColumn:
        def cell(section: RoadSection) -> str:
            return self.style.number(measure(section), _WIDTH_DIGITS)

        return RoadColumn((id_, title, unit), cell)

    def pair(
        self, id_: str, title: Text, measure: Callable[[RoadSection], tuple[float, float]]
    ) -> tuple[RoadColumn, ...]:
        return (
            self.of(f"{id_}_left_m", _left(title), lambda one: measure(one)[0]),
            self.of(f"{id_}_right_m", _right(title), lambda one: measure(one)[1]),
        )

    def sides(
        self, id_: str, title: Text, measure: Callable[[SideContent], float]
    ) -> tuple[RoadColumn, ...]:
        length = Text(f"{title.en} length", f"{title.ja}延長")
        return self.pair(id_, length, lambda one: (measure(one.left), measure(one.right)))


def _words(id_: str, title: Text, words: Callable[[RoadSection], str]) -> RoadColumn:
    return RoadColumn((id_, title, ""), lambda one: guard_text(words(one)), is_number=False)


def _counts(what: str, title: Text) -> tuple[RoadColumn, ...]:
    def column(side: Literal["left", "right"]) -> RoadColumn:
        def cell(section: RoadSection) -> str:
            content = section.left if side == "left" else section.right
            return str(content.counts.get(what, 0))

        words = _left(title) if side == "left" else _right(title)
        return RoadColumn((f"{what}_{side}", words, ""), cell)

    return column("left"), column("right")


def _gutters(catalogue: Catalogue, style: TableStyle) -> tuple[RoadColumn, ...]:
    def names(side: SideContent) -> str:
        language = style.language or "en"
        kinds = (catalogue[one].name.in_language(language) for one in side.gutters)
        return _joined(tuple(kinds), style)

    title = Text("Kind of gutter", "側溝種別")
    return (
        _words("gutter_kind_left", _left(title), lambda one: names(one.left)),
        _words("gutter_kind_right", _right(title), lambda one: names(one.right)),
    )


def _joined(names: tuple[str, ...], style: TableStyle) -> str:
    return ("、" if style.language == "ja" else ", ").join(names)


def _left(title: Text) -> Text:
    return Text(f"{title.en}, left", f"{title.ja}（左）")


def _right(title: Text) -> Text:
    return Text(f"{title.en}, right", f"{title.ja}（右）")
