"""The map as drawing sheets: ``sheets/*.dxf`` and ``sheets.pdf``."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from dataclasses import replace

from processing.core.errors import Unsuitable
from processing.core.monitor import Monitor
from processing.core.text import Language, Text
from processing.formats.drawings.sxf_looks import cad_catalogue
from processing.formats.map_delivery import MapDelivery, Position, SheetOptions
from processing.formats.sheets.drawing_sheet import DrawingSheet
from processing.formats.sheets.grid_division import MAP_WINDOW_MM, map_grid, plain_grid
from processing.formats.sheets.map_looks import map_shapes
from processing.formats.sheets.paper_layers import on_cad_layers
from processing.formats.sheets.paper_shapes import PaperShape
from processing.formats.sheets.route_strips import route_strips
from processing.formats.sheets.sheet_clips import SheetClips
from processing.formats.sheets.sheet_column import ColumnContent, column_shapes
from processing.formats.sheets.sheet_frame import frame_shapes
from processing.formats.sheets.sheet_layout import SheetLayout, layout_of
from processing.formats.sheets.sheet_words import UnplacedLabel, label_sheet
from processing.formats.sheets.sheets_dxf import DrawnSheet, write_flat_dxf, write_layouts_dxf
from processing.formats.sheets.sheets_pdf import write_sheets_pdf
from processing.formats.sheets.slope_marks import slope_shapes
from processing.formats.sheets.title_block import SheetPart, title_block
from processing.map.feature import Feature
from processing.map.routes.route import routes_of


def write_sheets_map(delivery: MapDelivery, position: Position, monitor: Monitor) -> None:
    """Write ``sheets.pdf``, a drawing with a layout a sheet, and a flat drawing for each sheet.

    Words without room are in ``sheets/unplaced_labels.csv``, and are told.

    Raises
    ------
    Unsuitable, OutOfRange
        A map without features; a division that the map or its reference system doesn't allow.
    """
    options = delivery.options_of(SheetOptions)
    has_cad_layers = options.drawing_layers == "cad"
    if has_cad_layers:
        delivery = replace(delivery, catalogue=cad_catalogue(delivery.catalogue))
    if not delivery.features:
        raise Unsuitable(
            Text("The map has no features to draw.", "図面にする地物がありません。"),
            Text("drawing sheets", "図面"),
            Text(
                "Accept features first, or export candidates as well; nothing was written.",
                "地物を確定するか、未確認の候補も書き出してください。何も書き込まれていません。",
            ),
        )
    clips = SheetClips(delivery.features)
    by_map = options.sheet_division == "map"
    layout = layout_of(options.sheet_paper, MAP_WINDOW_MM if by_map else None)
    sheets = _divided(delivery, clips, options, layout)
    shown = [clips.within(sheet.window) for sheet in sheets]
    language: Language = delivery.language or "ja"
    drawn, pages = [], []
    unplaced: list[UnplacedLabel] = []
    for number, (sheet, features) in enumerate(zip(sheets, shown, strict=True), 1):
        monitor.check()
        monitor.report(number / len(sheets) / 2)
        used = {feature.kind for feature in features}
        kinds = [kind for kind in delivery.catalogue if kind.id in used]
        words = label_sheet(number, features, delivery.catalogue, sheet, layout)
        part = SheetPart(sheet.name, f"1:{sheet.scale}", number, len(sheets))
        block = title_block(delivery, options, part)
        content = ColumnContent(sheets, number, kinds, block, language)
        around: tuple[PaperShape, ...] = (
            *frame_shapes(sheet, layout, language), *column_shapes(content, layout), *words.placed,
            *slope_shapes(features, delivery.catalogue, sheet, layout),
        )  # fmt: skip
        around = on_cad_layers(around) if has_cad_layers else around
        drawn.append(DrawnSheet(sheet, around))
        pages.append((*map_shapes(features, delivery.catalogue, sheet, layout), *around))
        unplaced += words.unplaced
    title = options.sheet_title or delivery.name
    write_sheets_pdf(position("sheets.pdf"), pages, layout.paper, language, title)
    whole = position(f"sheets/{delivery.name}_layouts.dxf")
    write_layouts_dxf(whole, delivery, drawn, layout, monitor)
    for number, (one, features) in enumerate(zip(drawn, shown, strict=True), 1):
        monitor.report(0.5 + number / len(sheets) / 2)
        path = position(f"sheets/{delivery.name}_{number:03d}.dxf")
        write_flat_dxf(path, delivery, features, one, layout, monitor=monitor)
    _tell_unplaced(delivery, position, unplaced)
    _tell_missing(delivery, position, shown)


def _divided(
    delivery: MapDelivery, clips: SheetClips, options: SheetOptions, layout: SheetLayout
) -> list[DrawingSheet]:
    scale = int(options.sheet_scale)
    if options.sheet_division == "map":
        return map_grid(clips.shapes, scale, delivery.crs)
    if options.sheet_division == "grid":
        return plain_grid(clips.shapes, scale, layout.window_size)
    routes = [
        route
        for route in routes_of(delivery.features, delivery.catalogue)
        if options.sheet_route in ("", route.name)
    ]
    return route_strips(routes, scale, layout.window_size, options.sheet_overlap)


def _tell_unplaced(
    delivery: MapDelivery, position: Position, unplaced: Sequence[UnplacedLabel]
) -> None:
    if not unplaced:
        return
    rows = []
    for one in unplaced:
        easting, northing = (f"{value:.3f}" for value in one.place)
        words = f"'{one.words}" if one.words[:1] in "=+-@" else one.words
        rows.append([one.sheet, one.feature.id, one.feature.kind, words, easting, northing])
    columns = ("sheet", "feature", "kind", "words", "easting_m", "northing_m")
    position("sheets/unplaced_labels.csv").write_bytes(_table(columns, rows))
    delivery.tell(
        Text(
            f"{len(unplaced)} labels have no room on their sheets;"
            " sheets/unplaced_labels.csv lists them.",
            f"{len(unplaced)}件の文字は図面に入りませんでした。"
            "sheets/unplaced_labels.csv に一覧があります。",
        )
    )


def _tell_missing(
    delivery: MapDelivery, position: Position, shown: Sequence[Sequence[Feature]]
) -> None:
    on_sheets = {feature.id for features in shown for feature in features}
    missing = [one for one in delivery.features if one.id not in on_sheets]
    if not missing:
        return
    rows = []
    for one in missing:
        easting, northing = (f"{value:.3f}" for value in one.vertices[0].xyz[:2])
        rows.append([one.id, one.kind, easting, northing])
    columns = ("feature", "kind", "easting_m", "northing_m")
    position("sheets/features_off_sheets.csv").write_bytes(_table(columns, rows))
    delivery.tell(
        Text(
            f"{len(missing)} features lie off the sheets; sheets/features_off_sheets.csv lists"
            " them.",
            f"{len(missing)}件の地物が図面の範囲外です。"
            "sheets/features_off_sheets.csv に一覧があります。",
        )
    )


def _table(columns: Sequence[str], rows: Sequence[Sequence[object]]) -> bytes:
    table = io.StringIO()
    writer = csv.writer(table, lineterminator="\r\n")
    writer.writerow(columns)
    writer.writerows(rows)
    return table.getvalue().encode("utf-8-sig")
