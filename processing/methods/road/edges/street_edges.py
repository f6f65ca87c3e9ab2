"""Edges of the carriageway of a survey: all heads and passes together, along the driven ways."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from processing.core.arrays import Flags, Floats
from processing.core.monitor import Monitor, PartMonitor
from processing.methods.road.edges.cross_cells import ChunksOf, CrossCells, cross_cells
from processing.methods.road.edges.edge_confidence import EdgeLineFacts, chance_of, facts_of
from processing.methods.road.edges.edge_courses import LEFT, EdgeCourse, edge_courses
from processing.methods.road.edges.edge_facts import PlaceFacts, evidence_of, place_facts
from processing.methods.road.edges.edge_lines import CarriagewayLine, EdgeType, Neighbour, lines_of
from processing.methods.road.edges.way import RoadWays, road_ways
from processing.methods.road.objects.drive_chunks import DriveChunk, chunks_of
from processing.methods.road.objects.sparse_plan import SparsePlan
from processing.methods.road.objects.survey import SurveyGround, survey_ground
from processing.recording.drive import Drive

_STRAIGHT_M = 0.01
"""Vertices that lie so near to the line through the others say nothing: an edge of asphalt is
broken by more."""

_DOUBLE_M = 0.3
"""Two ways see the same edge where their lines lie so near."""


@dataclass(frozen=True)
class StreetEdge:
    """A stretch of the carriageway's edge where no curb stands.

    Attributes
    ----------
    type : str
        What lies outside, or ``bridged``.
    side : str
        Of the way that was driven first.
    evidence : tuple of str
        ``intensity``, ``roughness``, ``slope``: what tells it, the strongest first.
    line : (n, 3) float64
        On the carriageway, m, project CRS.
    bridged_m : float
        How much of it wasn't seen.
    ends : (str, str)
        What closes the carriageway before and after it.
    confidence : float
        The share of its like that are edges.
    """

    type: EdgeType
    side: str
    evidence: tuple[str, ...]
    line: Floats
    bridged_m: float
    ends: tuple[Neighbour, Neighbour]
    confidence: float

    @property
    def length_m(self) -> float:
        """Its length in plan."""
        return float(np.hypot(*np.diff(self.line[:, :2], axis=0).T).sum())


@dataclass(frozen=True)
class SeenEdges:
    """Edges before their confidence.

    Attributes
    ----------
    plan : SparsePlan
    cells : CrossCells or None
        None where nothing was driven.
    places : PlaceFacts or None
    courses : tuple of EdgeCourse
    lines : tuple of (CarriagewayLine, EdgeLineFacts)
    """

    plan: SparsePlan | None
    cells: CrossCells | None
    places: PlaceFacts | None
    courses: tuple[EdgeCourse, ...]
    lines: tuple[tuple[CarriagewayLine, EdgeLineFacts], ...]


@dataclass(frozen=True)
class FoundEdges:
    """What was found, and what closes the carriageway.

    Attributes
    ----------
    edges : tuple of StreetEdge
    closed_m : mapping of str to float
        Metres of both sides of all ways by what closes them: ``edge``, ``curb``, ``gap``.
    has_tones : bool
        Whether the recording has intensities that differ.
    full_share : float
        Of points at the highest intensity.
    """

    edges: tuple[StreetEdge, ...]
    closed_m: Mapping[str, float]
    has_tones: bool
    full_share: float


def street_edges(drives: Sequence[Drive], monitor: Monitor) -> FoundEdges:
    """All edges of the carriageway without a step.

    Notes
    -----
    1. Along each driven way, what lies beside it is put into narrow cells: heights, roughness, and
       brightness without what range and incidence do.
    2. Each place beside each station gets the chance that the carriageway ends there, and first
       there, by learnt weights.
    3. On each side the likeliest course of the edge through all stations is taken. Where a step
       rises along it, or behind a gutter's width, a curb closes the carriageway, which is left to
       the search for curbs.
    4. What is left becomes lines; gaps between what closes the carriageway are bridged, with the
       low confidence that such lines have.
    """
    if not any(drive.count for drive in drives):
        return FoundEdges((), {}, has_tones=True, full_share=0.0)
    below = survey_ground(drives, PartMonitor(monitor, 0.0, 0.4))
    seen = seen_edges(drives, below, PartMonitor(monitor, 0.4, 1.0))
    if seen.plan is None or seen.cells is None:
        return FoundEdges((), {}, has_tones=True, full_share=0.0)
    edges = [_street_edge(seen.plan.origin, line, chance_of(facts)) for line, facts in seen.lines]
    found = sorted((one for one in edges if len(one.line) > 1), key=lambda one: -one.confidence)
    return FoundEdges(tuple(found), _closed(seen), seen.cells.has_tones, seen.cells.full_share)


def seen_edges(drives: Sequence[Drive], ground: SurveyGround, monitor: Monitor) -> SeenEdges:
    """Edges with what speaks for them."""

    def chunks(number: int, part: Monitor) -> Iterator[DriveChunk]:
        return chunks_of([drives[number]], ground.plan.origin, part)

    return edges_along(road_ways(drives, ground.plan), (drives, chunks), ground, monitor)


def edges_along(
    ways: RoadWays,
    points: tuple[Sequence[Drive], ChunksOf],
    ground: SurveyGround,
    monitor: Monitor,
) -> SeenEdges:
    """Edges along some ways, by some points of drives."""
    if not len(ways):
        return SeenEdges(None, None, None, (), ())
    cells = cross_cells(*points, ground, ways, PartMonitor(monitor, 0.0, 0.6))
    places = place_facts(cells, monitor)
    monitor.report(0.8)
    courses = tuple(edge_courses(cells, places, monitor))
    lines: list[CarriagewayLine] = []
    for course in courses:
        monitor.check()
        lines += [*lines_of(cells, places, course)]
    monitor.report(1.0)
    return SeenEdges(
        ground.plan, cells, places, courses, tuple((one, facts_of(one)) for one in _once(lines))
    )


def _once(lines: Sequence[CarriagewayLine]) -> list[CarriagewayLine]:
    """Without lines of which most runs along one of another way."""
    from scipy.spatial import cKDTree

    kept: list[CarriagewayLine] = []
    ordered = sorted(lines, key=lambda one: -float(one.told.sum()))
    for line in ordered:
        others = [one.line[:, :2] for one in kept if one.type != "bridged"]
        if others and len(line.line):
            away = np.asarray(cKDTree(np.concatenate(others)).query(line.line[:, :2])[0])
            is_double: Flags = away < _DOUBLE_M
            if is_double.mean() > 0.5:
                continue
        kept.append(line)
    return kept


def _street_edge(origin: Floats, line: CarriagewayLine, chance: float) -> StreetEdge:
    import shapely

    kept = np.asarray(
        shapely.get_coordinates(shapely.LineString(line.line).simplify(_STRAIGHT_M), include_z=True)
    )
    return StreetEdge(
        line.type,
        "left" if line.side == LEFT else "right",
        () if line.type == "bridged" else evidence_of(line.facts),
        kept + origin,
        line.bridged_m,
        line.ends,
        chance,
    )


def _closed(seen: SeenEdges) -> dict[str, float]:
    """Metres of both sides by what closes the carriageway."""
    counts: Counter[str] = Counter()
    step_m = seen.cells.ways.step_m if seen.cells is not None else 0.0
    for course in seen.courses:
        counts.update(course.source(at) for at in range(len(course.stations)))
    return {source: count * step_m for source, count in counts.items()}
