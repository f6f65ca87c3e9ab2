"""Places where something hangs too low over a carriageway, against a truth.

The truth tells of each thing over the carriageway the lowest place in every half metre of its plan.
A thing is found by a place of the result that lies on it or whose stretch reaches it; a place of
the result is right on any of them. Things that stand on the road, show too few points or reach only
a hand's breadth inside the edge are neither asked for nor held against the result; nor is what it
says of walks, of which the truth knows nothing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from processing.core.arrays import Floats
from processing.core.text import Text
from processing.scoring.features.file_scores import DetectionCounts, FileScore, errors_of
from processing.scoring.features.mapped_features import MappedFeature, MappedFile
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix

PLACES: dict[str, dict[str, object]] = {"clearance_place": {}}

LIMIT_M = 4.5
"""Over a carriageway (道路構造令 第12条), where the result doesn't say another."""

WITHIN_M = 1.0
"""In plan, from a place to the thing it lies on: twigs of a crown are as far apart."""

LEAST_POINTS = 20
"""In the room to be kept free, below which nothing could be said of a thing."""

LEAST_INSIDE_M = 0.3
"""Inside the edge of the carriageway, to which its edge can be told."""

_NEARLY_M = 0.1
"""What hangs higher than the limit by less may be found too: crowns move in the wind."""

_NAME = Text("places below the clearance", "建築限界の支障箇所")


@dataclass(frozen=True)
class TrueThing:
    """Something over a carriageway.

    Attributes
    ----------
    cells : (n, 5) float64
        Its low places: easting, northing, height, m, height over the road, points.
    is_asked : bool
    """

    cells: Floats
    is_asked: bool


def clearance_score(result: MappedFile, truth: MappedFile) -> FileScore:
    """Score places over carriageways.

    Raises
    ------
    BadFile
        Features aren't such places.
    """
    every = result.of_kinds(PLACES, "point", _NAME)
    found = [one for one in every if one.facts.get("above") != "walk"]
    limit = max((_number(one, "limit_m", LIMIT_M) for one in found), default=LIMIT_M)
    things = clearance_things(truth, limit)
    met = [[_meets(one, thing) for thing in things] for one in found]
    is_right = [any(on for on, _ in row) for row in met]
    is_found = [any(row[number][1] for row in met) for number in range(len(things))]
    asked = [thing.is_asked for thing in things]
    hits = sum(a and f for a, f in zip(asked, is_found, strict=True))
    counts = BinaryConfusionMatrix(hits, is_right.count(False), sum(asked) - hits, 0)
    return FileScore(
        "clearance",
        (DetectionCounts("places", _NAME, counts),),
        errors=(
            errors_of(
                "lowest", ("lowest height", "最低の高さ"), "m", _height_errors(found, things)
            ),
        ),
        left_out={"unseen": asked.count(False)},
        limits={
            "within_m": WITHIN_M, "least_points": LEAST_POINTS, "least_inside_m": LEAST_INSIDE_M,
        },
    )  # fmt: skip


def clearance_things(truth: MappedFile, limit_m: float) -> list[TrueThing]:
    """The things of a truth, as far as they hang lower than a limit.

    Raises
    ------
    BadFile
        Features aren't such places.
    """
    return [_thing(one, limit_m) for one in truth.of_kinds(PLACES, "point", _NAME)]


def lies_on(xyz: Floats, thing: TrueThing) -> bool:
    """Whether a place (3,) lies on a thing."""
    away = np.hypot(*(thing.cells[:, :2] - xyz[:2]).T)
    return bool(away.size and away.min() <= WITHIN_M)


def _thing(one: MappedFeature, limit_m: float) -> TrueThing:
    places = one.facts.get("places")
    if not isinstance(places, list):
        own = [*one.xyz[0].tolist(), _number(one, "lowest_m", 0.0), LEAST_POINTS]
        return TrueThing(np.array([own]), is_asked=True)
    cells = np.array(places, np.float64).reshape(-1, 5)
    low = cells[cells[:, 3] < limit_m]
    is_asked = (
        not one.facts.get("is_standing")
        and float(low[:, 4].sum()) >= LEAST_POINTS
        and _number(one, "depth_m", np.inf) >= LEAST_INSIDE_M
    )
    return TrueThing(low if is_asked else cells[cells[:, 3] < limit_m + _NEARLY_M], is_asked)


def _number(one: MappedFeature, name: str, otherwise: float) -> float:
    value = one.facts.get(name)
    return float(value) if isinstance(value, int | float) else otherwise


def _away(found: MappedFeature, thing: TrueThing) -> Floats:
    return np.asarray(np.hypot(*(thing.cells[:, :2] - found.xyz[0, :2]).T))


def _meets(found: MappedFeature, thing: TrueThing) -> tuple[bool, bool]:
    """Whether a place lies on a thing, and whether its stretch reaches it."""
    if not len(thing.cells):
        return False, False
    nearest = float(_away(found, thing).min())
    return nearest <= WITHIN_M, nearest <= WITHIN_M + _number(found, "length_m", 0.0)


def _height_errors(found: Sequence[MappedFeature], things: Sequence[TrueThing]) -> list[float]:
    """Found lowest heights minus the lowest true ones within the stretches of the places."""
    off = []
    for one in found:
        reach = WITHIN_M + _number(one, "length_m", 0.0)
        low = [
            thing.cells[_away(one, thing) <= reach, 3]
            for thing in things
            if thing.is_asked and len(thing.cells) and _meets(one, thing)[1]
        ]
        heights = np.concatenate([np.empty(0), *low])
        if heights.size and any(_meets(one, thing)[0] for thing in things):
            off.append(_number(one, "lowest_m", np.nan) - float(heights.min()))
    return off
