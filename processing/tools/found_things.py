"""What other tools find on drives, for classes to be told by."""

from __future__ import annotations

import itertools
from collections import defaultdict
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple, TypeVar

import numpy as np

from processing.core.errors import UserError
from processing.core.monitor import Monitor, parts_of
from processing.core.text import Text
from processing.methods.classes.found_things import (
    CURB,
    POLE_LIKE,
    SIGN,
    FoundPlate,
    FoundShaft,
    FoundThings,
)
from processing.methods.classes.points_on_curbs import CurbEdges
from processing.methods.road.poles.street_poles import StreetPole, street_poles
from processing.methods.road.poles.trunks_among import EVERY_TRUNK
from processing.methods.road.signs.road_signs import road_signs
from processing.methods.road.trees.street_trees import StreetTree, surest_trees, upright_things
from processing.recording.drive import Drive
from processing.tools.curbs import CurbParameters, find_curbs
from processing.tools.tool import Candidate

_Thing = TypeVar("_Thing", CurbEdges, FoundPlate, FoundShaft)
_Find = Callable[[tuple[Drive, ...], Monitor], Iterator[_Thing]]

_EDGES = 2
_BREAST_M = 1.2
"""Height at which the radius of a stem is told."""

_LEAST_CONFIDENCE = 0.2
"""What is less likely tells nothing; between it and certainty the classes' trees weigh it."""


class LookedFor(NamedTuple):
    """What was found, and what could not be looked for.

    Attributes
    ----------
    things : FoundThings
    note : Text
        Empty where everything could be looked for.
    """

    things: FoundThings
    note: Text


def look_for_things(drives: tuple[Drive, ...], monitor: Monitor) -> LookedFor:
    """Curbs, plates, poles and trunks of drives recorded together.

    What can't be looked for, for want of rows or of a trajectory, is left out and named.
    """
    parts = iter(parts_of(monitor, [2, 3, 4]))
    refusals: list[UserError] = []
    sought: list[int] = []

    def likely(find: _Find[_Thing], code: int) -> tuple[_Thing, ...]:
        try:
            found = tuple(find(drives, next(parts)))
        except UserError as error:
            refusals.append(error)
            return ()
        sought.append(code)
        return tuple(one for one in found if one.confidence >= _LEAST_CONFIDENCE)

    curbs, plates = likely(_curbs, CURB), likely(_plates, SIGN)
    shafts = likely(_shafts, POLE_LIKE)
    return LookedFor(FoundThings(curbs, plates, shafts, frozenset(sought)), _note(refusals))


def _note(refusals: Sequence[UserError]) -> Text:
    if not refusals:
        return Text("", "")
    reasons = {error.what.en: error.what for error in refusals}
    return Text(
        f"Not everything could be looked for: {' '.join(reasons)}",
        "一部の地物は探索できませんでした。" + "".join(one.ja for one in reasons.values()),
    )


def _curbs(drives: tuple[Drive, ...], monitor: Monitor) -> Iterator[CurbEdges]:
    parameters = CurbParameters(least_confidence=_LEAST_CONFIDENCE)
    pairs: dict[object, dict[object, Candidate]] = defaultdict(dict)
    for one in find_curbs(drives, parameters, monitor).candidates:
        pairs[one.attributes["run"]][one.attributes["edge"]] = one
    for pair in pairs.values():
        if len(pair) == _EDGES:
            upper, lower = pair["upper"], pair["lower"]
            yield CurbEdges(upper.xyz, lower.xyz, upper.confidence)


def _plates(drives: tuple[Drive, ...], monitor: Monitor) -> Iterator[FoundPlate]:
    for one in road_signs(drives, monitor):
        yield FoundPlate(one.plate.outline - one.plate.centre + one.centre, one.confidence)


def _shafts(drives: tuple[Drive, ...], monitor: Monitor) -> Iterator[FoundShaft]:
    """Poles and trunks: what the search for trees finds serves both."""
    first, second = parts_of(monitor, [1, 1])
    upright = upright_things(drives, EVERY_TRUNK, first)
    yield from (_pole(one) for one in street_poles(drives, second, upright=upright))
    yield from itertools.chain.from_iterable(_trunks(one) for one in surest_trees(upright))


def _pole(one: StreetPole) -> FoundShaft:
    shaft = one.shaft
    height_m, sure = one.height_m, one.confidence
    return FoundShaft(one.foot, shaft.lean, shaft.radius_m, shaft.taper, height_m, sure)


def _trunks(one: StreetTree) -> Iterator[FoundShaft]:
    thickest = one.trunk.stems[0]
    for stem in one.trunk.stems_about_foot:
        foot = one.foot + np.array([*stem.base, 0.0])
        radius_m = stem.radius_m + stem.taper * _BREAST_M
        rises = one.upright.rise.high_m if stem.lean is thickest.lean else stem.high_m
        yield FoundShaft(foot, stem.slope, radius_m, stem.taper, rises, one.confidence)
