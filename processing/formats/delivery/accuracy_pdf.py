"""精度管理表: how near the map comes to its check points, as a paper to be signed."""

from __future__ import annotations

import math
from pathlib import Path

from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.formats.reports.pdf_page import A4_PORTRAIT, Paper, write_report_page
from processing.formats.reports.pdf_table import Table, TableCell, TableRow
from processing.formats.work_facts import WorkFacts, crs_words, day
from processing.map.quality.check_points import CheckedPoint, Deviation, PointCheck

TITLE = Text("Accuracy of the map at check points", "数値地形図データ作成 精度管理表")
_MARGIN_MM, _GAP_MM, _SIZE = 14.0, 5.0, 8.0
_HEAD_MM = (30.0, 61.0, 30.0, 61.0)
_POINTS_MM = (26.0, 34.0, 34.0, 28.0, 30.0, 30.0)
_RESULT_MM = (34.0, 22.0, 32.0, 32.0, 32.0, 30.0)
_SIGNED_MM = (30.0, 61.0, 30.0, 61.0)
_POINT_COLUMNS = (
    Text("Point", "点名"),
    Text("Northing (m)", "X座標 (m)"),
    Text("Easting (m)", "Y座標 (m)"),
    Text("Height (m)", "標高 (m)"),
    Text("In plan (m)", "水平較差 (m)"),
    Text("Height (m)", "標高較差 (m)"),
)
_RESULT_COLUMNS = (
    Text.same(""),
    Text("Points", "点数"),
    Text("Standard deviation (m)", "標準偏差 (m)"),
    Text("Largest (m)", "最大較差 (m)"),
    Text("Limit (m)", "制限値 (m)"),
    Text("Verdict", "判定"),
)
_PLAN, _HEIGHT = Text("In plan", "水平位置"), Text("Height", "標高")
_PASSED, _FAILED, _OPEN = (
    Text("within", "制限内"),
    Text("beyond", "制限超過"),
    Text("not checked", "未検証"),
)
_SIGNED = (
    Text("Chief engineer", "主任技術者　　　　　　　　　　印"),
    Text("Checked by", "点検者　　　　　　　　　　　　印"),
)


def write_accuracy_pdf(path: Path, check: PointCheck, work: WorkFacts, monitor: Monitor) -> None:
    """Write the paper, in Japanese: it goes into a delivery.

    Raises
    ------
    UserError
        What :func:`processing.core.safe_write.write_safely` raises; `Cancelled`.
    """
    with write_report_page(path, A4_PORTRAIT, "ja", TITLE.ja) as paper:
        paper.text(paper.width_mm / 2, _MARGIN_MM + 4.0, TITLE, 16.0, "centre")
        y = Table(_MARGIN_MM, _HEAD_MM, _SIZE).draw(paper, _MARGIN_MM + 12.0, _head(check, work))
        y = Table(_MARGIN_MM, _RESULT_MM, _SIZE).draw(paper, y + _GAP_MM, _results(check))
        Table(_MARGIN_MM, _SIGNED_MM, _SIZE).draw(
            paper,
            y + _GAP_MM,
            [
                [
                    cell
                    for one in _SIGNED
                    for cell in (TableCell(one, is_head=True), TableCell("", "right"))
                ]
            ],
        )
        monitor.check()
        _draw_points(paper, check, work, y + 2 * _GAP_MM + 8.0)
        paper.foot(work.software, _MARGIN_MM)


def _head(check: PointCheck, work: WorkFacts) -> list[TableRow]:
    pairs = (
        (Text("Work", "業務名"), work.work),
        (Text("Area", "地区名"), work.place),
        (Text("Client", "計画機関名"), work.client),
        (Text("Contractor", "作業機関名"), work.contractor),
        (Text("Map level", "地図情報レベル"), str(check.level)),
        (Text("Date", "作成年月日"), day(work.made_on)),
        (Text("Reference system", "座標系"), crs_words(work.crs)),
        (Text("Heights", "標高の基準"), work.height_datum),
    )
    cells = [(TableCell(name, is_head=True), TableCell(value)) for name, value in pairs]
    return [[*one, *other] for one, other in zip(cells[::2], cells[1::2], strict=True)]


def _results(check: PointCheck) -> list[TableRow]:
    rows: list[TableRow] = [[TableCell(one, "centre", is_head=True) for one in _RESULT_COLUMNS]]
    for name, one in ((_PLAN, check.plan), (_HEIGHT, check.height)):
        numbers = (one.rmse_m, one.most_m, one.limit_m)
        rows.append(
            [
                TableCell(name, is_head=True),
                TableCell(f"{one.count}", "right"),
                *(TableCell(_metres(value), "right") for value in numbers),
                TableCell(_verdict(one), "centre"),
            ]
        )
    return rows


def _verdict(one: Deviation) -> Text:
    if not one.count:
        return _OPEN
    return _PASSED if one.passes else _FAILED


def _draw_points(paper: Paper, check: PointCheck, work: WorkFacts, y: float) -> None:
    rows: list[TableRow] = [[TableCell(one, "centre", is_head=True) for one in _POINT_COLUMNS]]
    rows += [_row(one) for one in check.points]
    tops = iter((y,))

    def next_page() -> float:
        top = next(tops, None)
        if top is not None:
            return top
        paper.foot(work.software, _MARGIN_MM)
        paper.next_page()
        return _MARGIN_MM

    bottom = paper.height_mm - _MARGIN_MM - 4.0
    Table(_MARGIN_MM, _POINTS_MM, _SIZE).draw_over_pages(paper, rows, next_page, bottom)


def _row(one: CheckedPoint) -> TableRow:
    point = one.point
    values = (
        f"{point.northing_m:.3f}",
        f"{point.easting_m:.3f}",
        _metres(point.height_m),
        _metres(one.plan_m) if one.feature else "図上に該当なし",
        _metres(one.height_m),
    )
    return [TableCell(point.id), *(TableCell(value, "right") for value in values)]


def _metres(value: float) -> str:
    return "–" if math.isnan(value) else f"{value:.3f}"
