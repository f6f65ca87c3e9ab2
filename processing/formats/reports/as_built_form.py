"""Form 31-2 (様式-31-2 出来形合否判定総括表) as PDF: numbers, verdict and heat map on one sheet."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

from processing.core.monitor import Monitor, SilentMonitor
from processing.core.text import Language, Text
from processing.formats.reports.as_built_rows import (
    COLUMNS,
    FORM,
    MAP_TITLE,
    NO_DATA,
    RESULT,
    TITLE,
    AsBuiltFacts,
    face_rows,
    fact_rows,
    notes,
    verdict,
)
from processing.formats.reports.pdf_page import (
    A4_LANDSCAPE,
    Paper,
    break_lines,
    leading_mm,
    width_of,
    write_report_page,
)
from processing.formats.reports.pdf_table import Table, TableCell, TableRow
from processing.formats.reports.plan_picture import (
    NO_VALUE,
    PlanPicture,
    as_built_plan,
    draw_legend,
    draw_plan,
    plan_parts,
)
from processing.methods.earthwork.as_built.as_built import AsBuiltResult
from processing.methods.earthwork.maps.heat_map import SHARE_CLASSES

_MARGIN_MM, _GAP_MM = 12.0, 4.0
_WIDTHS = (15.0, 35.0, 34.0, 40.0, 14.0)
_LEGEND_MM = 38.0
_FOOT_MM = 3.0
_NOTE_SIZES = (6.5, 6.0, 5.5)
_PART = Text("{title}, part {number} of {count}", "{title} {number}/{count}")
_NOTES = Text("Notes", "備考")
_NEXT_PAGE = Text("Notes: see the next page.", "備考は次のページ。")


def write_as_built_form(
    path: Path,
    result: AsBuiltResult,
    facts: AsBuiltFacts,
    language: Language,
    *,
    monitor: Monitor | None = None,
    never: Iterable[Path] = (),
) -> None:
    """Write the form.

    Parameters
    ----------
    never : iterable of Path
        Files that must not be overwritten: the inputs of the work.

    Raises
    ------
    UserError
        What :func:`processing.core.safe_write.write_safely` raises; `Cancelled`.

    References
    ----------
    MLIT, 3次元計測技術を用いた出来形管理要領（案）, 面管理編, 様式-31-2.
    """
    monitor = monitor or SilentMonitor()
    monitor.check()
    plan = as_built_plan(result)
    monitor.check()
    title = TITLE.in_language(language)
    with write_report_page(path, A4_LANDSCAPE, language, title, never=never) as paper:
        below = _draw_head(paper, result, facts)
        top = below + _GAP_MM
        bottom = paper.height_mm - _MARGIN_MM - _FOOT_MM
        ends = _draw_faces(paper, top, result)
        left_over = _draw_notes(paper, ends + 1.5, bottom, notes(result))
        left = _MARGIN_MM + sum(_WIDTHS) + _GAP_MM
        right = paper.width_mm - _MARGIN_MM
        paper.text(left, top + 2.2, MAP_TITLE, 8.5, width=right - left)
        size = (right - left - _LEGEND_MM - 3.0, bottom - top - 5.0)
        draw_plan(paper, (left, top + 5.0), size, plan)
        _draw_share_legend(paper, (right - _LEGEND_MM, top + 5.0))
        paper.foot(facts.work.software, _MARGIN_MM)
        _draw_parts(paper, plan, facts.work.software, monitor)
        if left_over:
            _draw_more_notes(paper, left_over, facts.work.software)
        monitor.check()


def _draw_parts(paper: Paper, plan: PlanPicture, software: str, monitor: Monitor) -> None:
    """A long site again, in parts that can be read."""
    right, bottom = paper.width_mm - _MARGIN_MM, paper.height_mm - _MARGIN_MM - _FOOT_MM
    top = _MARGIN_MM + 8.0
    size = (right - _MARGIN_MM - _LEGEND_MM - 3.0, bottom - top)
    scale, parts = plan_parts(plan, size)
    for number, part in enumerate(parts, 1):
        monitor.check()
        paper.next_page()
        title = _PART.filled(title=MAP_TITLE, number=number, count=len(parts))
        paper.text(_MARGIN_MM, _MARGIN_MM + 3.0, title, 11.0)
        draw_plan(paper, (_MARGIN_MM, top), size, part, scale)
        _draw_share_legend(paper, (right - _LEGEND_MM, top))
        paper.foot(software, _MARGIN_MM)


def _draw_share_legend(paper: Paper, corner: tuple[float, float]) -> None:
    extra = ((NO_DATA, NO_VALUE),)
    draw_legend(paper, corner, SHARE_CLASSES, (0, "%"), extra, width=_LEGEND_MM)


def _draw_head(paper: Paper, result: AsBuiltResult, facts: AsBuiltFacts) -> float:
    paper.text(_MARGIN_MM, _MARGIN_MM + 2.0, FORM, 9.0)
    paper.text(paper.width_mm / 2, _MARGIN_MM + 3.0, TITLE, 16.0, "centre")
    width = paper.width_mm - 2 * _MARGIN_MM
    label, half = 30.0, width / 2
    table = Table(_MARGIN_MM, (label, half - label, label, half - label))
    shown = fact_rows(result, facts)[:-1]  # the software stands at the foot
    first = (_name(shown[0][0]), TableCell(shown[0][1], columns=3))
    cells = [(_name(name), TableCell(value)) for name, value in shown[1:]]
    found = TableCell(verdict(passes=result.passes), "centre", is_result=True)
    cells.append((_name(RESULT), found))
    rows: list[TableRow] = [first]
    rows += [(*cells[at], *cells[at + 1]) for at in range(0, len(cells), 2)]
    return table.draw(paper, _MARGIN_MM + 9.0, rows)


def _name(words: Text) -> TableCell:
    return TableCell(words, is_head=True)


def _draw_faces(paper: Paper, y: float, result: AsBuiltResult) -> float:
    table = Table(_MARGIN_MM, _WIDTHS, size=7.5)
    y = table.draw(paper, y, [[TableCell(words, "centre", is_head=True) for words in COLUMNS]])
    for face in result.faces:
        shown = face_rows(face, result.table)
        name = TableCell(face.limits.name, "centre", rows=len(shown), is_head=True)
        rows: list[TableRow] = [
            (
                TableCell("") if number else name,
                TableCell(row.name),
                TableCell(row.shown, "right"),
                TableCell(row.limit, "right"),
                TableCell(row.verdict, "centre"),
            )
            for number, row in enumerate(shown)
        ]
        y = table.draw(paper, y, rows, is_framed=True)
    return y


def _draw_notes(paper: Paper, y: float, bottom: float, said: Sequence[Text]) -> Sequence[Text]:
    """Set notes below the numbers; those of long forms don't fit there, and are given back."""
    for size in _NOTE_SIZES:
        lines = _note_lines(paper, said, size, sum(_WIDTHS))
        if len(lines) * leading_mm(size) <= bottom - y:
            paper.lines(_MARGIN_MM, y, lines, size)
            return ()
    paper.lines(_MARGIN_MM, y, [_NEXT_PAGE.in_language(paper.language)], _NOTE_SIZES[0])
    return said


def _draw_more_notes(paper: Paper, said: Sequence[Text], software: str) -> None:
    paper.next_page()
    paper.text(_MARGIN_MM, _MARGIN_MM + 3.0, _NOTES, 12.0)
    lines = _note_lines(paper, said, 9.0, paper.width_mm - 2 * _MARGIN_MM)
    paper.lines(_MARGIN_MM, _MARGIN_MM + 9.0, lines, 9.0)
    paper.foot(software, _MARGIN_MM)


def _note_lines(paper: Paper, said: Sequence[Text], size: float, width: float) -> list[str]:
    lines = []
    for number, note in enumerate(said, 1):
        mark = f"{number}) "
        pieces = break_lines(paper.in_language(note), size, width - width_of(mark, size))
        lines += [mark + pieces[0], *("    " + piece for piece in pieces[1:])]
    return lines
