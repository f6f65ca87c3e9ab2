"""The noise of scanners, each kind with a shape and a share drawn anew for every scene."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from processing.core.arrays import Flags, Floats
from processing.laboratory.noise_training.rays import CROWN, RangeHits, thing, trace_rays
from processing.laboratory.noise_training.scanners import Shots
from processing.laboratory.noise_training.streets import BRIGHT, GROUND_STRIPS, ROAD, TrainingStreet

NOISE_KINDS = (
    "none",
    "arc",
    "folded",
    "mixed",
    "rain",
    "streak",
    "isolated",
    "mirrored",
    "under",
)
_NONE, ARC, FOLDED, MIXED, RAIN, STREAK, ISOLATED, MIRRORED, UNDER = range(len(NOISE_KINDS))
_AMBIGUITIES_M = (53.5, 79.0, 120.0)
_LEAST_M = 0.5
_UNBOUND_M = 1e9


@dataclass
class NoiseMaker:
    """Replaces some of the ranges that a scanner measured.

    Attributes
    ----------
    random : Generator
    shots : Shots
    met : RangeHits
        What the beams met, m.
    kinds : (n,) int64
        Of what they met, −1 where nothing.
    street : Street
    most_m : float
        The scanner's reach.
    noise : (n,) int64
        Kind of noise, 0 none.
    ranges : (n,) float64
        m; those of noise where there is noise.
    """

    random: Generator
    shots: Shots
    met: RangeHits
    kinds: NDArray[np.int64]
    street: TrainingStreet
    most_m: float
    noise: NDArray[np.int64]
    ranges: Floats

    def on_the_ground(self, footprint: float, ambiguity_m: float) -> None:
        """All kinds that scanners on the ground have."""
        amount = self.random.uniform(0.3, 1.6)
        if self.random.random() < 0.85:
            self._arcs(amount)
        if self.random.random() < 0.7:
            self._fold_ranges(ambiguity_m)
        self._mix_ranges(amount)
        self._rain(amount)
        self._streaks()
        if self.street.panes and self.random.random() < 0.8:
            self._mirror_beams(footprint)
        self._under_the_road()
        lone = self.random.uniform(1, 40, self._count) ** self.random.uniform(0.8, 1.1)
        self._put(self._some(0.0025 * amount), lone, ISOLATED)

    def from_the_air(self, length_m: float) -> None:
        """Birds, clouds of drops, returns below the ground."""
        amount, random = self.random.uniform(0.3, 1.6), self.random
        met = self.met.ranges
        high = random.uniform(0.1, 1, self._count) * min(50.0, float(met.min()) * 0.9)
        self._put(self._some(0.002 * amount), met - high, ISOLATED)
        low = random.exponential(3, self._count) + 0.3
        self._put(self._some(0.001 * amount), met + low, UNDER)
        positions = self.shots.origins + met[:, None] * self.shots.directions
        for _ in range(random.integers(0, 4)):
            for kind, size, share, shift in ((RAIN, 1.0, 0.3, -1), (UNDER, 0.5, 0.5, 1)):
                x, y = random.uniform(0, length_m), random.uniform(-length_m / 2, length_m / 2)
                radius = size * random.uniform(0.5, 3)
                is_near = np.hypot(positions[:, 0] - x, positions[:, 1] - y) < radius
                depth = -random.uniform(8, 25) if shift < 0 else random.uniform(0.5, 6)
                spread = random.normal(0, 0.8 if shift < 0 else 0.2, self._count)
                self._put(is_near & self._some(share), met + depth + spread, kind)

    @property
    def _count(self) -> int:
        return self.noise.size

    def _some(self, share: float | Floats) -> Flags:
        chosen: Flags = self.random.random(self._count) < share
        return chosen

    def _put(self, chosen: Flags, ranges: Floats, kind: int) -> None:
        placed = chosen & (self.noise == 0) & (ranges > _LEAST_M) & (ranges < self.most_m)
        self.noise[placed] = kind
        self.ranges[placed] = ranges[placed]

    def _arcs(self, amount: float) -> None:
        """Returns of one range over a part of the turn, for some rows (phase-based scanners)."""
        shots, random = self.shots, self.random
        is_sky = self.met.ranges > self.most_m
        most_rows = int(shots.rows.max())
        enough = 2 ** random.uniform(-6, -1.5) * int((self.met.things >= 0).sum())
        for _ in range(random.integers(2, 9)):
            if (self.noise > 0).sum() > enough:
                break
            reach, spread = random.uniform(1.5, 18), random.uniform(0.002, 0.03)
            middle, row = random.integers(shots.width), random.integers(most_rows + 1)
            half = random.integers(max(1, shots.width // 25), max(2, shots.width // 3))
            rows = random.integers(2, max(3, most_rows // 3))
            turned = (shots.columns - middle + shots.width // 2) % shots.width - shots.width // 2
            is_in = (np.abs(turned) < half) & (np.abs(shots.rows - row) < rows)
            drift = random.uniform(-0.002, 0.002) * (shots.rows - row)
            share = amount * random.choice([0.02, 0.06, 0.15, 0.4])
            share = share * np.where(is_sky, random.uniform(0.3, 1.5), 1)
            ranges = reach + drift + random.normal(0, spread, self._count)
            self._put(is_in & self._some(share), ranges, ARC)

    def _fold_ranges(self, ambiguity_m: float) -> None:
        """Things beyond the range that the phase can tell, brought nearer by it."""
        met = self.met.ranges
        is_folded = (met > ambiguity_m) & (met < 2 * ambiguity_m) & (self.met.things >= 0)
        share = self.random.uniform(0.2, 0.95)
        shift = -ambiguity_m + self.random.normal(0, 0.015, self._count)
        self._put(is_folded & self._some(share), met + shift, FOLDED)

    def _mix_ranges(self, amount: float) -> None:
        """Beams that met an edge and what is behind it."""
        met, things = self.met
        after, thing_after = np.r_[met[1:], met[-1]], np.r_[things[1:], things[-1]]
        is_edge = (thing_after != things) & (np.abs(after - met) > 0.15)
        is_edge &= ~((things < GROUND_STRIPS) & (thing_after < GROUND_STRIPS))
        is_edge &= (np.minimum(after, met) < 60) & (np.maximum(after, met) < self.most_m)
        between = met + (after - met) * self.random.random(self._count)
        self._put(is_edge & self._some(0.25 * amount), between, MIXED)

    def _rain(self, amount: float) -> None:
        """Drops near the scanner, and clouds of dust."""
        random, shots = self.random, self.shots
        drops = random.exponential(3, self._count) + 0.8
        self._put(self._some(0.0015 * amount * random.random()), drops, RAIN)
        along = shots.origins[:, 0].min() - 3, shots.origins[:, 0].max() + 3
        for _ in range(random.integers(0, 4)):
            x, y, radius = random.uniform(*along), random.uniform(-6, 6), random.uniform(0.2, 1.2)
            z = self.street.ground_at(y) + random.uniform(0, 1.5) * radius
            thickness = random.uniform(0.4, 3) * radius
            cloud = thing(CROWN, 0, 0.0, x, y, z, radius, radius, radius * 0.8, thickness)
            chances = random.random((self._count, 2))
            dust = trace_rays(shots.origins, shots.directions, np.array([cloud]), 0.0, chances)
            self._put(dust.ranges < self.met.ranges, dust.ranges, RAIN)

    def _streaks(self) -> None:
        """Ranges spread along the beam: at bright targets, and towards the sun."""
        random, shots = self.random, self.shots
        for number, row in enumerate(self.street.things):
            if row[2] == BRIGHT and random.random() < 0.6:
                spread = random.normal(0, random.uniform(0.3, 2.5), self._count)
                is_on_it = self.met.things == number
                self._put(is_on_it & self._some(0.35), self.met.ranges + spread, STREAK)
        for _ in range(random.integers(0, 4)):
            column, row = random.integers(shots.width), random.integers(shots.rows.max() + 1)
            wide = random.integers(2, max(3, shots.width // 100))
            is_near = np.abs(shots.columns - column) < wide
            is_near &= np.abs(shots.rows - row) < random.integers(2, 60)
            self._put(is_near & self._some(0.3), random.uniform(1, 25, self._count), STREAK)

    def _mirror_beams(self, footprint: float) -> None:
        """Glass: some beams come back from what it mirrors, most are lost."""
        random, shots = self.random, self.shots
        chances = random.random((self._count, 2))
        glass = trace_rays(
            shots.origins, shots.directions, np.array(self.street.panes), 0.0, chances
        )
        is_on_it = (glass.things >= 0) & (glass.ranges <= self.met.ranges + 0.1)
        chosen = np.flatnonzero(is_on_it & self._some(0.4))
        if chosen.size:
            directions = shots.directions[chosen] * np.array([1.0, -1.0, 1.0])
            positions = (
                shots.origins[chosen] + shots.directions[chosen] * glass.ranges[chosen, None]
            )
            things = np.array(self.street.things)
            seen = trace_rays(positions, directions, things, footprint, chances[chosen])
            ranges = np.full(self._count, _UNBOUND_M)
            ranges[chosen] = glass.ranges[chosen] + seen.ranges
            self._put(ranges < self.most_m, ranges, MIRRORED)
        lost = is_on_it & (self.noise == 0) & self._some(0.7)
        self.ranges[lost] = _UNBOUND_M

    def _under_the_road(self) -> None:
        """Patches some centimetres to decimetres below the road."""
        random, shots = self.random, self.shots
        positions = shots.origins + self.met.ranges[:, None] * shots.directions
        x = positions[self.kinds == ROAD, 0]
        low, high = (np.percentile(x, [2, 98])) if x.size else (0.0, 1.0)
        for _ in range(random.integers(0, 6)):
            at, beside = random.uniform(low, high), random.uniform(-5, 5)
            is_in = np.hypot(positions[:, 0] - at, positions[:, 1] - beside) < random.uniform(
                0.2, 1.2
            )
            depth = random.uniform(0.08, 0.8) + random.normal(0, 0.02, self._count)
            ranges = self.met.ranges + depth / np.maximum(-shots.directions[:, 2], 0.15)
            share = random.uniform(0.2, 0.9)
            self._put(is_in & (self.kinds == ROAD) & self._some(share), ranges, UNDER)


def ambiguity_of(random: Generator) -> float:
    """A range in metres beyond which a phase-based scanner folds what it sees."""
    return float(random.choice(_AMBIGUITIES_M))
