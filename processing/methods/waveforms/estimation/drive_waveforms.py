"""Waveforms of all pulses of a flight: its returns are grouped, described and given their packets.

1. Points of the same time are a pulse; where it came back more than once, its ray is known, and
   from these rays where the aircraft was (:mod:`flown_path`).
2. A part of the plan at a time, each packet's returns and what lies around its ray become a
   waveform (:mod:`packet_inputs`), kept in a file for the time of the run.
3. Points follow drive by drive in the order of time, with their packets.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.monitor import Monitor, PartMonitor
from processing.core.scratch_arrays import scratch_array
from processing.methods.noise.tiles_of_space import SpacePart, TiledCloud
from processing.methods.waveforms.estimation.flown_path import FlownPath, flown_path
from processing.methods.waveforms.estimation.packet_inputs import (
    Estimator,
    PacketDescriber,
    PulseReturns,
    ReturnBrightness,
    SystemResponse,
    brightness_of,
)
from processing.methods.waveforms.estimation.pulse_returns import (
    SAMPLES,
    packets_of_returns,
)
from processing.methods.waveforms.estimation.ray_kernels import Neighbours
from processing.methods.waveforms.estimation.response_network import shipped_network
from processing.recording.drive import Drive

_POINTS_AT_ONCE = 200_000
_MOST_OF_A_TIME = 4_096
"""Points of one time that are looked for across two reads; more share a time only by damage."""

_POINTS_PER_PART = 100_000
"""Points in memory with those around: some 400 MB of what the network sees."""

_TILE_M = 2.0
_REACH_M = 12.0
"""Around a part: how far a ray leads aside over a packet of 24 m at 30 degrees off the plumb
line."""

_MOST_RETURNS = 32
"""Points before and behind a first return among which its packet's are looked for: twice the 15
that LAS counts."""

_MOST_RAYS = 200_000
STEPS_OF_COUNT = 256
"""Samples of 16 bits hold 8-bit counts in steps of a 256th: a rounded one would be off by a quarter
of a count, which on plain ground is as much as the estimate itself."""

_MOST_STEPS = 65_535.0
_INTENSITIES = 65_536
EVEN_ENERGY = 1000.0
"""Of a pulse, in units of its own, where no intensities are known."""

_GROUPED, _TILED = 0.15, 0.25
"""Of the progress."""


@dataclass(frozen=True)
class EstimateRequest:
    """How waveforms are to be estimated.

    Attributes
    ----------
    pulse : SystemResponse
    knows_intensity : bool
        Whether intensities are used.
    intensity_of_count : float
        Of one count of the samples.
    """

    pulse: SystemResponse
    knows_intensity: bool
    intensity_of_count: float


class _InTime:
    """Points of drives, one after the other, each in the order of time and returns."""

    def __init__(self, drives: Sequence[Drive], file: Path) -> None:
        self.drives = drives
        self.starts = np.cumsum([0, *(drive.count for drive in drives)])
        self.count = int(self.starts[-1])
        self.order: Integers = scratch_array(file, np.int64, self.count)
        for drive, start in zip(drives, self.starts, strict=False):
            everything = slice(0, drive.count)
            time = np.asarray(drive.columns["time"][everything], np.float64)
            numbers = np.zeros(drive.count, np.uint8)
            if drive.columns.has("return_number"):
                numbers = np.asarray(drive.columns["return_number"][everything])
            self.order[start : start + drive.count] = np.lexsort((numbers, time))

    def xyz(self, points: Integers | slice) -> Floats:
        """Places, m, project CRS."""
        parts = [(own, self.drives[n].xyz(local)) for n, own, local in self._by_drive(points)]
        return self._joined(parts, (self._size(points), 3), np.float64)

    def time(self, points: Integers | slice) -> Floats:
        """On the drives' clock, s."""
        return self._column("time", points, np.float64)

    def numbers(self, points: Integers | slice) -> NDArray[np.uint8]:
        """Which of its pulse's returns each point is; 0 where nobody said."""
        return self._column("return_number", points, np.uint8)

    def give_back(self) -> None:
        """Let go of what was read."""
        for drive in self.drives:
            drive.columns.give_back()

    # Any: of the type that is asked for.
    def _column(self, name: str, points: Integers | slice, dtype: type[Any]) -> NDArray[Any]:
        parts = [
            (own, np.asarray(self.drives[n].columns[name][local]))
            for n, own, local in self._by_drive(points)
            if self.drives[n].columns.has(name)
        ]
        return self._joined(parts, (self._size(points),), dtype)

    def _joined(
        self,
        parts: list[tuple[NDArray[np.bool_], NDArray[Any]]],
        shape: tuple[int, ...],
        dtype: type[Any],
    ) -> NDArray[Any]:
        values = np.zeros(shape, dtype)
        for own, part in parts:
            values[own] = part
        return values

    def _size(self, points: Integers | slice) -> int:
        return len(range(*points.indices(self.count))) if isinstance(points, slice) else points.size

    def _by_drive(
        self, points: Integers | slice
    ) -> Iterator[tuple[int, NDArray[np.bool_], Integers]]:
        if isinstance(points, slice):
            points = np.arange(*points.indices(self.count))
        of = np.searchsorted(self.starts, points, side="right") - 1
        for number in np.unique(of).tolist():
            yield number, of == number, np.asarray(self.order[points[of == number]])

    def energies(
        self, points: Integers, request: EstimateRequest, packet: Integers
    ) -> NDArray[np.float32]:
        """Of returns, in intensities; even shares of their pulse where those aren't known.

        Parameters
        ----------
        packet : (n,) int64
            Of the points, all those of a packet among them.
        """
        if request.knows_intensity:
            return self._column("intensity", points, np.float32)
        _, of, returns = np.unique(packet, return_inverse=True, return_counts=True)
        return (EVEN_ENERGY / returns[of]).astype(np.float32)


@dataclass(frozen=True, eq=False)
class PointsWithWaves:
    """Consecutive points of a drive, and the packets of their pulses.

    Attributes
    ----------
    drive : int
        Which of the drives.
    points : (n,) int64
        Of the drive, in the order of time.
    packet : (n,) int64
        Row in ``samples``.
    after_ns : (n,) float32
        Behind the packet's first return, which lies at ``FIRST_SAMPLE_NS``.
    direction : (n, 3) float64
        Away from the sensor, unit vectors.
    samples : (k, SAMPLES) uint16
        Counts of 8 bits, in ``STEPS_OF_COUNT``.
    """

    drive: int
    points: Integers
    packet: Integers
    after_ns: NDArray[np.float32]
    direction: Floats
    samples: NDArray[np.uint16]


@dataclass(frozen=True, eq=False)
class _Grouped:
    """A drive's points as returns; arrays in files."""

    packet: Integers
    after_ns: NDArray[np.float32]
    owner: Integers
    packets: int
    stretches: tuple[tuple[int, int], ...]
    path: FlownPath
    brightness: ReturnBrightness


def waveforms_for(
    drives: Sequence[Drive], request: EstimateRequest, scratch: Path, monitor: Monitor
) -> Iterator[PointsWithWaves]:
    """Estimate the waveforms of drives: lines of a flight, which lie over each other.

    Parameters
    ----------
    drives : sequence of Drive
    scratch : Path
        An empty folder for what is kept meanwhile: some 350 bytes a point.

    Raises
    ------
    NoSpace, BadFile, Cancelled
    """
    points = _InTime(drives, scratch / "order")
    if points.count == 0:
        return
    grouped = _group(points, request, scratch, PartMonitor(monitor, 0.0, _GROUPED))
    cloud = TiledCloud(
        points.xyz,
        points.count,
        scratch / "tiles",
        _TILE_M,
        monitor=PartMonitor(monitor, _GROUPED, _TILED),
    )
    # The tiles count points; a pulse may have several.
    spacing_m = cloud.spacing_m * float(np.sqrt(points.count / grouped.packets))
    network = shipped_network(knows_intensity=request.knows_intensity)
    known = PacketDescriber(request.pulse, grouped.brightness, spacing_m, request.knows_intensity)
    estimator = Estimator(network, known)
    waves = scratch_array(scratch / "waves", np.uint16, grouped.packets * SAMPLES)
    waves = waves.reshape(-1, SAMPLES)
    done = 0
    for part in cloud.parts(_REACH_M, _POINTS_PER_PART):
        monitor.check()
        _estimate_part(points, grouped, (part, estimator, request), waves)
        done += part.own.size
        monitor.report(_TILED + (1.0 - _TILED) * done / points.count)
    for start, stop in grouped.stretches:
        yield _with_waves(points, grouped, slice(start, stop), waves)


def _group(points: _InTime, request: EstimateRequest, scratch: Path, monitor: Monitor) -> _Grouped:
    count = points.count
    packet = scratch_array(scratch / "packet", np.int64, count)
    owner = scratch_array(scratch / "owner", np.int64, count)
    after = scratch_array(scratch / "after", np.float32, count)
    rays: list[tuple[Floats, Floats, Floats]] = []
    of_all, of_first = np.zeros((2, _INTENSITIES), np.int64)
    packets, stretches = 0, tuple(_stretches(points))
    most = max(100, _MOST_RAYS // len(stretches))
    for start, stop in stretches:
        monitor.check()
        here = slice(start, stop)
        xyz, time = points.xyz(here), points.time(here)
        found = packets_of_returns(xyz, time, points.numbers(here))
        packet[start + found.order] = packets + found.packet
        after[start + found.order] = found.after_ns
        firsts = found.order[found.owner]
        owner[packets : packets + firsts.size] = start + firsts
        energy = points.energies(np.arange(start, stop), request, packet[here] - packets)
        of_all += np.bincount(energy.astype(np.int64), minlength=_INTENSITIES)
        of_first += np.bincount(energy[firsts].astype(np.int64), minlength=_INTENSITIES)
        lasts = found.order[np.append(found.owner[1:], len(xyz)) - 1]
        several = np.flatnonzero((firsts != lasts) & np.isfinite(time[firsts]))
        several = several[:: max(1, several.size // most)]
        rays.append((time[firsts[several]], xyz[firsts[several]], xyz[lasts[several]]))
        packets += firsts.size
        monitor.report(stop / count)
    path = _path_of(rays, points)
    return _Grouped(packet, after, owner, packets, stretches, path, brightness_of(of_all, of_first))


def _path_of(rays: list[tuple[Floats, Floats, Floats]], points: _InTime) -> FlownPath:
    time, first, last = (np.concatenate(one) for one in zip(*rays, strict=True))
    order = np.argsort(time, kind="stable")
    ends = points.time(np.concatenate([points.starts[:-1], points.starts[1:] - 1]))
    bounds = (float(np.nan_to_num(ends).min()), float(np.nan_to_num(ends).max()))
    return flown_path(time[order], first[order], last[order], bounds)


def _stretches(points: _InTime) -> Iterator[tuple[int, int]]:
    """Consecutive points of one drive between which no pulse is cut."""
    start = 0
    while start < points.count:
        end = int(points.starts[np.searchsorted(points.starts, start, side="right")])
        stop = min(start + _POINTS_AT_ONCE, end)
        if stop < end:
            low = max(start + 1, stop - _MOST_OF_A_TIME)
            time = points.time(slice(low - 1, stop + 1))
            changes = np.flatnonzero(time[1:] != time[:-1])
            if changes.size:
                stop = low + int(changes[-1])
        yield start, stop
        start = stop


def _estimate_part(
    points: _InTime,
    grouped: _Grouped,
    what: tuple[SpacePart, Estimator, EstimateRequest],
    waves: NDArray[np.uint16],
) -> None:
    """Fill the waveforms of the packets whose first return lies in a part."""
    part, estimator, request = what
    points.give_back()
    packet = np.asarray(grouped.packet[part.own])
    firsts = part.own[np.asarray(grouped.owner[packet]) == part.own]
    if not firsts.size:
        return
    numbers = np.asarray(grouped.packet[firsts])
    near = np.unique(np.concatenate([part.own, part.around]))
    span = firsts[:, None] + np.arange(-_MOST_RETURNS, _MOST_RETURNS + 1)
    span = np.clip(span, 0, points.count - 1)
    row, column = np.nonzero(np.asarray(grouped.packet[span]) == numbers[:, None])
    own = np.unique(span[row, column])
    order = np.argsort(numbers)
    rows = order[np.searchsorted(numbers[order], grouped.packet[own])]
    middle = points.xyz(firsts[:1])[0]
    returns = PulseReturns(
        points.xyz(own) - middle,
        points.energies(own, request, rows),
        rows,
        np.asarray(grouped.after_ns[own]),
        np.asarray(grouped.owner[grouped.packet[own]]) == own,
    )
    around = _around(points, grouped, near, (request, middle))
    at = np.searchsorted(numbers[order], around.packet)
    at = np.minimum(at, numbers.size - 1)
    is_own = numbers[order][at] == around.packet
    around = around._replace(
        packet=np.where(is_own, order[at], -1),
        energy=(around.energy / estimator.known.brightness.usual).astype(np.float32),
    )
    time = points.time(firsts)
    directions = grouped.path.directions(points.xyz(firsts), np.nan_to_num(time))
    found = estimator.waves(returns, directions, around) / request.intensity_of_count
    waves[numbers] = np.clip(np.rint(STEPS_OF_COUNT * found), 0.0, _MOST_STEPS).astype(np.uint16)


def _around(
    points: _InTime, grouped: _Grouped, near: Integers, what: tuple[EstimateRequest, Floats]
) -> Neighbours:
    request, middle = what
    packet = np.asarray(grouped.packet[near])
    energy = points.energies(near, request, packet)
    is_first = np.asarray(grouped.owner[packet]) == near
    return Neighbours(points.xyz(near) - middle, energy, packet, is_first)


def _with_waves(
    points: _InTime, grouped: _Grouped, here: slice, waves: NDArray[np.uint16]
) -> PointsWithWaves:
    packet = np.asarray(grouped.packet[here])
    first, end = int(packet.min()), int(packet.max()) + 1
    owners = np.asarray(grouped.owner[first:end])
    time = np.nan_to_num(points.time(owners))
    directions = grouped.path.directions(points.xyz(owners), time)
    return PointsWithWaves(
        int(np.searchsorted(points.starts, here.start, side="right")) - 1,
        np.asarray(points.order[here]),
        packet - first,
        np.asarray(grouped.after_ns[here]),
        directions[packet - first],
        np.asarray(waves[first:end]),
    )
