"""The volume report (土量計算書) as PDF: numbers, their proof, the map of change, the sections."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from pathlib import Path

from processing.core.monitor import Monitor, SilentMonitor
from processing.core.text import Language, Text
from processing.formats.reports.pdf_page import (
    A4_LANDSCAPE,
    A4_PORTRAIT,
    Paper,
    break_lines,
    leading_mm,
    width_of,
    write_report_page,
)
from processing.formats.reports.pdf_table import Table, TableCell, TableRow
from processing.formats.reports.plan_picture import (
    PlanPicture,
    change_plan,
    draw_legend,
    draw_plan,
    plan_parts,
)
from processing.formats.reports.section_figures import draw_section
from processing.formats.reports.volume_rows import (
    MAP_TITLE,
    QUANTITY_COLUMNS,
    REMARKS,
    SECTION_COLUMNS,
    SURFACE_COLUMNS,
    TITLE,
    TOTAL,
    VolumeFacts,
    class_digits,
    format_value,
    method_rows,
    quantities,
    remarks,
    section_rows,
    section_sums,
    surface_rows,
    work_rows,
)
from processing.methods.earthwork.maps.heat_map import change_classes, change_limit
from processing.methods.earthwork.volumes.volume_result import VolumeResult

_MARGIN_MM, _GAP_MM, _FOOT_MM = 14.0, 5.0, 4.0
_LABEL_MM = 30.0
_HEAD_SIZE, _TYPE = 10.5, 8.5
_LEGEND_ROWS = 5
_LEGEND_MM = 27.0
_FIGURE_MM, _HEADING_MM = 60.0, 6.0
_PART = Text("{title}, part {number} of {count}", "{title} {number}/{count}")
_WORK = Text("Work", "工事")
_SURFACES = Text("Surfaces", "比較した地盤面")
_METHOD = Text("Method", "計算方法")
_QUANTITIES = Text("Quantities", "数量")
_OUTLINE = Text("Outlined: {name}", "枠線: {name}")
_FILLED = Text("not measured, filled in", "未計測（補間）")
_SECTIONS = Text("Sections along {name}", "断面（{name}）")
_LINES = Text(
    "Dashed: before. Solid: after. Blue: cut. Orange: fill. Offsets and heights in m.",
    "破線: 変化前　実線: 変化後　青: 切土　橙: 盛土　単位: m",
)


def write_volume_report(
    path: Path,
    result: VolumeResult,
    facts: VolumeFacts,
    language: Language,
    *,
    monitor: Monitor | None = None,
    never: Iterable[Path] = (),
) -> None:
    """Write the report.

    Parameters
    ----------
    never : iterable of Path
        Files that must not be overwritten: the inputs of the work.

    Raises
    ------
    UserError
        What :func:`processing.core.safe_write.write_safely` raises; `Cancelled`.
    """
    monitor = monitor or SilentMonitor()
    monitor.check()
    limit_m = change_limit(result.change.change_m)
    plan = change_plan(result.change, change_classes(limit_m))
    title = TITLE.in_language(language)
    with write_report_page(path, A4_PORTRAIT, language, title, never=never) as paper:
        _draw_numbers(paper, result, facts)
        monitor.check()
        _next_page(paper, facts, _sheet_of(plan))
        _draw_map(paper, plan, limit_m, facts)
        _draw_parts(paper, plan, limit_m, facts)
        monitor.check()
        _draw_section_table(paper, facts)
        _draw_figures(paper, facts, monitor)
        paper.foot(facts.work.software, _MARGIN_MM)
        monitor.check()


def _next_page(
    paper: Paper, facts: VolumeFacts, size_mm: tuple[float, float] | None = None
) -> float:
    """End a page; gives where the next one begins."""
    paper.foot(facts.work.software, _MARGIN_MM)
    paper.next_page(size_mm)
    return _MARGIN_MM


def _sheet_of(plan: PlanPicture) -> tuple[float, float]:
    """Sheets of maps lie for a site that is wider than high."""
    is_wide = plan.east - plan.west > plan.north - plan.south
    return A4_LANDSCAPE if is_wide else A4_PORTRAIT


def _width(paper: Paper) -> float:
    return paper.width_mm - 2 * _MARGIN_MM


def _bottom(paper: Paper) -> float:
    return paper.height_mm - _MARGIN_MM - _FOOT_MM


def _draw_heading(paper: Paper, y: float, words: Text) -> float:
    paper.text(_MARGIN_MM, y + 2.5, words, _HEAD_SIZE, width=_width(paper))
    return y + _HEADING_MM


def _draw_numbers(paper: Paper, result: VolumeResult, facts: VolumeFacts) -> None:
    paper.text(paper.width_mm / 2, _MARGIN_MM + 4.0, TITLE, 18.0, "centre")
    y = _draw_heading(paper, _MARGIN_MM + 12.0, _WORK)
    width = _width(paper)
    half = width / 2
    pairs = Table(_MARGIN_MM, (_LABEL_MM, half - _LABEL_MM) * 2, _TYPE)
    y = pairs.draw(paper, y, _paired(work_rows(facts))) + _GAP_MM
    y = _draw_heading(paper, y, _SURFACES)
    surfaces = Table(_MARGIN_MM, (18.0, 42.0, 31.0, 52.0, width - 143.0), _TYPE)
    rows: list[TableRow] = [[TableCell(words, "centre", is_head=True) for words in SURFACE_COLUMNS]]
    for name, *values in surface_rows(facts):
        cells = [TableCell(value) for value in values[:-1]]
        rows.append([TableCell(name, is_head=True), *cells, TableCell(values[-1], "right")])
    y = surfaces.draw(paper, y, rows) + _GAP_MM
    y = _draw_heading(paper, y, _METHOD)
    methods = Table(_MARGIN_MM, (_LABEL_MM, width - _LABEL_MM), _TYPE)
    reported = [
        (TableCell(name, is_head=True), TableCell(value))
        for name, value in method_rows(result, facts)
    ]
    y = methods.draw(paper, y, reported) + _GAP_MM
    y = _draw_quantities(paper, _draw_heading(paper, y, _QUANTITIES), result) + _GAP_MM
    _draw_remarks(paper, y, remarks(result), facts)


def _paired(facts: Sequence[tuple[Text, Text]]) -> list[TableRow]:
    """The first fact over the whole width, the others two by two."""
    (first, value), *others = facts
    rows: list[TableRow] = [(TableCell(first, is_head=True), TableCell(value, columns=3))]
    cells = [(TableCell(name, is_head=True), TableCell(reported)) for name, reported in others]
    return rows + [(*cells[at], *cells[at + 1]) for at in range(0, len(cells), 2)]


def _draw_quantities(paper: Paper, y: float, result: VolumeResult) -> float:
    width = _width(paper)
    table = Table(_MARGIN_MM, (62.0, 44.0, width - 122.0, 16.0), 10.0)
    rows: list[TableRow] = [
        [TableCell(words, "centre", is_head=True) for words in QUANTITY_COLUMNS]
    ]
    rows += [
        (
            TableCell(one.name, is_head=True),
            TableCell(format_value(one, one.whole), "right"),
            TableCell(format_value(one, one.measured), "right"),
            TableCell(one.unit, "centre"),
        )
        for one in quantities(result)
    ]
    return table.draw(paper, y, rows, is_framed=True)


def _draw_remarks(paper: Paper, y: float, said: Sequence[Text], facts: VolumeFacts) -> None:
    """Numbered sentences, on a page more where they don't fit."""
    y = _draw_heading(paper, y, REMARKS)
    step = leading_mm(_TYPE)
    for number, one in enumerate(said, 1):
        mark = f"{number}) "
        indent = width_of(mark, _TYPE)
        lines = break_lines(paper.in_language(one), _TYPE, _width(paper) - indent)
        if y + len(lines) * step > _bottom(paper):
            y = _next_page(paper, facts)
        paper.lines(_MARGIN_MM, y, [mark], _TYPE)
        y = paper.lines(_MARGIN_MM + indent, y, lines, _TYPE) + 0.8


def _draw_parts(paper: Paper, plan: PlanPicture, limit_m: float, facts: VolumeFacts) -> None:
    """A large site again, in parts that can be read."""
    scale, parts = plan_parts(plan, _map_size(paper))
    for number, part in enumerate(parts, 1):
        _next_page(paper, facts)
        title = _PART.filled(title=MAP_TITLE, number=number, count=len(parts))
        _draw_map(paper, part, limit_m, facts, (title, scale))


def _map_size(paper: Paper) -> tuple[float, float]:
    return _width(paper), _bottom(paper) - _MARGIN_MM - _HEADING_MM - _LEGEND_MM


def _draw_map(
    paper: Paper,
    plan: PlanPicture,
    limit_m: float,
    facts: VolumeFacts,
    part: tuple[Text, int | None] = (MAP_TITLE, None),
) -> None:
    """A map with its title and its legend; a part of one has a title and a scale of its own."""
    title, scale = part
    y = _draw_heading(paper, _MARGIN_MM, title)
    size = _map_size(paper)
    draw_plan(paper, (_MARGIN_MM, y), size, plan, scale, outline=facts.area)
    if facts.area is not None:
        end = paper.width_mm - _MARGIN_MM
        name = _OUTLINE.filled(name=facts.boundary)
        paper.text(end, _MARGIN_MM + 2.5, name, 7.5, "right", width=0.5 * _width(paper))
    classes = change_classes(limit_m)
    unit = (class_digits(limit_m), "m")
    top, half = y + size[1] + 3.0, _width(paper) / 2
    width = half - _GAP_MM
    draw_legend(paper, (_MARGIN_MM, top), classes[-_LEGEND_ROWS:], unit, width=width)
    extra = ((_FILLED, None),)
    right = (_MARGIN_MM + half, top)
    draw_legend(paper, right, classes[:-_LEGEND_ROWS], unit, extra, width=width)


def _draw_section_table(paper: Paper, facts: VolumeFacts) -> None:
    rows = section_rows(facts)
    if not rows or facts.line is None:
        return
    cells: list[TableRow] = [
        (
            TableCell(row.name),
            *(
                TableCell(_number(value), "right")
                for value in (row.distance_m, row.cut_m2, row.cut_m3, row.fill_m2, row.fill_m3)
            ),
        )
        for row in rows
    ]
    distance, cut, fill = (TableCell(_number(value), "right") for value in section_sums(rows))
    cells.append(
        (TableCell(TOTAL, is_head=True), distance, TableCell(""), cut, TableCell(""), fill)
    )
    width = A4_PORTRAIT[0] - 2 * _MARGIN_MM
    table = Table(_MARGIN_MM, (width - 5 * 29.0, *(29.0,) * 5), _TYPE)
    head: TableRow = [TableCell(words, "centre", is_head=True) for words in SECTION_COLUMNS]
    title = _SECTIONS.filled(name=facts.line.name)
    table.draw_over_pages(
        paper,
        [head, *cells],
        lambda: _draw_heading(paper, _next_page(paper, facts, A4_PORTRAIT), title),
        A4_PORTRAIT[1] - _MARGIN_MM - _FOOT_MM,
    )


def _draw_figures(paper: Paper, facts: VolumeFacts, monitor: Monitor) -> None:
    line = facts.line or facts.figures
    if line is None:
        return
    y = math.inf
    for section in line.sections:
        monitor.check()
        if y + _FIGURE_MM > _bottom(paper):
            start = _next_page(paper, facts, A4_PORTRAIT)
            y = _draw_heading(paper, start, _SECTIONS.filled(name=line.name))
            paper.text(paper.width_mm - _MARGIN_MM, start + 2.5, _LINES, 7.5, "right")
        draw_section(paper, (_MARGIN_MM, y), (_width(paper), _FIGURE_MM - 3.0), section)
        y += _FIGURE_MM


def _number(value: float) -> str:
    return "" if math.isnan(value) else f"{value:,.2f}"
