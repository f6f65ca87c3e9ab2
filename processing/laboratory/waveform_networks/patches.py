"""First returns of flights with their waveforms and classes, cut into patches.

References
----------
Shinohara 2022, section 3.4: first returns, 160 samples, patches of 50,000 points.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import laspy
import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.methods.waveforms.local_network import scale_of
from processing.scoring.points.six_classes import SIX, as_six_classes

F32 = NDArray[np.float32]

UNKNOWN = -1


@dataclass(frozen=True, eq=False)
class FirstReturns:
    """First returns of a flight.

    Attributes
    ----------
    xyz : (n, 3) float64
        m, as delivered.
    waves : (n, 160) float16
        Counts over the baseline, in units of the flight's middle peak.
    classes : (n,) int64
        Places in `SIX`; `UNKNOWN` for all others, which are neither learnt nor scored.
    """

    xyz: Floats
    waves: NDArray[np.float16]
    classes: Integers

    @property
    def density(self) -> float:
        """Points/m² of the rectangle around them."""
        sides = np.ptp(self.xyz[:, :2], axis=0)
        return len(self.xyz) / max(float(sides.prod()), 1e-9)

    def thinned(self, density: float, rng: Generator) -> FirstReturns:
        """The same with at most so many points/m², left by chance."""
        share = density / self.density
        kept = np.arange(len(self.xyz))
        if share < 1:
            kept = np.sort(rng.choice(kept, max(1, round(share * kept.size)), replace=False))
        return FirstReturns(self.xyz[kept], self.waves[kept], self.classes[kept])

    def patch(self, points: Integers) -> Patch:
        """Some of them, from their middle."""
        xyz = self.xyz[points]
        return Patch(
            points,
            (xyz - xyz.mean(axis=0)).astype(np.float32),
            self.waves[points].astype(np.float32),
            self.classes[points],
        )


@dataclass(frozen=True, eq=False)
class Patch:
    """What one step of learning sees, or one look.

    Attributes
    ----------
    points : (k,) int64
        Which first returns of the flight.
    xyz : (k, 3) float32
        m from their middle.
    waves : (k, 160) float32
    classes : (k,) int64
    """

    points: Integers
    xyz: F32
    waves: F32
    classes: Integers

    def some(self, chosen: Integers) -> Patch:
        """Some of its points, by their place."""
        return Patch(
            self.points[chosen], self.xyz[chosen], self.waves[chosen], self.classes[chosen]
        )

    def turned(self, angle: float) -> Patch:
        """The same turned about the vertical, by radians."""
        cosine, sine = np.cos(angle), np.sin(angle)
        turn = np.array([[cosine, sine, 0], [-sine, cosine, 0], [0, 0, 1]], np.float32)
        return replace(self, xyz=self.xyz @ turn)


def first_returns_of(folder: Path) -> FirstReturns:
    """The first returns of a flight as ``zuka simulate flight`` leaves it, with their truth."""
    with np.load(folder / "truth" / "first.npz") as truth:
        index, waves, label = truth["index"], truth["wave"], truth["label"]
    cloud = laspy.read(folder / "in" / "points.laz")
    xyz = np.column_stack([cloud.x, cloud.y, cloud.z])[index]
    number_of = np.full(256, UNKNOWN, np.int64)
    number_of[list(SIX)] = np.arange(len(SIX))
    scaled = waves / scale_of(waves.max(axis=1).astype(np.float32))
    return FirstReturns(xyz, scaled.astype(np.float16), number_of[as_six_classes(label)])


def random_patch(flight: FirstReturns, count: int, rng: Generator) -> Patch:
    """The points nearest in plan to one of a class that is drawn first, so that rare ones are met.

    Where the flight has fewer points they are repeated, as published.
    """
    there = np.unique(flight.classes[flight.classes >= 0])
    wanted = flight.classes == rng.choice(there)
    middle = flight.xyz[rng.choice(np.flatnonzero(wanted)), :2]
    return flight.patch(rng.permutation(_nearest(flight, middle, count)))


def covering_patches(flight: FirstReturns, count: int, rng: Generator) -> list[Patch]:
    """Patches in which every point of a flight is seen at least once."""
    found = []
    for part in _parts(flight.xyz[:, :2], np.arange(len(flight.xyz)), count):
        plan = flight.xyz[part, :2]
        around = _nearest(flight, (plan.min(axis=0) + plan.max(axis=0)) / 2, count)
        others = around[~np.isin(around, part)]
        whole = np.concatenate([part, others])[:count]
        found.append(flight.patch(rng.permutation(np.resize(whole, count))))
    return found


def _nearest(flight: FirstReturns, middle: Floats, count: int) -> Integers:
    squares = ((flight.xyz[:, :2] - middle) ** 2).sum(axis=1)
    if squares.size <= count:
        return np.resize(np.arange(squares.size), count)
    return np.asarray(np.argpartition(squares, count - 1)[:count], np.int64)


def _parts(plan: Floats, points: Integers, most: int) -> list[Integers]:
    """Points cut in halves along the longer side until none has more than so many."""
    if points.size <= most:
        return [points]
    own = plan[points]
    axis = int(np.ptp(own, axis=0).argmax())
    order = points[np.argsort(own[:, axis], kind="stable")]
    half = order.size // 2
    return [*_parts(plan, order[:half], most), *_parts(plan, order[half:], most)]
