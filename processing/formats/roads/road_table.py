"""The road model as tables: a row a station, and a row for each place below the clearance."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from processing.core.text import Text
from processing.formats.reports.report_sheet import ReportSheet, SheetRow, SheetValue
from processing.map.routes.route import station_words
from processing.methods.road.clearance.street_clearance import ClearancePlace
from processing.methods.road.road_model.road_model import RoadModel, RoadStation, Sides

_DIGITS = 3
_PERCENT = 100.0

THING_NAMES = {
    "tree": Text("Branches", "枝"),
    "wire": Text("Wire", "架線"),
    "sign": Text("Sign or plate", "標識・板"),
    "pole": Text("Pole or arm", "柱・腕木"),
    "building": Text("Building", "建物"),
    "structure": Text("Structure", "構造物"),
    "other": Text("Other", "その他"),
}
"""What hangs there, in words."""

_WALK, _ROAD = Text("Walk", "歩道"), Text("Carriageway", "車道")


@dataclass(frozen=True)
class _Column:
    name: Text
    value: Callable[[RoadModel, RoadStation], SheetValue]


def _measure(name: Text, value: Callable[[RoadStation], float]) -> _Column:
    return _Column(name, lambda _, one: value(one))


def _sides(name: Text, unit: str, sides: Callable[[RoadStation], Sides]) -> tuple[_Column, ...]:
    left = Text(f"{name.en}, left [{unit}]", f"{name.ja}（左）[{unit}]")
    right = Text(f"{name.en}, right [{unit}]", f"{name.ja}（右）[{unit}]")
    return (
        _measure(left, lambda one: sides(one).left),
        _measure(right, lambda one: sides(one).right),
    )


def _falls(one: RoadStation) -> Sides:
    return Sides(*(_PERCENT * fit.slope for fit in one.fall))


def _falls_within(one: RoadStation) -> Sides:
    return Sides(*(_PERCENT * fit.within for fit in one.fall))


_COLUMNS: tuple[_Column, ...] = (
    _Column(Text("Route", "路線名"), lambda model, _: model.name),
    _Column(Text("Station", "測点"), lambda _, one: station_words(one.station_m)),
    _measure(Text("Along [m]", "追加距離 [m]"), lambda one: one.station_m),
    _measure(Text("Easting [m]", "東距(Y) [m]"), lambda one: one.easting_m),
    _measure(Text("Northing [m]", "北距(X) [m]"), lambda one: one.northing_m),
    _measure(Text("Height [m]", "路面高 [m]"), lambda one: one.height_m),
    _measure(Text("Carriageway [m]", "車道幅員 [m]"), lambda one: one.carriageway.total),
    *_sides(Text("Carriageway", "車道幅員"), "m", lambda one: one.carriageway),
    *_sides(Text("± of it", "車道幅員の誤差"), "m", lambda one: one.within),
    *_sides(Text("Walk", "歩道幅員"), "m", lambda one: one.walk),
    *_sides(Text("Shoulder", "路肩幅員"), "m", lambda one: one.shoulder),
    _measure(Text("Median [m]", "中央帯 [m]"), lambda one: one.median_m),
    *_sides(Text("Crossfall", "横断勾配"), "%", _falls),
    *_sides(Text("± of it", "横断勾配の誤差"), "%", _falls_within),
    _measure(
        Text("Longitudinal slope [%]", "縦断勾配 [%]"), lambda one: _PERCENT * one.slope.slope
    ),
    _measure(Text("± of it [%]", "縦断勾配の誤差 [%]"), lambda one: _PERCENT * one.slope.within),
    _measure(Text("Smallest radius [m]", "最小曲線半径 [m]"), lambda one: one.radius_m),
)


def station_rows(models: Sequence[RoadModel]) -> list[SheetRow]:
    """A head and a row for each station of each road; what isn't known is empty."""
    rows = [SheetRow([one.name for one in _COLUMNS], is_head=True)]
    for model in models:
        for station in model.stations:
            cells = [column.value(model, station) for column in _COLUMNS]
            rows.append(SheetRow(cells, digits=_DIGITS))
    return rows


_PLACE_HEADS = (
    Text("Route", "路線名"),
    Text("Station", "測点"),
    Text("From [m]", "自 [m]"),
    Text("To [m]", "至 [m]"),
    Text("Above", "場所"),
    Text("What", "支障物"),
    Text("Lowest [m]", "路面からの高さ [m]"),
    Text("To be kept free [m]", "建築限界 [m]"),
    Text("Missing [m]", "不足 [m]"),
    Text("Inside the edge [m]", "端からの入り込み [m]"),
    Text("Confidence", "信頼度"),
    Text("Easting [m]", "東距(Y) [m]"),
    Text("Northing [m]", "北距(X) [m]"),
    Text("Height [m]", "標高 [m]"),
)


def place_rows(models: Sequence[RoadModel]) -> list[SheetRow]:
    """A head and a row for each stretch in which something hangs too low."""
    rows = [SheetRow(list(_PLACE_HEADS), is_head=True)]
    for model in models:
        for station, place in model.places:
            rows.append(SheetRow(_place_cells(model, station, place), digits=_DIGITS))
    return rows


def _place_cells(model: RoadModel, station: float, place: ClearancePlace) -> list[SheetValue]:
    east, north, height = place.xyz.tolist()
    return [
        model.name,
        station_words(station),
        *place.stretch_m,
        _WALK if place.is_walk else _ROAD,
        THING_NAMES[place.type],
        place.lowest_m,
        place.limit_m,
        place.limit_m - place.lowest_m,
        place.depth_m,
        place.confidence,
        east,
        north,
        height,
    ]


def sheets_of(models: Sequence[RoadModel]) -> tuple[ReportSheet, ...]:
    """Both tables as sheets of a workbook."""
    return (
        ReportSheet(Text("Road model", "道路モデル"), station_rows(models)),
        ReportSheet(Text("Clearance", "建築限界"), place_rows(models)),
    )
