"""Notches of a recording: every row followed along the road, its openings weighed.

The feature points of Takahashi 2022, section 7.3. Nothing but the row itself is asked for the
surface: beside an opening it must be as smooth as the scanner measures, and bend by no more than
1.8° across it (Table 7-3). So neither slope nor cross fall matter, and a row costs one look at each
of its points.
"""

from __future__ import annotations

from collections.abc import Iterator
from copy import copy

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor
from processing.core.worked_ahead import in_order
from processing.methods.road.gutters.notches.head_position import head_position
from processing.methods.road.gutters.notches.notch_kernels import (
    DEPTH,
    FOUND,
    LOST_PULSES,
    PATTERN,
    SURFACE_Z,
    WIDTH,
    Limits,
    Sweeps,
    notches_kernel,
)
from processing.methods.road.gutters.notches.notches import (
    DENT,
    OPENING,
    Notches,
    NotchParameters,
    join_notches,
)
from processing.methods.road.gutters.notches.road_below import RowsOfBlock, road_below
from processing.recording.drive import Drive
from processing.recording.passes import Pass, passes_of
from processing.recording.revolutions.revolutions import Revolutions

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

# "By trial": chosen while the tool was made; no measurement of the single value is recorded.

_POINTS_AT_ONCE = 1 << 19
"""Some 40 MB with all that is worked out, and short enough for a cancel to be felt at once."""

_LEAST_ADVANCE_M = 0.01
"""Rows of a waiting vehicle are left out: a fifth of the shortest hole apart they show nothing
new."""

_BEYOND_ANY_PASS = 1e9
"""Steps of `_LEAST_ADVANCE_M`: 10,000 km."""

_ROOM, _LEAST_ROOM = 8, 64
"""Points for one notch that is kept, and room for notches at least; beyond it the kernel notes no
more."""

_NOISE_FLOOR_M = 0.0025
"""Least noise that depths are counted in: no lid is flatter, so that z_t is four times of it."""

_TIMES_NOISE = 4.0
"""Depths are counted in so many times the noise, which noise alone does once in 30,000 points."""

_FROM, _STEEP, _FLAT = 0.7, 1.2, 0.3
"""Strength begins at this share of that depth, and rises with it: by the second for openings of the
thesis' patterns, by the third for narrow dips. By trial."""

_LEAST_OPENING, _MOST_OPENING, _LEAST_DIP, _MOST_DIP = 0.05, 0.95, 0.02, 0.2
"""Bounds of strengths, of openings and of dips. By trial."""

_WIDE_SPACINGS, _WIDE_GAIN = 2.5, 1.5
"""A dip wider than so many spacings has two points and more, and is so many times as sure. By
trial."""

_LOST_STRENGTH = 0.05
"""Of pulses without return alone: wet spots and dark stones lose them too. By trial."""

_SEEN_WHOLE = 3.5
"""Spacings of points, across openings whose both rims are seen: fewer are one or two points. By
trial."""

_LONGEST_HOLE_M, _WIDEST_HOLE_M = 0.05, 0.20
"""Along and across the gutter: Takahashi 2022, Table 7-2 (50 mm, 190 mm)."""

_SPACINGS_OF_RIMS, _TOO_LONG, _HALF, _LEAST_FIT = 2.0, 1.5, 0.5, 0.05
"""An opening is seen so many spacings wider than it is. The strength is multiplied with the square
of 1.5 − half of how many times as long as a hole it is, 1 for a hole's own length, at least the
last. By trial."""

_LEAST_M, _LEAST_COSINE = 1e-9, 1e-6
"""Guards of divisions."""


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
        # A beam that leaves at 45 degrees meets the road as far ahead as aside.
        reach = 2.0 * parameters.reach_m
        for one in passes:
            at = float(one.station_at(one.time_nearest(position)))
            near = (sweeps.pass_number == one.number) & (np.abs(sweeps.stations - at) <= reach)
            about = sweeps.chosen(np.flatnonzero(near))
            for first, stop in about.blocks():
                parts.extend(_found_in(about, first, stop, parameters))
    return join_notches(parts)


_OF_SWEEPS = (
    "rows", "times", "pass_number", "stations", "advances", "starts", "stops", "heads"
)  # fmt: skip


class _Sweeps:
    """Rows of a drive: half a revolution to either side of the point below the scanner."""

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
        self.heads = _heads(drive, times[kept])
        self.rows = kept
        self.times, self.pass_number, self.stations = times[kept], number[kept], stations[kept]
        self.starts = np.searchsorted(pulse, folds[kept] - half)
        self.stops = np.searchsorted(pulse, folds[kept] + half)

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
            other = np.flatnonzero(self.pass_number[first:] != self.pass_number[first])
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
    own_pass = next(one for one in sweeps.passes if one.number == sweeps.pass_number[first])
    xyz = drive.xyz(slice(start, end)) - own_pass.origin
    pulse = np.asarray(drive.columns["pulse"][start:end], np.int64)
    stations = sweeps.stations[first:stop]
    positions = own_pass.positions_at(stations) - own_pass.origin
    spans = np.column_stack([sweeps.starts[first:stop], sweeps.stops[first:stop]]) - start
    road = road_below(RowsOfBlock(xyz, pulse, spans, stations), own_pass)
    if road is None:
        return
    positions[:, 2] -= road.height_m
    rights = own_pass.rights_at(stations)
    noise = road.noise_m
    limits = _limits(parameters, noise)
    room = max(len(xyz) // _ROOM, _LEAST_ROOM)
    found, origin = np.empty((room, FOUND)), np.empty((room, 3), np.int64)
    count = notches_kernel(xyz, pulse, Sweeps(spans, positions, rights), limits, (found, origin))
    found, origin = found[:count], origin[:count]
    time = np.asarray(drive.columns["time"])[origin[:, 1] + start]
    between = xyz[origin[:, 2], :2] - xyz[origin[:, 1], :2]
    length = np.maximum(np.hypot(between[:, 0], between[:, 1]), _LEAST_M)
    spacing = length / np.maximum(origin[:, 2] - origin[:, 1] + found[:, LOST_PULSES], 1)
    beam = found[:, : SURFACE_Z + 1] - (sweeps.heads[first:stop] - own_pass.origin)[origin[:, 0]]
    steepness = np.maximum(-beam[:, 2], 0.0) / np.maximum(np.hypot(*beam[:, :2].T), _LEAST_M)
    beyond = _beyond(found, beam, spacing, parameters.down_m)
    placed = found[:, : SURFACE_Z + 1] + own_pass.origin
    placed[:, :2] += beyond
    station, across = own_pass.stations_of(placed, time)
    is_known = np.isfinite(station)
    beside = np.where(is_known, station, 0.0)
    ahead = own_pass.directions_at(beside)
    along = (between * ahead).sum(axis=1) / length
    apart = sweeps.advances[first:stop][origin[:, 0]] * np.sqrt(np.maximum(1.0 - along**2, 0.0))
    whole = Notches(
        placed,
        time_s=time,
        depth_m=found[:, DEPTH],
        width_m=found[:, WIDTH],
        spacing_m=spacing,
        steepness=steepness,
        pattern=found[:, PATTERN].astype(np.uint8),
        strength=_strength(found, noise, along, spacing),
        row=sweeps.rows[first:stop][origin[:, 0]],
        point=origin[:, 1] + start,
        station_m=station,
        across_m=across,
        pass_number=np.full(count, own_pass.number, np.int64),
        direction=between / length[:, None],
        area_m2=found[:, WIDTH] * apart,
        raised_m=placed[:, 2] - own_pass.positions_at(beside)[:, 2] + road.height_m,
    )
    yield whole.chosen(is_known)


def _limits(parameters: NotchParameters, noise: float) -> Limits:
    """As the kernel takes them."""
    return Limits(
        parameters.reach_m,
        parameters.height_range_m,
        noise,
        parameters.aside_m,
        parameters.down_m,
        parameters.step_m,
        parameters.noise_factor,
    )


def _heads(drive: Drive, times: Floats) -> Floats:
    """(s, 3) where the head was at times, m, project CRS."""
    trajectory = drive.trajectory
    if trajectory is None or not times.size:
        return np.empty((times.size, 3))
    at = head_position(drive)
    found: Floats = trajectory.positions_at(times) + trajectory.rotations_at(times) @ at
    return found


def _beyond(found: Floats, beam: Floats, spacing: Floats, down_m: float) -> Floats:
    """(n, 2) how far the middles of openings lie beyond where they were seen, m.

    A beam that enters a hole near its far rim meets the wall less than z_t below the surface and
    isn't told from it: of an opening that one or two points are in, the near part is seen.
    """
    blind = down_m / np.maximum(-beam[:, 2:], down_m) * beam[:, :2]
    is_missed = (found[:, WIDTH] < _SEEN_WHOLE * spacing) & (found[:, DEPTH] > 0.0)
    return np.asarray(np.where(is_missed[:, None], blind / 2, 0.0), np.float64)


def _strength(found: Floats, noise: float, along: Floats, spacing: Floats) -> Floats:
    """How sure an opening is that of a lid, (n,).

    Parameters
    ----------
    found : (n, FOUND)
        Of the kernel.
    noise : float
        Height noise, m.
    along : (n,)
        Cosine between row and path.
    spacing : (n,)
        Between points of the row, m.

    Notes
    -----
    Depth is counted in noise. Holes are at most 50 mm by 200 mm, so the row's direction says how
    wide they may be.
    """
    depth, width, lost = found[:, DEPTH], found[:, WIDTH], found[:, LOST_PULSES]
    pattern = found[:, PATTERN].astype(np.uint8)
    is_thesis = (pattern & (OPENING | DENT)) > 0
    times = depth / (_TIMES_NOISE * max(noise, _NOISE_FLOOR_M)) - _FROM
    by_depth = np.where(
        is_thesis,
        np.clip(_STEEP * times, _LEAST_OPENING, _MOST_OPENING),
        np.clip(_FLAT * times, _LEAST_DIP, _MOST_DIP),
    )
    # A single low point is noise more often than two.
    is_wide = ~is_thesis & (width > _WIDE_SPACINGS * spacing)
    by_depth = np.where(is_wide, _WIDE_GAIN * by_depth, by_depth)
    by_depth = np.where((lost > 0) & (depth < _NOISE_FLOOR_M), _LOST_STRENGTH, by_depth)
    aside = np.sqrt(np.maximum(1.0 - along**2, 0.0))
    longest = np.minimum(
        _LONGEST_HOLE_M / np.maximum(np.abs(along), _LEAST_COSINE),
        _WIDEST_HOLE_M / np.maximum(aside, _LEAST_COSINE),
    )
    over = (width - _SPACINGS_OF_RIMS * spacing) / longest
    return np.asarray(by_depth * np.clip(_TOO_LONG - _HALF * over, _LEAST_FIT, 1.0) ** 2)
