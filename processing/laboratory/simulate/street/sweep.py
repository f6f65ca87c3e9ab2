"""A profile led along a track: its places, its triangles, and the curbs' truth.

Each run of a curb is a thing of its own (kind ``curb``). The triangles of its face and of the first
10 cm of its top carry its instance; their piece is the number of half metres along its upper edge,
and `FACE_PIECE` more on the face, so that truth knows where the foot shows. A run is one curb of
one type: a dropped part reaches from ramp's middle to ramp's middle.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats, grid
from processing.laboratory.simulate.scene.things import NO_THING, SectionBuilder, TrueFeature
from processing.laboratory.simulate.street.alignment import Alignment
from processing.laboratory.simulate.street.profile import CURB, Edge, RoadProfile
from processing.laboratory.simulate.street.terrain import SectionTerrain

PIECE_M = 0.5
FACE_PIECE = 128
_LONGEST_RUN_M = 63.0  # pieces of tops and faces are told apart within a byte
_SHORTEST_RUN_M = 0.05
_LEAST_REAR_M = 0.015
"""A stone's rear edge that stands less above the walk is no edge."""

_LAND_STEP_M = 0.02
SKIRT_M = 0.4
"""How far land reaches down at its ends, where the next section's is made of other pieces."""


_CURB, _DROPPED, _NOTHING = 0, 1, 2


class SweepTrack(Protocol):
    """Where a profile is led."""

    def coordinates(self, away: Floats) -> tuple[Floats, Floats]:
        """Chainages and offsets of one line's nodes, from their distances (n,)."""


@dataclass(frozen=True)
class Straight:
    """Along the road.

    Attributes
    ----------
    chainages : (n,) float64
    side : int
    """

    chainages: Floats
    side: int

    def coordinates(self, away: Floats) -> tuple[Floats, Floats]:
        """Chainages and offsets of one line's nodes."""
        return self.chainages, self.side * away


@dataclass(frozen=True)
class Sweep:
    """A profile on its track.

    Attributes
    ----------
    chainages, offsets, heights : (n, k) float64
        Of every line's nodes; z in m.
    """

    profile: RoadProfile
    chainages: Floats
    offsets: Floats
    heights: Floats
    side: int

    @staticmethod
    def along(track: SweepTrack, profile: RoadProfile, terrain: SectionTerrain, side: int) -> Sweep:
        """Lead a profile along a track."""
        pairs = [track.coordinates(one) for one in profile.away]
        chainages = np.column_stack([one[0] for one in pairs])
        offsets = np.column_stack([one[1] for one in pairs])
        heights = terrain.height(chainages, offsets) + np.column_stack(profile.above)
        return Sweep(profile, chainages, offsets, heights, side)

    def edge_positions(self, alignment: Alignment, edge: Edge) -> Floats:
        """The upper edge: (n, 3) float64, on the planes of its face and top."""
        start = edge.foot
        low, high = self.profile.above[start], self.profile.above[edge.top]
        near, far = self.profile.away[start], self.profile.away[edge.top]
        wide = far - near
        safe = np.where(np.abs(wide) < 1e-9, 1.0, wide)
        share = np.where(np.abs(wide) < 1e-9, 1.0, (edge.away - near) / safe)
        base_low = self.heights[:, start] - low
        base_high = self.heights[:, edge.top] - high
        chainage = self._between(self.chainages, edge, share)
        offset = self._between(self.offsets, edge, share)
        height = base_low + share * (base_high - base_low) + edge.above
        return alignment.at(chainage, offset, height)

    @staticmethod
    def _between(lines: Floats, edge: Edge, share: Floats) -> Floats:
        between: Floats = lines[:, edge.foot] + share * (lines[:, edge.top] - lines[:, edge.foot])
        return between


def add_surfaces(sweep: Sweep, alignment: Alignment, built: SectionBuilder, walk: Material) -> None:
    """Add every strip that has a surface, but for the faces that belong to runs of curbs."""
    taken = {number for edge in sweep.profile.edges for number in _strips_of(edge)}
    lowered = sweep.profile.edges[0].lowered if sweep.profile.edges else None
    for number, strip in enumerate(sweep.profile.strips):
        if number in taken or not strip.has_surface:
            continue
        pair = slice(number, number + 2)
        rows = _rows(sweep, alignment, pair)
        if strip.kind == "land":
            rows = rows[_apart(sweep.chainages[:, number])]
            for end in (rows[0], rows[-1]):
                skirt = grid(np.stack([end, end - [0.0, 0.0, SKIRT_M]]))
                built.mesh.add(skirt, strip.material, strip.label, NO_THING)
        shape = grid(rows)
        material: Material | NDArray[np.uint8] = strip.material
        if strip.kind == "strip" and lowered is not None:
            paved = np.maximum(lowered[1:], lowered[:-1]) > 0
            material = np.repeat(np.where(paved, walk, strip.material).astype(np.uint8), 2)
        built.mesh.add(shape, material, strip.label, NO_THING)


def add_runs(sweep: Sweep, alignment: Alignment, built: SectionBuilder) -> None:
    """Add the curbs' faces, each run a thing of its own, and their truth."""
    for edge in sweep.profile.edges:
        upper = sweep.edge_positions(alignment, edge)
        lower = alignment.at(
            sweep.chainages[:, edge.foot], sweep.offsets[:, edge.foot], sweep.heights[:, edge.foot]
        )
        along = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(upper, axis=0), axis=1)))
        strips = _strips_of(edge)
        rows = _rows(sweep, alignment, slice(strips[0], strips[-1] + 2))
        material = sweep.profile.strips[strips[0]].material
        for kind, first, last in _runs(edge, upper[:, 2] - lower[:, 2], along):
            piece_rows = rows[first : last + 1]
            if kind == _NOTHING:
                built.mesh.add(grid(piece_rows), material, CURB, NO_THING)
                continue
            run = built.thing("curb")
            middles = (along[first:last] + along[first + 1 : last + 1]) / 2 - along[first]
            is_face = np.arange(len(strips)) == (0 if edge.foot < edge.top else len(strips) - 1)
            piece = (middles / PIECE_M).astype(np.int64)[:, None] + FACE_PIECE * is_face
            piece = np.repeat(piece.ravel(), 2)
            built.mesh.add(grid(piece_rows), material, CURB, run, piece=piece)
            lines = (upper[first : last + 1], lower[first : last + 1])
            chainage = float(np.mean(sweep.chainages[first : last + 1, edge.foot]))
            built.truth.extend(_features(edge, kind, lines, (run, sweep.side, chainage)))


def _features(
    edge: Edge, kind: int, lines: tuple[Floats, Floats], which: tuple[int, int, float]
) -> Iterator[TrueFeature]:
    upper, lower = lines
    run, side, chainage = which
    name = "dropped" if kind == _DROPPED else "curb"
    facts: dict[str, str | int | float | bool | list[float] | None] = {
        "kind": "curb",
        "run": run,
        "type": "back" if edge.role == "rear" else name,
        "height_m": round(float(np.mean(upper[:, 2] - lower[:, 2])), 4),
        "side": "left" if side > 0 else "right",
        "role": edge.role,
        "chamfer_m": round(edge.chamfer_m, 4),
        "length_m": round(float(np.linalg.norm(np.diff(upper, axis=0), axis=1).sum()), 3),
    }
    yield TrueFeature("curbs", "LineString", upper, {**facts, "edge": "upper"}, run, chainage)
    if edge.role != "rear":
        yield TrueFeature("curbs", "LineString", lower, {**facts, "edge": "lower"}, run, chainage)


def _runs(edge: Edge, steps: Floats, along: Floats) -> Iterator[tuple[int, int, int]]:
    """Type, first and last node of each run."""
    lowered = np.maximum(edge.lowered[1:], edge.lowered[:-1]) > 0.5 + 1e-9
    kinds = np.where(lowered, _DROPPED, _CURB)
    if edge.role in ("rear", "edging"):
        gone = np.minimum(steps[1:], steps[:-1]) < _LEAST_REAR_M
        kinds[gone | lowered] = _NOTHING
    kinds[(np.minimum(steps[1:], steps[:-1]) <= 0) & ~lowered] = _NOTHING
    first = 0
    for node in range(1, kinds.size + 1):
        is_end = node == kinds.size or kinds[node] != kinds[first]
        if is_end or along[node + 1] - along[first] > _LONGEST_RUN_M:
            is_short = along[node] - along[first] < _SHORTEST_RUN_M
            yield (_NOTHING if is_short else int(kinds[first])), first, node
            first = node


def _strips_of(edge: Edge) -> range:
    return range(min(edge.foot, edge.top), max(edge.foot, edge.top))


def _rows(sweep: Sweep, alignment: Alignment, lines: slice) -> Floats:
    return alignment.at(sweep.chainages[:, lines], sweep.offsets[:, lines], sweep.heights[:, lines])


def _apart(chainages: Floats) -> NDArray[np.bool_]:
    """One node of each joint: triangles tens of metres long have to be wider than a joint."""
    kept = np.append(True, np.diff(chainages) > _LAND_STEP_M)
    kept[-1] = True
    return kept
