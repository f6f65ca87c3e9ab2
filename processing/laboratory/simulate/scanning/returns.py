"""Returns of a stretch of pulses: what was met, what was measured of it, and what is noise."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from processing.laboratory.simulate.scanning.beams import Beams
from processing.laboratory.simulate.scanning.casting import CastHits, RaycastScene
from processing.laboratory.simulate.scanning.return_kernels import (
    MIXED,
    OPEN,
    edge_returns,
    first_returns,
)
from processing.laboratory.simulate.scanning.sensors import Sensor
from processing.laboratory.simulate.scene.materials import SURFACES, Material
from processing.laboratory.simulate.scene.mesh import Floats, Integers, Mesh

LOW_NOISE, HIGH_NOISE = 7, 18
PIECES = 256
"""Pieces of a thing: a key of evidence is instance × PIECES + piece."""

NO_EVIDENCE = -1
_STEP_BEHIND_M = 0.05
_MOST_LATER = 2
_PASSES_ON = 0.55
_PULSE_LENGTH_M = 0.7
_FEWEST_M = 1.2  # nearer is the vehicle itself
_WEAKEST_SHARE = 0.02
OPTICS: Floats = np.array(
    [
        (
            one.reflectance,
            one.spread,
            one.roughness_m,
            one.grain_m,
            one.shine,
            one.retro,
            one.stands_m,
            float(one.is_open),
        )
        for one in (SURFACES[material] for material in Material)
    ]
)
"""(materials, 8) All materials as the kernels take them."""

_IS_OPEN = OPTICS[:, OPEN] > 0


@dataclass(frozen=True)
class Weather:
    """What changes from recording to recording.

    Attributes
    ----------
    wetness : float
        Share of the ground that is wet, 0 to 1.
    damping : float
        Exponent of intensity over power: 1 in proportion, less where the maker evens out.
    levelled : float
        How far the maker takes out what the range does: 0 not at all, 1 wholly.
    growth : float
        Height of grass as a share of that of a meadow, 0 to 1: mown lawns have next to none;
        beyond 1 it is left to grow.
    flattest : float
        Sine of the angle to the ground below which beams don't end any farther before the ground
        for the grass on it: the less, the sooner dense grass ends them.
    """

    wetness: float
    damping: float
    levelled: float = 0.0
    growth: float = 1.0
    flattest: float = 0.25


@dataclass(frozen=True)
class Returns:
    """Points in the order in which they were measured.

    Attributes
    ----------
    pulse : (n,) int64
        Counted from the beginning of the pass.
    time_s : (n,) float64
    xyz : (n, 3) float64
        m, the street's frame.
    strength : (n,) float64
        Power as the scanner tells it; 1 for a white surface 10 m away.
    number, count : (n,) uint8
        Which return of how many of its pulse.
    label : (n,) uint8
    evidence : (n,) int64
        Instance × 256 + piece; `NO_EVIDENCE` for noise.
    """

    pulse: Integers
    time_s: Floats
    xyz: Floats
    strength: Floats
    number: NDArray[np.uint8]
    count: NDArray[np.uint8]
    label: NDArray[np.uint8]
    evidence: Integers

    def chosen(self, points: NDArray[np.bool_] | Integers) -> Returns:
        """Some of the points."""
        return Returns(*(getattr(self, one.name)[points] for one in fields(self)))

    @staticmethod
    def joined(parts: Sequence[Returns]) -> Returns:
        """All points of some, one after the other."""
        return Returns(
            *(
                np.concatenate([getattr(one, name.name) for one in parts])
                for name in fields(Returns)
            )
        )

    @property
    def instance(self) -> NDArray[np.int32]:
        """The thing that each point is of; 0 for none."""
        return np.maximum(self.evidence // PIECES, 0).astype(np.int32)


@dataclass
class BeamHits:
    """What beams met first, of all scenes together.

    Attributes
    ----------
    ranges, cosines : (n,) float64
        m, infinite where nothing was met.
    material, label : (n,) uint8
    evidence : (n,) int64
    """

    ranges: Floats
    cosines: Floats
    material: NDArray[np.uint8]
    label: NDArray[np.uint8]
    evidence: Integers

    @staticmethod
    def of(hits: CastHits, mesh: Mesh) -> BeamHits:
        """What was met of one mesh."""
        count = hits.ranges.size
        met = BeamHits(
            np.full(count, np.inf),
            np.ones(count),
            np.zeros(count, np.uint8),
            np.zeros(count, np.uint8),
            np.full(count, NO_EVIDENCE, np.int64),
        )
        met.take(np.flatnonzero(hits.triangles >= 0), hits, mesh)
        return met

    def take(self, rays: Integers, hits: CastHits, mesh: Mesh) -> None:
        """Take over what of another mesh lies nearer: hits of all rays, or of ``rays`` alone."""
        part = rays if hits.ranges.size == self.ranges.size else np.arange(rays.size)
        nearer = hits.ranges[part] < self.ranges[rays]
        rays, part = rays[nearer], part[nearer]
        found = hits.triangles[part]
        self.ranges[rays], self.cosines[rays] = hits.ranges[part], hits.cosines[part]
        self.material[rays], self.label[rays] = mesh.material[found], mesh.label[found]
        self.evidence[rays] = mesh.instance[found].astype(np.int64) * PIECES + mesh.piece[found]


def weakest_of(sensor: Sensor) -> float:
    """The weakest echo that a scanner takes for one; 1 is that of a white surface 10 m away."""
    return _WEAKEST_SHARE * (10.0 / (0.25 * sensor.most_m)) ** 2


def scanner_numbers(sensor: Sensor, pulses: int, weather: Weather) -> Floats:
    """The numbers of a scanner for the kernels: (13,) float64."""
    return np.array(
        [
            sensor.noise_m,
            sensor.exit_m,
            sensor.divergence_rad,
            2 * np.pi / pulses,
            sensor.returns,
            float(sensor.measures_by == "phase"),
            weakest_of(sensor),
            weather.levelled,
            weather.wetness,
            _PULSE_LENGTH_M,
            weather.growth,
            1.0,
            weather.flattest,
        ]
    )


def returns_of(
    beams: Beams, met: BeamHits, scene: RaycastScene, scanner: Floats, key: int
) -> tuple[Returns, Floats]:
    """What comes back of beams, without the noise that a scanner adds of its own.

    Parameters
    ----------
    scene : RaycastScene
        What the beams go on into behind leaves and nets.
    scanner : (13,) float64
        `scanner_numbers`.
    key : int
        Of the recording's chance.

    Returns
    -------
    returns : Returns
        What came back.
    ranges : (beams,) float64
        The true range of the first return of every pulse, NaN where there is none.
    """
    count = met.ranges.size
    ranges, truths, strengths = np.empty(count), np.empty(count), np.empty(count)
    met.ranges[met.ranges < _FEWEST_M] = np.inf
    first_returns(
        (beams.first, beams.origins, beams.directions),
        (met.ranges, met.cosines, met.material),
        OPTICS,
        scanner,
        key,
        (ranges, truths, strengths),
    )
    seconds, others, kinds = np.empty(count), np.empty(count, np.int64), np.empty(count, np.uint8)
    bodies = met.evidence // PIECES + met.label.astype(np.int64) * (1 << 40)
    out = (ranges, strengths, seconds, others, kinds)
    edge_returns(beams.first, (truths, bodies), scanner, key, out)
    is_there = ~np.isnan(ranges)
    label = np.where(kinds == MIXED, HIGH_NOISE, met.label).astype(np.uint8)
    evidence = np.where(kinds == MIXED, NO_EVIDENCE, met.evidence)
    firsts = _Echoes(np.flatnonzero(is_there), ranges, strengths, label, evidence)
    parts = [firsts.of_all(beams)]
    if scanner[4] > 1.5:
        parts += _beside(beams, met, seconds, others, strengths)
        parts += _behind(beams, met, scene, (ranges, seconds, strengths), key)
    return _ordered(beams, parts), truths


@dataclass(frozen=True)
class _Echoes:
    """Returns of some pulses: their rows among the beams, and values of all beams."""

    rays: Integers
    ranges: Floats
    strengths: Floats
    labels: NDArray[np.uint8]
    evidence: Integers

    def of_all(self, beams: Beams) -> Returns:
        rays = self.rays
        ones = np.ones(rays.size, np.uint8)
        return Returns(
            beams.first + rays,
            beams.time_s[rays],
            beams.origins[rays] + beams.directions[rays] * self.ranges[rays, None],
            self.strengths[rays],
            ones,
            ones,
            self.labels[rays],
            self.evidence[rays],
        )


def _beside(
    beams: Beams, met: BeamHits, seconds: Floats, others: Integers, strengths: Floats
) -> list[Returns]:
    """Second returns at edges, where the neighbouring beam met what is beside."""
    rays = np.flatnonzero(~np.isnan(seconds))
    there = _Echoes(rays, seconds, strengths * 0.4, met.label[others], met.evidence[others])
    returns = there.of_all(beams)
    directions = beams.directions[others[rays]]
    return [replace(returns, xyz=beams.origins[rays] + directions * seconds[rays, None])]


def _behind(
    beams: Beams,
    met: BeamHits,
    scene: RaycastScene,
    measured: tuple[Floats, Floats, Floats],
    key: int,
) -> list[Returns]:
    """Later returns, from behind leaves and nets."""
    ranges, seconds, strengths = measured
    parts = []
    rays = np.flatnonzero(~np.isnan(ranges) & np.isnan(seconds) & _IS_OPEN[met.material])
    reach = met.ranges
    for step in range(_MOST_LATER):
        rays = rays[shares_of(beams.first + rays, key + 20 + step) < _PASSES_ON]
        if rays.size == 0:
            break
        start = reach[rays] + _STEP_BEHIND_M
        directions = beams.directions[rays]
        hits = scene.cast(beams.origins[rays] + directions * start[:, None], directions)
        behind = BeamHits.of(hits, scene.mesh)
        is_apart = np.isfinite(behind.ranges) & (behind.ranges > _PULSE_LENGTH_M)
        rays, start = rays[is_apart], start[is_apart]
        there = _taken(behind, is_apart)
        far = np.full(met.ranges.size, np.nan)
        far[rays] = start + there.ranges
        labels, evidence = met.label.copy(), met.evidence.copy()
        labels[rays], evidence[rays] = there.label, there.evidence
        fuzz = 0.006 * (shares_of(beams.first + rays, key + 30 + step) - 0.5)
        noisy = far.copy()
        noisy[rays] += fuzz
        parts.append(
            _Echoes(rays, noisy, strengths * 0.45 ** (step + 1), labels, evidence).of_all(beams)
        )
        rays, reach = rays[_IS_OPEN[there.material]], far
    return parts


def _taken(met: BeamHits, rows: NDArray[np.bool_]) -> BeamHits:
    return BeamHits(*(getattr(met, one.name)[rows] for one in fields(met)))


def shares_of(numbers: Integers, salt: int) -> Floats:
    """Numbers from 0 to 1 that belong to numbers and a salt (as `return_kernels.share_of`)."""
    bits = numbers.astype(np.uint64) * np.uint64(0x9E3779B97F4A7C15)
    bits += np.uint64(salt * 0xD1B54A32D192ED03 % (1 << 64))
    bits = (bits ^ (bits >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    bits = (bits ^ (bits >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    bits ^= bits >> np.uint64(31)
    return (bits >> np.uint64(11)).astype(np.float64) / float(1 << 53)


def _ordered(beams: Beams, parts: list[Returns]) -> Returns:
    """Returns of all kinds by pulse and range, numbered within their pulse."""
    joined = parts[0]
    if len(parts) > 1:
        joined = Returns.joined(parts)
        away = np.linalg.norm(joined.xyz - beams.origins[joined.pulse - beams.first], axis=1)
        joined = joined.chosen(np.lexsort((away, joined.pulse)))
    return number_returns(joined)


def number_returns(returns: Returns) -> Returns:
    """The same with number and count of returns as they are now."""
    pulse = returns.pulse
    if pulse.size == 0:
        return returns
    starts = np.flatnonzero(np.r_[True, pulse[1:] != pulse[:-1]])
    counts = np.diff(np.r_[starts, pulse.size])
    number = np.arange(pulse.size) - np.repeat(starts, counts) + 1
    return Returns(
        pulse,
        returns.time_s,
        returns.xyz,
        returns.strength,
        number.astype(np.uint8),
        np.repeat(counts, counts).astype(np.uint8),
        returns.label,
        returns.evidence,
    )
