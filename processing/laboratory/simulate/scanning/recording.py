"""A pass recorded: sections in their order, pulses in stretches, files and evidence as they come.

Scenes hold the sections around the vehicle and are made once per section, so memory doesn't grow
with the street; stretches begin at fixed pulses, so the points don't depend on how it is cut.
"""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, wait
from dataclasses import dataclass
from threading import Event
from typing import TypeVar

import numpy as np

from processing.core.errors import Cancelled
from processing.core.monitor import Monitor
from processing.laboratory.simulate.assembly.street import BuiltSection, Street
from processing.laboratory.simulate.scanning.beams import ScanPattern, beams_of
from processing.laboratory.simulate.scanning.casting import RaycastScene
from processing.laboratory.simulate.scanning.moving import MovingScene
from processing.laboratory.simulate.scanning.noise_options import NoiseOptions
from processing.laboratory.simulate.scanning.passing_noise import Path
from processing.laboratory.simulate.scanning.returns import (
    Returns,
    Weather,
    returns_of,
    scanner_numbers,
)
from processing.laboratory.simulate.scanning.scanner_noise import NoiseSource, PulseHits
from processing.laboratory.simulate.scanning.sensors import Head, Sensor
from processing.laboratory.simulate.scanning.simulated_passes import SimulatedPass
from processing.laboratory.simulate.scanning.surroundings import scene_around
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.mesh import Floats, Integers

_STRETCH = 1 << 17
_REACH_M = 110.0
_PATIENCE_S = 0.05  # between questions whether to stop
_WORKERS = max(2, min(8, os.cpu_count() or 2))

BatchT = TypeVar("BatchT")


@dataclass(frozen=True)
class Setup:
    """What records.

    Attributes
    ----------
    sensor : Sensor
    scan_pattern : ScanPattern
        Of all heads; each starts at an angle of its own.
    weather : Weather
    noise : NoiseOptions or None
        None: what is usual for the seed.
    """

    sensor: Sensor
    scan_pattern: ScanPattern
    weather: Weather
    noise: NoiseOptions | None = None


@dataclass(frozen=True)
class HeadChunk:
    """Some points of one head, in their order."""

    head: Head
    returns: Returns


class SimulatedRecording:
    """One pass along a street.

    Parameters
    ----------
    driven : Pass
    moving : MovingScene
        What drives and walks meanwhile.
    """

    def __init__(
        self, street: Street, setup: Setup, driven: SimulatedPass, moving: MovingScene
    ) -> None:
        self._street, self._setup, self._driven, self._moving = street, setup, driven, moving
        self._spins = [self._scan_pattern(number) for number in range(len(setup.sensor.heads))]
        self._scanner = scanner_numbers(setup.sensor, setup.scan_pattern.pulses, setup.weather)
        self._keys = [
            int(chance(street.seed, "returns", driven.number, number).integers(1 << 40))
            for number in range(len(self._spins))
        ]
        self._noise = [
            NoiseSource(
                street.seed,
                (driven.number, number),
                setup.sensor,
                scan_pattern,
                Path(driven.time_s, driven.positions),
                options=setup.noise,
            )
            for number, scan_pattern in enumerate(self._spins)
        ]

    @property
    def pulses(self) -> int:
        """Of one head, in all; one at least, however short the pass."""
        return max(1, int(self._driven.duration_s * self._setup.scan_pattern.rate_hz))

    def sections(self) -> Iterator[BuiltSection]:
        """The sections that are seen, in their order along the street; built when asked for."""
        low, high = self._driven.chainages.min(), self._driven.chainages.max()
        for row in self._street.within(low - _REACH_M, high + _REACH_M):
            yield self._street.section(row)

    def chunks(self, monitor: Monitor) -> Iterator[HeadChunk]:
        """All points, of every head in the order of its time.

        Raises
        ------
        Cancelled
        """
        spans = self._spans()
        ended = Event()

        def check() -> None:
            if ended.is_set():
                raise Cancelled

        with ThreadPoolExecutor(_WORKERS) as pool:
            coming = pool.submit(scene_around, self._street, spans[0][0], _REACH_M, check)
            waiting: deque[Future[HeadChunk]] = deque()
            try:
                for number, (_, pulses) in enumerate(spans):
                    scene = _result(coming, monitor)
                    if number + 1 < len(spans):
                        row = spans[number + 1][0]
                        coming = pool.submit(scene_around, self._street, row, _REACH_M, check)
                    for head, part in self._tasks(pulses):
                        waiting.append(pool.submit(self._record, scene, head, part))
                        while len(waiting) > 2 * _WORKERS:
                            yield _result(waiting.popleft(), monitor)
                    monitor.report(pulses.stop / max(1, self.pulses))
                while waiting:
                    yield _result(waiting.popleft(), monitor)
            finally:
                ended.set()
                coming.cancel()
                for one in waiting:
                    one.cancel()

    def _scan_pattern(self, head: int) -> ScanPattern:
        scan_pattern = self._setup.scan_pattern
        random = chance(self._street.seed, "spin", self._driven.number, head)
        return ScanPattern(
            scan_pattern.pulses, scan_pattern.turns_per_s, float(random.uniform(0, 2 * np.pi))
        )

    def _spans(self) -> list[tuple[int, range]]:
        """Sections (rows of the street's plans) that are driven through, and pulses sent there."""
        driven = self._driven
        direction = -1 if driven.number % 2 else 1
        rows = list(self._street.within(driven.chainages.min(), driven.chainages.max()))[
            ::direction
        ]
        plans = self._street.plans
        edges = [plans[row].end_m if direction > 0 else plans[row].start_m for row in rows[:-1]]
        at = np.searchsorted(direction * driven.chainages, direction * np.array(edges))
        times = driven.time_s[np.minimum(at, driven.time_s.size - 1)]
        cuts = [
            0,
            *np.ceil(times * self._setup.scan_pattern.rate_hz).astype(int).tolist(),
            self.pulses,
        ]
        cuts = np.minimum(cuts, self.pulses).tolist()
        return [
            (row, range(start, stop))
            for row, start, stop in zip(rows, cuts[:-1], cuts[1:], strict=True)
            if stop > start
        ]

    def _tasks(self, pulses: range) -> Iterator[tuple[int, range]]:
        start = pulses.start
        while start < pulses.stop:
            stop = min(pulses.stop, (start // _STRETCH + 1) * _STRETCH)
            for head in range(len(self._spins)):
                yield head, range(start, stop)
            start = stop

    def _record(self, scene: RaycastScene, number: int, pulses: range) -> HeadChunk:
        head = self._setup.sensor.heads[number]
        beams = beams_of(self._driven, head, self._spins[number], pulses)
        hits = scene.cast(beams.origins, beams.directions)
        met = self._noise[number].first_met(beams, hits, scene)
        self._moving.meet(beams, met)
        returns, _ = returns_of(beams, met, scene, self._scanner, self._keys[number])
        noisy = self._noise[number].added(PulseHits(beams, met, returns, scene, self._scanner))
        return HeadChunk(head, noisy)


def _result(coming: Future[BatchT], monitor: Monitor) -> BatchT:
    """What a worker finds; whoever waits for it can be stopped meanwhile."""
    monitor.check()
    while not wait((coming,), _PATIENCE_S).done:
        monitor.check()
    return coming.result()


class Evidence:
    """How many points show each piece of each thing."""

    def __init__(self) -> None:
        self._keys: list[Integers] = []
        self._counts: list[Integers] = []

    def count(self, returns: Sequence[Returns]) -> None:
        """Count points."""
        for one in returns:
            keys, counts = np.unique(one.evidence[one.evidence >= 0], return_counts=True)
            self._keys.append(keys)
            self._counts.append(counts)
        if len(self._keys) > 64:
            self._merge()

    def of(self, instance: int) -> Integers:
        """Points on each of the 256 pieces of a thing."""
        self._merge()
        keys, counts = self._keys[0], self._counts[0]
        low, high = np.searchsorted(keys, [instance * 256, (instance + 1) * 256])
        pieces = np.zeros(256, np.int64)
        pieces[keys[low:high] - instance * 256] = counts[low:high]
        return pieces

    def _merge(self) -> None:
        if len(self._keys) == 1:
            return
        keys = np.concatenate([np.empty(0, np.int64), *self._keys])
        counts = np.concatenate([np.empty(0, np.int64), *self._counts])
        merged, position = np.unique(keys, return_inverse=True)
        self._keys = [merged]
        self._counts = [np.bincount(position, counts, merged.size).astype(np.int64)]


def delivered_positions(
    driven: SimulatedPass, head: Head, returns: Returns, mounted_rad: Floats
) -> Floats:
    """Places as they are delivered: off by what trajectory, attitude and mounting are off.

    Parameters
    ----------
    mounted_rad : (3,) float64
        How far the head is turned from what its calibration says, as `SimulatedPass.turned_rad`.

    Returns
    -------
    (n, 3) float64
        m, the street's frame.
    """
    errors = np.column_stack(
        [np.interp(returns.time_s, driven.time_s, one) for one in driven.errors.T]
    )
    if not (driven.turned_rad.any() or mounted_rad.any()):
        return np.asarray(returns.xyz + errors)
    row = np.clip(np.searchsorted(driven.time_s, returns.time_s), 0, driven.time_s.size - 1)
    axes = driven.rotations[row]
    at = np.column_stack(
        [np.interp(returns.time_s, driven.time_s, one) for one in driven.positions.T]
    )
    # In the vehicle's frame; a turn by a small vector moves a place by their cross product.
    away = np.einsum("nij,ni->nj", axes, returns.xyz - at)
    moved = np.cross(driven.turned_rad[row], away)
    moved += np.cross(mounted_rad, away - np.array(head.lever_m))
    return np.asarray(returns.xyz + errors + np.einsum("nij,nj->ni", axes, moved))
