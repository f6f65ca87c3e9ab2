"""Failures of curbs, sorted as the thesis sorts its own (L1864-L1910)."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence

import numpy as np

from processing.core.arrays import Floats
from processing.laboratory.accuracy.road.road_surroundings import (
    BUILDING,
    COVERS,
    CURB,
    LOW_STEP_M,
    NEAR_M,
    PLANTS,
    ROAD,
    SHARE,
    WALLS,
    Failure,
    FailureKind,
    StreetSurroundings,
    first_type,
)
from processing.scoring.features.curb_lines import ScoredEdge
from processing.scoring.features.curb_sections import TrueSection, kind_of
from processing.scoring.features.line_positions import PolylineIndex, length_m, middle_positions

CURB_TYPES: Mapping[FailureKind, tuple[str, ...]] = {
    "missed": (
        "vehicles",
        "blind zone of a turn",
        "hidden, few points",
        "low dropped step",
        "dropped curb",
        "plants",
        "far from the vehicle",
        "tight bend",
        "end of a curb",
        "a line lies 10 to 30 cm beside",
        "other",
    ),
    "false": (
        "second line along a curb",
        "10 to 30 cm beside a curb",
        "beyond the end of a curb",
        "vehicles",
        "walls and fences",
        "plants",
        "gutters and lids",
        "other things",
        "same place measured twice",
        "on the carriageway",
        "other steps",
    ),
}
"""By what went wrong, in the order in which they are asked for: the first counts."""

FAR_M = 10.0
"""A curb farther off lies behind another lane."""

_FEW_PER_M = 30.0
_TURNED_DEG = 20.0
"""Over the blind zone's length a path that turns by so much turns off; a bend of a street, of 60 m
radius, turns by 14°."""
_BESIDE_M, _ALONG_M, _END_M = 0.3, 0.1, 2.0
_BEND_RADIUS_M = 6.0
_MOSTLY = 0.5
_JOINED_M = 0.2


def curb_failures(
    street: str, edges: Mapping[str, ScoredEdge], around: StreetSurroundings
) -> Iterator[Failure]:
    """Sections of curbs that were missed or made up."""
    for edge, judged in edges.items():
        lines = PolylineIndex([one.feature.xyz for one in judged.lines])
        true = PolylineIndex([one.xyz for one in judged.asked])
        ends = _ends([one.xyz for one in judged.asked])
        for section, is_found in zip(judged.asked, judged.is_found, strict=True):
            if not is_found:
                kind = _missed_curb(section, lines, ends, around)
                detail = f"{edge} {section.kind} {100 * section.step_m:.0f} cm"
                yield Failure("curbs", street, "missed", kind, section.xyz, detail)
        for line in judged.lines:
            for piece in line.false:
                kind, thing = _false_curb(piece, true, ends, around)
                detail = f"{edge} {kind_of(line.feature)} on {thing}"
                yield Failure("curbs", street, "false", kind, piece, detail)


def _missed_curb(
    section: TrueSection, lines: PolylineIndex, ends: Floats, around: StreetSurroundings
) -> str:
    points = around.near(section.xyz, NEAR_M)
    on_curb = int((around.cloud.label[points] == CURB).sum())
    is_beside = lines.nearest(middle_positions(section.xyz, 0.4), _BESIDE_M).line >= 0
    is_low = section.kind == "dropped"
    facts: dict[str, Callable[[], bool]] = {
        "vehicles": lambda: around.has_vehicle(section.xyz),
        "blind zone of a turn": lambda: (
            points.size < _FEW_PER_M * length_m(section.xyz)
            and around.turned_deg(section.xyz) > _TURNED_DEG
        ),
        "hidden, few points": lambda: on_curb < _FEW_PER_M * length_m(section.xyz),
        "low dropped step": lambda: is_low and section.step_m < LOW_STEP_M,
        "dropped curb": lambda: is_low,
        "plants": lambda: around.share(points, PLANTS) > SHARE,
        "far from the vehicle": lambda: around.away_m(section.xyz) > FAR_M,
        "tight bend": lambda: _is_bent(section.xyz),
        "end of a curb": lambda: _is_at_end(section.xyz, ends),
        "a line lies 10 to 30 cm beside": lambda: bool(is_beside.mean() >= _MOSTLY),
    }
    return first_type(CURB_TYPES["missed"], facts)


def _false_curb(
    piece: Floats, true: PolylineIndex, ends: Floats, around: StreetSurroundings
) -> tuple[str, str]:
    points = around.near(piece, NEAR_M)
    positions = middle_positions(piece, 0.2)

    facts: dict[str, Callable[[], bool]] = {
        "second line along a curb": lambda: _is_along(true, positions, _ALONG_M),
        "10 to 30 cm beside a curb": lambda: _is_along(true, positions, _BESIDE_M),
        "beyond the end of a curb": lambda: _is_at_end(piece, ends),
        "vehicles": lambda: around.has_vehicle(piece),
        "walls and fences": lambda: (
            around.most(points, WALLS) or around.share(points, (BUILDING,)) > SHARE
        ),
        "plants": lambda: around.share(points, PLANTS) > SHARE,
        "gutters and lids": lambda: around.most(points, COVERS),
        "other things": lambda: (
            bool(points.size) and around.things(points)[""] < (1 - SHARE) * points.size
        ),
        "same place measured twice": lambda: (
            len(around.drives) > 1 and around.share(points, (ROAD,)) > 1 - SHARE / 2
        ),
        "on the carriageway": lambda: around.share(points, (ROAD,)) > 1 - SHARE / 2,
    }
    return first_type(CURB_TYPES["false"], facts, "other steps"), around.named(points)


def _is_along(lines: PolylineIndex, positions: Floats, within_m: float) -> bool:
    return bool((lines.nearest(positions, within_m).line >= 0).mean() >= _MOSTLY)


def _ends(lines: Sequence[Floats]) -> Floats:
    """Ends that no other line continues."""
    ends = np.array([line[side] for line in lines for side in (0, -1)]).reshape(-1, 3)
    if not len(ends):
        return ends
    away = np.hypot(*(ends[:, None] - ends[None])[..., :2].transpose(2, 0, 1))
    return np.asarray(ends[(away < _JOINED_M).sum(axis=1) < 2])


def _is_at_end(xyz: Floats, ends: Floats) -> bool:
    if not len(ends):
        return False
    middle = middle_positions(xyz, max(length_m(xyz), 1e-6))[0]
    return bool(np.hypot(*(ends - middle)[:, :2].T).min() < _END_M)


def _is_bent(xyz: Floats) -> bool:
    """Whether a section turns as on a circle of a small radius."""
    long_m = length_m(xyz)
    steps = np.diff(xyz[:, :2], axis=0)
    steps = steps[np.hypot(*steps.T) > 1e-6]
    if len(steps) < 2 or long_m == 0:
        return False
    ways = np.unwrap(np.arctan2(steps[:, 1], steps[:, 0]))
    return bool(abs(ways[-1] - ways[0]) > long_m / _BEND_RADIUS_M)
