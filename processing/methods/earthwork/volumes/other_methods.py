"""Volumes from a map of change by the methods other than cells: triangles, and sections."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from processing.core.errors import Unsuitable
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.methods.earthwork.geometry.triangle_surface import TriangleSurface
from processing.methods.earthwork.geometry.triangulation import triangulate_ground
from processing.methods.earthwork.geometry.volume_scope import VolumeScope
from processing.methods.earthwork.maps.change_grid import ChangeGrid
from processing.methods.earthwork.sections.cross_sections import SectionLayout
from processing.methods.earthwork.sections.drawing_parts import SectionedLine
from processing.methods.earthwork.sections.drawn_sections import drawn_line, volumes_between
from processing.methods.earthwork.sections.end_areas import end_area_volume, prismoidal_volume
from processing.methods.earthwork.sections.height_surfaces import GridSurface
from processing.methods.earthwork.surfaces.sides import Side
from processing.methods.earthwork.volumes.tin_volume import volume_between
from processing.methods.earthwork.volumes.volume_parameters import PRISMOIDAL, TIN, VolumeParameters

Floats = NDArray[np.float64]

_LINE = "L1"
_ON_EDGE_M = 1e-3
"""Points so far outside a boundary are on it: files have whole millimetres."""

_SHOWN = 6
"""Sections that show a site in its report: two sheets."""

_ON_GROUND_M, _STEP_M = 0.3, 0.5
"""A break line lies on a ground when it is no farther from it in the median, asked at steps as wide
as the cells of holes. By trial: a line drawn on one date lies in the air on the other."""
_OFF_GROUND = Text(
    "Break line {number} lies on neither ground and was not used.",
    "ブレークライン{number}はどちらの地盤面にも載っていないため、使用していません。",
)
_NOISE_TWICE = Text(
    "Exact between the triangles: noise of the points counts in cut and in fill alike.",
    "三角網の間では厳密ですが、点のノイズは切土量にも盛土量にも加算されます。",
)


@dataclass(frozen=True)
class OtherMethod:
    """Cut and fill by another method.

    Attributes
    ----------
    line : SectionedLine or None
        Sections of the methods along a line.
    between : tuple of (float, float)
        Cut and fill stated at each of them but the first, m³.
    """

    cut_m3: float
    fill_m3: float
    notes: tuple[Text, ...] = ()
    line: SectionedLine | None = None
    between: tuple[tuple[float, float], ...] = ()


def volume_by(
    parameters: VolumeParameters,
    change: ChangeGrid,
    sides: tuple[Side, Side],
    monitor: Monitor,
    within: VolumeScope,
) -> OtherMethod:
    """Cut and fill by triangles or along a line, as the parameters say.

    Parameters
    ----------
    sides : (Side, Side)
        Of a design its own triangles count.

    Raises
    ------
    Unsuitable
        Break lines that contradict each other; a line without length or off the ground.
    """
    if parameters.method == TIN:
        return _by_triangles(change, sides, monitor, within)
    line = within.line if within.line is not None else _middle_line(change, within.boundary)
    along = SectionLayout(line, parameters.half_width_m, parameters.interval_m)
    grounds = GridSurface(change.grid, change.before), GridSurface(change.grid, change.after)
    by = prismoidal_volume if parameters.method == PRISMOIDAL else end_area_volume
    # A section right on the edge counts, as one that a line begins or ends with often is.
    area = None if within.boundary is None else within.boundary.buffer(_ON_EDGE_M)
    found = by(along, grounds, monitor, area)
    drawn = drawn_line(found, along, _LINE)
    return OtherMethod(found.cut_m3, found.fill_m3, found.notes, drawn, volumes_between(found))


def shown_sections(
    change: ChangeGrid, boundary: shapely.Geometry | None, monitor: Monitor
) -> SectionedLine | None:
    """A few sections across the whole site, to show it; None where none meets both grounds."""
    line, wide_m = _middle_of(change, boundary)
    long_m = float(np.hypot(*(line[1] - line[0])))
    if not (long_m > 0.0 and wide_m > 0.0):
        return None
    margin = (line[1] - line[0]) / (2 * _SHOWN)
    inner = np.stack([line[0] + margin, line[1] - margin])
    interval_m, half_m = long_m / _SHOWN, wide_m / 2
    along = SectionLayout(inner, half_m, interval_m, max(change.grid.size_m / 2, half_m / 1000))
    grounds = GridSurface(change.grid, change.before), GridSurface(change.grid, change.after)
    area = None if boundary is None else boundary.buffer(_ON_EDGE_M)
    try:
        return drawn_line(end_area_volume(along, grounds, monitor, area), along, _LINE)
    except Unsuitable:  # the numbers don't need them
        return None


def _by_triangles(
    change: ChangeGrid, sides: tuple[Side, Side], monitor: Monitor, within: VolumeScope
) -> OtherMethod:
    surfaces: list[TriangleSurface] = []
    used: set[int] = set()
    for side, heights in zip(sides, (change.before, change.after), strict=True):
        monitor.check()
        if isinstance(side, TriangleSurface):
            surfaces.append(side)
            continue
        lines = _lines_on(GridSurface(change.grid, heights), within.break_lines)
        used |= set(lines)
        positions = _positions(change, heights)
        surfaces.append(triangulate_ground(positions, tuple(lines.values()), monitor))
    area = within.boundary if within.boundary is not None else _outline(change)
    found = volume_between(surfaces[0], surfaces[1], monitor, area)
    left = [number for number in range(len(within.break_lines)) if number not in used]
    notes = (_NOISE_TWICE, *(_OFF_GROUND.filled(number=str(one + 1)) for one in left))
    return OtherMethod(found.cut_m3, found.fill_m3, notes=notes)


def _lines_on(ground: GridSurface, lines: tuple[Floats, ...]) -> dict[int, Floats]:
    """Break lines that lie on a ground, by their numbers: a crest of one date is none of another.

    A line drawn in plan only takes its heights from the ground.
    """
    found = {}
    for number, drawn in enumerate(lines):
        line = drawn
        if np.isnan(drawn[:, 2]).any():
            # Between positions in plan the ground isn't straight.
            dense = shapely.segmentize(shapely.LineString(drawn[:, :2]), _STEP_M)
            xy = shapely.get_coordinates(dense)
            line = np.column_stack([xy, np.full(len(xy), np.nan)])
        heights = ground.heights_at(line[:, :2])
        known = np.isfinite(heights)
        own = np.where(np.isfinite(line[:, 2]), line[:, 2], heights)
        is_on = known.any() and np.median(np.abs(own - heights)[known]) <= _ON_GROUND_M
        if is_on and np.isfinite(own).all():
            found[number] = np.column_stack([line[:, :2], own])
    return found


def _positions(change: ChangeGrid, heights: NDArray[np.float32]) -> Floats:
    row, column = np.nonzero(np.isfinite(heights))
    x, y = ((np.stack([column, row]) + 0.5) * change.grid.size_m) + change.grid.origin[:2, None]
    return np.column_stack([x, y, heights[row, column].astype(np.float64) + change.grid.origin[2]])


def _outline(change: ChangeGrid) -> shapely.Geometry:
    """The cells that count, as an area."""
    size_m, (west, south, _) = change.grid.size_m, change.grid.origin
    boxes = []
    for row in np.flatnonzero((change.inside > 0).any(axis=1)):
        steps = np.diff(np.pad((change.inside[row] > 0).astype(np.int8), 1))
        starts, stops = np.flatnonzero(steps == 1), np.flatnonzero(steps == -1)
        boxes.append(
            shapely.box(
                west + starts * size_m,
                south + row * size_m,
                west + stops * size_m,
                south + (row + 1) * size_m,
            )
        )
    return shapely.unary_union(np.concatenate(boxes))


def _middle_line(change: ChangeGrid, boundary: shapely.Geometry | None) -> Floats:
    """The longer middle line of the smallest rectangle round the area: (2, 2) float64."""
    return _middle_of(change, boundary)[0]


def _middle_of(change: ChangeGrid, boundary: shapely.Geometry | None) -> tuple[Floats, float]:
    """That line, and how wide the rectangle is across it, m."""
    area = boundary if boundary is not None else _outline(change)
    corners = shapely.get_coordinates(shapely.minimum_rotated_rectangle(area))[:4]
    middles = (corners + np.roll(corners, -1, axis=0)) / 2
    lines = middles[[0, 2]], middles[[1, 3]]
    across, along = sorted(lines, key=lambda line: float(np.hypot(*(line[1] - line[0]))))
    return along, float(np.hypot(*(across[1] - across[0])))
