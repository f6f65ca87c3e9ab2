"""Which things of a street hang into the room over its carriageway, as the points show them."""

from __future__ import annotations

import json
from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from processing.formats.vectors.geojson import write_members
from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.road_truth.true_roads import carriageway_edges
from processing.laboratory.simulate.scanning.returns import Returns
from processing.laboratory.simulate.scene.mesh import Floats, Integers
from processing.laboratory.simulate.scene.things import Thing
from processing.laboratory.simulate.street.plan import LEFT, RIGHT

FILE = "clearance.geojson"

HIGHEST_M = 6.0
"""Over the road: what hangs higher is in no limit's way."""

STANDING_M = 1.0
"""What comes lower over the carriageway stands there: vehicles, people, posts."""

PASSING = frozenset({"car", "van", "truck", "bus", "motorcycle", "bicycle", "person", "wheel_stop"})
"""Kinds of things that are there today and not tomorrow."""

_LABELS = (1, 4, 5, 6, 14, 15, 65, 66)
"""Codes of what may hang: neither ground nor road, noise nor what moves."""

_FARTHEST_M = 25.0
_PIECES = 256
_LEAST_OVER_M = 0.3
_BIN_M = 0.25
_DIGITS = 4


@dataclass
class _Seen:
    """What was seen of a thing over the carriageway: heights and places."""

    heights: list[Floats] = field(default_factory=list)
    depths: list[Floats] = field(default_factory=list)
    places: list[Floats] = field(default_factory=list)
    chainages: list[Floats] = field(default_factory=list)


class ClearanceEvidence:
    """Gathers points over the carriageway, by the thing that they lie on."""

    def __init__(self, street: Street, length_m: float) -> None:
        self._street, self._length_m = street, length_m
        self._seen: dict[int, _Seen] = defaultdict(_Seen)
        self._tree = _tree_of(street.alignment.positions[:, :2])

    def count(self, returns: Returns) -> None:
        """Take in points."""
        chosen = np.isin(returns.label, _LABELS) & (returns.evidence >= _PIECES)
        xyz, owner = returns.xyz[chosen], returns.evidence[chosen] // _PIECES
        if not len(xyz):
            return
        chainage, offset = self._along(xyz)
        near = np.abs(offset) < _FARTHEST_M
        near &= (chainage >= 0.0) & (chainage <= self._length_m)
        xyz, owner, chainage, offset = xyz[near], owner[near], chainage[near], offset[near]
        depth = self._depths(chainage, offset)
        inside = depth > 0
        xyz, owner, depth = xyz[inside], owner[inside], depth[inside]
        chainage, offset = chainage[inside], offset[inside]
        over = xyz[:, 2] - self._street.ground_height(chainage, offset)
        kept = (over > _LEAST_OVER_M) & (over < HIGHEST_M)
        for one in np.unique(owner[kept]):
            mine = kept & (owner == one)
            seen = self._seen[int(one)]
            seen.heights.append(over[mine])
            seen.depths.append(depth[mine])
            seen.places.append(xyz[mine])
            seen.chainages.append(chainage[mine])

    def write(self, folder: Path, things: Mapping[int, Thing], origin: Floats, crs: str) -> None:
        """Write ``clearance.geojson``: each thing at its lowest place over the carriageway."""
        members = [
            _member(seen, things[one].kind, one, origin)
            for one, seen in sorted(self._seen.items())
            if one in things and things[one].kind not in PASSING
        ]
        write_members(folder / FILE, members, crs=crs)

    def _along(self, xyz: Floats) -> tuple[Floats, Floats]:
        """Chainage and offset of places."""
        alignment = self._street.alignment
        _, row = self._tree.query(xyz[:, :2])
        heading = alignment.headings[row]
        beside = xyz[:, :2] - alignment.positions[row, :2]
        ahead = np.cos(heading) * beside[:, 0] + np.sin(heading) * beside[:, 1]
        aside = -np.sin(heading) * beside[:, 0] + np.cos(heading) * beside[:, 1]
        return alignment.chainages[row] + ahead, aside

    def _depths(self, chainage: Floats, offset: Floats) -> Floats:
        """How far inside the carriageway's edge places are, m; negative outside."""
        depths = np.full(chainage.shape, -np.inf)
        starts = np.array([one.start_m for one in self._street.plans])
        rows: Integers = np.clip(np.searchsorted(starts, chainage, "right") - 1, 0, None)
        for row in np.unique(rows):
            there = rows == row
            section = self._street.bare_section(int(row))
            edges = carriageway_edges(section, chainage[there])
            away = np.abs(offset[there])
            outer = np.where(offset[there] >= 0, edges[LEFT], edges[RIGHT]) - away
            median = section.plan.median_m / 2
            depths[there] = np.minimum(outer, away - median) if median > 0 else outer
        return depths


def _tree_of(places: Floats) -> Any:  # scipy's tree has no stub that mypy takes
    from scipy.spatial import cKDTree

    return cKDTree(places)


def _member(seen: _Seen, kind: str, instance: int, origin: Floats) -> dict[str, Any]:
    """A thing, with how many points it shows below each quarter of a metre."""
    heights, depths = np.concatenate(seen.heights), np.concatenate(seen.depths)
    places, along = np.concatenate(seen.places), np.concatenate(seen.chainages)
    lowest = int(heights.argmin())
    place = np.round(places[lowest] + origin, _DIGITS).tolist()
    counts = np.bincount((heights / _BIN_M).astype(np.int64), minlength=int(HIGHEST_M / _BIN_M))
    return {
        "type": "Feature",
        "geometry": {"type": "Point", "coordinates": place},
        "properties": {
            "kind": "clearance_place",
            "type": kind,
            "confidence": 1.0,
            "status": "candidate",
            "instance": instance,
            "lowest_m": round(float(heights[lowest]), _DIGITS),
            "from_m": round(float(along.min()), _DIGITS),
            "to_m": round(float(along.max()), _DIGITS),
            "depth_m": round(float(depths.max()), _DIGITS),
            "points": int(heights.size),
            "points_by_height": counts.tolist(),
            "is_standing": bool(heights[lowest] < STANDING_M),
            "places": _thinned(places + origin, heights),
        },
    }


def _thinned(places: Floats, heights: Floats) -> list[list[float]]:
    """The lowest place of each half metre in plan, its height over the road, and its points."""
    cells = np.floor(places[:, :2] / 0.5).astype(np.int64)
    order = np.lexsort((heights, cells[:, 1], cells[:, 0]))
    firsts = np.flatnonzero(np.any(np.diff(cells[order], axis=0, prepend=cells[order][:1] - 1), 1))
    chosen = order[firsts]
    counts = np.diff(np.append(firsts, len(order)))
    rows = np.column_stack([places[chosen], heights[chosen], counts])
    return [[round(float(one), 3) for one in row] for row in rows]


def read_places(path: Path) -> Iterator[dict[str, Any]]:
    """The properties of each thing in a file as `ClearanceEvidence` writes it."""
    for one in json.loads(path.read_text(encoding="utf-8"))["features"]:
        yield {**one["properties"], "xyz": one["geometry"]["coordinates"]}
