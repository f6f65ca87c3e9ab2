"""Contour lines of a gridded ground, and level lines of a change."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import shapely
from contourpy import LineType, contour_generator
from numpy.typing import NDArray

from processing.core.errors import OutOfRange
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.methods.earthwork.maps.change_grid import ChangeGrid
from processing.methods.ground.filters.cells import CellGrid

Floats = NDArray[np.float64]

_INDEX_EACH = 5
"""Each fifth contour is an index contour (計曲線), as on topographic maps."""

_STEPS = (1.0, 2.0, 5.0, 10.0)
"""Of intervals within a decade; ten for what rounds up into the next."""

_SMALLEST_M = 0.01
"""Least interval that is chosen: below, lines show the noise of points."""

_MOST_LEVELS = 2000
"""More are refused: a drawing of them can't be read, and takes minutes. By judgement."""

_WANTED_LEVELS = 40
"""Most levels of an interval that is chosen; by judgement, what can be told apart on a sheet."""

_ROUNDING = 1e-9
"""Share by which logarithms and quotients end beside a whole number."""

_STEP_DECIMALS, _LEVEL_DECIMALS = 6, 9
"""To which intervals and levels are rounded, so that 0.1 + 0.2 is 0.3."""

_RING_CORNERS = 4
"""Of the smallest closed line: three, and the first once more."""


@dataclass(frozen=True)
class LevelLine:
    """A line at one height, or of one change.

    Attributes
    ----------
    level_m : float
        The height, or by how much the later ground lies higher.
    is_index : bool
        Each fifth level is drawn bolder (計曲線).
    xyz : (k, 3) float64
        m, project CRS; the level is the third coordinate. A closed line ends where it begins.
    """

    level_m: float
    is_index: bool
    xyz: Floats

    @property
    def is_closed(self) -> bool:
        """Whether the line leads back to its first point."""
        return bool(np.array_equal(self.xyz[0], self.xyz[-1]))


@dataclass(frozen=True)
class ContourOptions:
    """Which lines are wanted.

    Attributes
    ----------
    interval_m : float
        From one level to the next; levels are whole multiples of it.
    simplify_m : float
        Points that lie no farther from the line without them are left out.
    shortest_m : float
        Shorter lines are left out: stones and noise.
    """

    interval_m: float
    simplify_m: float = 0.0
    shortest_m: float = 0.0


def choose_interval(low_m: float, high_m: float, most_levels: int = _WANTED_LEVELS) -> float:
    """The smallest of 1, 2, 5, 10, 20, 50 … cm that gives no more levels between two heights."""
    least = max((high_m - low_m) / most_levels, _SMALLEST_M)
    decade = 10.0 ** math.floor(math.log10(least) + _ROUNDING)
    step = next(step for step in _STEPS if step * decade >= least * (1.0 - _ROUNDING))
    return round(step * decade, _STEP_DECIMALS)


def contour_lines(
    grid: CellGrid, heights: NDArray[np.float32], options: ContourOptions, monitor: Monitor
) -> tuple[LevelLine, ...]:
    """Contours through the middles of cells, lowest first.

    Parameters
    ----------
    heights : (rows, columns) float32
        m above the grid's origin; row = north; NaN without ground, where lines end.

    Raises
    ------
    OutOfRange
        The interval isn't positive, or gives too many levels.
    """
    values = heights.astype(np.float64) + float(grid.origin[2])
    return _lines(grid, values, options, _levels_between(values, options), monitor=monitor)


def change_lines(
    change: ChangeGrid, options: ContourOptions, monitor: Monitor
) -> tuple[LevelLine, ...]:
    """Lines of equal change within the boundary, deepest cut first.

    There is none of no change: over ground that nobody touched it would follow the noise.

    Raises
    ------
    OutOfRange
        The interval isn't positive, or gives too many levels.
    """
    values = change.change_m.astype(np.float64)
    numbers = [number for number in _levels_between(values, options) if number != 0]
    return _lines(change.grid, values, options, numbers, monitor=monitor)


def _levels_between(values: Floats, options: ContourOptions) -> list[int]:
    """Multiples of the interval that values reach."""
    if not (math.isfinite(options.interval_m) and options.interval_m > 0.0):
        raise OutOfRange(
            Text(
                "The interval of contours is no positive length.",
                "等高線の間隔が正の長さではありません。",
            ),
            Text(f"{options.interval_m} m", f"{options.interval_m} m"),
            Text("Give a positive interval.", "正の間隔を指定してください。"),
        )
    known = values[np.isfinite(values)]
    if not known.size:
        return []
    low, high = float(known.min()), float(known.max())
    first, last = math.ceil(low / options.interval_m), math.floor(high / options.interval_m)
    if last - first >= _MOST_LEVELS:
        enough = choose_interval(low, high, _MOST_LEVELS // 2)
        raise OutOfRange(
            Text(
                f"The interval gives {last - first + 1:,} contour levels.",
                f"この間隔では等高線が{last - first + 1:,}段になります。",
            ),
            Text(
                f"Interval {options.interval_m} m over {high - low:.2f} m of height",
                f"高低差{high - low:.2f} mに対して間隔{options.interval_m} m",
            ),
            Text(f"Take {enough:g} m or more.", f"{enough:g} m以上にしてください。"),
        )
    return list(range(first, last + 1))


def _lines(
    grid: CellGrid,
    values: Floats,
    options: ContourOptions,
    numbers: Iterable[int],
    *,
    monitor: Monitor,
) -> tuple[LevelLine, ...]:
    if min(values.shape) < 2:
        return ()
    east = (np.arange(grid.columns) + 0.5) * grid.size_m
    north = (np.arange(grid.rows) + 0.5) * grid.size_m
    generator = contour_generator(
        east,
        north,
        np.ma.masked_invalid(values),
        line_type=LineType.Separate,
        corner_mask=True,
    )
    found = []
    for number in numbers:
        monitor.check()
        level = round(number * options.interval_m, _LEVEL_DECIMALS)
        for plan in generator.lines(level):
            local = _drawn(np.asarray(plan, np.float64), options)
            if local is not None:
                xyz = np.column_stack([local + grid.origin[:2], np.full(len(local), level)])
                found.append(LevelLine(level, number % _INDEX_EACH == 0, xyz))
    return tuple(found)


def _drawn(plan: Floats, options: ContourOptions) -> Floats | None:
    """A line as it is wanted, or None where it is none."""
    line = shapely.LineString(plan)
    if line.length <= options.shortest_m:
        return None
    if options.simplify_m <= 0.0:
        return plan
    simple: Floats = shapely.get_coordinates(
        shapely.simplify(line, options.simplify_m, preserve_topology=False)
    )
    # A closed line that becomes a stroke there and back is smaller than what is left out.
    return None if len(simple) < _RING_CORNERS and np.array_equal(simple[0], simple[-1]) else simple
