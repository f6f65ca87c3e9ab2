"""A section as DXF: its ground line with heights, what crosses it, grid, scales and title.

Drawn in metres: x is the offset to the right of the section's middle, y the height above the
datum line times the vertical exaggeration.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from processing.core.errors import OutOfRange, Unsuitable
from processing.core.monitor import SilentMonitor
from processing.core.safe_write import write_safely
from processing.core.text import Language, Text
from processing.formats.drawings.drawing_scale import decimals_of, grid_step, round_down_to
from processing.formats.drawings.dxf_document import DxfDocument, PlanVersion
from processing.section.profile import Crossing, SectionProfile

GROUND_LAYER, POINT_LAYER = "断面_地盤線", "断面_点群"
GRID_LAYER, TEXT_LAYER, TITLE_LAYER = "断面_方眼", "断面_文字", "断面_表題"

_LAYERS: Mapping[str, int] = {  # AutoCAD colour indices
    GROUND_LAYER: 7,
    POINT_LAYER: 8,
    GRID_LAYER: 9,
    TEXT_LAYER: 7,
    TITLE_LAYER: 7,
}
_TEXT_M = 0.0025
"""Height of texts on paper."""

_GRID_M = 0.01
"""Lines of the grid are at least so far apart on paper."""

_MARGIN_M = 0.5
"""So much is shown below and above what is drawn."""


@dataclass(frozen=True)
class ProfileStyle:
    """How a profile is drawn.

    Attributes
    ----------
    scale : int
        The drawing is to be printed 1 : scale in plan; texts and grid follow it.
    exaggeration : float
        How many times heights are drawn larger than offsets.
    has_points : bool
        Whether the measured points are drawn below the ground line.
    version : {"R2000", "R2018"}
        AC1015 in cp932, or AC1032 in UTF-8.
    language : {"en", "ja"}
        Of the texts.
    """

    scale: int = 100
    exaggeration: float = 1.0
    has_points: bool = True
    version: PlanVersion = "R2018"
    language: Language = "ja"


def write_profile_dxf(
    path: Path,
    profile: SectionProfile,
    look: ProfileStyle | None = None,
    *,
    never: Iterable[Path] = (),
) -> None:
    """Draw a section.

    Parameters
    ----------
    never : iterable of Path
        Files that must not be overwritten.

    Raises
    ------
    OutOfRange
        A scale isn't positive.
    Unsuitable
        The section shows no ground.
    UserError
        What :func:`processing.core.safe_write.write_safely` raises.
    """
    look = look or ProfileStyle()
    if not (look.scale > 0 and look.exaggeration > 0 and math.isfinite(look.exaggeration)):
        raise OutOfRange(
            Text("A profile can't be drawn at this scale.", "この縮尺では断面図を作図できません。"),
            Text.same(f"1:{look.scale}, ×{look.exaggeration}"),
            Text("Give positive numbers.", "正の値を指定してください。"),
        )
    if not profile.ground:
        raise Unsuitable(
            Text("The section shows no ground.", "断面内に地盤の点がありません。"),
            profile.title,
            Text(
                "Make the section wider, or place it where points were measured.",
                "断面の幅を広げるか、点が計測されている位置に断面を移してください。",
            ),
        )
    sheet = _Sheet(profile, look)
    sheet.draw()
    with write_safely(path, never=never) as temporary:
        sheet.document.write(temporary, SilentMonitor())


class _Sheet:
    """A drawing being filled."""

    def __init__(self, profile: SectionProfile, look: ProfileStyle) -> None:
        self._profile = profile
        self._look = look
        self.document = DxfDocument.of_plan(look.version)
        self._layers, self._space = self.document.doc.layers, self.document.space
        for layer, colour in _LAYERS.items():
            self._layers.add(layer, color=colour)
        self._text_m = _TEXT_M * look.scale
        ground = np.concatenate(profile.ground)
        heights = [*ground[:, 1].tolist(), *(one.height_m for one in profile.crossings)]
        self._step_x = grid_step(_GRID_M * look.scale)
        self._step_y = grid_step(_GRID_M * look.scale / look.exaggeration)
        self._left = round_down_to(min(ground[0, 0], self._least_offset), self._step_x)
        self._right = -round_down_to(-max(ground[-1, 0], self._most_offset), self._step_x)
        self._datum = round_down_to(min(heights) - _MARGIN_M, self._step_y)
        self._top = -round_down_to(-max(heights) - _MARGIN_M, self._step_y)

    @property
    def _least_offset(self) -> float:
        return min((one.offset_m for one in self._profile.crossings), default=math.inf)

    @property
    def _most_offset(self) -> float:
        return max((one.offset_m for one in self._profile.crossings), default=-math.inf)

    def draw(self) -> None:
        """Draw everything."""
        self._draw_grid()
        if self._look.has_points:
            self._draw_points()
        for part in self._profile.ground:
            positions = [(x, self._y(height)) for x, height in part.tolist()]
            self._space.add_lwpolyline(positions, dxfattribs={"layer": GROUND_LAYER})
        for crossing in self._profile.crossings:
            self._draw_crossing(crossing)
        self._draw_title()
        low, high = (self._left, self._below(4)), (self._right, self._y(self._top))
        self.document.show(low, high)

    def _y(self, height_m: float) -> float:
        return (height_m - self._datum) * self._look.exaggeration

    def _below(self, lines: float) -> float:
        return -lines * 1.8 * self._text_m

    def _draw_grid(self) -> None:
        top = self._y(self._top)
        for number in range(round((self._top - self._datum) / self._step_y) + 1):
            height = self._datum + number * self._step_y
            self._line((self._left, self._y(height)), (self._right, self._y(height)))
            words = f"{height:.{decimals_of(self._step_y)}f}"
            position = self._left - self._text_m / 2, self._y(height)
            self._write(words if number else f"DL={words}", position, "MIDDLE_RIGHT")
        for number in range(round((self._right - self._left) / self._step_x) + 1):
            offset = self._left + number * self._step_x
            self._line((offset, 0.0), (offset, top))
            words = f"{offset:.{decimals_of(self._step_x)}f}"
            self._write(words, (offset, self._below(0.7)), "MIDDLE_CENTER")
            ground_m = self._profile.ground_at(offset)
            if ground_m is not None:
                position = offset, self._below(1.3)
                self._write(f"{ground_m:.3f}", position, "MIDDLE_RIGHT", rotation_deg=90.0)
        names = {0.7: Text("Offset", "離れ"), 2.4: Text("Ground", "地盤高")}
        for lines, name in names.items():
            position = self._left - 1.5 * self._text_m, self._below(lines)
            self._write(self._in_language(name), position, "MIDDLE_RIGHT")

    def _draw_points(self) -> None:
        for offset, height in self._profile.points.tolist():
            if self._datum <= height <= self._top and self._left <= offset <= self._right:
                self._space.add_point((offset, self._y(height)), dxfattribs={"layer": POINT_LAYER})

    def _draw_crossing(self, crossing: Crossing) -> None:
        layer = crossing.layer
        if layer not in self._layers:
            self.document.require_encodable(layer)
            self._layers.add(layer, color=crossing.aci)
        looks = {"layer": layer}
        position = crossing.offset_m, self._y(crossing.height_m)
        head = position[0], position[1] + 4 * self._text_m
        self._space.add_circle(position, self._text_m / 2, dxfattribs=looks)
        self._space.add_line((position[0], position[1] + self._text_m / 2), head, dxfattribs=looks)
        words = f"{self._in_language(crossing.name)} {crossing.height_m:.3f}"
        head = head[0], head[1] + self._text_m / 2
        self._write(words, head, "MIDDLE_LEFT", layer=layer, rotation_deg=90.0)

    def _draw_title(self) -> None:
        look, cut = self._look, self._profile.cut
        heights = look.scale / look.exaggeration
        lines = [
            self._in_language(self._profile.title),
            self._in_language(
                Text(
                    "Plan 1:{scale}, heights 1:{heights:g}; DL={datum} m; slab {width:.2f} m",
                    "縮尺 横1:{scale} 縦1:{heights:g}　DL={datum} m　断面の幅 {width:.2f} m",
                ).filled(
                    scale=look.scale,
                    heights=heights,
                    datum=f"{self._datum:.{decimals_of(self._step_y)}f}",
                    width=cut.width_m,
                )
            ),
            self._in_language(
                Text(
                    "Offset 0 at E {e:.3f}, N {n:.3f}; to the right at {azimuth:.4f}° from north",
                    "離れ0の位置 東距 {e:.3f} 北距 {n:.3f}　右方向の方位角 {azimuth:.4f}°",
                ).filled(e=cut.middle[0], n=cut.middle[1], azimuth=_azimuth_deg(cut.direction))
            ),
        ]
        if self._profile.station_m is not None:
            station = Text("Station {m:.3f} m", "測点 {m:.3f} m")
            lines.insert(1, self._in_language(station.filled(m=self._profile.station_m)))
        for number, words in enumerate(reversed([line for line in lines if line])):
            position = self._left, self._y(self._top) - self._below(number + 1)
            self._write(words, position, "LEFT", layer=TITLE_LAYER)

    def _line(self, start: tuple[float, float], end: tuple[float, float]) -> None:
        self._space.add_line(start, end, dxfattribs={"layer": GRID_LAYER})

    def _write(
        self,
        words: str,
        position: tuple[float, float],
        align: str,
        *,
        layer: str = TEXT_LAYER,
        rotation_deg: float = 0.0,
    ) -> None:
        attributes = {"layer": layer, "height": self._text_m, "rotation": rotation_deg}
        self.document.write_text(words, position, align, attributes)

    def _in_language(self, text: Text) -> str:
        return text.in_language(self._look.language)


def _azimuth_deg(direction: tuple[float, float]) -> float:
    return math.degrees(math.atan2(*direction)) % 360.0
