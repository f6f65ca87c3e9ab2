"""What speaks for an edge of the carriageway at each place beside the ways, and how much."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.monitor import Monitor
from processing.methods.noise.tree_files import read_trees
from processing.methods.noise.trees import Trees, log_odds
from processing.methods.road.edges.cross_cells import CrossCells
from processing.methods.road.edges.fact_kernels import FACTS, NOT_SEEN, facts_kernel
from processing.methods.road.edges.path_kernels import likeliest_kernel
from resources import path_of

_STATIONS_AT_ONCE = 50
_NEVER = -20.0
"""Log-odds of places whose inner side wasn't seen."""

_GUTTER = 11
"""Cells out from where a drop of 7 cm or more is first told, up to 0.4 m before it, and its rim:
nothing that lies farther out was driven on."""

_BLOCK = 6  # cells: what lies so near together is one change
_INWARDS = 1.0
"""How much the changes nearer to the way count against a place: neighbouring ones are no
independent witnesses."""


_LEAST, _MOST = -4.0, 3.0
"""Log-odds of one station count no further: each may be wrong for reasons that none knows."""

_TURN, _JUMP = 0.5, 10.0
"""What moving by a cell from one station to the next costs, in log-odds, and moving anywhere:
three stations and more must speak for it."""


class EdgeFacts(NamedTuple):
    """What is told of a place; changes are 0 to 1, half where something grows by a third.

    Attributes
    ----------
    sharp : float
        How brightness changes from one decimetre to the next.
    brighter, darker : float
        How much brighter or darker all of the 0.3 m outside is than the 0.8 m inside.
    far_tone : float
        How brightness differs from 0.2 to 0.5 m outside.
    fleeting : float
        `sharp` where neither brightness nor roughness differ farther out: painted lines.
    unlike : float
        How brightness inside differs from the lane's.
    rougher, smoother : float
        How roughness changes from one decimetre to the next.
    rough_on : float
        How much rougher all of the 0.3 m outside is.
    far_rough : float
        How roughness differs from 0.2 to 0.5 m outside.
    uneven : float
        How roughness inside differs from the lane's.
    bend : float
        How the slope changes, over a tenth.
    rise, drop : float
        Up or down by more than 2 cm, full at 7 cm.
    hidden : float
        Share of the 0.3 m outside without points.
    """

    sharp: float
    brighter: float
    darker: float
    far_tone: float
    fleeting: float
    unlike: float
    rougher: float
    smoother: float
    rough_on: float
    far_rough: float
    uneven: float
    bend: float
    rise: float
    drop: float
    hidden: float


MODEL = "models/edges/places.onnx"
"""Log-odds that the carriageway ends at a place if it didn't before, from `EdgeFacts`; made by
`processing.laboratory.road_training.edge_training`."""

_TELLING = 0.25
"""Change from which a source of evidence is named: a tenth more, a slope that turns by 2.5 %."""


class PlaceFacts(NamedTuple):
    """Of the boundary before each cell, by its distance from the way; the left side first.

    Attributes
    ----------
    facts : (stations, 2, cells, FACTS) float32
        See :class:`EdgeFacts`.
    steps : (stations, 2, cells) float32
        How far the ground rises there, m.
    logits : (stations, 2, cells) float64
        Log-odds of an edge by what is seen there.
    outward : (stations, 2, cells) float64
        Less what speaks for an edge nearer to the way: the carriageway ends where it first ends.
    """

    facts: NDArray[np.float32]
    steps: NDArray[np.float32]
    logits: Floats
    outward: Floats


def place_facts(cells: CrossCells, monitor: Monitor) -> PlaceFacts:
    """What is told of all places beside the ways.

    Notes
    -----
    First each station by itself: the likeliest courses along them tell how the vehicle swerves.
    Then stations that follow each other are laid beside each other by these courses, so that what
    runs along the road is told from what doesn't.
    """
    alone = np.full((len(cells.ways), 2), -1, np.int32)
    outward = _facts_by(cells, alone, monitor).outward  # its facts take much room
    courses = likeliest_courses(outward, cells.ways.stretches(), monitor)
    return _facts_by(cells, courses.astype(np.int32), monitor)


def likeliest_courses(
    outward: Floats, stretches: Sequence[tuple[int, int]], monitor: Monitor
) -> Integers:
    """(stations, 2) int64 the likeliest place of the carriageway's edge at each station."""
    places = np.zeros(outward.shape[:2], np.int64)
    for first, end in stretches:
        for side in range(outward.shape[1]):
            monitor.check()
            gains = np.clip(outward[first:end, side], _LEAST, _MOST)
            own = np.zeros(end - first, np.int64)
            likeliest_kernel(np.ascontiguousarray(gains), _TURN, _JUMP, own)
            places[first:end, side] = own
    return places


def _facts_by(cells: CrossCells, course: NDArray[np.int32], monitor: Monitor) -> PlaceFacts:
    stations, half = cells.counts.shape[0], cells.counts.shape[1] // 2
    facts = np.zeros((stations, 2, half, FACTS), np.float32)
    steps = np.zeros((stations, 2, half), np.float32)
    values = (cells.counts, cells.heights, cells.rough, cells.tones)
    for first in range(0, stations, _STATIONS_AT_ONCE):
        monitor.check()
        end = min(first + _STATIONS_AT_ONCE, stations)
        facts_kernel(values, course, (first, end), facts[first:end], steps[first:end])
    logits = np.full(facts.shape[:3], _NEVER)
    is_seen = facts[..., 0] != NOT_SEEN
    logits[is_seen] = log_odds(_model(), facts[is_seen], monitor)
    drops = facts[..., EdgeFacts._fields.index("drop")] >= 1.0
    behind = np.maximum.accumulate(drops, axis=-1)[..., :-_GUTTER]
    logits[..., _GUTTER:] = np.where(behind, _NEVER, logits[..., _GUTTER:])
    monitor.check()
    return PlaceFacts(facts, steps, logits, outward_logits(logits))


def outward_logits(logits: Floats) -> Floats:
    """Log-odds of the first edge from the way outwards: the chance that none lies nearer is added.

    Parameters
    ----------
    logits : (stations, 2, cells) float64

    Notes
    -----
    A discrete hazard: the likeliest place of each 0.3 m stands for it, and what lies in the same or
    the next one doesn't count.
    """
    stations, sides, cells = logits.shape
    blocks = cells // _BLOCK
    highest = logits[..., : blocks * _BLOCK].reshape(stations, sides, blocks, _BLOCK).max(axis=-1)
    none = np.maximum(-np.logaddexp(0.0, highest), np.log(1e-3))
    before = np.concatenate([np.zeros((stations, sides, 2)), np.cumsum(none, axis=-1)], axis=-1)
    of_block = np.minimum(np.arange(cells) // _BLOCK, blocks)
    return np.asarray(logits + _INWARDS * before[..., of_block])


def evidence_of(facts: Floats) -> tuple[str, ...]:
    """What tells an edge: ``intensity``, ``roughness``, ``slope``, the strongest first.

    Parameters
    ----------
    facts : (FACTS,) float64
        Means over the places of a line.
    """
    means = EdgeFacts(*facts.tolist())
    changes = {
        "intensity": (means.sharp + means.far_tone) / 2,
        "roughness": (max(means.rougher, means.smoother) + means.far_rough) / 2,
        "slope": max(means.bend, means.rise, means.drop),
    }
    named = sorted(changes, key=lambda source: -changes[source])
    told = tuple(source for source in named if changes[source] >= _TELLING)
    return told or (named[0],)


@cache
def _model() -> Trees:
    return read_trees(path_of(MODEL))
