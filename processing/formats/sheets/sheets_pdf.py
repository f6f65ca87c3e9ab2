"""Sheets as PDF, true to scale: a page for each, in the font that papers carry."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from processing.core.text import Language
from processing.formats.reports.pdf_page import Align, Paper, write_report_page
from processing.formats.sheets.paper_shapes import (
    PaperCircle,
    PaperLine,
    PaperShape,
    PaperWords,
    type_points,
)

_ALIGN: dict[str, Align] = {"LEFT": "left", "CENTER": "centre", "RIGHT": "right"}


def write_sheets_pdf(
    path: Path,
    pages: Iterable[Iterable[PaperShape]],
    size_mm: tuple[float, float],
    language: Language,
    title: str,
) -> None:
    """Write pages of one size; viewers are asked to print them unscaled.

    What is drawn lies on the layers of its pens, which readers show and hide by name.

    Raises
    ------
    UserError
        What :func:`processing.core.safe_write.write_safely` raises.
    """
    with write_report_page(path, size_mm, language, title) as paper:
        paper.print_true_to_scale()
        for number, page in enumerate(pages):
            if number:
                paper.next_page()
            for shape in page:
                _draw(paper, shape)


def _draw(paper: Paper, shape: PaperShape) -> None:
    height, pen = paper.height_mm, shape.pen
    paper.layer(pen.layer)
    match shape:
        case PaperLine():
            places = [(x, height - y) for x, y in shape.places]
            if shape.is_filled:
                paper.area(places, pen.colour)
            else:
                paper.line(places, pen.width_mm, pen.colour, dash_mm=pen.dash_mm)
        case PaperCircle():
            x, y = shape.centre
            paper.circle((x, height - y), shape.radius, pen.width_mm, pen.colour)
        case PaperWords():
            x, y = shape.place
            paper.slanted_text(
                (x, height - y),
                shape.words,
                type_points(shape.height),
                shape.angle_deg,
                _ALIGN[shape.align],
                colour=pen.colour,
            )
