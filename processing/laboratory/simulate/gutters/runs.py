"""How the covers of one gutter follow each other: lids, gratings, gaps, cast slabs, their wear."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.gutters.lid_shapes import LID_KINDS, LidKind
from processing.laboratory.simulate.scene.mesh import Floats

CoverType = Literal["lid", "grating", "missing", "slab"]

_LEAST_M = 0.25  # a shorter rest of a run is cast in concrete


@dataclass(frozen=True)
class CoverStyle:
    """What one gutter's covers have in common; lengths in m.

    Attributes
    ----------
    kind : LidKind
        The lids' mould; its width is that of the bed's opening at most.
    lengths_m : tuple of float
        Of its lids: one, or several where lids are mixed.
    between_m : (float, float)
        From one grating to the next.
    notch_at : float
        Middle of a hole from the lid's middle as a share of the lid's width; 0 for one hole.
    wear : float
        0 (new) to 1: scatter of heights, tilts and joints.
    """

    kind: LidKind
    lengths_m: tuple[float, ...]
    joint_m: tuple[float, float]
    gap_m: float
    between_m: tuple[float, float]
    grating_m: float
    notch_at: float
    wear: float


@dataclass(frozen=True)
class CoverPosition:
    """One cover's place in a run: metres along the lids' middle line from the bed's beginning.

    Attributes
    ----------
    turned_rad : float
        About its upright axis.
    """

    what: CoverType
    start_m: float
    long_m: float
    turned_rad: float


def cover_style_of(random: Generator, wide_m: float, radius_m: float) -> CoverStyle:
    """What a gutter's covers are like in a bed of a width, on a curve of a radius."""
    gap = float(random.uniform(0.003, 0.008))
    fits = [one for one in LID_KINDS if one.wide_m + 2 * gap + 0.006 <= wide_m] or [LID_KINDS[0]]
    # Rather a lid that fills the bed than the commonest one.
    shares = np.array([one.share * np.exp((one.wide_m - wide_m) / 0.06) + 0.02 for one in fits])
    kind = fits[int(random.choice(len(fits), p=shares / shares.sum()))]
    usual: tuple[tuple[float, ...], ...] = ((0.6,), (0.5,), (1.0,), (0.5, 0.6), (0.6, 1.0))
    shares_of = (0.72, 0.12, 0.08, 0.05, 0.03) if radius_m > 60.0 else (0.6, 0.4, 0.0, 0.0, 0.0)
    lengths = usual[int(random.choice(len(usual), p=shares_of))]
    notch_at = float(random.uniform(0.22, 0.27)) if kind.holes == 2 else 0.0
    joint = float(random.uniform(0.002, 0.005))
    return CoverStyle(
        kind,
        lengths,
        (joint, joint + float(random.uniform(0.001, 0.005))),
        gap,
        (5.0, float(random.uniform(6.0, 20.0))),
        float(random.choice([0.5, 1.0])),
        notch_at,
        float(random.uniform(0.0, 1.0)),
    )


def wide_m(habit: CoverStyle, bed_m: float) -> float:
    """Of the lids of a habit in a bed."""
    return min(habit.kind.wide_m, bed_m - 2 * habit.gap_m - 0.006)


def cover_positions_of(
    random: Generator, habit: CoverStyle, long_m: float, bend: float
) -> list[CoverPosition]:
    """The covers along a bed, one after the other, never overlapping.

    Parameters
    ----------
    long_m : float
        Of the lids' middle line.
    bend : float
        Its sharpest curvature, 1/m: joints become wedges there.
    """
    wide = habit.kind.wide_m
    positions: list[CoverPosition] = []
    at, before, next_grating = float(random.uniform(0.0, 0.01)), 0.0, _distance(random, habit)
    slab_at = float(random.uniform(0, long_m)) if random.random() < 0.2 else np.inf
    while at < long_m - _LEAST_M:
        long = float(random.choice(habit.lengths_m))
        what: CoverType = "lid"
        if at > slab_at:
            what, long, slab_at = "slab", float(random.uniform(1.5, 5.0)), np.inf
        elif at > next_grating:
            is_basin = random.random() < 0.2
            what, long = "grating", max(0.4, wide) if is_basin else habit.grating_m
            next_grating = at + _distance(random, habit)
        elif random.random() < 0.004 + 0.006 * habit.wear:
            what = "missing"
        turned = _turned(random, habit, long) if what in ("lid", "grating") else 0.0
        joint = float(random.uniform(*habit.joint_m)) + wide / 2 * long * bend
        joint += wide / 2 * (abs(turned) + before)
        if random.random() < 0.03 * habit.wear:
            joint += float(random.uniform(0.005, 0.03))
        start = at + joint
        long = min(long, long_m - start)
        if long < _LEAST_M:
            break
        positions.append(CoverPosition(what, start, long, turned))
        at, before = start + long, abs(turned)
    return positions


def _distance(random: Generator, habit: CoverStyle) -> float:
    return float(random.uniform(*habit.between_m))


def _turned(random: Generator, habit: CoverStyle, long_m: float) -> float:
    """Turned up to one degree, as far as the opening lets it."""
    most = min(np.deg2rad(1.0), 2 * (habit.gap_m - 0.001) / long_m)
    usual = random.normal(0, 0.0015 + 0.002 * habit.wear)
    if random.random() < 0.03:
        usual = random.uniform(-np.deg2rad(1.0), np.deg2rad(1.0))
    return float(np.clip(usual, -most, most))


@dataclass(frozen=True)
class CoverTilts:
    """How covers lie about their level places: (n,) float64 each.

    Attributes
    ----------
    raised : m.
    pitched, rolled : radians, along and across the gutter.
    """

    raised: Floats
    pitched: Floats
    rolled: Floats


def cover_tilts_of(random: Generator, wear: float, count: int) -> CoverTilts:
    """Small scatter everywhere, and accidents: a lid that has sunk, rises or tilts."""
    # Lids of an old road that is driven over stand a centimetre above their neighbours.
    raised = random.normal(0, 0.0005 + 0.0025 * wear + 0.004 * wear**4, count)
    pitched = random.normal(0, 0.001 + 0.004 * wear, count)
    rolled = random.normal(0, 0.001 + 0.003 * wear, count)
    accident = random.random(count)
    raised += np.where(accident < 0.02, random.uniform(-0.035, 0.02, count), 0.0)
    steep = np.where((accident > 0.02) & (accident < 0.035), 0.03, 0.0)
    return CoverTilts(
        raised,
        pitched + steep * random.uniform(-1, 1, count),
        rolled + steep * random.uniform(-1, 1, count),
    )
