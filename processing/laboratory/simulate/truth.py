"""Truth of a street in the contract's formats, with what of each object the points show."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from processing.formats.vectors.geojson import write_members
from processing.laboratory.simulate.edge_evidence import EdgeEvidence
from processing.laboratory.simulate.plant_evidence import PlantEvidence
from processing.laboratory.simulate.scanning.delivered_files import CRS_NAME
from processing.laboratory.simulate.scanning.recording import Evidence
from processing.laboratory.simulate.scanning.simulated_passes import SimulatedPass
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.mesh import Floats, Integers
from processing.laboratory.simulate.scene.things import Thing, TrueFeature
from processing.laboratory.simulate.street.sweep import FACE_PIECE
from processing.laboratory.simulate.wall_evidence import WallEvidence

TRUTH_FILES = (
    *("curbs", "gutters", "trees", "signs", "poles", "wires", "markings"),
    *("barriers", "walls", "edges", "covers", "plant_areas"),
)
CURB_PIECE_M, CURB_SECTION_M = 0.5, 2.0
BREAST_PIECES, TRUNK_PIECE = range(1, 37), 37
FRONT_PIECE, BACK_PIECE = 1, 2
LID_CELLS = 24

_DIGITS = 4
_INITIAL_ERROR_M = 0.5

TruthProperties = dict[str, Any]  # whatever JSON can hold


@dataclass(frozen=True)
class RecordingEvidence:
    """What the recording shows.

    Attributes
    ----------
    evidence : Evidence
        Points by thing and piece.
    walls : WallEvidence
        Points by piece of a wall's foot.
    edges : EdgeEvidence
        Points by piece of an edge of the carriageway.
    plants : PlantEvidence
        Points by area of plants.
    path : (n, 3) float64
        Where the vehicle drove, m, the street's frame.
    """

    evidence: Evidence
    walls: WallEvidence
    edges: EdgeEvidence
    plants: PlantEvidence
    path: Floats

    @staticmethod
    def by(
        driven: SimulatedPass,
        evidence: Evidence,
        counted: tuple[WallEvidence, EdgeEvidence, PlantEvidence],
    ) -> RecordingEvidence:
        """What one pass, or several along the same street, show."""
        return RecordingEvidence(
            evidence, *counted, driven.positions[:: max(1, driven.positions.shape[0] // 200_000)]
        )

    def passes(self, positions: Floats) -> list[bool]:
        """Whether the vehicle drove by places, with as much road before and behind as beside."""
        tree, along = self._search
        away, nearest = tree.query(positions[:, :2])
        room = np.minimum(along[nearest], along[-1] - along[nearest])
        found: list[bool] = ((room > 0) & (room >= away)).tolist()
        return found

    @cached_property
    def _search(self) -> tuple[Any, Floats]:  # scipy's tree has no stub that mypy takes
        """The path as a tree of places, and how far along it each lies."""
        from scipy.spatial import cKDTree

        steps = np.linalg.norm(np.diff(self.path[:, :2], axis=0), axis=1)
        return cKDTree(self.path[:, :2]), np.r_[0.0, np.cumsum(steps)]


def write_truth(
    folder: Path, features: Iterable[TrueFeature], seen: RecordingEvidence, origin: Floats
) -> dict[str, int]:
    """Write ``curbs.geojson`` and its like; how many of each there are.

    Parameters
    ----------
    origin : (3,) float64
        Of the street's frame in the project's CRS, m.
    """
    by_file: dict[str, list[TruthProperties]] = {name: [] for name in TRUTH_FILES}
    for one in features:
        by_file[one.file].append(_member(one, seen, origin))
    for name, members in by_file.items():
        write_members(folder / f"{name}.geojson", members, crs=CRS_NAME)
    return {name: len(members) for name, members in by_file.items()}


def write_things(path: Path, things: Iterable[Thing]) -> None:
    """Write what each instance is: ``{"12": {"kind": "tree"}, …}``."""
    kinds = {str(one.instance): {"kind": one.kind} for one in things}
    path.write_text(json.dumps(kinds, ensure_ascii=False), encoding="utf-8")


def write_rough_positions(
    path: Path, features: Iterable[TrueFeature], seen: RecordingEvidence, origin: Floats, seed: int
) -> None:
    """Write where stereo measurement of images would put the signs: off by half a metre or more."""
    lines = ["easting_m,northing_m,height_m"]
    for one in features:
        front = seen.evidence.of(one.instance)[FRONT_PIECE]
        if one.file != "signs" or one.facts.get("supplementary") or front == 0:
            continue
        off = chance(seed, "rough position", one.instance).normal(0, _INITIAL_ERROR_M, 3)
        position = one.xyz[0] + origin + off * np.array([1.0, 1.0, 0.5])
        lines.append(",".join(f"{value:.3f}" for value in position))
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def _member(one: TrueFeature, seen: RecordingEvidence, origin: Floats) -> TruthProperties:
    positions = np.round(one.xyz + origin, _DIGITS).tolist()
    coordinates = {"Point": positions[0], "LineString": positions, "Polygon": [positions]}[
        one.geometry
    ]
    facts: TruthProperties = {"confidence": 1.0, "status": "candidate", **one.facts}
    for name, value in one.facts.items():
        if isinstance(value, list) and name.endswith("centre"):
            facts[name] = np.round(np.array(value) + origin, _DIGITS).tolist()
        elif isinstance(value, float):
            facts[name] = round(value, _DIGITS)
    facts["instance"] = one.instance
    facts.update(_shown(one, seen))
    return {
        "type": "Feature",
        "geometry": {"type": one.geometry, "coordinates": coordinates},
        "properties": facts,
    }


def _shown(one: TrueFeature, seen: RecordingEvidence) -> TruthProperties:
    """What the recording shows of a thing."""
    pieces = seen.evidence.of(one.instance)
    if one.file in _LINES:
        return _LINES[one.file](one, pieces, seen)
    if one.file == "walls":
        return _wall(one, seen)
    if one.file == "edges":
        return _edge(one, seen)
    if one.file == "plant_areas":
        points, covered = seen.plants.of(one)
        return {"points": points, "covered": round(covered, 3)}
    shown = _cover(one, pieces) if one.file == "covers" else _SHOWN[one.file](pieces)
    passed = seen.passes(one.xyz.mean(axis=0)[None])[0]
    return {**shown, "in_span": bool(passed and one.facts.get("in_span", True))}


def _curb(one: TrueFeature, pieces: Integers, seen: RecordingEvidence) -> TruthProperties:
    """Stretches of 2 m with the points on them, and the share of half metres that have any.

    Points on the top of a stone show its upper edge only: at the far side of a median, say, no
    point is near the lower one.
    """
    faces, tops = pieces[FACE_PIECE:], pieces[:FACE_PIECE]
    pieces = faces if one.facts["edge"] == "lower" else faces + tops
    steps = np.linalg.norm(np.diff(one.xyz, axis=0), axis=1)
    along = np.r_[0.0, np.cumsum(steps)]
    long = float(along[-1])
    starts = np.arange(0.0, max(long, 1e-6), CURB_SECTION_M)
    if starts.size > 1 and long - starts[-1] < CURB_PIECE_M:
        starts = starts[:-1]  # a short rest belongs to the stretch before it
    ends = np.r_[starts[1:], long]
    middles = np.column_stack([np.interp((starts + ends) / 2, along, axis) for axis in one.xyz.T])
    sections = []
    for start, end, passed in zip(starts, ends, seen.passes(middles), strict=True):
        span = pieces[int(start / CURB_PIECE_M) : max(1, int(np.ceil(end / CURB_PIECE_M)))]
        covered = float(np.mean(span > 0)) if span.size else 0.0
        sections.append(
            {
                "u0": round(float(start), 3),
                "u1": round(float(end), 3),
                "points": int(span.sum()),
                "covered": round(covered, 3),
                "in_span": passed,
            }
        )
    return {"length_m": round(long, 3), "sections": sections}


def _wire(one: TrueFeature, pieces: Integers, seen: RecordingEvidence) -> TruthProperties:
    """The points on each straight piece of a wire or barrier, and whether the vehicle passed it."""
    counts = pieces[: len(one.xyz) - 1]
    return {
        "points": int(counts.sum()),
        "piece_points": counts.tolist(),
        "piece_in_span": seen.passes((one.xyz[:-1] + one.xyz[1:]) / 2),
    }


def _marking(one: TrueFeature, pieces: Integers, seen: RecordingEvidence) -> TruthProperties:
    """The same of a marking; a gap of a broken line is shown as well as the worse dash beside."""
    counts = pieces[: len(one.xyz) - 1]
    painted = one.facts.get("painted")
    if isinstance(painted, list):
        at = np.arange(len(counts))
        dashes = np.flatnonzero(np.array(painted) > 0)
        if dashes.size:
            after = np.searchsorted(dashes, at)
            before = counts[dashes[np.clip(after - 1, 0, dashes.size - 1)]]
            behind = counts[dashes[np.clip(after, 0, dashes.size - 1)]]
            counts = np.where(np.isin(at, dashes), counts, np.minimum(before, behind))
    return {
        "points": int(pieces.sum()),
        "piece_points": counts.tolist(),
        "piece_in_span": seen.passes((one.xyz[:-1] + one.xyz[1:]) / 2),
    }


def _wall(one: TrueFeature, seen: RecordingEvidence) -> TruthProperties:
    """The points on the face over each straight piece of a wall's foot.

    Walls are seen from afar: what counts is what the points show, wherever the vehicle drove.
    """
    counts = seen.walls.of(one)
    return {"points": int(counts.sum()), "piece_points": counts.tolist()}


def _edge(one: TrueFeature, seen: RecordingEvidence) -> TruthProperties:
    """The points on the worse shown side of each straight piece, and whether it was passed."""
    counts = seen.edges.of(one)
    return {
        "points": int(counts.sum()),
        "piece_points": counts.tolist(),
        "piece_in_span": seen.passes((one.xyz[:-1] + one.xyz[1:]) / 2),
    }


def _gutter(pieces: Integers) -> TruthProperties:
    cells = pieces[:LID_CELLS]
    return {"points": int(pieces.sum()), "scanned": round(float(np.mean(cells > 0)), 3)}


def _tree(pieces: Integers) -> TruthProperties:
    breast = pieces[BREAST_PIECES.start : BREAST_PIECES.stop]
    return {
        "points": int(pieces.sum()),
        "trunk_points": int(breast.sum() + pieces[TRUNK_PIECE]),
        "breast_points": int(breast.sum()),
        "arc_deg": 10.0 * int((breast > 0).sum()),
    }


def _sign(pieces: Integers) -> TruthProperties:
    front, back = int(pieces[FRONT_PIECE]), int(pieces[BACK_PIECE])
    return {"points": front + back, "front_points": front}


def _cover(one: TrueFeature, pieces: Integers) -> TruthProperties:
    """The points on a cover, and the share of its pieces that any show."""
    count = one.facts["pieces"]
    shown = pieces[: int(count)] if isinstance(count, int) else pieces
    return {"points": int(pieces.sum()), "covered": round(float(np.mean(shown > 0)), 3)}


def _pole(pieces: Integers) -> TruthProperties:
    return {"points": int(pieces.sum())}


_LINES: Mapping[str, Callable[[TrueFeature, Integers, RecordingEvidence], TruthProperties]] = {
    "curbs": _curb,
    "wires": _wire,
    "markings": _marking,
    "barriers": _wire,
}

_SHOWN: Mapping[str, Callable[[Integers], TruthProperties]] = {
    "gutters": _gutter,
    "trees": _tree,
    "signs": _sign,
    "poles": _pole,
}
