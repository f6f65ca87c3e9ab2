"""Sections of earthwork as DXF: both grounds at every station, cut and fill, laid out as a sheet.

Drawn in metres at their own scale: in each section x is the offset to the right of the line, y
the height above the section's datum line times the vertical exaggeration. As road offices lay
them out, stations go up a column, then on in the next one to the right.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
import shapely

from processing.core.arrays import Floats
from processing.core.errors import OutOfRange, Unsuitable
from processing.core.monitor import Monitor, SilentMonitor
from processing.core.safe_write import write_safely
from processing.core.text import Language, Text
from processing.formats.drawings.drawing_scale import (
    decimals_of,
    fitting_scale,
    grid_step,
    round_down_to,
)
from processing.formats.drawings.dxf_document import DxfDocument, PlanVersion
from processing.formats.drawings.dxf_fills import Ink, add_areas
from processing.methods.earthwork.sections.drawing_parts import (
    DrawnSection,
    earth_moved,
    parts_with_ground,
)

BEFORE_LAYER, AFTER_LAYER = "横断_地盤線_前", "横断_地盤線_後"
CUT_LAYER, FILL_LAYER = "横断_切土", "横断_盛土"
GRID_LAYER, FRAME_LAYER, AXIS_LAYER = "横断_方眼", "横断_枠", "横断_中心線"
TEXT_LAYER, TITLE_LAYER = "横断_文字", "横断_表題"

_LAYERS = {
    CUT_LAYER: Ink(151, (169, 207, 233)),
    FILL_LAYER: Ink(31, (253, 212, 158)),
    GRID_LAYER: Ink(9, (215, 215, 215)),
    FRAME_LAYER: Ink(7),
    AXIS_LAYER: Ink(8, (110, 110, 110)),
    BEFORE_LAYER: Ink(8, (90, 90, 90)),
    AFTER_LAYER: Ink(1, (200, 0, 0)),
    TEXT_LAYER: Ink(7),
    TITLE_LAYER: Ink(7),
}
_TEXT_M = 0.0025
_GRID_M = 0.01
_MARGIN_M = 0.005
_ROOM_M = (0.25, 0.25)
"""What a section may take on paper where the scale is chosen."""

_LEFT_TEXTS, _RIGHT_TEXTS, _ABOVE_TEXTS, _BELOW_TEXTS = 7.0, 3.0, 6.0, 3.0
"""Room round a frame, in heights of a text."""

_SHEET_RATIO = 1.4


@dataclass(frozen=True)
class SectionStyle:
    """How sections are drawn.

    Attributes
    ----------
    scale : int
        To be printed 1 : scale in plan; 0 for the largest at which a section has 25 cm.
    exaggeration : float
        How many times heights are drawn larger than offsets.
    names : (Text, Text)
        Of the earlier and the later ground, for the legend.
    version : {"R2000", "R2018"}
        AC1015 in cp932, or AC1032 in UTF-8.
    language : {"en", "ja"}
        Of the texts; layers are Japanese.
    """

    scale: int = 0
    exaggeration: float = 1.0
    names: tuple[Text, Text] = (Text("Before", "着手前"), Text("After", "施工後"))
    version: PlanVersion = "R2018"
    language: Language = "ja"


def write_section_sheet_dxf(
    path: Path,
    sections: Iterable[DrawnSection],
    title: Text,
    look: SectionStyle | None = None,
    *,
    monitor: Monitor | None = None,
    never: Iterable[Path] = (),
) -> None:
    """Draw sections with their cut and fill.

    Parameters
    ----------
    sections : iterable of DrawnSection
        In the order of their stations; one without ground is left out.
    never : iterable of Path
        Files that must not be overwritten.

    Raises
    ------
    OutOfRange
        The scale or the exaggeration is not positive, or there is no such version.
    Unsuitable
        No section has ground.
    UserError
        What :func:`processing.core.safe_write.write_safely` raises; `Cancelled`.
    """
    look = look or SectionStyle()
    if look.scale < 0 or not 0.0 < look.exaggeration < math.inf:
        raise OutOfRange(
            Text("Sections can't be drawn at this scale.", "この縮尺では断面図を作図できません。"),
            Text.same(f"1:{look.scale}, ×{look.exaggeration}"),
            Text("Give positive numbers.", "正の値を指定してください。"),
        )
    drawn = [one for one in sections if len(_heights(one))]
    if not drawn:
        raise Unsuitable(
            Text("No section has ground.", "地盤のある断面がありません。"),
            Text.same(str(path)),
            Text(
                "Place the line where both grounds were measured.",
                "両時期の地盤が計測されている位置に測線を引いてください。",
            ),
        )
    monitor = monitor or SilentMonitor()
    sheet = _Sheet(drawn, look)
    sheet.draw(drawn, title, monitor)
    with write_safely(path, never=never) as temporary:
        sheet.document.write(temporary, monitor)


@dataclass(frozen=True)
class _Layout:
    """What all sections of a sheet have in common, in metres of the drawing.

    Attributes
    ----------
    step_x, step_y : float
        Of the grid, in offset and height.
    left, right : float
        Offsets at the ends of a frame.
    rows : int
        Steps of height in a frame.
    margin : float
        Least room below and above the ground, as a height.
    """

    scale: int
    exaggeration: float
    text_m: float
    step_x: float
    step_y: float
    left: float
    right: float
    rows: int
    margin: float

    @property
    def size(self) -> tuple[float, float]:
        """Of a frame."""
        return self.right - self.left, self.rows * self.step_y * self.exaggeration

    @property
    def pitch(self) -> tuple[float, float]:
        """From one section to the next, to the right and up."""
        width, height = self.size
        return (
            width + (_LEFT_TEXTS + _RIGHT_TEXTS) * self.text_m,
            height + (_ABOVE_TEXTS + _BELOW_TEXTS) * self.text_m,
        )


def _layout(sections: list[DrawnSection], look: SectionStyle) -> _Layout:
    left = min(float(one.offsets[0]) for one in sections)
    right = max(float(one.offsets[-1]) for one in sections)
    high = max(float(np.ptp(_heights(one))) for one in sections)
    scale = look.scale or fitting_scale((right - left, high * look.exaggeration), _ROOM_M)
    step_x = grid_step(_GRID_M * scale)
    step_y = grid_step(_GRID_M * scale / look.exaggeration)
    margin = _MARGIN_M * scale / look.exaggeration
    return _Layout(
        scale,
        look.exaggeration,
        _TEXT_M * scale,
        step_x,
        step_y,
        round_down_to(left, step_x),
        -round_down_to(-right, step_x),
        # One more, since the lowest place seldom lies on a line of the grid.
        math.ceil((high + 2 * margin) / step_y) + 1,
        margin,
    )


class _Sheet:
    """A sheet being drawn."""

    def __init__(self, sections: list[DrawnSection], look: SectionStyle) -> None:
        self._look = look
        self._layout = _layout(sections, look)
        self.document = DxfDocument.of_plan(look.version)
        self._space = self.document.space
        for layer, ink in _LAYERS.items():
            self.document.add_layer(layer, ink.aci, ink.rgb)
        self.document.doc.layers.get(AFTER_LAYER).dxf.lineweight = 30  # 1/100 mm

    def draw(self, sections: list[DrawnSection], title: Text, monitor: Monitor) -> None:
        """Draw all sections, then what is said of them together."""
        count = len(sections)
        width, height = self._layout.pitch
        down = max(1, min(count, round(math.sqrt(count * width / height / _SHEET_RATIO))))
        for number, section in enumerate(sections):
            monitor.check()
            column, row = divmod(number, down)
            self._draw_section(section, (column * width, row * height))
        top = self._draw_title(title, down * height)
        self.document.show((0.0, 0.0), (-(-count // down) * width, top))

    def _draw_section(self, section: DrawnSection, corner: tuple[float, float]) -> None:
        layout = self._layout
        datum = round_down_to(float(_heights(section).min()) - layout.margin, layout.step_y)
        x = corner[0] + _LEFT_TEXTS * layout.text_m
        y = corner[1] + _BELOW_TEXTS * layout.text_m
        self._draw_grid((x, y), datum)

        def placed(line: Floats) -> Floats:
            shifted: Floats = (line - [layout.left, datum]) * [1.0, layout.exaggeration] + [x, y]
            return shifted

        for is_cut, outline in earth_moved(section):
            area = shapely.Polygon(placed(outline))
            add_areas(self._space, [area], CUT_LAYER if is_cut else FILL_LAYER)
        for layer, heights in ((BEFORE_LAYER, section.before), (AFTER_LAYER, section.after)):
            for part in parts_with_ground(section.offsets, heights):
                self._space.add_lwpolyline(placed(part).tolist(), dxfattribs={"layer": layer})
        self._draw_words(section, (x, y + layout.size[1]))

    def _draw_grid(self, low: tuple[float, float], datum: float) -> None:
        """Frame, grid, heights on the left, offsets below, the line's own place."""
        layout = self._layout
        (x, y), (width, height) = low, layout.size
        for number in range(layout.rows + 1):
            at = y + number * layout.step_y * layout.exaggeration
            self._line((x, at), (x + width, at), GRID_LAYER)
            words = f"{datum + number * layout.step_y:.{max(1, decimals_of(layout.step_y))}f}"
            position = (x - layout.text_m / 2, at)
            self._write(words if number else f"DL={words}", position, "MIDDLE_RIGHT")
        for number in range(round(width / layout.step_x) + 1):
            at = x + number * layout.step_x
            self._line((at, y), (at, y + height), GRID_LAYER)
            # Without a minus before zero.
            offset = round(layout.left + number * layout.step_x, 6) + 0.0
            words = f"{offset:.{decimals_of(layout.step_x)}f}"
            self._write(words, (at, y - layout.text_m), "TOP_CENTER")
        corners = [(x, y), (x + width, y), (x + width, y + height), (x, y + height)]
        for start, end in pairwise([*corners, corners[0]]):
            self._line(start, end, FRAME_LAYER)
        if layout.left <= 0.0 <= layout.right:
            at = x - layout.left
            self._line((at, y), (at, y + height + layout.text_m / 2), AXIS_LAYER)

    def _draw_words(self, section: DrawnSection, corner: tuple[float, float]) -> None:
        """Name, station and areas above the frame."""
        size = self._layout.text_m
        areas = Text(
            "Cut {cut:.2f} m², fill {fill:.2f} m²", "切土 {cut:.2f} m²　盛土 {fill:.2f} m²"
        )
        station = Text("{name}  (station {m:.2f} m)", "{name}　（測点 {m:.2f} m）")
        lines = (
            areas.filled(cut=section.cut_m2, fill=section.fill_m2),
            station.filled(name=section.name, m=section.station_m),
        )
        for number, line in enumerate(lines):
            position = (corner[0], corner[1] + (1.0 + 1.8 * number) * size)
            self._write(self._in_language(line), position, "LEFT")

    def _draw_title(self, title: Text, bottom: float) -> float:
        """Write title, scales and what the lines are above all sections; gives the upper end."""
        look, size, scale = self._look, self._layout.text_m, self._layout.scale
        scales = Text(
            "Horizontal 1:{scale}, vertical 1:{heights:g}", "縮尺 横1:{scale}　縦1:{heights:g}"
        ).filled(scale=scale, heights=scale / look.exaggeration)
        x, y = _LEFT_TEXTS * size, bottom + 2 * size
        for layer, name in zip((BEFORE_LAYER, AFTER_LAYER), look.names, strict=True):
            self._line((x, y + size / 2), (x + 6 * size, y + size / 2), layer)
            self._write(self._in_language(name), (x + 7 * size, y), "LEFT", layer=TITLE_LAYER)
            x += (10 + len(self._in_language(name))) * size
        for number, words in enumerate((scales, title), 1):
            position = (_LEFT_TEXTS * size, y + 2 * number * size)
            self._write(self._in_language(words), position, "LEFT", layer=TITLE_LAYER)
        return y + 7 * size

    def _line(self, start: tuple[float, float], end: tuple[float, float], layer: str) -> None:
        self._space.add_line(start, end, dxfattribs={"layer": layer})

    def _write(
        self, words: str, position: tuple[float, float], align: str, *, layer: str = TEXT_LAYER
    ) -> None:
        looks = {"layer": layer, "height": self._layout.text_m}
        self.document.write_text(words, position, align, looks)

    def _in_language(self, text: Text) -> str:
        return text.in_language(self._look.language)


def _heights(section: DrawnSection) -> Floats:
    """All heights of a section that are drawn."""
    grounds = (section.before, section.after)
    parts = [part for one in grounds for part in parts_with_ground(section.offsets, one)]
    return np.concatenate([np.empty(0), *(part[:, 1] for part in parts)])
