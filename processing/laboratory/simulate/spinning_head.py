"""One turn of a head with many beams on a car's roof, as driverless cars carry it: a single scan.

The axis stands upright; each beam has its elevation and all turn together. What is higher than the
highest beam is never seen: of a façade ten metres away some four metres.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.cameras.rigs import Pose
from processing.laboratory.simulate.cameras.seen_street import SeenStreet
from processing.laboratory.simulate.moving_traffic.moving import movers_of
from processing.laboratory.simulate.scanning.beams import Beams
from processing.laboratory.simulate.scanning.return_kernels import intensities
from processing.laboratory.simulate.scanning.returns import (
    BeamHits,
    Weather,
    returns_of,
    scanner_numbers,
)
from processing.laboratory.simulate.scanning.sensors import Sensor
from processing.laboratory.simulate.scanning.simulated_passes import Driving, pass_of
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.street.styles import style_of

_BEAMS = (16, 32, 40, 64, 64, 128)
_LOWEST_DEG, _HIGHEST_DEG = (-30.0, -12.0), (1.0, 18.0)
_COLUMNS = (900, 2200)
"""Those of heads on cars of the last fifteen years, from 16 beams over ±15° on; what is delivered
of them is often thinned to a thousand directions."""

_UP_M, _TILT_DEG = (1.4, 2.6), 1.0
_NOISE_M, _REACH_M, _DIVERGENCE_RAD = (0.005, 0.03), (60.0, 120.0), (0.0005, 0.003)
_LOST = (0.0, 0.15)
"""Share of the pulses of which nothing is delivered."""

_SPEED_M_S = 8.0

SCANS = 4
_STREET_M, _AVENUES = 160.0, 0.35
_STYLES = ("urban",) * 7 + ("rural",) * 2 + ("highway",)
"""Scans of a street, its length, and how often a street is an avenue or of a style."""


@dataclass(frozen=True)
class SpinningHead:
    """A head and how it stands.

    Attributes
    ----------
    elevations_rad : (b,) float64
        Of the beams.
    columns : int
        Directions in a turn.
    up_m : float
        Above the road.
    tilt_rad : (2,) float64
        Of its axis, forward and to the left.
    lost : float
        Share of pulses without a point.
    sensor : Sensor
        What it measures with.
    """

    elevations_rad: Floats
    columns: int
    up_m: float
    tilt_rad: Floats
    lost: float
    sensor: Sensor


@dataclass(frozen=True)
class SpinningScan:
    """The points of a turn.

    Attributes
    ----------
    xyz : (n, 3) float64
        m, about the head, level.
    intensity : (n,) uint16
    labels : (n,) uint8
        Codes of the contract.
    instance : (n,) int32
        Of which thing of the street each is.
    """

    xyz: Floats
    intensity: NDArray[np.uint16]
    labels: NDArray[np.uint8]
    instance: NDArray[np.int32]


def any_spinning_head(random: Generator) -> SpinningHead:
    """A head of any number of beams, height and range."""
    beams = int(random.choice(_BEAMS))
    elevations = np.linspace(random.uniform(*_LOWEST_DEG), random.uniform(*_HIGHEST_DEG), beams)
    columns = int(np.exp(random.uniform(*np.log(_COLUMNS))))
    sensor = Sensor(
        id="spinning",
        name=Text.same("spinning head"),
        kind="standing",
        turns_per_s=10.0,
        pulses=columns,
        measures_by="pulse",
        most_m=float(random.uniform(*_REACH_M)),
        noise_m=float(np.exp(random.uniform(*np.log(_NOISE_M)))),
        exit_m=0.01,
        divergence_rad=float(np.exp(random.uniform(*np.log(_DIVERGENCE_RAD)))),
        returns=1,
    )
    return SpinningHead(
        np.radians(elevations),
        columns,
        float(random.uniform(*_UP_M)),
        np.radians(random.normal(0.0, _TILT_DEG, 2)),
        float(random.uniform(*_LOST)),
        sensor,
    )


def scanned_streets(seeds: Sequence[int]) -> Iterator[tuple[Street, list[SpinningScan]]]:
    """Streets of seeds of any style, each with single scans of it."""
    for seed in seeds:
        random = chance(seed, "spin street")
        style = style_of(_STYLES[int(random.integers(len(_STYLES)))])
        street = Street(seed, style, _STREET_M, is_avenue=bool(random.random() < _AVENUES))
        yield street, spinning_scans(street, SCANS)


def spinning_scans(street: Street, count: int) -> list[SpinningScan]:
    """Single scans from places of a pass along a street, each by a head of its own."""
    random = chance(street.seed, "spinning heads")
    driven = pass_of(street, 0, Driving(_SPEED_M_S, stops=False, drift_m=0.0, attitude_deg=0.0))
    seen = SeenStreet(street, movers_of(street, driven), SilentMonitor().check)
    scans = []
    for record in np.sort(random.integers(driven.time_s.size, size=count)).tolist():
        head = any_spinning_head(random)
        chainage = float(driven.chainages[record])
        position = driven.positions[record].copy()
        road_m = street.alignment.carriageway_height(chainage, 0.0)
        position[2] = road_m + head.up_m
        pose = Pose(
            float(driven.time_s[record]),
            position,
            driven.rotations[record],
            np.zeros(3),
            chainage,
        )
        scans.append(_scan(seen, pose, head, random))
    return scans


def _scan(seen: SeenStreet, pose: Pose, head: SpinningHead, random: Generator) -> SpinningScan:
    turns = 2 * np.pi * np.arange(head.columns) / head.columns
    azimuth = np.repeat(turns, head.elevations_rad.size)
    elevation = np.tile(head.elevations_rad, turns.size)
    flat = np.cos(elevation)
    forward, left = head.tilt_rad
    inside = np.column_stack([flat * np.cos(azimuth), flat * np.sin(azimuth), np.sin(elevation)])
    tilted = inside + np.column_stack(
        [-forward * inside[:, 2], -left * inside[:, 2], inside[:, :2] @ head.tilt_rad]
    )
    directions = tilted / np.linalg.norm(tilted, axis=1)[:, None]
    directions = directions @ pose.turn.T
    origins = np.broadcast_to(pose.position, directions.shape)
    beams = Beams(0, np.zeros(azimuth.size), origins, directions)
    scenes = seen.at(pose)
    met = BeamHits.of(scenes[0].cast(origins, directions), scenes[0].mesh)
    for scene in scenes[1:]:
        met.take(np.arange(azimuth.size), scene.cast(origins, directions), scene.mesh)
    weather = Weather(0.0, float(random.uniform(0.3, 0.9)), 0.9, float(0.03 ** random.random()))
    scanner = scanner_numbers(head.sensor, head.columns, weather)
    returns, _ = returns_of(beams, met, scenes[0], scanner, int(random.integers(1, 1 << 31)))
    away = np.linalg.norm(returns.xyz - pose.position, axis=1)
    kept = (away < head.sensor.most_m) & (random.random(away.size) >= head.lost)
    strength = np.empty(away.size, np.uint16)
    intensities(returns.strength, weather.damping, strength)
    xyz, instance = returns.xyz[kept] - pose.position, returns.instance[kept]
    return SpinningScan(xyz, strength[kept], returns.label[kept], instance)
