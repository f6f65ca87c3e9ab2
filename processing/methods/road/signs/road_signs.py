"""Road signs of a survey: plates beside and over the road, their place, shape, size and facing."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from processing.core.arrays import Floats, Integers
from processing.core.monitor import Monitor, PartMonitor
from processing.core.worked_ahead import in_order
from processing.methods.road.objects.ground_heights import height_of
from processing.methods.road.objects.sparse_plan import SparsePlan
from processing.methods.road.objects.survey import survey_ground
from processing.methods.road.signs.distinct_plates import distinct_plates
from processing.methods.road.signs.piece_kernels import COUNT, FIRST, FROM, LAST, TO
from processing.methods.road.signs.plate_fit import FittedPlate, fit_plates
from processing.methods.road.signs.plate_groups import PlateGroup, plate_groups
from processing.methods.road.signs.plate_lines import empty_lines, lines_of
from processing.methods.road.signs.plates import Plate, plate_alone, plates_of
from processing.methods.road.signs.scan_pieces import ScanPieces, scan_pieces
from processing.methods.road.signs.sign_confidence import (
    SignFacts,
    best_chance_of,
    chance_of,
    facts_of,
    facts_with_other_side,
    facts_with_post,
)
from processing.methods.road.signs.sign_posts import PostForm, posts_of
from processing.methods.road.signs.sign_shapes import SignShape, looked_for
from processing.methods.road.signs.two_sided import with_other_side
from processing.recording.drive import Drive

_ABOUT_S = 0.05
"""Before and after a turn, between which the vehicle's speed is taken: trajectories waver by
millimetres from record to record."""

_EVERY = 20
"""Records of a trajectory of which one is kept: a tenth of a second."""

_LIKELY = 0.1
"""Chance from which it is looked for what a plate hangs on: what is less likely is hardly shown,
and nothing that holds it makes it likelier."""


_HOPELESS = 0.05
"""Chance of a plate, if all that isn't known yet speaks for it, up to which it is none: less
than any limit that people set."""


_RIM_M = 0.02
"""Beyond the rim of a plate, where points on it may seem to lie: noise, and the beam is wide."""


@dataclass(frozen=True)
class RoadSign:
    """One sign, or what might be one.

    Attributes
    ----------
    plate : Plate
        m about the origin of the plan.
    centre : (3,) float64
        Of its area, m, project CRS.
    ground_m : float
        Height of the ground below it, project CRS.
    facts : SignFacts
    confidence : float
        The share of its like that are signs.
    is_supplement : bool
        Whether it hangs below another plate that it explains.
    point, drive : int
        The measured point nearest to the centre that lies on it, and which of the drives it is of.
    own_points, own_drives : (k,) int64
        The measured points on it, and which of the drives each is of.
    post : str or None
        What it hangs on; None where that wasn't measured.
    """

    plate: Plate
    centre: Floats
    ground_m: float
    facts: SignFacts
    confidence: float
    is_supplement: bool
    point: int
    drive: int
    own_points: Integers
    own_drives: Integers
    post: PostForm | None = None


class SoughtShapes(NamedTuple):
    """What plates may look like.

    Attributes
    ----------
    shapes : tuple of SignShape
        All but rectangles.
    with_rectangles : bool
        Whether rectangles of any size are looked for, too.
    """

    shapes: tuple[SignShape, ...]
    with_rectangles: bool = True


ShapesAt = Callable[[Floats], SoughtShapes | None]
"""What plates about a place (m, project CRS) may look like; None: nobody asks for them."""


def any_shape(_place: Floats) -> SoughtShapes:
    """All shapes, wherever a plate is."""
    return SoughtShapes(looked_for())


def road_signs(
    drives: Sequence[Drive], monitor: Monitor, shapes_at: ShapesAt = any_shape
) -> tuple[RoadSign, ...]:
    """All plates that may be signs; a confidence tells signs from the others.

    Parameters
    ----------
    shapes_at : callable
        What is looked for at a place.

    Notes
    -----
    1. Scan lines are followed over what rises above the ground and cut into straight pieces
       (:mod:`.scan_pieces`).
    2. Pieces of neighbouring lines that span an upright plane are plates, or parts of other flat
       things (:mod:`.plate_groups`).
    3. Outlines of the standard plates, and rectangles, are laid on the lines of a plane, beside
       each other where one doesn't explain all (:mod:`.plate_fit`).
    4. Which side shines is the face; how well a plate is explained says how sure it is.
    5. What stands behind and beside it says what it hangs on (:mod:`.sign_posts`).
    """
    plan, ground = survey_ground(drives, PartMonitor(monitor, 0.0, 0.3))
    pieces = scan_pieces(drives, plan, ground, PartMonitor(monitor, 0.3, 0.7))
    groups = plate_groups(pieces, turn_ways(drives, pieces), PartMonitor(monitor, 0.7, 0.8))
    ways = DriveWays(drives)

    def of_group(group: PlateGroup) -> list[RoadSign]:
        monitor.check()
        sought = shapes_at(group.middle + plan.origin)
        if sought is None:
            return []
        lines = lines_of(pieces, group)
        empty = empty_lines(pieces, group, lines)
        rectangles = sought.with_rectangles

        def is_hopeful(fitted: FittedPlate, explained: float) -> bool:
            plate = plate_alone(pieces, group, lines, fitted, explained)
            return plate is not None and _may_be_sign(plate, pieces, (plan, ground), ways)

        fit = fit_plates(
            lines,
            empty,
            sought.shapes,
            monitor,
            with_rectangles=rectangles,
            is_hopeful=is_hopeful,
        )
        return _signs(plates_of(pieces, group, lines, fit), pieces, (plan, ground), ways)

    found: list[RoadSign] = []
    for number, signs_of_group in enumerate(in_order(of_group, groups)):
        found += signs_of_group
        monitor.report(0.8 + 0.1 * (number + 1) / len(groups))
    return _held(_distinct(_with_other_sides(found)), drives, plan, PartMonitor(monitor, 0.9, 1.0))


def _distinct(found: list[RoadSign]) -> list[RoadSign]:
    """One of each plate."""
    chances = np.array([one.confidence for one in found])
    return [found[n] for n in distinct_plates([one.plate for one in found], chances, _LIKELY)]


def _held(
    signs: list[RoadSign], drives: Sequence[Drive], plan: SparsePlan, monitor: Monitor
) -> tuple[RoadSign, ...]:
    """Signs with what each hangs on, the surest ones first."""
    likely = [one for one in signs if best_chance_of(one.facts) >= _LIKELY]
    others = [one for one in signs if best_chance_of(one.facts) < _LIKELY]
    grounded = [(one.plate, one.ground_m - float(plan.origin[2])) for one in likely]
    forms = posts_of(drives, plan, grounded, monitor)
    held = [_with_post(one, form) for one, form in zip(likely, forms, strict=True)]
    held += [_with_post(one, None) for one in others]
    return tuple(sorted(held, key=lambda one: -one.confidence))


def _with_other_sides(signs: list[RoadSign]) -> list[RoadSign]:
    """Signs, those less sure of which the other side was found and doesn't shine either."""
    others = with_other_side([one.plate for one in signs])
    found = []
    for sign, other in zip(signs, others, strict=True):
        if other is None:
            found.append(sign)
            continue
        facts = facts_with_other_side(sign.facts, sign.plate, signs[other].plate)
        found.append(replace(sign, facts=facts, confidence=chance_of(facts)))
    return found


def _with_post(sign: RoadSign, post: PostForm | None) -> RoadSign:
    facts = facts_with_post(sign.facts, post)
    return replace(sign, facts=facts, confidence=chance_of(facts), post=post)


class DriveWays:
    """Which way the vehicles of drives went, wherever they were."""

    def __init__(self, drives: Sequence[Drive]) -> None:
        places, steps = [], []
        for drive in drives:
            if drive.trajectory is not None:
                places.append(drive.trajectory.xyz[::_EVERY, :2])
                heading = np.radians(drive.trajectory.roll_pitch_heading_deg[::_EVERY, 2])
                steps.append(np.column_stack([np.sin(heading), np.cos(heading)]))
        self._tree = cKDTree(np.concatenate(places)) if places else None
        self._steps = np.concatenate(steps) if steps else np.empty((0, 2))

    def at(self, place: Floats) -> Floats:
        """(2,) unit vector in plan of the way beside a place; NaN without one."""
        if self._tree is None:
            return np.full(2, np.nan)
        return np.asarray(self._steps[int(self._tree.query(place[:2])[1])])


def turn_ways(drives: Sequence[Drive], pieces: ScanPieces) -> Floats:
    """(n, 3) what the vehicle went during one turn where each piece was measured, m.

    NaN where a drive doesn't say.
    """
    ways = np.full((len(pieces), 3), np.nan)
    for number, drive in enumerate(drives):
        revolutions, trajectory = drive.revolutions, drive.trajectory
        if revolutions is None or trajectory is None or len(trajectory.time) < 2:
            continue
        mine = np.flatnonzero(pieces.drive == number)
        times = np.asarray(drive.columns["time"])[pieces.values[mine, FIRST].astype(np.int64)]
        first, last = (
            np.clip(times + off, trajectory.time[0], trajectory.time[-1])
            for off in (-_ABOUT_S, _ABOUT_S)
        )
        seconds = np.maximum(last - first, 1e-6) * revolutions.revolution_rate_hz
        for axis, along in enumerate(trajectory.xyz.T):
            went = np.interp(last, trajectory.time, along)
            went -= np.interp(first, trajectory.time, along)
            ways[mine, axis] = went / seconds
    return ways


def _signs(
    plates: Sequence[Plate],
    pieces: ScanPieces,
    below: tuple[SparsePlan, NDArray[np.float32]],
    ways: DriveWays,
) -> list[RoadSign]:
    """The plates of one plane with what is known of each; supplements are as sure as their sign."""
    plan = below[0]
    found: list[RoadSign] = []
    for plate in plates:
        level = _level_below(plate, pieces, below)
        facts = facts_of(plate, level, ways.at(plate.centre + plan.origin))
        point, drive = _point_near(plate, pieces)
        own_points, own_drives = _points_on(plate, pieces)
        found.append(
            RoadSign(
                plate,
                plate.centre + plan.origin,
                level + float(plan.origin[2]),
                facts,
                chance_of(facts),
                plate.upper >= 0,
                point,
                drive,
                own_points,
                own_drives,
            )
        )
    return found


def _points_on(plate: Plate, pieces: ScanPieces) -> tuple[Integers, Integers]:
    """The points on a plate, and the drive of each; few of lines with other things before them.

    Lines go on to what hangs beside a plate; where on a line a point lies, its number tells.
    """
    values, drives = pieces.values[plate.pieces], pieces.drive[plate.pieces]
    first, last = (values[:, column].astype(np.int64) for column in (FIRST, LAST))
    steps = np.where(last - first + 1 == values[:, COUNT], 1, last - first)
    counts = (last - first) // steps + 1
    line = np.repeat(np.arange(counts.size), counts)
    points = first[line] + steps[line] * (np.arange(line.size) - (np.cumsum(counts) - counts)[line])
    along = (points - first[line]) / (last - first)[line]
    ends = values[line, FROM : FROM + 3], values[line, TO : TO + 3]
    places = ends[0] + along[:, None] * (ends[1] - ends[0]) - plate.centre
    right = np.array([-plate.normal[1], plate.normal[0], 0.0])
    axes = np.column_stack([right / np.linalg.norm(right), np.cross(plate.normal, right)])
    rim, flat = (plate.outline - plate.centre) @ axes, places @ axes
    is_on = (flat >= rim.min(axis=0) - _RIM_M) & (flat <= rim.max(axis=0) + _RIM_M)
    chosen = is_on.all(axis=1)
    return points[chosen], drives[line[chosen]]


def _may_be_sign(
    plate: Plate,
    pieces: ScanPieces,
    below: tuple[SparsePlan, NDArray[np.float32]],
    ways: DriveWays,
) -> bool:
    """Whether a plate may be a sign if it is a supplement or hangs on what holds signs."""
    level = _level_below(plate, pieces, below)
    facts = facts_of(plate, level, ways.at(plate.centre + below[0].origin))
    return best_chance_of(facts._replace(narrow=0.0)) > _HOPELESS


def _level_below(
    plate: Plate, pieces: ScanPieces, below: tuple[SparsePlan, NDArray[np.float32]]
) -> float:
    """Height of the ground below a plate, m about the origin of the plan."""
    plan, ground = below
    level = height_of(ground, plan, float(plate.centre[0]), float(plate.centre[1]))
    return level if np.isfinite(level) else float(np.median(pieces.ground[plate.pieces]))


def _point_near(plate: Plate, pieces: ScanPieces) -> tuple[int, int]:
    """A measured point on a plate: the first of the piece whose beginning is nearest."""
    values = pieces.values[plate.pieces]
    nearest = int(np.linalg.norm(values[:, FROM : FROM + 3] - plate.centre, axis=1).argmin())
    return int(values[nearest, FIRST]), int(pieces.drive[plate.pieces[nearest]])
