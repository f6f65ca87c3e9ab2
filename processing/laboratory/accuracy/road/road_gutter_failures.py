"""Failures of covered gutters, sorted as the thesis sorts its own (section 7.5)."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from processing.core.arrays import Floats
from processing.laboratory.accuracy.road.road_surroundings import (
    BUILDING,
    COVERS,
    GROUND,
    LOW_STEP_M,
    NEAR_M,
    PLANTS,
    SHARE,
    WALLS,
    Failure,
    FailureKind,
    StreetSurroundings,
    first_type,
)
from processing.scoring.features.gutters import ScoredGutters
from processing.scoring.features.line_positions import PolylineIndex
from processing.scoring.features.mapped_features import MappedFeature, MappedFile

GUTTER_TYPES: Mapping[FailureKind, tuple[str, ...]] = {
    "missed": (
        "covered by leaves, soil or plants",
        "irregular spacing",
        "too far",
        "grating",
        "vehicles",
        "hidden, few points",
        "end of a run",
        "other",
    ),
    "false": (
        "joints or size off",
        "gap or end of a run",
        "curb stones",
        "walls and fences",
        "other covers",
        "gravel, soil, plants",
        "vehicles",
        "long steps",
        "other",
    ),
}
"""By what went wrong, in the order in which they are asked for: the first counts."""

FAR_M = 3.8
"""Mms.md 7.5: the thesis found gutters within so much of the vehicle."""

_UNCOVERED, _SCANNED = 0.95, 0.8
_LID_M, _PITCH_OFF_M = 0.6, 0.02
_SOILED = frozenset(("soil", "litter", "weeds"))
_SOILED_SHARE, _MOSTLY = 0.1, 0.5
_FIRST_COVERS = 2


def gutter_failures(
    street: str,
    judged: ScoredGutters,
    truth: MappedFile,
    around: StreetSurroundings,
    curbs: MappedFile,
) -> Iterator[Failure]:
    """Slots of gutters that were missed or made up, and covers that lie on no gutter."""
    covers = _Covers.of(truth)
    stones = PolylineIndex([one.xyz for one in curbs.features if one.shape == "line"])
    for slot in judged.missed:
        kind, detail = _missed_slot(slot, covers, around)
        yield Failure("gutters", street, "missed", kind, slot[None], detail)
    beside = [one.xyz.mean(axis=0) for one in judged.beside]
    lying_off = {id(one) for one in judged.beside}
    for one, is_right in judged.is_right:
        if not is_right and id(one) not in lying_off:
            middle, word = one.xyz.mean(axis=0)[None], str(one.facts["type"])
            yield Failure("gutters", street, "false", "joints or size off", middle, word)
    for slot in (*judged.false, *beside):
        kind, detail = _false_slot(slot, covers, stones, around)
        yield Failure("gutters", street, "false", kind, slot[None], detail)


@dataclass(frozen=True)
class _Covers:
    """True covers, to be asked for the nearest."""

    features: tuple[MappedFeature, ...]
    middles: Floats

    @staticmethod
    def of(truth: MappedFile) -> _Covers:
        middles = [one.xyz.mean(axis=0) for one in truth.features]
        return _Covers(truth.features, np.array(middles).reshape(-1, 3))

    def nearest(self, position: Floats) -> tuple[MappedFeature | None, float]:
        """The nearest one, and how far its middle is."""
        if not self.features:
            return None, np.inf
        away = np.hypot(*(self.middles - position)[:, :2].T)
        number = int(away.argmin())
        return self.features[number], float(away[number])

    def is_irregular(self, position: Floats, cover: MappedFeature) -> bool:
        """Whether covers about a place are of another length, or their joints are wide."""
        away = np.hypot(*(self.middles - position)[:, :2].T)
        own = [
            one
            for one, near in zip(self.features, away < 1.5 * _LID_M, strict=True)
            if near and one.facts.get("run") == cover.facts.get("run")
        ]
        own.sort(key=lambda one: _number(one, "order"))
        lengths = np.array([_number(one, "length_m") for one in own])
        if (np.abs(lengths - _LID_M) > _PITCH_OFF_M).any():
            return True
        middles = np.array([one.xyz.mean(axis=0) for one in own])
        gaps = np.hypot(*np.diff(middles, axis=0)[:, :2].T) - (lengths[1:] + lengths[:-1]) / 2
        return bool((np.abs(gaps) > _PITCH_OFF_M).any())


def _missed_slot(slot: Floats, covers: _Covers, around: StreetSurroundings) -> tuple[str, str]:
    cover, _ = covers.nearest(slot)
    if cover is None:
        return "other", ""
    points = around.near(slot[None], NEAR_M)
    things = around.things(points)
    soiled = sum(things[kind] for kind in _SOILED) / max(points.size, 1)
    facts: dict[str, Callable[[], bool]] = {
        "covered by leaves, soil or plants": lambda: (
            _number(cover, "uncovered") < _UNCOVERED
            or soiled > _SOILED_SHARE
            or around.share(points, PLANTS) > SHARE
        ),
        "irregular spacing": lambda: (
            cover.facts["type"] == "lid" and covers.is_irregular(slot, cover)
        ),
        "too far": lambda: around.away_m(slot[None]) > FAR_M,
        "grating": lambda: cover.facts["type"] == "grating",
        "vehicles": lambda: around.has_vehicle(slot[None]),
        "hidden, few points": lambda: _number(cover, "scanned") < _SCANNED,
        "end of a run": lambda: _number(cover, "order") < _FIRST_COVERS,
    }
    detail = f"{cover.facts['type']} {_number(cover, 'width_m'):.2f} x "
    return first_type(GUTTER_TYPES["missed"], facts), f"{detail}{_number(cover, 'length_m'):.2f}"


def _false_slot(
    slot: Floats, covers: _Covers, stones: PolylineIndex, around: StreetSurroundings
) -> tuple[str, str]:
    _, away = covers.nearest(slot)
    points = around.near(slot[None], NEAR_M)
    heights = around.cloud.xyz[points, 2]
    rise = float(np.ptp(np.percentile(heights, (5, 95)))) if points.size else 0.0
    facts: dict[str, Callable[[], bool]] = {
        "gap or end of a run": lambda: away < 2.5 * _LID_M,
        "curb stones": lambda: bool(stones.nearest(slot[None], 0.5).line[0] >= 0),
        "walls and fences": lambda: (
            around.most(points, WALLS) or around.share(points, (BUILDING,)) > SHARE
        ),
        "other covers": lambda: around.most(points, COVERS | {"wheel_stop"}),
        "gravel, soil, plants": lambda: around.share(points, (GROUND, *PLANTS)) > _MOSTLY,
        "vehicles": lambda: around.has_vehicle(slot[None]),
        "long steps": lambda: rise > LOW_STEP_M,
    }
    return first_type(GUTTER_TYPES["false"], facts), around.named(points)


def _number(feature: MappedFeature, name: str) -> float:
    value = feature.facts.get(name)
    return float(value) if isinstance(value, (int, float)) else np.nan
