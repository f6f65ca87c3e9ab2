"""Notches of a recording: every row followed along the road, its openings weighed (mms.md, 7.3).

Nothing but the row itself is asked for the surface: beside an opening it must be as smooth as the
scanner measures, and bend by no more than Table 7-3's 1.8° across it. So neither slope nor cross
fall matter, and a row costs one look at each of its points.
"""

from __future__ import annotations

from collections.abc import Iterator
from copy import copy

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor
from processing.core.worked_ahead import in_order
from processing.methods.road.gutters.notch_kernels import FOUND, Limits, notches_kernel
from processing.methods.road.gutters.notches import (
    DENT,
    OPENING,
    Notches,
    NotchParameters,
    join_notches,
)
from processing.recording.drive import Drive
from processing.recording.passes import Pass, passes_of
from processing.recording.revolutions.revolutions import Revolutions

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

_POINTS_AT_ONCE = 1 << 19
_LEAST_ADVANCE_M = 0.01
_BEYOND_ANY_PASS = 1e9  # steps
_NEAR_M = 3.0
_SAMPLED_ROWS = 40
_LEAST_NOISE_M, _MOST_NOISE_M = 0.0005, 0.02
_ROOM = 8  # points for one notch that is kept
_NOISE_FLOOR_M = 0.0025
"""Least noise that depths are counted in: no lid is flatter, so that z_t is four times of it."""
_LOST_STRENGTH = 0.05
_SEEN_WHOLE = 3.5  # spacings of points, across openings whose both rims are seen
_LONGEST_HOLE_M, _WIDEST_HOLE_M = 0.05, 0.20


def notches_of(
    drive: Drive,
    parameters: NotchParameters,
    monitor: Monitor,
    points_at_once: int = _POINTS_AT_ONCE,
) -> Notches:
    """All notches of a drive; none without revolutions.

    Raises
    ------
    MissingInput
        The drive has no trajectory.
    """
    passes = passes_of(drive)
    parts: list[Notches] = []
    if drive.revolutions is not None:
        sweeps = _Sweeps(drive, drive.revolutions, passes)

        def found(block: tuple[int, int]) -> tuple[int, list[Notches]]:
            monitor.check()
            return block[1], list(_found_in(sweeps, *block, parameters))

        for stop, those in in_order(found, sweeps.blocks(points_at_once)):
            monitor.report(stop / sweeps.count)
            parts.extend(those)
    return join_notches(parts)


def notches_about(drive: Drive, position: Floats, parameters: NotchParameters) -> Notches:
    """Notches of the rows that may pass a place, of every pass; none without revolutions.

    Parameters
    ----------
    position : (3,) float64
        m, project CRS.

    Raises
    ------
    MissingInput
        The drive has no trajectory.
    """
    passes = passes_of(drive)
    parts: list[Notches] = []
    if drive.revolutions is not None and passes:
        sweeps = _Sweeps(drive, drive.revolutions, passes)
        # A beam that is turned by 45 degrees meets the road as far ahead as aside.
        reach = 2.0 * parameters.reach_m
        for one in passes:
            at = float(one.station_at(one.time_nearest(position)))
            near = (sweeps.stretch == one.number) & (np.abs(sweeps.stations - at) <= reach)
            about = sweeps.chosen(np.flatnonzero(near))
            for first, stop in about.blocks():
                parts.extend(_found_in(about, first, stop, parameters))
    return join_notches(parts)


_OF_SWEEPS = ("rows", "times", "stretch", "stations", "advances", "starts", "stops", "below")


class _Sweeps:
    """Rows of a drive from half a turn before the point below the scanner to half a turn after."""

    def __init__(self, drive: Drive, revolutions: Revolutions, passes: tuple[Pass, ...]) -> None:
        self.drive = drive
        self.passes = passes
        folds = np.asarray(revolutions.fold_pulses, np.int64)
        half = int(revolutions.pulses_per_revolution / 2)
        times = np.asarray(revolutions.reference_times, np.float64)
        number = np.full(len(times), -1, np.int64)
        stations = np.zeros(len(times))
        for one in passes:
            is_in = (times >= one.times[0]) & (times <= one.times[-1])
            number[is_in] = one.number
            stations[is_in] = one.station_at(times[is_in])
        kept = np.flatnonzero(number >= 0)
        kept = kept[_advancing(stations[kept], number[kept])]
        self.advances = _advances(stations[kept], number[kept])
        pulse = drive.columns["pulse"]
        self.rows = kept
        self.times, self.stretch, self.stations = times[kept], number[kept], stations[kept]
        self.starts = np.searchsorted(pulse, folds[kept] - half)
        self.stops = np.searchsorted(pulse, folds[kept] + half)
        self.below = np.searchsorted(pulse, folds[kept])

    @property
    def count(self) -> int:
        """How many there are."""
        return len(self.rows)

    def chosen(self, which: Integers) -> _Sweeps:
        """Some of them."""
        some = copy(self)
        for name in _OF_SWEEPS:
            setattr(some, name, getattr(self, name)[which])
        return some

    def blocks(self, points_at_once: int = _POINTS_AT_ONCE) -> Iterator[tuple[int, int]]:
        """First and last sweep + 1 of blocks of bounded size, of one pass each."""
        first = 0
        while first < self.count:
            most = np.searchsorted(self.stops, self.starts[first] + points_at_once)
            other = np.flatnonzero(self.stretch[first:] != self.stretch[first])
            stop = first + int(other[0]) if other.size else self.count
            stop = max(first + 1, min(stop, int(most)))
            yield first, stop
            first = stop


def _advancing(stations: Floats, number: Integers) -> Integers:
    """Rows that are a little on from the one before: a standing vehicle repeats itself."""
    step = np.floor(stations / _LEAST_ADVANCE_M)
    # Where the vehicle waits, its place goes to and fro within the trajectory's noise.
    farthest = np.maximum.accumulate(step + number * _BEYOND_ANY_PASS)
    is_new = np.ones(len(stations), np.bool_)
    is_new[1:] = np.diff(farthest) > 0
    return np.flatnonzero(is_new)


def _advances(stations: Floats, number: Integers) -> Floats:
    """(s,) m of the vehicle's path that each row stands for: half way to the rows beside it."""
    steps = np.diff(stations)
    is_same = np.diff(number) == 0
    behind, ahead = np.full(len(stations), np.nan), np.full(len(stations), np.nan)
    behind[1:][is_same], ahead[:-1][is_same] = steps[is_same], steps[is_same]
    both = np.where(
        np.isnan(behind) | np.isnan(ahead), np.fmax(behind, ahead), (behind + ahead) / 2
    )
    return np.asarray(np.nan_to_num(both), np.float64)


def _found_in(
    sweeps: _Sweeps, first: int, stop: int, parameters: NotchParameters
) -> Iterator[Notches]:
    start, end = int(sweeps.starts[first]), int(sweeps.stops[stop - 1])
    if end - start < 3:
        return
    drive = sweeps.drive
    vehicle_path = next(one for one in sweeps.passes if one.number == sweeps.stretch[first])
    xyz = drive.xyz(slice(start, end)) - vehicle_path.origin
    pulse = np.asarray(drive.columns["pulse"][start:end], np.int64)
    stations = sweeps.stations[first:stop]
    positions = vehicle_path.positions_at(stations) - vehicle_path.origin
    below = np.clip(sweeps.below[first:stop] - start, 1, len(xyz) - 2)
    height_m = _height_above_road(xyz, below, positions, parameters)
    positions[:, 2] -= height_m
    spans = np.column_stack([sweeps.starts[first:stop], sweeps.stops[first:stop]]) - start
    rights = vehicle_path.rights_at(stations)
    noise = _noise(xyz, pulse, spans, positions)
    limits = _limits(parameters, noise)
    room = max(len(xyz) // _ROOM, 64)
    found, origin = np.empty((room, FOUND)), np.empty((room, 3), np.int64)
    count = notches_kernel(xyz, pulse, (spans, positions, rights), limits, (found, origin))
    found, origin = found[:count], origin[:count]
    time = np.asarray(drive.columns["time"])[origin[:, 1] + start]
    between = xyz[origin[:, 2], :2] - xyz[origin[:, 1], :2]
    length = np.maximum(np.hypot(between[:, 0], between[:, 1]), 1e-9)
    spacing = length / np.maximum(origin[:, 2] - origin[:, 1] + found[:, 7], 1)
    beyond = _beyond(found, positions[origin[:, 0]], spacing, parameters)
    placed = found[:, :3] + vehicle_path.origin
    placed[:, :2] += beyond
    station, across = vehicle_path.stations_of(placed, time)
    is_known = np.isfinite(station)
    beside = np.where(is_known, station, 0.0)
    ahead = vehicle_path.directions_at(beside)
    along = (between * ahead).sum(axis=1) / length
    apart = sweeps.advances[first:stop][origin[:, 0]] * np.sqrt(np.maximum(1.0 - along**2, 0.0))
    whole = Notches(
        placed,
        time_s=time,
        depth_m=found[:, 3],
        width_m=found[:, 4],
        pattern=found[:, 8].astype(np.uint8),
        strength=_strength(found, noise, along, spacing),
        row=sweeps.rows[first:stop][origin[:, 0]],
        point=origin[:, 1] + start,
        station_m=station,
        across_m=across,
        stretch=np.full(count, vehicle_path.number, np.int64),
        direction=between / length[:, None],
        area_m2=found[:, 4] * apart,
        raised_m=placed[:, 2] - vehicle_path.positions_at(beside)[:, 2] + height_m,
    )
    yield whole.chosen(is_known)


def _limits(parameters: NotchParameters, noise: float) -> Limits:
    """As the kernel takes them."""
    return (
        parameters.reach_m,
        parameters.height_range_m,
        noise,
        parameters.aside_m,
        parameters.down_m,
        parameters.step_m,
        parameters.noise_factor,
    )


def _beyond(found: Floats, vehicle: Floats, spacing: Floats, parameters: NotchParameters) -> Floats:
    """(n, 2) how far the middles of openings lie beyond where they were seen, m.

    A beam that enters a hole near its far rim meets the wall less than z_t below the surface and
    isn't told from it: of an opening that one or two points are in, the near part is seen.
    """
    beam = found[:, :2] - vehicle[:, :2]
    blind = parameters.down_m / parameters.height_m * beam
    is_missed = (found[:, 4] < _SEEN_WHOLE * spacing) & (found[:, 3] > 0.0)
    return np.asarray(np.where(is_missed[:, None], blind / 2, 0.0), np.float64)


def _height_above_road(
    xyz: Floats, below: Integers, positions: Floats, parameters: NotchParameters
) -> float:
    """How far the trajectory is above the road: measured below the scanner where there are points.

    A trajectory may be that of the scanner, the antenna or the wheels (trap 25).
    """
    aside = np.hypot(*(xyz[below, :2] - positions[:, :2]).T)
    heights = (positions[:, 2] - xyz[below, 2])[aside <= _NEAR_M]
    return float(np.median(heights)) if heights.size else parameters.height_m


def _noise(xyz: Floats, pulse: Integers, spans: Integers, positions: Floats) -> float:
    """Height noise of the road, m: half the second differences of a few rows near the vehicle."""
    values = []
    for sweep in range(0, len(positions), max(1, len(positions) // _SAMPLED_ROWS)):
        part = xyz[slice(*spans[sweep])]
        if len(part) < 3:
            continue
        number = pulse[slice(*spans[sweep])]
        second = part[2:, 2] - 2 * part[1:-1, 2] + part[:-2, 2]
        aside = np.hypot(*(part[1:-1, :2] - positions[sweep, :2]).T)
        is_road = (aside <= _NEAR_M) & (number[2:] - number[:-2] == 2)
        values.append(np.abs(second[is_road]))
    every = np.concatenate([np.empty(0), *values])
    if not every.size:
        return _LEAST_NOISE_M
    # The second difference of white noise has √6 times its spread.
    spread = float(np.median(every)) / (0.6745 * np.sqrt(6.0))
    return float(np.clip(spread, _LEAST_NOISE_M, _MOST_NOISE_M))


def _strength(found: Floats, noise: float, along: Floats, spacing: Floats) -> Floats:
    """How sure an opening is that of a lid, (n,).

    Parameters
    ----------
    found : (n, FOUND)
        Of the kernel.
    noise : float
        Height noise, m.
    along : (n,)
        Cosine between row and way.
    spacing : (n,)
        Between points of the row, m.

    Notes
    -----
    Depth is counted in noise: four times is what noise alone does once in 30,000 points. Holes are
    at most 50 mm by 200 mm (Table 7-2), so the row's direction says how wide they may be.
    """
    depth, width, lost = found[:, 3], found[:, 4], found[:, 7]
    pattern = found[:, 8].astype(np.uint8)
    is_thesis = (pattern & (OPENING | DENT)) > 0
    times = depth / (4.0 * max(noise, _NOISE_FLOOR_M))
    by_depth = np.where(
        is_thesis, np.clip(1.2 * (times - 0.7), 0.05, 0.95), np.clip(0.3 * (times - 0.7), 0.02, 0.2)
    )
    # A single low point is noise more often than two.
    by_depth = np.where(~is_thesis & (width > 2.5 * spacing), 1.5 * by_depth, by_depth)
    by_depth = np.where((lost > 0) & (depth < _NOISE_FLOOR_M), _LOST_STRENGTH, by_depth)
    aside = np.sqrt(np.maximum(1.0 - along**2, 0.0))
    longest = np.minimum(
        _LONGEST_HOLE_M / np.maximum(np.abs(along), 1e-6),
        _WIDEST_HOLE_M / np.maximum(aside, 1e-6),
    )
    over = (width - 2.0 * spacing) / longest
    return np.asarray(by_depth * np.clip(1.5 - 0.5 * over, 0.05, 1.0) ** 2)
