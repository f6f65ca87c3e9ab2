"""The lines of one side, from the asphalt's edge outwards, and the strips between them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.street.dropped_curbs import Lowering
from processing.laboratory.simulate.street.ground import Strip
from processing.laboratory.simulate.street.measures import BandSurfaces, Measures
from processing.laboratory.simulate.street.plan import SidePlan
from processing.laboratory.simulate.street.stones import StoneNodes

OTHER, GROUND, GRASS, ROAD, CURB = 1, 2, 3, 11, 67
Role = Literal["road", "rear", "edging", "median", "island", "pit"]

STONE_TOP_M = 0.1
"""How much of a stone's top belongs to the run of its edge."""

_LEAST_WIDE_M = 0.03
_BROKEN_M = 0.01  # how far the broken edge of asphalt goes down to a shoulder
_ARC = tuple((float(np.cos(one)), float(np.sin(one))) for one in np.radians([22.5, 45.0, 67.5]))
"""Places on a quarter of a circle, from the face up to the top."""
_RAMP_DEEP_M = 1.2  # how far a walk's slope to a dropped curb reaches


@dataclass(frozen=True)
class Edge:
    """The edges of a stone, as lines of a profile.

    Attributes
    ----------
    foot, top : int
        Lines: where the face begins, and where that part of the top ends that shows the edge.
    away, above : (n,) float64
        The upper edge: where the planes of face and top meet, m.
    chamfer_m : float
    lowered : (n,) float64
        0 to 1: how far it is a dropped curb.
    """

    role: Role
    foot: int
    top: int
    away: Floats
    above: Floats
    chamfer_m: float
    lowered: Floats


@dataclass
class RoadProfile:
    """Lines outwards: distance from the road's centre and height over the asphalt's edge.

    Attributes
    ----------
    away, above : list of (n,) float64
        m, at each node.
    strips : list of Strip
        That between each line and the next: one fewer than lines.
    edges : list of Edge
    """

    away: list[Floats] = field(default_factory=list)
    above: list[Floats] = field(default_factory=list)
    strips: list[Strip] = field(default_factory=list)
    edges: list[Edge] = field(default_factory=list)

    def line(self, away: ArrayLike, above: ArrayLike, strip: Strip | None = None) -> int:
        """Add a line, and the strip that leads to it; its number."""
        if strip is not None:
            self.strips.append(strip)
        like = self.away[0] if self.away else np.asarray(away, np.float64)
        here = np.broadcast_to(np.asarray(away, np.float64), like.shape)
        if self.away:
            here = np.maximum(here, self.away[-1])
        self.away.append(here)
        self.above.append(np.broadcast_to(np.asarray(above, np.float64), like.shape))
        return len(self.away) - 1

    def stacked(self) -> tuple[Floats, Floats]:
        """Distances and heights of all lines: (n, k) float64 each."""
        return np.column_stack(self.away), np.column_stack(self.above)


@dataclass(frozen=True)
class Course:
    """What a profile is made from.

    Attributes
    ----------
    edge : (n,) float64
        From the centre to the asphalt's edge, m.
    laid : StoneNodes
        Its nodes.
    """

    side: SidePlan
    measures: Measures
    looks: BandSurfaces
    edge: Floats
    laid: StoneNodes
    lowering: Lowering


def profile_of(course: Course) -> RoadProfile:
    """The lines of a side without the land's far end."""
    profile = RoadProfile()
    profile.line(course.edge, 0.0)
    _add_drain(profile, course)
    if course.side.curb != "none":
        _add_curb(profile, course)
        if course.side.strip_m > 0:
            _add_strip(profile, course)
    if course.side.walk_m > 0:
        _add_walk(profile, course)
    if course.side.shoulder_m > 0:
        _add_shoulder(profile, course)
    start, level = profile.away[-1], profile.above[-1]
    measures = course.measures
    verge = Strip("verge", Material.GRASS, GRASS)
    profile.line(start + measures.verge, level - 0.01, verge)
    slope = Strip("slope", Material.GRASS, GRASS)
    if course.side.outside == "wall":
        slope = Strip("wall", Material.OLD_CONCRETE, OTHER)
    top = start + measures.verge + measures.run
    profile.line(np.maximum(top, profile.away[-1] + 0.01), level - 0.01 + measures.rise, slope)
    return profile


def _add_shoulder(profile: RoadProfile, course: Course) -> None:
    measures, start, level = course.measures, profile.away[-1], profile.above[-1]
    soft = Strip("shoulder", course.looks.shoulder, GROUND)
    low = level - measures.shoulder_low
    profile.line(start + _BROKEN_M, low, soft)
    profile.line(start + measures.shoulder, low - measures.shoulder_fall * measures.shoulder, soft)


def _add_drain(profile: RoadProfile, course: Course) -> None:
    measures, edge = course.measures, course.edge
    wide, drain = measures.drain, course.side.drain
    gutter = course.looks.gutter
    if drain == "apron":
        apron = Strip("apron", gutter, ROAD, has_surface=False)
        profile.line(edge + wide, -measures.fall * wide, apron)
    elif drain == "lids":
        profile.line(edge + wide, 0.0, Strip("drain", gutter, ROAD, has_surface=False))
    elif drain == "open":
        rim = Strip("rim", gutter, GROUND)
        channel = Strip("channel", Material.OLD_CONCRETE, OTHER)
        wall, depth = np.minimum(measures.wall, 0.2 * wide), measures.depth
        profile.line(edge + wall, 0.0, rim)
        profile.line(edge + wall + 0.002, -depth, channel)
        profile.line(edge + wide - wall - 0.002, -depth, channel)
        profile.line(edge + wide - wall, 0.0, channel)
        profile.line(edge + wide, 0.0, rim)


def curb_high(course: Course) -> Floats:
    """Height of the stone's upper edge over its foot at every node, m."""
    share = course.lowering.share
    normal: Floats = course.measures.high * (1 - share) + course.lowering.high * share
    return np.maximum(normal + course.laid.upwards, 0.0)


def _add_curb(profile: RoadProfile, course: Course) -> None:
    measures, laid, kind = course.measures, course.laid, course.side.curb
    strip = Strip("curb", course.looks.stone, CURB)
    foot, level = profile.away[-1] + 0.0, profile.above[-1]
    share = course.lowering.share
    high = curb_high(course)
    batter = measures.batter + laid.tilted
    lean = batter * high
    at = foot + laid.outwards
    profile.away[-1] = np.maximum(at, profile.away[-2]) if len(profile.away) > 1 else at
    if len(profile.away) == 1:
        profile.away[0] = at
    foot_line = len(profile.away) - 1
    chamfer = np.minimum(measures.chamfer + laid.chipped + laid.rounded, 0.45 * high)
    if kind == "asphalt":
        chamfer = np.zeros_like(high)
    rear = foot + np.maximum(measures.wide, lean + chamfer + _LEAST_WIDE_M)
    if kind == "asphalt":
        rear = foot + lean * 2 + np.maximum(measures.wide, 0.1) / 2
    top = level + high
    profile.line(at + batter * (high - chamfer), top - chamfer, strip)
    if np.any(laid.rounded > 0):
        # A worn edge is an arc about a place as far behind the face as below the top.
        for cos, sin in _ARC:
            away = chamfer * (1 - cos)
            profile.line(at + lean + away, top - chamfer * (1 - sin), strip)
    profile.line(at + lean + chamfer, top, strip)
    low = np.minimum(measures.behind, course.lowering.high)
    behind = level + np.minimum(measures.behind * (1 - share) + low * share, high)
    if kind == "raised":
        behind = top
    stands = top - behind
    back = np.minimum(measures.chamfer, 0.45 * stands) if kind in ("semi", "flat") else 0 * high
    line = profile.line(np.minimum(at + lean + STONE_TOP_M, rear - back - 0.002), top, strip)
    nominal = float(np.median(measures.chamfer)) if kind != "asphalt" else 0.0
    profile.edges.append(Edge("road", foot_line, line, at + lean, top, nominal, share))
    line = profile.line(rear - back, top, strip)
    if kind == "raised":
        return
    profile.line(rear, top - back, strip)
    slack = 0.5 * stands if kind == "asphalt" else 0.002 + 0 * stands
    last = profile.line(rear + slack, behind, strip)
    if kind != "asphalt":
        profile.edges.append(Edge("rear", last, line - 1, rear, top, nominal, share))


def _laid_high(course: Course) -> Floats:
    """How far single stones stand out of the walk that is level with them."""
    return course.laid.upwards * (course.side.curb == "raised")


def _walk_level(course: Course, level: Floats) -> Floats:
    """Height of the walk behind a planting strip, over the asphalt's edge."""
    measures, share = course.measures, course.lowering.share
    missing = (measures.behind - np.minimum(measures.behind, course.lowering.high)) * share
    near: Floats = np.clip(1 - measures.strip / 1.5, 0.0, 1.0)
    return level + missing * (1 - near)


def _add_strip(profile: RoadProfile, course: Course) -> None:
    measures, share = course.measures, course.lowering.share
    start, level = profile.away[-1], profile.above[-1] - _laid_high(course)
    walk = _walk_level(course, level)
    end = start + measures.strip
    wide, high = measures.edging_wide, measures.edging_high * (1 - share)
    soil = Strip("strip", Material.SOIL, GROUND)
    stone = Strip("edging", course.looks.stone, CURB)
    deep = measures.soil * (1 - share)
    profile.line(start + 0.004, level - deep, soil)
    profile.line(end - wide - 0.004, walk - deep + 0.3 * high, soil)
    profile.line(end - wide, walk + high, stone)
    top = profile.line(end - 0.004, walk + high, stone)
    foot = profile.line(end, walk, stone)
    if np.any(measures.edging_high > 0):
        edge = Edge("edging", foot, top - 1, end - 0.004, walk + high, 0.0, share)
        profile.edges.append(edge)


def _add_walk(profile: RoadProfile, course: Course) -> None:
    measures, share = course.measures, course.lowering.share
    start, level = profile.away[-1], profile.above[-1]
    if course.side.strip_m <= 0:
        level = level - _laid_high(course)
    low = np.minimum(measures.behind, course.lowering.high)
    nearness = np.clip(1 - measures.strip / 1.5, 0.0, 1.0)
    whole = level + (measures.behind - low) * share * nearness
    walk = Strip("walk", course.looks.walk, GROUND)
    reach = np.minimum(_RAMP_DEEP_M, 0.7 * measures.walk)
    profile.line(start + reach, whole + measures.walk_slope * reach, walk)
    profile.line(start + measures.walk, whole + measures.walk_slope * measures.walk, walk)
