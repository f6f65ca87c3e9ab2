"""The road model as files: tables, a workbook, and the plot as PDF, SVG and PNG."""

from __future__ import annotations

from collections.abc import Sequence

from processing.core.errors import Unsuitable
from processing.core.monitor import Monitor, PartMonitor
from processing.core.text import Language, Text
from processing.formats.map_delivery import MapDelivery, Position, RoadModelOptions
from processing.formats.pictures.paper_png import write_paper_png
from processing.formats.pictures.paper_svg import paper_svg
from processing.formats.reports.report_sheet import write_report_csv, write_report_xlsx
from processing.formats.roads.road_plot import PAGE_MM, diagram_page, pages_of, road_pages
from processing.formats.roads.road_table import place_rows, sheets_of, station_rows
from processing.formats.sheets.sheets_pdf import write_sheets_pdf
from processing.methods.road.clearance.street_clearance import ClearanceLimits
from processing.methods.road.road_model.road_model import (
    RoadModel,
    RoadModelSettings,
    road_models,
)


def write_road_map(delivery: MapDelivery, position: Position, monitor: Monitor) -> None:
    """Write ``road.csv``, ``road_clearance.csv``, ``road.xlsx``, ``road.pdf`` and the plot.

    Each road's plot is ``road.svg`` and ``road.png``; of several, and of long ones in stretches of
    a kilometre, the second is ``road_2`` and so on.

    Raises
    ------
    Unsuitable
        No centre line is drawn, and none can be made.
    OutOfRange
        A character that the tables' encoding lacks; drives that lie too far apart.
    """
    options = delivery.options_of(RoadModelOptions)
    language: Language = delivery.language or "ja"
    models = models_of(delivery, PartMonitor(monitor, 0.0, 0.9))
    write_report_csv(position("road.csv"), station_rows(models), language, options.encoding)
    write_report_csv(position("road_clearance.csv"), place_rows(models), language, options.encoding)
    write_report_xlsx(position("road.xlsx"), sheets_of(models), language)
    monitor.check()
    pages = road_pages(models, delivery.name, language)
    write_sheets_pdf(position("road.pdf"), pages, PAGE_MM, language, delivery.name)
    plots = [page for model in models for page in pages_of(model, delivery.name, language)]
    for number, page in enumerate(plots, 1):
        monitor.check()
        stem = "road" if number == 1 else f"road_{number}"
        shapes = tuple(diagram_page(page))
        position(f"{stem}.svg").write_text(paper_svg(shapes, PAGE_MM), encoding="utf-8")
        write_paper_png(position(f"{stem}.png"), shapes, PAGE_MM)


def models_of(delivery: MapDelivery, monitor: Monitor) -> tuple[RoadModel, ...]:
    """The roads of a map that is handed in; what they lack is told.

    Raises
    ------
    Unsuitable
        No centre line is drawn, and none can be made.
    OutOfRange
        The drives lie too far apart.
    """
    options = delivery.options_of(RoadModelOptions)
    limits = ClearanceLimits(options.road_clearance, options.walk_clearance)
    settings = RoadModelSettings(options.road_pitch, limits)
    models = road_models(delivery.features, delivery.catalogue, delivery.drives, settings, monitor)
    if not models:
        raise _no_line(delivery)
    _tell_lacking(delivery, models)
    return models


def _no_line(delivery: MapDelivery) -> Unsuitable:
    has_way = any(one.trajectory is not None for one in delivery.drives)
    remedy = Text(
        "Accept or draw curbs, footways or road edges on both sides of the way that was driven, or"
        " draw the centre line; nothing was written.",
        "走行軌跡の両側の縁石・歩道・道路縁を採用・作図するか、道路中心線を描いてください。"
        "何も書き込まれていません。",
    )
    if not has_way:
        remedy = Text(
            "Draw the road's centre line and accept it: without a trajectory none can be made;"
            " nothing was written.",
            "道路中心線を作図・採用してください。軌跡がないため自動では作成できません。"
            "何も書き込まれていません。",
        )
    return Unsuitable(
        Text("The map has no road's centre line.", "道路中心線がありません。"),
        Text("road model", "道路モデル"),
        remedy,
    )


def _tell_lacking(delivery: MapDelivery, models: Sequence[RoadModel]) -> None:
    """Say what isn't known, and of how many stations."""
    stations = [one for model in models for one in model.stations]
    if any(not model.is_drawn for model in models):
        unknown = sum(model.unknown_m for model in models)
        delivery.tell(
            Text(
                "The centre line was made midway between the edges on both sides of the way that "
                f"was driven; along {unknown:.0f} m one of them is missing.",
                "中心線は、走行軌跡の両側の縁の中間に自動作成しました"
                f"（片側の縁がない区間: {unknown:.0f} m）。",
            )
        )
    without = sum(not one.carriageway.total > 0 for one in stations)
    if without:
        delivery.tell(
            Text(
                f"{without} of {len(stations)} stations have no edge on one side or either: their "
                "widths and crossfall are empty.",
                f"測点{len(stations)}か所のうち{without}か所は、片側または両側の縁がないため、"
                "幅員・横断勾配が空欄です。",
            )
        )
    bare = sum(not len(one.section) for one in stations)
    if bare:
        delivery.tell(
            Text(
                f"At {bare} of {len(stations)} stations no surface was measured: heights and "
                "slopes are empty.",
                f"測点{len(stations)}か所のうち{bare}か所は路面が計測されていないため、"
                "高さ・勾配が空欄です。",
            )
        )
