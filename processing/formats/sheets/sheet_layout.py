"""How a sheet of paper is laid out: frame, the map's window, the column beside it; mm on paper."""

from __future__ import annotations

from dataclasses import dataclass

from processing.core.errors import Unsuitable
from processing.core.text import Text
from processing.formats.sheets.paper_shapes import PaperPlace

PAPERS_MM = {
    "A0": (1189.0, 841.0),
    "A1": (841.0, 594.0),
    "A2": (594.0, 420.0),
    "A3": (420.0, 297.0),
}
"""Width and height, landscape (ISO 216)."""

_COLUMNS_MM = {"A0": 170.0, "A1": 140.0, "A2": 110.0, "A3": 90.0}
_MARGINS_MM = {"A0": 20.0, "A1": 20.0, "A2": 10.0, "A3": 10.0}  # CAD製図基準
_EDGE_MM = 9.0
"""Around the window, for coordinates at the grid's lines."""
_STEP_MM = 50.0
"""The window's sides are multiples, so that sheets of a grid begin at round coordinates."""


@dataclass(frozen=True)
class SheetLayout:
    """Where things are on the paper.

    Attributes
    ----------
    paper : (float, float)
        Width and height.
    frame_low, frame_size : (float, float)
        Of the frame around everything.
    window_low, window_size : (float, float)
        Of the map.
    column_low, column_size : (float, float)
        Of title block, legend and the rest, on the right within the frame.
    """

    paper: PaperPlace
    frame_low: PaperPlace
    frame_size: PaperPlace
    window_low: PaperPlace
    window_size: PaperPlace
    column_low: PaperPlace
    column_size: PaperPlace

    @property
    def window_centre(self) -> PaperPlace:
        """Middle of the map's window."""
        (x, y), (width, height) = self.window_low, self.window_size
        return x + width / 2, y + height / 2


def layout_of(paper: str, window_mm: PaperPlace | None = None) -> SheetLayout:
    """The layout of a paper of :data:`PAPERS_MM`.

    Parameters
    ----------
    window_mm : (float, float) or None
        Size that the map's window must have; as large as there is room for where None.

    Raises
    ------
    Unsuitable
        The paper has no room for the window.
    """
    width, height = PAPERS_MM[paper]
    margin, column = _MARGINS_MM[paper], _COLUMNS_MM[paper]
    frame = (width - 2 * margin, height - 2 * margin)
    room = (frame[0] - column - 2 * _EDGE_MM, frame[1] - 2 * _EDGE_MM)
    window = window_mm or (room[0] // _STEP_MM * _STEP_MM, room[1] // _STEP_MM * _STEP_MM)
    if window[0] > room[0] or window[1] > room[1]:
        raise Unsuitable(
            Text(
                "A sheet of the map grid has no room on the paper.",
                "国土基本図の図郭がこの用紙に収まりません。",
            ),
            Text(
                f"{paper}: {window[0]:.0f} × {window[1]:.0f} mm",
                f"{paper}（図郭 {window[0]:.0f} × {window[1]:.0f} mm）",
            ),
            Text(
                "Choose the paper A0, or the plain grid; nothing was written.",
                "用紙をA0にするか、分割を任意の格子にしてください。何も書き込まれていません。",
            ),
        )
    low = (
        margin + _EDGE_MM + (room[0] - window[0]) / 2,
        margin + _EDGE_MM + (room[1] - window[1]) / 2,
    )
    return SheetLayout(
        (width, height), (margin, margin), frame, low, window,
        (width - margin - column, margin), (column, frame[1]),
    )  # fmt: skip
