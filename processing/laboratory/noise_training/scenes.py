"""Training scenes: what a scanner measured in a simulated street, and what of it is noise."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.laboratory.noise_training.noise_kinds import NoiseMaker, ambiguity_of
from processing.laboratory.noise_training.rays import NOWHERE, trace_rays
from processing.laboratory.noise_training.scanners import (
    AIRBORNE,
    MOBILE,
    STANDING,
    Shots,
    airborne_shots,
    mobile_shots,
    standing_shots,
)
from processing.laboratory.noise_training.streets import GRASS, ROAD, TrainingStreet, street_of
from processing.methods.noise.beams.beam_kernels import PointBeams

_STREAMS = {MOBILE: 1, STANDING: 2, AIRBORNE: 3}
_LIKE_TRUE_M = 0.05  # noise nearer to the true surface is left out
_PIECES = 0.08
_FEWEST_OF_A_PIECE = 100
_DEEPEST_M = -30.0
_FAR_M = 1e9


@dataclass(frozen=True)
class TrainingScene:
    """Points with their truth, in the order in which they were measured.

    Attributes
    ----------
    xyz, origins : (n, 3) float64
        m.
    ranges : (n,) float64
        m.
    rows, columns, scans : (n,) int64
    intensity : (n,) uint16
    kinds : (n,) int64
        What was met, as `KINDS`; −1 for noise.
    noise : (n,) int64
        As `NOISE_KINDS`.
    """

    xyz: Floats
    origins: Floats
    ranges: Floats
    rows: Integers
    columns: Integers
    scans: Integers
    intensity: NDArray[np.uint16]
    kinds: Integers
    noise: Integers

    def chosen(self, points: NDArray[np.bool_] | Integers) -> TrainingScene:
        """Some of the points."""
        return TrainingScene(*(getattr(self, one.name)[points] for one in fields(self)))

    def beams(self, turn: float) -> PointBeams:
        """As a recording whose beams are known, about its middle."""
        middle = np.median(self.xyz, axis=0)
        rows = self.rows - self.rows.min()
        starts = np.searchsorted(rows, np.arange(int(rows.max()) + 2))
        segments = np.zeros(starts.size - 1, np.int32)
        firsts = np.minimum(starts[:-1], rows.size - 1)
        segments[:] = self.scans[firsts]
        return PointBeams(
            self.xyz - middle,
            self.origins - middle,
            self.ranges,
            self.columns.astype(np.int32),
            starts.astype(np.int64),
            segments,
            turn,
        )


def scene_of(seed: int, how: str, budget: int) -> tuple[TrainingScene, float]:
    """A scene and the angle from beam to beam.

    Parameters
    ----------
    how : {"mobile", "standing", "airborne"}
    budget : int
        About how many beams are sent.
    """
    random = np.random.default_rng(seed * 7 + _STREAMS[how])
    length_m = random.uniform(40, 80)
    street = street_of(random, length_m, has_far=how != MOBILE or random.random() < 0.5)
    if how == MOBILE:
        shots, footprint = mobile_shots(random, length_m, budget), random.uniform(0.0005, 0.0015)
    elif how == STANDING:
        stations = int(random.integers(1, 5))
        shots, footprint = standing_shots(random, length_m, budget, stations), 0.0004
    else:
        shots, footprint = airborne_shots(random, length_m, budget), 0.0005
    scene = _measure_scene(random, street, shots, footprint, (how, length_m))
    if how == MOBILE and random.random() < 0.5:  # cut to a strip, as surveyors do
        low, wide = random.uniform(-15, 0), random.uniform(15, 30)
        y = scene.xyz[:, 1]
        scene = scene.chosen((y > low) & (y < low + wide))
    return scene, shots.turn


def thin_scene(scene: TrainingScene, seed: int) -> TrainingScene:
    """As clouds are delivered without their order: some thinned, some by a grid, some in pieces."""
    random = np.random.default_rng(seed)
    if random.random() < _PIECES:
        middle = scene.xyz[random.integers(scene.ranges.size)]
        piece = np.abs(scene.xyz - middle).max(axis=1) < random.uniform(1.5, 8)
        scene = scene.chosen(piece) if piece.sum() > _FEWEST_OF_A_PIECE else scene
    way = random.random()
    if way < 0.4:
        return scene
    if way < 0.7:
        return scene.chosen(random.random(scene.ranges.size) < 2 ** random.uniform(-2.5, 0))
    cells = np.floor(scene.xyz / random.uniform(0.01, 0.06)).astype(np.int64)
    order = random.permutation(cells.shape[0])
    _, firsts = np.unique(cells[order], axis=0, return_index=True)
    return scene.chosen(np.sort(order[firsts]))


def _measure_scene(
    random: Generator,
    street: TrainingStreet,
    shots: Shots,
    footprint: float,
    where: tuple[str, float],
) -> TrainingScene:
    how, length_m = where
    things = np.array(street.things)
    count = shots.rows.size
    chances = random.random((count, 4))
    met = trace_rays(shots.origins, shots.directions, things, footprint, chances[:, :2].copy())
    kinds = np.where(met.things >= 0, things[met.things, 1].astype(np.int64), -1)
    albedos = np.where(met.things >= 0, things[met.things, 2], 0.0)
    kinds = _grow_grass(random, street, shots, met.ranges, (kinds, chances[:, 2:]))
    ambiguity_m = ambiguity_of(random)
    most_m = _FAR_M if how == AIRBORNE else min(ambiguity_m, 119.0)
    if how == MOBILE:
        most_m = min(ambiguity_m, random.uniform(80, 119))
        if random.random() < 0.5:
            ambiguity_m = most_m = random.uniform(45, 60)
    maker = NoiseMaker(
        random, shots, met, kinds, street, most_m, np.zeros(count, np.int64), met.ranges.copy()
    )
    if how == AIRBORNE:
        maker.from_the_air(length_m)
    else:
        maker.on_the_ground(footprint, ambiguity_m)
    is_noise = maker.noise > 0
    fuzz = random.normal(0, random.uniform(0.001, 0.008), count) * (1 + met.ranges * 0.01)
    ranges = np.where(is_noise, maker.ranges, maker.ranges + np.where(met.things >= 0, fuzz, 0))
    xyz = shots.origins + shots.directions * ranges[:, None]
    kept = (ranges < most_m) & (ranges > 0.6) & (ranges < NOWHERE) & (xyz[:, 2] > _DEEPEST_M)
    kept &= is_noise | ((met.things >= 0) & (random.random(count) < random.uniform(0.93, 1)))
    kept &= ~(is_noise & (np.abs(maker.ranges - met.ranges) < _LIKE_TRUE_M))
    scene = TrainingScene(
        xyz,
        shots.origins,
        ranges,
        shots.rows,
        shots.columns,
        shots.scans,
        _intensities(random, ranges, albedos, is_noise),
        np.where(is_noise, -1, kinds),
        maker.noise,
    )
    return scene.chosen(kept)


def _grow_grass(
    random: Generator,
    street: TrainingStreet,
    shots: Shots,
    ranges: Floats,
    seen: tuple[Integers, Floats],
) -> Integers:
    """Let grass grow beside the pavement: shorter ``ranges``, in place, and the kinds."""
    kinds, chances = seen
    aside = np.abs(shots.origins[:, 1] + ranges * shots.directions[:, 1])
    start = street.half_width + street.walk
    is_grass = (kinds == ROAD) & (aside > start) & (aside < start + 7) & (chances[:, 0] < 0.55)
    is_grass &= street.has_grass
    high = random.uniform(0.08, 0.35) * chances[:, 1] ** 0.7
    nearer = np.minimum(high / np.maximum(np.abs(shots.directions[:, 2]), 0.08), 2.5)
    ranges[is_grass] -= nearer[is_grass]
    return np.where(is_grass, GRASS, kinds)


def _intensities(
    random: Generator, ranges: Floats, albedos: Floats, is_noise: NDArray[np.bool_]
) -> NDArray[np.uint16]:
    near = np.minimum(1.0, 8 / np.maximum(ranges, 1.0))
    count = ranges.size
    true = 60_000 * albedos * near ** random.uniform(0.5, 2) * np.exp(random.normal(0, 0.15, count))
    if random.random() < 0.7:
        weak = 10.0 ** random.uniform(2, 4, count)
    else:
        weak = 60_000 * near * random.uniform(0.05, 0.8, count)
    return np.clip(np.where(is_noise, weak, true), 1, 65_535).astype(np.uint16)
