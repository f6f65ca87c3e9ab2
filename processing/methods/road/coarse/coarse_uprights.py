"""Trunks and poles of recordings too sparse for round shafts to be fitted.

A pole is some rows of points there, decimetres apart and shaken against each other by centimetres;
a car's spinning scanner shows no more of one either. So columns are told by what stands on, beside
and above them in decimetres, with trees of decisions learnt from sparse recordings of simulated
streets (:mod:`processing.laboratory.road_training.coarse_training`). No diameter is measured.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.monitor import Monitor, PartMonitor
from processing.core.text import Text
from processing.methods.noise.tree_files import read_trees
from processing.methods.noise.trees import Trees, log_odds
from processing.methods.road.coarse.column_facts import ColumnFacts, facts_of
from processing.methods.road.coarse.column_sums import (
    LOWEST_M,
    ON_M,
    ColumnSums,
    sum_columns,
)
from processing.methods.road.objects.column_points import points_about
from processing.methods.road.objects.columns import FoundColumns, distinct_columns
from processing.methods.road.objects.sparse_plan import SparsePlan
from processing.methods.road.objects.survey import survey_columns
from processing.recording.density import is_single_scan
from processing.recording.drive import Drive
from resources import path_of

MODELS = "models/uprights"
TREE, POLE = "tree", "pole"
_KINDS = (TREE, POLE)

_LEAST_CHANCE = 0.05
"""What is less likely either is left out."""

_APART_M = 1.0
"""Two columns nearer to each other are of one thing where axes are known to decimetres."""

_ABOUT_M = 2.0
"""From a foot in plan, so that 13 m above it an axis that leans by 8 degrees has its points."""


@dataclass(frozen=True)
class CoarseUpright:
    """A column that may be a trunk or a pole.

    Attributes
    ----------
    foot : (3,) float64
        Where its axis meets the survey's coarse ground, m, project CRS: rings about a foot hold too
        few points to tell it closer.
    lean : (2,) float64
        What it moves to the east and north in a metre of height.
    top_m, highest_m : float
        How far above the ground its axis shows, and what was seen about it; neither its own height
        where the scanner sees no higher.
    tree, pole : float
        The share of its like that are trees, and that are poles.
    points, drives : (n,) int64
        Measured points on its axis, the lowest first: each by its number in its drive, and which of
        the drives that is.
    """

    foot: Floats
    lean: Floats
    top_m: float
    highest_m: float
    tree: float
    pole: float
    points: Integers
    drives: Integers

    @property
    def lean_deg(self) -> float:
        """From the vertical."""
        return math.degrees(math.atan(float(np.hypot(*self.lean))))


def coarse_uprights(drives: Sequence[Drive], monitor: Monitor) -> tuple[CoarseUpright, ...]:
    """What may be a trunk or a pole, of each place the likeliest, the likeliest first.

    Parameters
    ----------
    drives : sequence of Drive
        One or more; sparse ones, for of others too little is asked.
    """
    plan, columns, sums = summed_columns(drives, PartMonitor(monitor, 0.0, 0.8))
    told = known_columns(sums, monitor)
    if not told:
        return ()
    rows = np.array([facts for _, facts in told], np.float32)
    chances = chances_of(rows, is_scan=all(is_single_scan(one) for one in drives), monitor=monitor)
    numbers = np.array([number for number, _ in told], np.int64)
    kept = _likeliest(sums.axes.base[numbers], chances)
    found = [(int(numbers[one]), told[one][1], chances[one]) for one in kept]
    part = PartMonitor(monitor, 0.8, 1.0)
    return tuple(_standing(drives, plan, (columns, sums), found, part))


def summed_columns(
    drives: Sequence[Drive], monitor: Monitor
) -> tuple[SparsePlan, FoundColumns, ColumnSums]:
    """The columns of drives, one of each thing, and what stands about them."""
    below, (columns, *_) = survey_columns(drives, PartMonitor(monitor, 0.0, 0.4))
    columns = distinct_columns(columns)
    sums = sum_columns(drives, below.plan, columns, PartMonitor(monitor, 0.4, 1.0))
    return below.plan, columns, sums


def known_columns(sums: ColumnSums, monitor: Monitor) -> list[tuple[int, ColumnFacts]]:
    """Number and facts of each column that has some."""
    told: list[tuple[int, ColumnFacts]] = []
    for number in range(len(sums.slabs)):
        monitor.check()
        facts = facts_of(sums, number)
        if facts is not None:
            told.append((number, facts))
    return told


def chances_of(rows: NDArray[np.float32], *, is_scan: bool, monitor: Monitor) -> Floats:
    """How likely columns are trees, and how likely poles.

    Parameters
    ----------
    rows : (n, f) float32
        Their facts.
    is_scan : bool
        Whether the recording is one scan from one place; profiles from a vehicle otherwise.

    Returns
    -------
    (n, 2) float64
    """
    odds = [log_odds(_model(model_name(kind, is_scan=is_scan)), rows, monitor) for kind in _KINDS]
    chances: Floats = 1 / (1 + np.exp(-np.column_stack(odds)))
    return chances


def model_name(kind: str, *, is_scan: bool) -> str:
    """The file of a model below `MODELS`."""
    return f"{'scan' if is_scan else 'profile'}_{kind}.onnx"


@cache
def _model(name: str) -> Trees:
    return read_trees(path_of(f"{MODELS}/{name}"))


def _likeliest(places: Floats, chances: Floats) -> list[int]:
    """Of columns that are one thing the one that is likelier either."""
    from scipy.spatial import cKDTree

    either = chances.max(axis=1)
    tree, taken = cKDTree(places), np.zeros(len(places), np.bool_)
    kept: list[int] = []
    for one in np.argsort(-either, kind="stable").tolist():
        if either[one] < _LEAST_CHANCE:
            break
        if not taken[one]:
            kept.append(one)
            taken[tree.query_ball_point(places[one], _APART_M)] = True
    return kept


def _standing(
    drives: Sequence[Drive],
    plan: SparsePlan,
    known: tuple[FoundColumns, ColumnSums],
    found: Sequence[tuple[int, ColumnFacts, Floats]],
    monitor: Monitor,
) -> list[CoarseUpright]:
    """Columns with their feet and the points on their axes."""
    columns, sums = known
    numbers = [number for number, _, _ in found]
    middles = sums.axes.base[numbers] + LOWEST_M * sums.axes.lean[numbers]
    about = points_about(drives, plan, middles, _ABOUT_M, monitor)
    things: list[CoarseUpright] = []
    for place, (number, facts, chance) in enumerate(found):
        base, lean, coarse = sums.axes.base[number], sums.axes.lean[number], columns.ground[number]
        part = about.of(place)
        local = about.local[part]
        up = local[:, 2] - coarse
        off = local[:, :2] - base - up[:, None] * lean
        is_on = (np.hypot(off[:, 0], off[:, 1]) < ON_M) & (up > LOWEST_M) & (up <= facts.top_m)
        lines = np.flatnonzero(is_on)
        lines = lines[np.argsort(up[lines], kind="stable")]
        things.append(
            CoarseUpright(
                foot=np.array([*base, coarse]) + plan.origin,
                lean=lean.copy(),
                top_m=facts.top_m,
                highest_m=float(sums.highest_m[number]),
                tree=float(chance[0]),
                pole=float(chance[1]),
                points=about.points[part][lines],
                drives=about.drives[part][lines],
            )
        )
    return things


def sparse_note(likely: int, found: int) -> Text:
    """What things of sparse recordings lack; or that none of what was found is likely."""
    if not likely:
        return Text(
            "The recording is too sparse for round shapes, and by where points stand "
            f"none of {found} upright things is likely enough.",
            f"点密度が低く円形を当てはめられません。点の並びから見て、直立した物{found}件のうち、"
            "該当するとみなせるものはありませんでした。",
        )
    return Text(
        "The recording is too sparse for round shapes: what was found is told by where points "
        "stand, without a diameter and only as high as it was seen.",
        "点密度が低く円形を当てはめられないため、点の並びから判定しました。"
        "直径は求めず、高さは計測された範囲の値です。",
    )
