"""What lies around a failure of curbs or gutters, and how it is told."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.laboratory.accuracy.road.road_scenes import RoadScene, StreetCloud
from processing.scoring.features.line_positions import PolylineIndex, length_m, middle_positions

FailureKind = Literal["missed", "false", "wrong"]

ROAD, CURB, BUILDING, GROUND = 11, 67, 6, 2
PLANTS = (3, 4, 5)
NEAR_M = 0.4
SHARE = 0.25
"""Of the points around: so many of a kind make the place one of that kind."""
LOW_STEP_M = 0.03
"""Thesis Table 6-1: what is lower is no curb there."""
WALLS = frozenset(
    ("wall", "fence", "building", "gate", "hedge", "planter", "guard_pipe", "guardrail", "parapet")
)
COVERS = frozenset(("lid", "grating", "gutter", "box_lid", "manhole", "basin", "slab"))

_MOVING = 64
_VEHICLE_M, _VEHICLE_POINTS = 1.5, 10
_FARTHEST_M = 100.0
_BLIND_M, _MOVED_M = 15.0, 0.01
"""How long the zone behind a vehicle is about that nothing looks at, over both sides of the nearest
place; and how far apart places of a path must be to tell a direction."""


@dataclass(frozen=True)
class Failure:
    """A section, slot or thing that was missed, made up or told wrongly.

    Attributes
    ----------
    tool, street : str
    what : "missed", "false" or "wrong"
    type : str
        One of `CURB_TYPES` or `GUTTER_TYPES`; of things what they are.
    xyz : (n, 3) float64
        The section, or the slot's middle or the thing's place, m.
    detail : str
        What it is or lies on, in a word or two.
    """

    tool: str
    street: str
    what: FailureKind
    type: str
    xyz: Floats
    detail: str

    @property
    def middle(self) -> Floats:
        """(3,) its middle, m."""
        if len(self.xyz) == 1:
            return np.asarray(self.xyz[0])
        return np.asarray(middle_positions(self.xyz, max(length_m(self.xyz), 1e-6))[0])


class StreetSurroundings:
    """What lies around places of a street."""

    def __init__(self, scene: RoadScene, cloud: StreetCloud) -> None:
        self.cloud = cloud
        things = json.loads((scene.delivery / "truth/instance_kinds.json").read_text("utf-8"))
        self._kinds = {int(number): str(one["kind"]) for number, one in things.items()}
        paths = [drive.trajectory.xyz for drive in scene.drives if drive.trajectory is not None]
        self.ways = [path[::20] for path in paths]
        self.paths = PolylineIndex(self.ways)
        self.drives = scene.drives

    @cached_property
    def _tree(self) -> Any:  # scipy's tree has no stub that mypy takes
        from scipy.spatial import cKDTree

        return cKDTree(self.cloud.xyz[:, :2], balanced_tree=False, compact_nodes=False)

    def near(self, xyz: Floats, within_m: float) -> NDArray[np.int64]:
        """Points within so much of any place along a line or of a single place."""
        positions = xyz if len(xyz) == 1 else middle_positions(xyz, 0.4)
        found = self._tree.query_ball_point(positions[:, :2], within_m)
        return np.unique(np.concatenate([np.asarray(one, np.int64) for one in found]))

    def away_m(self, xyz: Floats) -> float:
        """How far the middle of a line is from the vehicle's path; NaN where that isn't known."""
        off = float(self.paths.nearest(xyz[[len(xyz) // 2]], _FARTHEST_M).off_m[0])
        return off if np.isfinite(off) else np.nan

    def turned_deg(self, xyz: Floats) -> float:
        """By how much the vehicle turned while it passed a line, degrees; 0 where that isn't known.

        Behind the vehicle lies a zone that no head looks at; who drives straight on measures it
        from farther ahead, who turns off doesn't (Takahashi 2022, section 6.5.6, figure 6-15).
        """
        middle, turned = xyz[len(xyz) // 2, :2], 0.0
        for way in self.ways:
            steps = np.diff(way[:, :2], axis=0)
            long_m = np.hypot(*steps.T)
            way_m = np.append(0.0, np.cumsum(long_m))
            away_m = np.hypot(*(way[:, :2] - middle).T)
            moves = long_m > _MOVED_M
            if away_m.min() > _FARTHEST_M or not moves.any():
                continue
            at_m = way_m[int(np.argmin(away_m))] + np.array([-_BLIND_M, _BLIND_M]) / 2
            headings = np.unwrap(np.arctan2(steps[moves, 1], steps[moves, 0]))
            ends = np.interp(at_m, way_m[:-1][moves], headings)
            turned = max(turned, float(np.degrees(abs(ends[1] - ends[0]))))
        return turned

    def share(self, points: NDArray[np.int64], labels: Sequence[int]) -> float:
        """Share of points with one of these labels."""
        return float(np.isin(self.cloud.label[points], labels).mean()) if points.size else 0.0

    def things(self, points: NDArray[np.int64]) -> Counter[str]:
        """Points by kind of thing; those of no single thing under an empty word."""
        numbers, counts = np.unique(self.cloud.instance[points], return_counts=True)
        found: Counter[str] = Counter()
        for number, count in zip(numbers.tolist(), counts.tolist(), strict=True):
            found[self._kinds.get(number, "")] += count
        return found

    def has_vehicle(self, xyz: Floats) -> bool:
        """Whether something that moves or is parked stands beside."""
        beside = self.cloud.label[self.near(xyz, _VEHICLE_M)]
        return int((beside == _MOVING).sum()) >= _VEHICLE_POINTS

    def most(self, points: NDArray[np.int64], kinds: frozenset[str]) -> bool:
        """Whether many of some points are of these kinds of things."""
        things = self.things(points)
        return sum(things[kind] for kind in kinds) > SHARE * max(points.size, 1)

    def named(self, points: NDArray[np.int64]) -> str:
        """The things that most of some points are of, with their shares."""
        common = self.things(points).most_common(3)
        total = max(points.size, 1)
        return ", ".join(f"{kind} {100 * count // total} %" for kind, count in common if kind)


def first_type(
    types: Sequence[str], facts: Mapping[str, Callable[[], bool]], otherwise: str = "other"
) -> str:
    """The first of some types whose fact is so."""
    return next((name for name in types if name in facts and facts[name]()), otherwise)
