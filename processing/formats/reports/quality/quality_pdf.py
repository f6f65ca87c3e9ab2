"""The quality report as PDF: verdicts, quantities by kind, and every place to look at."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from processing.core.monitor import Monitor
from processing.core.text import Language, Text
from processing.formats.reports.pdf_page import A4_PORTRAIT, Paper, write_report_page
from processing.formats.reports.pdf_table import Table, TableCell, TableRow
from processing.formats.reports.quality.quality_rows import (
    ACCURACY_COLUMNS,
    FINDING_COLUMNS,
    FINDINGS_TITLE,
    HAND_COLUMNS,
    HAND_TITLE,
    KIND_COLUMNS,
    KINDS_TITLE,
    NO_FINDINGS,
    POINT_COLUMNS,
    POINTS_TITLE,
    RULE_COLUMNS,
    RULES_TITLE,
    TITLE,
    QualityFacts,
    accuracy_rows,
    accuracy_title,
    finding_rows,
    hand_rows,
    is_number,
    kind_rows,
    point_rows,
    rule_rows,
    summary_rows,
)

_MARGIN_MM, _GAP_MM, _HEADING_MM = 14.0, 5.0, 6.0
_SIZE = 8.0
_SUMMARY_MM = (70.0, 112.0)
_RULES_MM = (48.0, 14.0, 20.0, 100.0)
_KINDS_MM = (44.0, 18.0, 16.0, 24.0, 20.0, 16.0, 14.0, 15.0, 15.0)
_ACCURACY_MM = (62.0, 20.0, 26.0, 26.0, 24.0, 24.0)
_HAND_MM = (52.0, 26.0, 26.0, 26.0, 26.0, 26.0)
_POINTS_MM = (40.0, 52.0, 34.0, 28.0, 28.0)
_FINDINGS_MM = (10.0, 42.0, 34.0, 31.0, 24.0, 24.0, 17.0)


def write_quality_pdf(
    path: Path, facts: QualityFacts, language: Language, monitor: Monitor
) -> None:
    """Write the report.

    Raises
    ------
    UserError
        What :func:`processing.core.safe_write.write_safely` raises; `Cancelled`.
    """
    title = TITLE.in_language(language)
    with write_report_page(path, A4_PORTRAIT, language, title) as paper:
        _draw_first_page(paper, facts)
        monitor.check()
        bottom = paper.height_mm - _MARGIN_MM - 4.0
        _draw_over_pages(
            paper, facts, KINDS_TITLE, _table(_KINDS_MM, KIND_COLUMNS, kind_rows(facts)), bottom
        )
        monitor.check()
        if facts.hand is not None:
            rows = _table(_HAND_MM, HAND_COLUMNS, hand_rows(facts, facts.hand))
            _draw_over_pages(paper, facts, HAND_TITLE, rows, bottom)
        if facts.points is not None:
            rows = _table(_POINTS_MM, POINT_COLUMNS, point_rows(facts, facts.points))
            _draw_over_pages(paper, facts, POINTS_TITLE, rows, bottom)
        if facts.check.findings:
            rows = _table(_FINDINGS_MM, FINDING_COLUMNS, finding_rows(facts))
            _draw_over_pages(paper, facts, FINDINGS_TITLE, rows, bottom)
        paper.foot(facts.software, _MARGIN_MM)
        monitor.check()


_Rows = tuple[Table, list[TableRow]]


def _draw_first_page(paper: Paper, facts: QualityFacts) -> None:
    paper.text(paper.width_mm / 2, _MARGIN_MM + 4.0, TITLE, 18.0, "centre")
    y = _MARGIN_MM + 14.0
    summary: list[TableRow] = [
        [TableCell(name, is_head=True), TableCell(value)] for name, value in summary_rows(facts)
    ]
    y = Table(_MARGIN_MM, _SUMMARY_MM, _SIZE).draw(paper, y, summary) + _GAP_MM
    y = _heading(paper, y, RULES_TITLE)
    table, rows = _table(_RULES_MM, RULE_COLUMNS, rule_rows(facts))
    y = table.draw(paper, y, rows) + _GAP_MM
    if facts.points is not None:
        y = _heading(paper, y, accuracy_title(facts.points))
        table, rows = _table(_ACCURACY_MM, ACCURACY_COLUMNS, accuracy_rows(facts.points))
        y = table.draw(paper, y, rows) + _GAP_MM
    if not facts.check.findings:
        paper.text(_MARGIN_MM, y + 3.0, NO_FINDINGS, 9.0)


def _draw_over_pages(
    paper: Paper, facts: QualityFacts, title: Text, table: _Rows, bottom: float
) -> None:
    def next_page() -> float:
        paper.foot(facts.software, _MARGIN_MM)
        paper.next_page()
        return _heading(paper, _MARGIN_MM, title)

    table[0].draw_over_pages(paper, table[1], next_page, bottom)


def _heading(paper: Paper, y: float, words: Text) -> float:
    paper.text(_MARGIN_MM, y + 2.5, words, 10.5, width=paper.width_mm - 2 * _MARGIN_MM)
    return y + _HEADING_MM


def _table(
    widths: tuple[float, ...], columns: Sequence[Text], rows: Iterator[tuple[Text, ...]]
) -> _Rows:
    head: TableRow = [TableCell(words, "centre", is_head=True) for words in columns]
    return Table(_MARGIN_MM, widths, _SIZE), [head, *map(_cells, rows)]


def _cells(row: tuple[Text, ...]) -> TableRow:
    return [TableCell(one, "right" if is_number(one.en) else "left") for one in row]
