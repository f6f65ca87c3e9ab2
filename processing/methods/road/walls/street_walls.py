"""Walls, retaining walls and faces of buildings of a survey: all heads and passes together."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.core.monitor import Monitor, PartMonitor
from processing.methods.road.objects.drive_chunks import DriveChunk, chunks_of
from processing.methods.road.objects.driven_path import driven_places
from processing.methods.road.objects.survey import SurveyGround, survey_ground
from processing.methods.road.walls.face_fits import FaceSurroundings, measured_faces
from processing.methods.road.walls.steady_ground import steady_ground
from processing.methods.road.walls.wall_cells import PulseTimes, cell_columns, cell_points
from processing.methods.road.walls.wall_confidence import WallFacts, chance_of, facts_of
from processing.methods.road.walls.wall_faces import linked_cells, local_planes, neighbours
from processing.methods.road.walls.wall_lines import WallLine, WallType, length_of, wall_lines
from processing.recording.drive import Drive

_REACH_CELLS = 2
_OFF = 1.25
"""How far one cell's plane may miss the next one's, over how far a point may lie off its plane."""

_TALL_SLABS, _FLAT_SHARE = 5, 0.1
"""Slabs of a plane that is tall, and which share of those are the recording's flattest."""

_HIGHEST_LOW_M = 2.0
"""What begins higher over the ground hangs: balconies, awnings and boards. Walls of yards, which
hide the lower part of a face, end at about this height."""

_NEAREST_M = 0.3
"""Of a vertex, the farthest of the measured points that it rests on."""


@dataclass(frozen=True)
class StreetWall:
    """One line of a wall or of a building's face.

    Attributes
    ----------
    type : str
    line : (n, 3) float64
        The foot of a wall; the face of a building at the height asked for. m, project CRS.
    height_m : float
        From the foot to the top, as far as it was seen.
    top_m : float
        Height of the top, m, project CRS.
    lowest_m : float
        Over the foot, where the face begins to be seen.
    openings_m : (float, float)
        Widths of the openings at its beginning and its end; 0: none.
    run : int
        Shared by what lies on both sides of an opening.
    hidden_m : float
        How much of its length was not measured.
    confidence : float
        The share of its like that are walls or faces.
    points, drives : (n,) int64
        Of each vertex the measured point nearest to it by its number in its drive, −1 where none is
        near; and which drive it is of.
    """

    type: WallType
    line: Floats
    height_m: float
    top_m: float
    lowest_m: float
    openings_m: tuple[float, float]
    run: int
    hidden_m: float
    confidence: float
    points: Integers
    drives: Integers

    @property
    def long_m(self) -> float:
        """Length in plan."""
        return length_of(self.line)


@dataclass(frozen=True)
class SeenWalls:
    """Lines before their confidence.

    Attributes
    ----------
    lines : tuple of (WallLine, WallFacts)
    about : FaceSurroundings or None
        None where there are no points.
    """

    lines: tuple[tuple[WallLine, WallFacts], ...]
    about: FaceSurroundings | None


def street_walls(
    drives: Sequence[Drive], face_height_m: float, monitor: Monitor
) -> tuple[StreetWall, ...]:
    """All upright planes on the ground; a confidence tells walls from other things.

    Parameters
    ----------
    face_height_m : float
        Over its foot, where the line of a building's face lies.

    Notes
    -----
    1. Over cells of the plan that are filled at several heights the likeliest steep plane is drawn.
    2. Planes that go on from cell to cell are faces; each is measured station by station.
    3. Faces in one line are joined where something hid them, and parted at openings.
    """
    seen = seen_walls(drives, monitor)
    if seen.about is None:
        return ()
    found = [_street_wall(one, facts, seen.about, face_height_m) for one, facts in seen.lines]
    monitor.report(1.0)
    return tuple(sorted(found, key=lambda one: -one.confidence))


def seen_walls(drives: Sequence[Drive], monitor: Monitor) -> SeenWalls:
    """Lines with what speaks for them."""
    if not any(drive.count for drive in drives):
        return SeenWalls((), None)
    plan, ground = survey_ground(drives, PartMonitor(monitor, 0.0, 0.4))

    def chunks(part: Monitor) -> Iterable[DriveChunk]:
        return chunks_of(drives, plan.origin, part)

    part = PartMonitor(monitor, 0.4, 0.95)
    seen = walls_in(drives, chunks, SurveyGround(plan, ground), part)
    monitor.report(0.95)
    return seen


def walls_in(
    drives: Sequence[Drive],
    chunks: Callable[[Monitor], Iterable[DriveChunk]],
    below: SurveyGround,
    monitor: Monitor,
) -> SeenWalls:
    """Lines of the points that chunks hold.

    Parameters
    ----------
    drives : sequence of Drive
        In the order that chunks number them.
    chunks : callable
        Goes through the points, each time it is called.
    """
    plan = below.plan
    ground = steady_ground(plan, below.heights, monitor)
    below = SurveyGround(plan, ground)
    path = driven_places(drives, plan)
    columns = cell_columns(chunks(PartMonitor(monitor, 0.0, 0.35)), plan, ground)
    part = PartMonitor(monitor, 0.35, 0.7)
    points = cell_points(chunks(part), below, columns, PulseTimes(drives), monitor)
    planes, middles, noise_m = local_planes(points, plan, monitor)
    wide = neighbours(points, plan, middles, _REACH_CELLS)
    faces = linked_cells(planes, middles, wide, _OFF * noise_m)
    about = FaceSurroundings(plan, ground.reshape(-1), columns, points, path, noise_m)
    around = neighbours(points, plan, middles, 1)
    measured = list(measured_faces(about, planes, middles, (faces, around), monitor))
    monitor.check()
    lines = [one for one in wall_lines(measured, about) if one.face.low_m <= _HIGHEST_LOW_M]
    flat_m = _flattest(planes)
    facts = [facts_of(one, _aside_m(one, path), flat_m) for one in lines]
    return SeenWalls(tuple(zip(lines, facts, strict=True)), about)


def _flattest(planes: Floats) -> float:
    """How far points lie off the flattest of the planes, m."""
    off = planes[planes[:, 4] >= _TALL_SLABS, 6]
    return float(np.quantile(off, _FLAT_SHARE)) if off.size else 0.0


def _aside_m(line: WallLine, path: Floats) -> float:
    """How near a line comes to the vehicle's way in plan."""
    if not len(path):
        return float("inf")
    from scipy.spatial import cKDTree

    asked = np.concatenate([line.line[:, :2], line.line[:, :2].mean(axis=0)[None]])
    return float(np.min(cKDTree(path).query(asked)[0]))


def _street_wall(
    line: WallLine, facts: WallFacts, about: FaceSurroundings, face_height_m: float
) -> StreetWall:
    from scipy.spatial import cKDTree

    shape, face = line.line.copy(), line.face
    top = float(shape[:, 2].mean() + face.top_m + about.plan.origin[2])
    if line.type == "building":
        above = min(max(face_height_m, face.low_m), face.top_m)
        shape[:, 2] += above
        shape[:, :2] -= face.lean * above * line.normal
    local = about.points.local[line.points]
    # The foot of a wall lies below its lowest points: what is near in plan is what it rests on.
    away, nearest = cKDTree(local[:, :2]).query(shape[:, :2])
    rests = np.where(away <= _NEAREST_M, line.points[nearest], -1)
    return StreetWall(
        type=line.type,
        line=shape + about.plan.origin,
        height_m=face.top_m,
        top_m=top,
        lowest_m=face.low_m,
        openings_m=line.openings,
        run=line.run,
        hidden_m=line.hidden_m,
        confidence=chance_of(facts),
        points=np.where(rests >= 0, about.points.points[rests], -1),
        drives=np.where(rests >= 0, about.points.drives[rests], 0),
    )
