"""Where a side street meets the road: widths, corners, and how it turns askew.

Everything is worked out in a frame of its own, in which the side street is square to the road:
``along`` (chainage) and ``beside`` (m outwards from the asphalt's edge). `Mouth.askew` then bends
the side street, without moving the section's ends.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.street.measures import Measures, measures_of
from processing.laboratory.simulate.street.plan import SectionPlan
from processing.laboratory.simulate.street.terrain import Grade

DEEP_M = 35.0
"""How far up the side street everything is built."""

_LEAST_RADIUS_M = 1.5
_CLEAR_M = 1.2
_BEND_M = 8.0
_CROWN = 0.015  # as the road's own camber
_CROWN_FROM_M = 6.0


@dataclass(frozen=True)
class Corner:
    """One corner of a mouth, seen from the section's end at its own side.

    Attributes
    ----------
    turn_m : float
        From the section's end to where the road's edge would meet the side street's.
    radius_m : float
        Of the asphalt's edge.
    is_late : bool
        Whether it lies behind the side street.
    """

    turn_m: float
    radius_m: float
    is_late: bool


@dataclass(frozen=True)
class Mouth:
    """A side street's mouth.

    Attributes
    ----------
    side : int
    start_m, end_m : float
        Of the section.
    middle_m, half_m : float
        Chainage of its middle, and half the width of its carriageway.
    corners : (Corner, Corner)
        The one before it and the one behind it.
    beside : Measures
        Of its own sides.
    shift_m, bend_m : float
        How far it runs askew, and within what distance it turns square again.
    still_m : float
        How far from its middle everything is turned alike.
    grade : Grade
    """

    side: int
    start_m: float
    end_m: float
    middle_m: float
    half_m: float
    corners: tuple[Corner, Corner]
    beside: Measures
    shift_m: float
    bend_m: float
    still_m: float
    grade: Grade

    @property
    def from_m(self) -> float:
        """Where the road's edge begins to turn."""
        first = self.corners[0]
        return self.start_m + first.turn_m - first.radius_m

    @property
    def to_m(self) -> float:
        """Where the second corner ends."""
        second = self.corners[1]
        return self.end_m - second.turn_m + second.radius_m

    def calm(self, chainage: Floats) -> Floats:
        """How much of the edge's swinging is left: 1 at the section's ends, 0 in the mouth."""
        ahead = (self.from_m - 0.3 - chainage) / (self.from_m - 0.3 - self.start_m)
        behind = (chainage - self.to_m - 0.3) / (self.end_m - self.to_m - 0.3)
        share: Floats = np.clip(np.maximum(ahead, behind), 0.0, 1.0)
        return share

    def askew(self, along: Floats, beside: Floats) -> Floats:
        """Chainages of places of the square frame."""
        far = np.abs(along - self.middle_m)
        room = np.where(
            along < self.middle_m, self.middle_m - self.start_m, self.end_m - self.middle_m
        )
        part = np.clip((room - far) / np.maximum(room - self.still_m, 1e-6), 0.0, 1.0)
        shift = self.shift_m * (1 - np.exp(-np.maximum(beside, 0.0) / self.bend_m))
        turned: Floats = along + shift * part
        return turned

    def square(self, chainage: Floats, beside: Floats) -> Floats:
        """The reverse of `askew`: where places lie in the square frame."""
        along = chainage
        for _ in range(12):
            along = along - (self.askew(along, beside) - chainage)
        return along

    def inside_m(self, chainage: Floats, beside: Floats) -> tuple[Floats, Floats]:
        """How far a place lies from the asphalt, below 0 on it: in each corner's block."""
        along = self.square(chainage, beside)
        depths = []
        for corner in self.corners:
            from_end = self.end_m - along if corner.is_late else along - self.start_m
            behind = corner.turn_m - from_end
            radius = corner.radius_m
            in_arc = (beside < radius) & (behind < radius)
            arc = radius - np.hypot(radius - beside, radius - behind)
            depths.append(np.where(in_arc, arc, np.minimum(beside, behind)))
        return depths[0], depths[1]

    def crown(self, chainage: Floats, beside: Floats) -> Floats:
        """How much the side street's asphalt is raised between its edges, m."""
        depths = self.inside_m(chainage, beside)
        from_edge = np.clip(-np.maximum(depths[0], depths[1]) / self.half_m, 0.0, 1.0)
        part = np.clip(beside / _CROWN_FROM_M, 0.0, 1.0)
        crown: Floats = _CROWN * self.half_m * (1 - (1 - from_edge) ** 2) * part
        return crown


def mouth_of(seed: int, plan: SectionPlan, side: int) -> Mouth:
    """The side street at one side of a junction."""
    shared = chance(seed, "junction", plan.index)
    random = chance(seed, "mouth", plan.index, side)
    half_length = plan.length_m / 2
    middle = plan.start_m + half_length + float(shared.uniform(-0.04, 0.04)) * plan.length_m
    room = min(middle - plan.start_m, plan.end_m - middle)
    half = min(float(random.uniform(2.0, 4.5)), room - _CLEAR_M - _LEAST_RADIUS_M - 1.0)
    turns = (middle - half - plan.start_m, plan.end_m - middle - half)
    corners = []
    for late, turn in enumerate(turns):
        radius = min(float(random.uniform(2.0, 8.0)), turn - _CLEAR_M)
        corners.append(Corner(turn, max(radius, _LEAST_RADIUS_M), bool(late)))
    beside, used = _beside(seed, plan, side, min(turns) - 0.4)
    angle = float(random.uniform(-25, 25)) if random.random() < 0.5 else 0.0
    still = min(half + used, room - 0.3)
    tangent = float(np.tan(np.radians(angle)))
    bend = _BEND_M
    if abs(tangent) > 1e-6:
        bend = min(_BEND_M, 0.6 * (room - still) / abs(tangent))
    slope = float(random.uniform(-0.04, 0.04)) if random.random() < 0.7 else 0.0
    grade = Grade(side, middle, still, room, slope)
    return Mouth(
        side,
        plan.start_m,
        plan.end_m,
        middle,
        half,
        (corners[0], corners[1]),
        beside,
        tangent * bend,
        max(bend, 1e-3),
        still,
        grade,
    )


def _beside(seed: int, plan: SectionPlan, side: int, room_m: float) -> tuple[Measures, float]:
    """Measures of the side street's own sides within a room, and how wide its street is."""
    random = chance(seed, "beside", plan.index, side)
    own = measures_of(seed, plan.side(side))
    curb = float(own.drain + own.wide)
    left = max(room_m - curb - 0.1, 0.1)
    walk = float(random.uniform(0.9, 2.0)) if random.random() < 0.6 else 0.0
    walk = min(walk, 0.5 * left, float(own.walk))
    verge = min(float(random.uniform(0.15, 0.5)), 0.3 * (left - walk))
    run = min(float(own.run), 0.9 * (left - walk - verge))
    values = dict(zip(own.__dataclass_fields__, own.all(), strict=True))
    values["strip"] = values["soil"] = values["edging_high"] = np.asarray(0.0)
    values["walk"], values["verge"] = np.asarray(walk), np.asarray(verge)
    values["run"] = np.asarray(run)
    return Measures(**values), curb + walk
