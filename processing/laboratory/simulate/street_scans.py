"""A street scanned from a tripod that stands on it: its points with their labels."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path as FilePath

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from processing.core.monitor import Monitor
from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.scanning.beams import ScanPattern
from processing.laboratory.simulate.scanning.casting import RaycastScene
from processing.laboratory.simulate.scanning.delivered_files import (
    ArrayFile,
    DeliveredPoints,
    PointFile,
)
from processing.laboratory.simulate.scanning.noise_options import NoiseOptions
from processing.laboratory.simulate.scanning.passing_noise import Path
from processing.laboratory.simulate.scanning.return_kernels import intensities
from processing.laboratory.simulate.scanning.returns import (
    Returns,
    Weather,
    returns_of,
    scanner_numbers,
)
from processing.laboratory.simulate.scanning.scanner_noise import NoiseSource, PulseHits
from processing.laboratory.simulate.scanning.sensors import Sensor
from processing.laboratory.simulate.scanning.surroundings import scene_around
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.sites.recording import (
    LOWEST_RAD,
    TripodScanPattern,
    tripod_beams,
)

_PULSES_AT_ONCE = 60_000
_HIGHEST_RAD = np.radians(90.0)
_HIGH_M, _ASIDE_M = (1.4, 1.9), 3.0
_CLEAR_M, _TRIES = 0.8, 20
_ALL_ROUND = 200
_REACH_M = 110.0
_START_S = 350_000_000.0  # adjusted standard GPS time
_FIRST_PASS = 1000  # numbers of scans, apart from those of passes


@dataclass(frozen=True)
class StreetScan:
    """How a street is scanned from one place.

    Attributes
    ----------
    number : int
        From 0, of the scans of a street; each has a place and chance of its own.
    sensor : Sensor
        On a tripod.
    pulses : int
        About how many are sent in all.
    share : float
        Of the horizon that is scanned: the less, the finer.
    noise : NoiseOptions or None
        None: what is usual for the street's seed.
    """

    number: int
    sensor: Sensor
    pulses: int
    share: float = 1.0
    noise: NoiseOptions | None = None

    @property
    def pattern(self) -> TripodScanPattern:
        """The steps that send so many pulses."""
        solid = (_HIGHEST_RAD - LOWEST_RAD) * 2 * np.pi * self.share
        columns = max(8, int(np.ceil(2 * np.pi / np.sqrt(solid / self.pulses))))
        turn_s = max(1.0 / self.sensor.turns_per_s, columns / self.sensor.rate_hz)
        return TripodScanPattern(2 * np.pi / columns, turn_s, turn_s / columns, columns)


def scan_street(
    street: Street, scan: StreetScan, weather: Weather, file: FilePath, monitor: Monitor
) -> None:
    """Write a scan as ``file`` (LAZ) with its labels beside it, ``NAME.labels.npy``.

    Raises
    ------
    NoSpace, BadFile, Cancelled
    """
    random = chance(street.seed, "street scan", scan.number)
    chainage = float(random.uniform(0.2, 0.8)) * street.length_m
    row = street.within(chainage, chainage)[0]
    scene = scene_around(street, row, _REACH_M, monitor.check)
    position = _place(random, street, scene, chainage)
    with (
        PointFile(file, position) as points,
        ArrayFile(file.with_suffix(".labels.npy"), np.uint8) as labels,
    ):
        for returns in _stretches(street, scan, weather, scene, (position, random)):
            monitor.check()
            strength: NDArray[np.uint16] = np.empty(returns.pulse.size, np.uint16)
            intensities(returns.strength, weather.damping, strength)
            near = np.linalg.norm(returns.xyz - position, axis=1) < scan.sensor.most_m
            kept = returns.chosen(near)
            points.write(
                DeliveredPoints(
                    kept.xyz,
                    _START_S + kept.time_s,
                    strength[near],
                    kept.number,
                    kept.count,
                    scan.number + 1,
                )
            )
            labels.write(kept.label)


def _place(random: Generator, street: Street, scene: RaycastScene, chainage: float) -> Floats:
    """Where nothing stands within an arm's reach; the last try takes what there is."""
    turn = np.linspace(0, 2 * np.pi, _ALL_ROUND, endpoint=False)
    around = np.column_stack([np.cos(turn), np.sin(turn), np.zeros(_ALL_ROUND)])
    for _ in range(_TRIES):
        aside = float(random.uniform(-_ASIDE_M, _ASIDE_M))
        height = street.alignment.carriageway_height(chainage, aside) + random.uniform(*_HIGH_M)
        position: Floats = street.alignment.at(chainage, aside, height)
        met = scene.cast(np.broadcast_to(position, around.shape), around).ranges
        if float(np.min(met)) > _CLEAR_M:
            break
    return position


def _stretches(
    street: Street,
    scan: StreetScan,
    weather: Weather,
    scene: RaycastScene,
    place: tuple[Floats, Generator],
) -> Iterator[Returns]:
    pattern, (position, random) = scan.pattern, place
    start_rad = float(random.uniform(-np.pi, np.pi))
    key = int(random.integers(1, 1 << 31))
    rows = np.arange(LOWEST_RAD, _HIGHEST_RAD, pattern.step_rad)
    wanted = max(1, int(pattern.columns * scan.share))
    path = Path(np.zeros(1), position[None], stands=True)
    source = NoiseSource(
        street.seed,
        (_FIRST_PASS + scan.number, 0),
        scan.sensor,
        ScanPattern(rows.size, 1.0 / pattern.column_s, 0.0),
        path,
        options=scan.noise,
    )
    scanner = scanner_numbers(scan.sensor, pattern.columns, weather)
    per_stretch = max(1, _PULSES_AT_ONCE // rows.size)
    for first in range(0, wanted, per_stretch):
        columns = range(first, min(first + per_stretch, wanted))
        beams = tripod_beams(pattern, (position, start_rad), columns, rows, (0, 0.0))
        met = source.first_met(beams, scene.cast(beams.origins, beams.directions), scene)
        returns, _ = returns_of(beams, met, scene, scanner, key)
        yield source.added(PulseHits(beams, met, returns, scene, scanner))
