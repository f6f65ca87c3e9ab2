"""The plan of earthwork as DXF: change in colours with its legend, contours, boundary, volumes.

Drawn at its place in metres, x east and y north; texts have their size at the printed scale.
Layers are those of the CAD drafting standard of public works for contours (S-BGD-HICN,
S-BGD-LWCN), and plain words for what it does not name.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from processing.core.arrays import Floats
from processing.core.errors import Unsuitable
from processing.core.monitor import Monitor, SilentMonitor
from processing.core.safe_write import write_safely
from processing.core.text import Language, Text
from processing.formats.drawings.drawing_scale import fitting_scale, grid_step
from processing.formats.drawings.dxf_document import DxfDocument, PlanVersion
from processing.formats.drawings.dxf_fills import Ink, add_areas, add_box, inks_of
from processing.methods.earthwork.maps.change_grid import ChangeGrid
from processing.methods.earthwork.maps.class_areas import class_areas
from processing.methods.earthwork.maps.contours import LevelLine
from processing.methods.earthwork.maps.heat_map import ColourClass

INDEX_LAYER, CONTOUR_LAYER = "S-BGD-HICN_計曲線", "S-BGD-LWCN_主曲線"
LABEL_LAYER = "S-BGD-HICN_計曲線_文字"
CHANGE_LAYER, UNMEASURED_LAYER = "切盛", "切盛_未計測"
"""Layers of change are numbered from the lowest class, and say its limits."""
BOUNDARY_LAYER = "土量計算範囲"
LEGEND_LAYER, TITLE_LAYER = "切盛_凡例", "切盛_表題"

_ROOM_M = (0.30, 0.23)
"""Of the map on a sheet of A3, beside its legend and below its title."""

_TEXT_M, _LABEL_M = 0.0025, 0.0018
_GAP_M, _ROW_M, _BOX_M = 0.008, 0.006, (0.010, 0.005)
_LABEL_EVERY_M = 0.15
_LEAST_LABELLED_M = 0.03
_LINES_M = 0.003
_BAR_M = 0.04
_CHECK_EVERY = 64


_INDEX, _CONTOUR = Ink(34, (110, 60, 15)), Ink(32, (150, 90, 40))
_BOUNDARY, _BLACK, _GREY = Ink(1, (220, 0, 0)), Ink(7), Ink(8, (120, 120, 120))
_WHITE_ACI = 255


@dataclass(frozen=True)
class PlanStyle:
    """How the plan is drawn.

    Attributes
    ----------
    scale : int
        To be printed 1 : scale, which texts follow; 0 for the largest at which A3 has room.
    version : {"R2000", "R2018"}
        AC1015 in cp932, or AC1032 in UTF-8.
    language : {"en", "ja"}
        Of the texts; layers are Japanese.
    """

    scale: int = 0
    version: PlanVersion = "R2018"
    language: Language = "ja"


@dataclass(frozen=True)
class EarthworkPlan:
    """What is drawn; any part may be missing, but not all.

    Attributes
    ----------
    title : tuple of Text
        Lines above the map: the work, dates, volumes.
    change : ChangeGrid or None
        Filled with the colours of ``classes``.
    boundary : tuple of (n, 2) float64
        Rings, m, project CRS; the first place is not repeated.
    crs : str
        ``EPSG:n``, or empty when unknown.
    """

    title: tuple[Text, ...] = ()
    change: ChangeGrid | None = None
    classes: tuple[ColourClass, ...] = ()
    contours: tuple[LevelLine, ...] = ()
    boundary: tuple[Floats, ...] = ()
    crs: str = ""


def write_earthwork_dxf(
    path: Path,
    plan: EarthworkPlan,
    look: PlanStyle | None = None,
    *,
    monitor: Monitor | None = None,
    never: Iterable[Path] = (),
) -> None:
    """Draw the plan of a volume.

    Parameters
    ----------
    never : iterable of Path
        Files that must not be overwritten.

    Raises
    ------
    OutOfRange
        There is no such version.
    Unsuitable
        There is nothing to draw.
    UserError
        What :func:`processing.core.safe_write.write_safely` raises; `Cancelled`.

    References
    ----------
    MLIT, CAD drafting standard: layers of contours in plans.
    """
    monitor = monitor or SilentMonitor()
    sheet = _Sheet(plan, look or PlanStyle(), path)
    sheet.draw(monitor)
    with write_safely(path, never=never) as temporary:
        sheet.document.write(temporary, monitor)


class _Sheet:
    """A plan being drawn."""

    def __init__(self, plan: EarthworkPlan, look: PlanStyle, path: Path) -> None:
        self._plan = plan
        self._look = look
        self.document = DxfDocument.of_plan(look.version)
        self.document.tell_system(plan.crs)
        self._space = self.document.space
        self._low, self._high = _extent(plan, path)
        self._scale = look.scale or fitting_scale((self._high - self._low).tolist(), _ROOM_M)
        self._text_m = _TEXT_M * self._scale

    def draw(self, monitor: Monitor) -> None:
        """Draw everything, from below to above."""
        plan = self._plan
        legend = self._draw_change(monitor)
        self._draw_contours(monitor)
        if plan.boundary:
            self.document.add_layer(BOUNDARY_LAYER, _BOUNDARY.aci, _BOUNDARY.rgb)
            for ring in plan.boundary:
                looks = {"layer": BOUNDARY_LAYER}
                self._space.add_lwpolyline(ring.tolist(), close=True, dxfattribs=looks)
        self.document.add_layer(TITLE_LAYER, _BLACK.aci)
        self.document.add_layer(LEGEND_LAYER, _BLACK.aci)
        right, bottom = self._draw_legend(legend)
        top = self._draw_title()
        self._draw_north()
        low = (float(self._low[0]), min(float(self._low[1]), bottom))
        self.document.show(low, (right, top))

    def _draw_change(self, monitor: Monitor) -> list[tuple[str, str]]:
        """Fill the map; gives layer and words of each class, lowest first."""
        plan = self._plan
        if plan.change is None:
            return []
        monitor.check()
        areas = class_areas(plan.change, plan.classes)
        rows = []
        digits = _digits(plan.classes)
        inks = inks_of([one.rgb for one in plan.classes])
        for number, (one, ink) in enumerate(zip(plan.classes, inks, strict=True)):
            words = one.label(digits, "m")
            layer = f"{CHANGE_LAYER}{number + 1}_{_as_layer(words.ja)}"
            self.document.add_layer(layer, ink.aci, ink.rgb)
            rows.append((layer, self._in_language(words)))
            monitor.check()
            add_areas(self._space, areas.of_class.get(number, []), layer)
        if areas.unmeasured:
            self.document.add_layer(UNMEASURED_LAYER, _GREY.aci, _GREY.rgb)
            add_areas(
                self._space, areas.unmeasured, UNMEASURED_LAYER, lines_m=_LINES_M * self._scale
            )
            rows.insert(
                0, (UNMEASURED_LAYER, self._in_language(Text("not measured", "未計測（補間）")))
            )
        return rows

    def _draw_contours(self, monitor: Monitor) -> None:
        contours = self._plan.contours
        if not contours:
            return
        for layer, ink in {
            INDEX_LAYER: _INDEX,
            CONTOUR_LAYER: _CONTOUR,
            LABEL_LAYER: _INDEX,
        }.items():
            self.document.add_layer(layer, ink.aci, ink.rgb)
        self.document.doc.layers.get(INDEX_LAYER).dxf.lineweight = 30  # 1/100 mm
        digits = max((_digits_of(one.level_m) for one in contours if one.is_index), default=0)
        for number, one in enumerate(contours):
            if number % _CHECK_EVERY == 0:
                monitor.check()
            layer = INDEX_LAYER if one.is_index else CONTOUR_LAYER
            self._space.add_lwpolyline(
                one.xyz[: len(one.xyz) - one.is_closed, :2].tolist(),
                close=one.is_closed,
                dxfattribs={"layer": layer, "elevation": one.level_m},
            )
            if one.is_index:
                self._label(one, f"{one.level_m:.{digits}f}")

    def _label(self, contour: LevelLine, words: str) -> None:
        """Write a contour's height along it, upright; over colours on a plate of white."""
        steps = np.hypot(*np.diff(contour.xyz[:, :2], axis=0).T)
        along = np.append(0.0, np.cumsum(steps))
        length = float(along[-1])
        if length < _LEAST_LABELLED_M * self._scale:
            return
        count = max(1, round(length / (_LABEL_EVERY_M * self._scale)))
        height = _LABEL_M * self._scale
        half = 0.4 * height * len(words)
        for number in range(count):
            at = length * (number + 0.5) / count
            start, end, middle = (
                np.array([np.interp(position, along, contour.xyz[:, axis]) for axis in (0, 1)])
                for position in (max(at - half, 0.0), min(at + half, length), at)
            )
            direction = math.atan2(*(end - start)[::-1])
            if not -math.pi / 2 < direction <= math.pi / 2:
                direction += math.pi
            right = np.array([math.cos(direction), math.sin(direction)])
            up = np.array([-right[1], right[0]])
            if self._plan.change is None:
                middle = middle + 0.75 * height * up
            else:
                self._draw_plate(middle, half * right, 0.7 * height * up, contour.level_m)
            looks = {
                "layer": LABEL_LAYER,
                "height": height,
                "rotation": math.degrees(direction) % 360.0,
            }
            position = (*middle.tolist(), contour.level_m)
            self.document.write_text(words, position, "MIDDLE_CENTER", looks)

    def _draw_plate(self, middle: Floats, right: Floats, up: Floats, height_m: float) -> None:
        corners = [(sign * right + side * up) for side in (-1, 1) for sign in (-1, 1)]
        looks = {"layer": LABEL_LAYER, "color": _WHITE_ACI}
        self._space.add_solid(
            [(*(middle + corner).tolist(), height_m) for corner in corners], dxfattribs=looks
        )

    def _draw_legend(self, rows: list[tuple[str, str]]) -> tuple[float, float]:
        """Write what the colours say, right of the map; gives its right and lower end."""
        gap, row = _GAP_M * self._scale, _ROW_M * self._scale
        width, height = (side * self._scale for side in _BOX_M)
        left, top = float(self._high[0]) + gap, float(self._high[1])
        if rows:
            title = Text("Change in height (+ fill, − cut)", "標高差（＋盛土 −切土）")
            self._write(self._in_language(title), (left, top), "TOP_LEFT", layer=LEGEND_LAYER)
            top -= 2 * self._text_m
        for number, (layer, words) in enumerate(reversed(rows)):
            low = (left, top - number * row - height)
            lines_m = _LINES_M * self._scale if layer == UNMEASURED_LAYER else 0.0
            add_box(self._space, low, (width, height), (layer, LEGEND_LAYER), lines_m=lines_m)
            position = (left + width + self._text_m, low[1] + height / 2)
            self._write(words, position, "MIDDLE_LEFT", layer=LEGEND_LAYER)
        bottom = top - len(rows) * row
        self._draw_bar((left, bottom - 2 * row))
        return left + 0.07 * self._scale, bottom - 4 * row

    def _draw_bar(self, position: tuple[float, float]) -> None:
        length = grid_step(_BAR_M * self._scale / 2.5)
        x, y = position
        tick = self._text_m / 2
        for number in range(3):
            at = x + number * length
            self._line((at, y), (at, y + tick))
            self._write(f"{number * length:g}", (at, y - tick), "TOP_CENTER", layer=LEGEND_LAYER)
        self._line((x, y), (x + 2 * length, y))
        self._write("m", (x + 2 * length + 2 * self._text_m, y), "BOTTOM_LEFT", layer=LEGEND_LAYER)

    def _draw_north(self) -> None:
        """An arrow above the legend."""
        x = float(self._high[0]) + _GAP_M * self._scale + self._text_m
        y = float(self._high[1]) + self._text_m
        top = y + 4 * self._text_m
        self._line((x, y), (x, top))
        for side in (-1, 1):
            self._line((x, top), (x + side * self._text_m / 2, top - 1.5 * self._text_m))
        self._write("N", (x, top + self._text_m / 2), "BOTTOM_CENTER", layer=LEGEND_LAYER)

    def _draw_title(self) -> float:
        """Write the lines above the map; gives their upper end."""
        crs = self._plan.crs or Text("unknown", "不明")
        last = Text("Coordinate system {crs}, scale 1:{scale}", "座標系 {crs}　縮尺 1:{scale}")
        lines = [*self._plan.title, last.filled(crs=crs, scale=self._scale)]
        y = float(self._high[1]) + 2 * self._text_m
        for line in reversed(lines):
            self._write(
                self._in_language(line), (float(self._low[0]), y), "LEFT", layer=TITLE_LAYER
            )
            y += 1.8 * self._text_m
        return max(y, float(self._high[1]) + 8 * self._text_m)

    def _line(self, start: tuple[float, float], end: tuple[float, float]) -> None:
        self._space.add_line(start, end, dxfattribs={"layer": LEGEND_LAYER})

    def _write(self, words: str, position: tuple[float, float], align: str, *, layer: str) -> None:
        self.document.write_text(words, position, align, {"layer": layer, "height": self._text_m})

    def _in_language(self, text: Text) -> str:
        return text.in_language(self._look.language)


def _extent(plan: EarthworkPlan, path: Path) -> tuple[Floats, Floats]:
    parts = [*plan.boundary, *(one.xyz[:, :2] for one in plan.contours)]
    if plan.change is not None:
        rows, columns = np.nonzero(np.isfinite(plan.change.change_m))
        if len(rows):
            grid = plan.change.grid
            cells = np.array([[columns.min(), rows.min()], [columns.max() + 1, rows.max() + 1]])
            parts.append(grid.origin[:2] + cells * grid.size_m)
    if not parts:
        raise Unsuitable(
            Text(
                "There is no change, no contour and no boundary to draw.",
                "作図する標高差・等高線・範囲がありません。",
            ),
            Text.same(str(path)),
            Text("Compute the volume first.", "先に土量を計算してください。"),
        )
    positions = np.concatenate(parts)
    return positions.min(axis=0), positions.max(axis=0)


def _digits(classes: tuple[ColourClass, ...]) -> int:
    """Digits that tell every limit of the classes, at least whole centimetres."""
    bounds = [one.low for one in classes if math.isfinite(one.low)]
    return max(2, *map(_digits_of, bounds)) if bounds else 2


def _digits_of(value: float) -> int:
    """Digits behind the point, at most four."""
    return next((count for count in range(4) if abs(round(value, count) - value) < 1e-9), 4)


def _as_layer(words: str) -> str:
    """Words as a layer's name: without blanks, in characters that cp932 has."""
    return words.replace("−", "-").replace(" … ", "～").replace(" ", "")
