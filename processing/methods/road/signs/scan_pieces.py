"""Straight pieces of scan lines that may lie on plates, of all drives of a survey."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.monitor import Monitor, SilentMonitor
from processing.core.worked_ahead import in_order
from processing.methods.road.gutters.notches.head_position import head_position
from processing.methods.road.objects.drive_chunks import DriveChunk, chunks_of
from processing.methods.road.objects.sparse_plan import SparsePlan
from processing.methods.road.signs.brightness import CLASSES, Brightness, brightness_of
from processing.methods.road.signs.piece_kernels import (
    BRIGHTS,
    COUNT,
    ORIGIN_EVERY,
    PIECE,
    SHINE,
    ChunkPoints,
    PieceLimits,
    brightness_kernel,
    heights_kernel,
    pieces_kernel,
    range_classes,
    ranges_of,
    runs_kernel,
)
from processing.recording.columns.counted_classes import class_columns
from processing.recording.drive import Drive

_LOWEST_M = 1.0
"""Above the ground: signs hang from 1.8 m on (道路標識設置基準 2-2), plates below them and worn
posts lower."""

_SHORTEST_M = 0.07
"""Of a piece that isn't bright: the smallest plate is 10 cm high (標識令, 補助標識)."""

_LONGEST_M = 6.0
"""Of a piece: across the largest guide sign."""

_SAMPLES = 200
_SAMPLE_POINTS = 2_000
"""Stretches of a drive, and points of each, from which brightness and noise follow: of a country
road, beside which hardly anything rises, a hundredth are points of things."""

_USUAL_PULSES = 2_000
"""Of a turn, where a drive doesn't say."""

_MUCH_HIGH = 0.1
"""Share of points that rise above the ground from which few of them are of signs, whatever else
they are of. Where fewer do, a sign or two may be most of what rises."""

_NEAR = 1.5
"""Ranges of the road below the vehicle over the least: it is seen under 45 degrees and more."""

_OVER_ROAD = 5.0
"""What is this much brighter than the road below the vehicle is no diffuse thing: white paint
(reflectance 0.6 to 0.8) over asphalt (0.13 to 0.2), and farther away all is darker. Scales that are
a root or a logarithm of the strength show less of it."""

_FEWEST_HIGH = 1_500
"""Points of things from which they tell what is bright; where fewer rise, the road tells it too."""

_LOWEST_SHARE = 0.05
"""Of the points of a few turns: on the road, not below it."""

_FEWEST_STRAIGHT_M = 0.012
_STRAIGHT_NOISES = 4.0
"""Points of a straight piece lie so near to its line: four times the noise, and what a plate that
was bent by a few millimetres adds."""

_MOST_STRAIGHT_M = 0.04


_FEWEST_SHINING = 10
"""Points that shine, from which a survey is known to show faces: as many as a sign has that is
asked for."""


@dataclass(frozen=True)
class ScanPieces:
    """Straight pieces.

    Attributes
    ----------
    values : (n, PIECE) float64
        Columns of :mod:`.piece_kernels`, m about the origin of the plan.
    drive : (n,) int64
    row : (n,) int64
        Which turn of its drive's scanner each is of.
    ground : (n,) float64
        Height of the ground below its middle, m about the origin of the plan.
    at_end : (n,) bool
        Whether no turn came before it, or after it: what it lies on may go on.
    """

    values: Floats
    drive: Integers
    row: Integers
    ground: Floats
    at_end: NDArray[np.bool_]

    @cached_property
    def face_shine(self) -> float:
        """How bright faces are to this survey; NaN where nothing shone.

        In standard deviations above the middle of diffuse things, and of all drives together: a
        head that looks back meets backs alone, and measures as the one does that looks ahead.
        """
        counts = self.values[:, COUNT]
        bright = np.flatnonzero(2 * self.values[:, BRIGHTS] > counts)
        shine = self.values[bright, SHINE] / counts[bright]
        order = np.argsort(-shine, kind="stable")
        points = np.cumsum(counts[bright][order])
        enough = int(np.searchsorted(points, _FEWEST_SHINING))
        return float(shine[order[enough]]) if enough < order.size else math.nan

    def __len__(self) -> int:
        return len(self.values)


class _Head:
    """What is known of a drive's scanner: where it was, how fine it looks, what is bright to it."""

    def __init__(
        self,
        drive: Drive,
        plan: SparsePlan,
        ground: NDArray[np.float32] | None,
        monitor: Monitor,
    ) -> None:
        self._drive, self._plan = drive, plan
        self._ground = None if ground is None else ground.reshape(-1)
        self._lever = head_position(drive)
        revolutions = drive.revolutions
        self.pulses = revolutions.pulses_per_revolution if revolutions else _USUAL_PULSES
        self.limits = PieceLimits(
            _LOWEST_M, 2 * np.pi / self.pulses, _FEWEST_STRAIGHT_M, _SHORTEST_M, _LONGEST_M,
            drive.trajectory is not None, 10.0,
        )  # fmt: skip
        samples = self._samples(monitor)
        monitor.check()
        straight = _STRAIGHT_NOISES * _noise([one.local for one, _ in samples])
        limit = min(max(straight, _FEWEST_STRAIGHT_M), _MOST_STRAIGHT_M)
        monitor.check()
        brightness = self._brightness(samples)
        self.limits = self.limits._replace(straight_m=limit, brightness=brightness)

    def points(self, start: int, local: Floats, is_noise: NDArray[np.bool_]) -> ChunkPoints:
        """Points as the kernels take them."""
        stop = start + len(local)
        columns = self._drive.columns
        return ChunkPoints(
            np.ascontiguousarray(local),
            np.asarray(columns["pulse"][start:stop], np.int64),
            is_noise,
            np.asarray(columns["intensity"][start:stop], np.uint16),
            self._origins(start, stop),
        )

    def is_at_end(self, pulses: Integers) -> NDArray[np.bool_]:
        """(n,) whether pulses are of the first or of the last turn."""
        every = self._drive.columns["pulse"]
        first, last = (int(every[number]) for number in (0, -1)) if len(every) else (0, 0)
        return np.asarray((pulses < first + self.pulses) | (pulses > last - self.pulses))

    def heights(self, local: Floats) -> NDArray[np.float32]:
        """(n,) above the ground; where it isn't given, above what lies lowest among the points."""
        if self._ground is None:
            low = np.quantile(local[:, 2], _LOWEST_SHARE) if len(local) else 0.0
            return (local[:, 2] - low).astype(np.float32)
        heights = np.empty(len(local), np.float32)
        heights_kernel(local, self._plan.table, self._ground, heights)
        return heights

    def _origins(self, start: int, stop: int) -> Floats:
        """(m, 3) where the scanner was at every 256th point."""
        trajectory = self._drive.trajectory
        count = (stop - start - 1) // ORIGIN_EVERY + 1
        if trajectory is None:
            return np.zeros((count, 3))
        times = np.asarray(self._drive.columns["time"][start:stop:ORIGIN_EVERY], np.float64)
        times = np.clip(np.nan_to_num(times), trajectory.time[0], trajectory.time[-1])
        is_covered = trajectory.covers(times)
        if not is_covered.all():
            times[~is_covered] = (
                trajectory.time[0] if not is_covered.any() else times[is_covered][0]
            )
        turned = np.einsum("nij,j->ni", trajectory.rotations_at(times), self._lever)
        return np.asarray(trajectory.positions_at(times) + turned - self._plan.origin)

    def _samples(self, monitor: Monitor) -> list[tuple[ChunkPoints, NDArray[np.float32]]]:
        drive = self._drive
        step = max(1, drive.count // _SAMPLES)
        found = []
        for start in range(0, drive.count, step):
            monitor.check()
            stop = min(start + min(step, _SAMPLE_POINTS), drive.count)
            # Mapped: checksums are of blocks fifty times as long, and all points are read later.
            local = drive.coordinates.about(slice(start, stop), self._plan.origin)
            none = np.zeros(len(local), np.bool_)
            found.append((self.points(start, local, none), self.heights(local)))
        return found

    def _brightness(self, samples: Sequence[tuple[ChunkPoints, NDArray[np.float32]]]) -> Brightness:
        high = np.concatenate([heights >= self.limits.lowest_m for _, heights in samples])
        intensity = np.concatenate([chunk.intensity for chunk, _ in samples])
        ranges = np.concatenate([ranges_of(chunk, self.limits) for chunk, _ in samples])
        if high.mean() < _MUCH_HIGH and not high.all():
            near = ~high & (ranges <= _NEAR * np.quantile(ranges[~high], _LOWEST_SHARE))
            high &= intensity <= _OVER_ROAD * np.median(intensity[near])
        if np.count_nonzero(high) < _FEWEST_HIGH:
            high[:] = True
        return brightness_of(intensity[high], range_classes(ranges[high], CLASSES))


def scan_pieces(
    drives: Sequence[Drive], plan: SparsePlan, ground: NDArray[np.float32], monitor: Monitor
) -> ScanPieces:
    """All straight pieces of scan lines above the ground that end in the free, or are bright."""
    heads = list(in_order(lambda drive: _Head(drive, plan, ground, monitor), drives))
    values: list[Floats] = []
    owners: list[Integers] = []
    rows: list[Integers] = []
    at_end: list[NDArray[np.bool_]] = []

    def of_chunk(chunk: DriveChunk) -> tuple[int, Floats, Integers]:
        return chunk.drive, *_pieces_of(chunk, heads[chunk.drive], monitor)

    for drive, found, pulses in in_order(of_chunk, chunks_of(drives, plan.origin, monitor)):
        values.append(found)
        owners.append(np.full(len(found), drive, np.int64))
        rows.append((pulses / heads[drive].pulses).astype(np.int64))
        at_end.append(heads[drive].is_at_end(pulses))
    if not values:
        none = np.empty(0, np.int64)
        return ScanPieces(np.empty((0, PIECE)), none, none, np.empty(0), np.empty(0, np.bool_))
    whole = np.concatenate(values)
    middles = np.ascontiguousarray((whole[:, 0:3] + whole[:, 3:6]) / 2)
    heights = heads[0].heights(middles)
    return ScanPieces(
        whole, np.concatenate(owners), np.concatenate(rows), middles[:, 2] - heights,
        np.concatenate(at_end),
    )  # fmt: skip


def pieces_between(drive: Drive, start: int, stop: int, plan: SparsePlan) -> ScanPieces:
    """Pieces of some points of a drive alone, with the road there for ground."""
    head = _Head(drive, plan, None, SilentMonitor())
    local = drive.coordinates.chunk_about(start, stop, plan.origin)
    is_noise = class_columns(drive.columns).noise_between(start, stop)
    found, pulses = _pieces_of(DriveChunk(0, start, local, is_noise), head, SilentMonitor())
    ground = float(np.quantile(local[:, 2], _LOWEST_SHARE))
    rows = (pulses / head.pulses).astype(np.int64)
    return ScanPieces(
        found, np.zeros(len(found), np.int64), rows, np.full(len(found), ground),
        head.is_at_end(pulses),
    )  # fmt: skip


def _pieces_of(chunk: DriveChunk, head: _Head, monitor: Monitor) -> tuple[Floats, Integers]:
    """Pieces of a chunk, and the pulse of the first point of each."""
    points = head.points(chunk.start, chunk.local, chunk.is_noise)
    kinds = np.empty(len(chunk.local), np.uint8)
    brightness_kernel(points, head.heights(chunk.local), head.limits, kinds)
    monitor.check()
    runs = np.empty(len(kinds), np.int32)
    runs_kernel(points, kinds, head.limits, runs)
    monitor.check()
    room = np.empty((int(np.count_nonzero(kinds)) // 2 + 1, PIECE))
    found = room[: pieces_kernel(points, kinds, runs, head.limits, room)].copy()
    pulses = points.pulses[found[:, 10].astype(np.int64)]
    found[:, 10:12] += chunk.start
    return found, pulses


def _noise(parts: Sequence[Floats]) -> float:
    """How far points lie off the line of their neighbours, m: the middle of all."""
    off = []
    for local in parts:
        if len(local) < 3:
            continue
        chord = local[2:] - local[:-2]
        long = np.maximum(np.linalg.norm(chord, axis=1), 1e-9)
        beside = local[1:-1] - (local[2:] + local[:-2]) / 2
        along = np.einsum("ij,ij->i", beside, chord) / long
        across = np.sqrt(np.maximum(np.einsum("ij,ij->i", beside, beside) - along**2, 0.0))
        off.append(across[long < 0.3])
    every = np.concatenate(off) if off else np.empty(0)
    # The second difference of three points scatters √1.5 as much as one point does.
    return float(np.median(every) / 0.6745 / np.sqrt(1.5)) if every.size else 0.0
