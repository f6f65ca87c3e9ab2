"""What stands on a street, as a simulation tells it and as far as its scanners saw it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import laspy
import numpy as np
from scipy.spatial import cKDTree

from processing.core.arrays import Floats

_STEP_M = 0.2
_SEEN_M, _SEEN_POINTS = 0.12, 6
_HOLE_M = 4.0
_JOINED_M = 0.6
_LEAST_M = 6.0
_ASIDE = 4
"""Places left out at both ends of a stretch: nobody clicks where points begin to show."""
_PLATE_M, _TRUNK_M = 0.2, 0.35
_PLATE_POINTS, _TRUNK_POINTS = 20, 15
_BREAST_M = 1.0


@dataclass(frozen=True)
class TrueStreet:
    """Curbs, signs and trees, each with the drive that saw it best.

    Attributes
    ----------
    curbs : tuple of (drive name, kind, tuple of (n, 3) float64)
        The edge along one side, in pieces: at their joints curbs are lowered.
    signs : tuple of (drive name, centre, size in m, degrees clockwise from north it faces)
    trees : tuple of (drive name, foot, diameter in m)
    """

    curbs: tuple[tuple[str, str, tuple[Floats, ...]], ...]
    signs: tuple[tuple[str, Floats, float, float], ...]
    trees: tuple[tuple[str, Floats, float], ...]

    @staticmethod
    def read(path: Path) -> TrueStreet:
        """The street of a file that :meth:`write` wrote."""
        stored = json.loads(path.read_text(encoding="utf-8"))
        return TrueStreet(
            tuple(
                (one["drive"], one["kind"], tuple(map(np.array, one["pieces"])))
                for one in stored["curbs"]
            ),
            tuple(
                (one["drive"], np.array(one["centre"]), one["size_m"], one["facing_deg"])
                for one in stored["signs"]
            ),
            tuple((one["drive"], np.array(one["foot"]), one["dbh_m"]) for one in stored["trees"]),
        )

    @staticmethod
    def seen_in(clouds: Mapping[str, Path], truth: Path) -> TrueStreet:
        """What of a simulation's truth was seen in point files, by the names of their drives."""
        seen = {name: cKDTree(_points(path)) for name, path in clouds.items()}
        return TrueStreet(
            tuple(_curbs(seen, _features(truth / "curbs.geojson"))),
            tuple(_signs(seen, _features(truth / "signs.geojson"))),
            tuple(_trees(seen, _features(truth / "trees.geojson"))),
        )

    def write(self, path: Path, about: str) -> None:
        """Write it for :meth:`read`, to a tenth of a millimetre."""
        stored = {
            "about": about,
            "curbs": [
                {"drive": drive, "kind": kind, "pieces": [_rounded(one) for one in pieces]}
                for drive, kind, pieces in self.curbs
            ],
            "signs": [
                {"drive": drive, "centre": _rounded(at), "size_m": size, "facing_deg": facing}
                for drive, at, size, facing in self.signs
            ],
            "trees": [
                {"drive": drive, "foot": _rounded(foot), "dbh_m": dbh}
                for drive, foot, dbh in self.trees
            ],
        }
        text = json.dumps(stored, ensure_ascii=False, separators=(",", ":"))
        path.write_text(text + "\n", encoding="utf-8")


def _points(path: Path) -> Floats:
    cloud = laspy.read(path)
    return np.column_stack([cloud.x, cloud.y, cloud.z])


# GeoJSON has no types of its own.
def _features(path: Path) -> list[tuple[Floats, dict[str, Any]]]:
    features = json.loads(path.read_text(encoding="utf-8"))["features"]
    return [(np.array(one["geometry"]["coordinates"]), one["properties"]) for one in features]


def _curbs(
    seen: Mapping[str, cKDTree], features: list[tuple[Floats, dict[str, Any]]]
) -> list[tuple[str, str, tuple[Floats, ...]]]:
    curbs = []
    for edge in ("lower", "upper"):
        lines = [line for line, facts in features if facts["edge"] == edge and _is_front(facts)]
        for chain in _chains(lines):
            dense = [_every_step(line) for line in chain]
            count, first, last, name = max(
                (*_stretch(tree, dense), name) for name, tree in seen.items()
            )
            pieces = _cut(dense, first, last)
            if count * _STEP_M >= _LEAST_M and pieces:
                curbs.append((name, f"curb_{edge}", pieces))
    return curbs


def _is_front(facts: dict[str, Any]) -> bool:
    return bool(facts["type"] != "back")


def _chains(lines: list[Floats]) -> list[list[Floats]]:
    """Lines that go on from each other, in their order."""
    chains: list[list[Floats]] = []
    for line in lines:
        if chains and np.linalg.norm(chains[-1][-1][-1] - line[0]) <= _JOINED_M:
            chains[-1].append(line)
        else:
            chains.append([line])
    return chains


def _every_step(line: Floats) -> Floats:
    ends = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    along = np.arange(0.0, ends[-1], _STEP_M)
    return np.column_stack([np.interp(along, ends, line[:, k]) for k in range(3)])


def _stretch(tree: cKDTree, dense: list[Floats]) -> tuple[int, int, int]:
    """The longest stretch that was seen: number of its places, the first and the last."""
    positions = np.concatenate(dense)
    counts = tree.query_ball_point(positions, _SEEN_M, return_length=True)
    filled = np.flatnonzero(counts >= _SEEN_POINTS)
    if not filled.size:
        return 0, 0, 0
    parts = np.split(filled, np.flatnonzero(np.diff(filled) > _HOLE_M / _STEP_M) + 1)
    longest = max(parts, key=len)
    inside = max((len(longest) - 1) // 2, 0)
    aside = min(_ASIDE, inside)
    return len(longest), int(longest[aside]), int(longest[-1 - aside])


def _cut(dense: list[Floats], first: int, last: int) -> tuple[Floats, ...]:
    """Pieces between two places counted along all of them; every fifth place and the ends."""
    pieces, start = [], 0
    for positions in dense:
        low, high = max(first - start, 0), min(last - start, len(positions) - 1)
        start += len(positions)
        if high - low >= 3:
            chosen = np.unique(np.append(np.arange(low, high + 1, 5), high))
            pieces.append(positions[chosen])
    return tuple(pieces)


def _signs(
    seen: Mapping[str, cKDTree], features: list[tuple[Floats, dict[str, Any]]]
) -> list[tuple[str, Floats, float, float]]:
    signs = []
    for centre, facts in features:
        counts = {name: len(tree.query_ball_point(centre, _PLATE_M)) for name, tree in seen.items()}
        name = max(counts, key=lambda one: counts[one])
        if counts[name] > _PLATE_POINTS:
            signs.append((name, centre, float(facts["size_m"]), float(facts["facing_deg"])))
    return signs


def _trees(
    seen: Mapping[str, cKDTree], features: list[tuple[Floats, dict[str, Any]]]
) -> list[tuple[str, Floats, float]]:
    trees = []
    for foot, facts in features:
        breast = foot + np.array([0.0, 0.0, _BREAST_M])
        counts = {name: len(tree.query_ball_point(breast, _TRUNK_M)) for name, tree in seen.items()}
        name = max(counts, key=lambda one: counts[one])
        if counts[name] > _TRUNK_POINTS and facts["stems"] == 1:
            trees.append((name, foot, float(facts["dbh_m"])))
    return trees


def _rounded(values: Floats) -> list[Any]:
    rounded: list[Any] = np.round(values, 4).tolist()
    return rounded
