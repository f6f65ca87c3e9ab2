"""Cross-sections of two grounds along a line: profiles, and the areas of cut and fill in each."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from processing.core.errors import OutOfRange, Unsuitable
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.methods.earthwork.sections.height_surfaces import HeightSurface
from processing.section.stations import Stations

Floats = NDArray[np.float64]

_POSITIONS_AT_ONCE = 50_000
"""Of profiles whose heights are asked between two questions whether to go on."""

_MOST_POSITIONS = 50_000_000
"""Of all profiles together; more take minutes and are a slip of the distances."""

_SAME_OFFSET_M = 1e-9
"""Offsets that differ by less do so by rounding."""

_ON_STATION = 1e-9
"""Intervals by which the end of a line may lie beside a section by rounding."""


@dataclass(frozen=True)
class SectionLayout:
    """A line in plan and the sections across it.

    Attributes
    ----------
    xy : (k, 2) float64
        m, project CRS; heights are passed over.
    half_width_m : float
        Of a section, to either side.
    interval_m : float
        From one section to the next, along the line; the last one is at its end. 20 m as stations
        of roads and rivers are set (測点).
    step_m : float
        From one position of a profile to the next: half the usual mesh.
    """

    xy: Floats
    half_width_m: float
    interval_m: float = 20.0
    step_m: float = 0.1


@dataclass(frozen=True)
class Moments:
    """What is summed over a section.

    Attributes
    ----------
    cut, fill, width, missing : float
        Areas where the later ground is lower and higher, m²; widths where both grounds are and
        where one is missing, m.
    """

    cut: float
    fill: float
    width: float
    missing: float

    def plus(self, share: float, other: Moments) -> Moments:
        """These and a share of others."""
        return Moments(
            self.cut + share * other.cut,
            self.fill + share * other.fill,
            self.width + share * other.width,
            self.missing + share * other.missing,
        )


@dataclass(frozen=True)
class CrossSection:
    """Both grounds across a line at a station, as seen when one looks along it.

    Attributes
    ----------
    station_m : float
        Along the line in plan.
    position, direction : (2,) float64
        Where the line is there, m, project CRS, and the unit vector along it.
    offsets_m : (n,) float64
        Rising; left of the line negative, as in LandXML.
    before, after : (n,) float64
        Heights, m; NaN where there is no ground.
    is_inside : (n − 1,) bool
        Which of the steps from one offset to the next are within the boundary.
    areas, moments : Moments
        Sums over the steps inside, and the same times their offset: m³ and m².
    """

    station_m: float
    position: Floats
    direction: Floats
    offsets_m: Floats
    before: Floats
    after: Floats
    is_inside: NDArray[np.bool_]
    areas: Moments
    moments: Moments

    @property
    def cut_m2(self) -> float:
        """Area between the profiles where the later one is lower."""
        return self.areas.cut

    @property
    def fill_m2(self) -> float:
        """Area between the profiles where the later one is higher."""
        return self.areas.fill

    @property
    def missing_m(self) -> float:
        """Width inside the boundary without one of the grounds."""
        return self.areas.missing


@dataclass(frozen=True)
class _Placed:
    station_m: float
    position: Floats
    direction: Floats
    offsets_m: Floats
    is_inside: NDArray[np.bool_]

    def positions(self) -> Floats:
        across = np.array([self.direction[1], -self.direction[0]])
        positions: Floats = self.position + self.offsets_m[:, None] * across
        return positions


def stations_of(line: SectionLayout) -> Floats:
    """Where its sections are: (s,) float64, m, rising from 0 to its length.

    Raises
    ------
    Unsuitable
        The line has no length, or a position that is no number.
    OutOfRange
        A width, interval or step that isn't positive, or more positions than can be worked on.
    """
    _check_line(line)
    length = _measured(line).length_m
    count = int(np.ceil(length / line.interval_m - _ON_STATION))
    if count * 2 * line.half_width_m / line.step_m > _MOST_POSITIONS:
        raise OutOfRange(
            Text("The sections have too many places.", "横断の点数が多すぎます。"),
            Text(f"{count + 1} sections", f"横断{count + 1}か所"),
            Text("Take a longer interval or step.", "間隔または点の間隔を大きくしてください。"),
        )
    stations: Floats = np.append(np.arange(count) * line.interval_m, length)
    return stations


def cross_sections(
    line: SectionLayout,
    stations_m: Floats,
    grounds: tuple[HeightSurface, HeightSurface],
    monitor: Monitor,
    boundary: shapely.Geometry | None = None,
) -> tuple[CrossSection, ...]:
    """Sections at stations of a line.

    Parameters
    ----------
    stations_m : (s,) float64
        As of :func:`stations_of`, or others along the line.
    grounds : HeightSurface, HeightSurface
        Before and after.
    boundary : shapely.Polygon or shapely.MultiPolygon or None
        Only what is within it counts.
    """
    measured = _measured(line)
    if boundary is not None:
        shapely.prepare(boundary)
    found: list[CrossSection] = []
    for block in _blocks(line, stations_m):
        placed = [_placed(line, measured, float(station), boundary) for station in block]
        monitor.check()
        found += _with_heights(placed, grounds)
        monitor.report(len(found) / len(stations_m))
    return tuple(found)


def _check_line(line: SectionLayout) -> None:
    sizes = (line.half_width_m, line.interval_m, line.step_m)
    if not all(np.isfinite(size) and size > 0.0 for size in sizes):
        raise OutOfRange(
            Text("Sections can't be like this.", "この横断は設定できません。"),
            Text(
                "half width {half} m, interval {interval} m, step {step} m",
                "片側の幅{half} m、間隔{interval} m、点の間隔{step} m",
            ).filled(half=line.half_width_m, interval=line.interval_m, step=line.step_m),
            Text("Give positive lengths.", "正の長さを指定してください。"),
        )
    if not np.isfinite(line.xy).all():
        raise Unsuitable(
            Text("The line has a place without position.", "線に座標のない点があります。"),
            Text("Line of the sections", "横断の基準線"),
            Text("Draw the line again.", "線を描き直してください。"),
        )


def _measured(line: SectionLayout) -> Stations:
    return Stations(np.column_stack([line.xy[:, :2], np.zeros(len(line.xy))]))


def _blocks(line: SectionLayout, stations_m: Floats) -> Iterator[Floats]:
    each = int(2 * line.half_width_m / line.step_m) + 2
    count = max(1, _POSITIONS_AT_ONCE // each)
    for start in range(0, len(stations_m), count):
        yield stations_m[start : start + count]


def _placed(
    line: SectionLayout, measured: Stations, station_m: float, boundary: shapely.Geometry | None
) -> _Placed:
    """The offsets of a section, those where it meets the boundary among them."""
    position = np.array(measured.position_at(station_m)[:2])
    direction = np.array(measured.direction_at(station_m))
    half = line.half_width_m
    offsets = np.linspace(-half, half, int(np.ceil(2 * half / line.step_m)) + 1)
    if boundary is None:
        return _Placed(station_m, position, direction, offsets, np.ones(len(offsets) - 1, bool))
    across = np.array([direction[1], -direction[0]])
    whole = shapely.LineString([position - half * across, position + half * across])
    met = (shapely.get_coordinates(shapely.intersection(whole, boundary)) - position) @ across
    offsets = np.sort(np.concatenate([offsets, np.clip(met, -half, half)]))
    offsets = offsets[np.append(True, np.diff(offsets) > _SAME_OFFSET_M)]
    middles = position + ((offsets[1:] + offsets[:-1]) / 2)[:, None] * across
    is_inside = shapely.contains_xy(boundary, middles[:, 0], middles[:, 1])
    return _Placed(station_m, position, direction, offsets, is_inside)


def _with_heights(
    placed: Sequence[_Placed], grounds: tuple[HeightSurface, HeightSurface]
) -> list[CrossSection]:
    positions = np.concatenate([one.positions() for one in placed])
    before, after = (ground.heights_at(positions) for ground in grounds)
    ends = np.cumsum([len(one.offsets_m) for one in placed])[:-1]
    return [
        _section(one, below, above)
        for one, below, above in zip(
            placed, np.split(before, ends), np.split(after, ends), strict=True
        )
    ]


def _section(one: _Placed, before: Floats, after: Floats) -> CrossSection:
    """The sums of a section; steps are halved where the profiles cross."""
    change = after - before
    start, end = one.offsets_m[:-1], one.offsets_m[1:]
    is_known = np.isfinite(change[:-1]) & np.isfinite(change[1:])
    is_missing = one.is_inside & ~is_known
    kept = one.is_inside & is_known
    width, width_moment = _under(start[kept], end[kept], *np.ones((2, kept.sum())))
    missing, missing_moment = _under(
        start[is_missing], end[is_missing], *np.ones((2, is_missing.sum()))
    )
    fill, fill_moment = _above(start[kept], end[kept], change[:-1][kept], change[1:][kept])
    cut, cut_moment = _above(start[kept], end[kept], -change[:-1][kept], -change[1:][kept])
    return CrossSection(
        one.station_m,
        one.position,
        one.direction,
        one.offsets_m,
        before,
        after,
        one.is_inside,
        Moments(cut, fill, width, missing),
        Moments(cut_moment, fill_moment, width_moment, missing_moment),
    )


def _above(start: Floats, end: Floats, first: Floats, last: Floats) -> tuple[float, float]:
    """Area and first moment of what is above zero on steps from ``first`` to ``last``."""
    crosses = first * last < 0.0
    share = np.where(crosses, first / np.where(crosses, first - last, 1.0), 1.0)
    middle, height = start + share * (end - start), np.where(crosses, 0.0, last)
    first, height, last = (np.maximum(values, 0.0) for values in (first, height, last))
    area, moment = _under(start, middle, first, height)
    more, more_moment = _under(middle, end, height, last)
    return area + more, moment + more_moment


def _under(start: Floats, end: Floats, first: Floats, last: Floats) -> tuple[float, float]:
    """Area and first moment under straight steps."""
    long = end - start
    area = (long * (first + last) / 2).sum()
    moment = (long * (start * (2 * first + last) + end * (first + 2 * last)) / 6).sum()
    return float(area), float(moment)
