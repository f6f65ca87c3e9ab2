"""Curb edges against a truth, counted in sections of 2 m as the thesis does, and measured.

Each edge is judged by itself: upper edges by true upper ones, lower by lower. A true section is
found where result lines run along most of it; what runs along no true line, or along one that
another line already accounts for, is cut into sections that are false. So a line at a wrong place
is both a miss and a false alarm, and neither the direction of lines nor where they are split
matters.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.text import Text
from processing.scoring.features.curb_sections import (
    COVERED_SHARE,
    SECTION_M,
    TrueSection,
    kind_of,
    pieces_of,
    sections_of,
)
from processing.scoring.features.file_scores import (
    DetectionCounts,
    ErrorStatistics,
    FileScore,
    errors_of,
    named_share,
)
from processing.scoring.features.line_positions import PolylineIndex, middle_positions
from processing.scoring.features.mapped_features import MappedFeature, MappedFile
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix

CURBS: dict[str, dict[str, object]] = {
    "curb": {},
    "curb_upper": {"edge": "upper"},
    "curb_lower": {"edge": "lower"},
}
"""Kinds of features that are curbs, with the edge that a kind implies."""

EDGES = ("upper", "lower")

TOLERANCE_M = 0.10
"""Mms.md 6.4: how far in plan a line may be from the true one."""

FOUND_SHARE = 0.5
"""A section is found, or false, if most of it is."""

_STEP_M = 0.1  # judged places along a line: 20 a section
_NAME = Text("curbs", "縁石")


@dataclass(frozen=True)
class ScoredLine:
    """A line of the result.

    Attributes
    ----------
    feature : MappedFeature
    right_share : float
        0 to 1: how much of it lies along true edges, seen or not, as the nearest line there.
    false : tuple of (n, 3) float64
        Sections of it that are false, m.
    """

    feature: MappedFeature
    right_share: float
    false: tuple[Floats, ...]


@dataclass(frozen=True)
class ScoredEdge:
    """One edge of all curbs, judged section by section.

    Attributes
    ----------
    asked : tuple of TrueSection
        Those that have to be found.
    is_found : (n,) bool
        Which of them are.
    lines : tuple of ScoredLine
        Those of the result.
    plan_off, height_off, step_off : (m,) float64
        Errors at places of found sections, and of the steps of found sections, m.
    right_types : int
        Found sections with the right type.
    unseen : int
        Sections that the points don't show.
    """

    asked: tuple[TrueSection, ...]
    is_found: NDArray[np.bool_]
    lines: tuple[ScoredLine, ...]
    plan_off: Floats
    height_off: Floats
    step_off: Floats
    right_types: int
    unseen: int

    def counts(self, *, with_dropped: bool) -> BinaryConfusionMatrix:
        """Sections found, false and missed; dropped curbs count neither way where left out."""
        is_dropped = np.array([one.kind == "dropped" for one in self.asked], np.bool_)
        counted = self.is_found[with_dropped | ~is_dropped]
        hits = int(counted.sum())
        false = sum(len(one.false) for one in self.lines)
        return BinaryConfusionMatrix(hits, false, counted.size - hits, 0)


def curb_score(
    result: MappedFile, truth: MappedFile, tolerance_m: float = TOLERANCE_M
) -> FileScore:
    """Score curbs.

    Parameters
    ----------
    tolerance_m : float
        How far in plan a line may be from the true one.

    Raises
    ------
    BadFile
        Features aren't lines of curbs, don't say which edge they are, or a measure is no number.
    """
    edges = score_edges(result, truth, tolerance_m)
    return FileScore(
        "curbs",
        tuple(_counts(edges)),
        (
            named_share(
                "type",
                ("sections found with the right type", "種類（縁石・切下げ）も正しい区間"),
                sum(one.right_types for one in edges.values()),
                sum(one.counts(with_dropped=True).hits for one in edges.values()),
            ),
        ),
        tuple(error for edge in EDGES for error in _edge_errors(edge, edges[edge])),
        left_out={"unseen_sections": sum(one.unseen for one in edges.values())},
        limits={
            "tolerance_m": tolerance_m,
            "section_m": SECTION_M,
            "found_share": FOUND_SHARE,
            "covered_share": COVERED_SHARE,
        },
    )


def score_edges(
    result: MappedFile, truth: MappedFile, tolerance_m: float = TOLERANCE_M
) -> dict[str, ScoredEdge]:
    """What was found, missed and made up of each of `EDGES`, place by place.

    Raises
    ------
    BadFile
        As :func:`curb_score`.
    """
    found, true = _by_edge(result), _by_edge(truth)
    return {
        edge: _judge_edge(
            result,
            [one for one in found[edge] if kind_of(one) != "back"],
            sections_of(truth, true[edge]),
            tolerance_m,
        )
        for edge in EDGES
    }


def _counts(edges: Mapping[str, ScoredEdge]) -> Iterator[DetectionCounts]:
    """What is counted, the thesis's own way first."""
    names = {
        False: Text("2 m sections, without dropped curbs", "2m区間（切下げを除く）"),
        True: Text("2 m sections, with dropped curbs", "2m区間（切下げを含む）"),
    }
    for with_dropped, name in names.items():
        counts = [one.counts(with_dropped=with_dropped) for one in edges.values()]
        id_ = "all" if with_dropped else "without_dropped"
        yield DetectionCounts(id_, name, sum(counts, BinaryConfusionMatrix(0, 0, 0, 0)))
    for edge, score in edges.items():
        name = Text(*_edge_name(edge, "2 m sections", "の2m区間"))
        yield DetectionCounts(edge, name, score.counts(with_dropped=True))


def _by_edge(file: MappedFile) -> dict[str, list[MappedFeature]]:
    """Lines by edge; the rear edges of kerb stones, which no map asks for, in both."""
    lines: dict[str, list[MappedFeature]] = {edge: [] for edge in EDGES}
    for one in file.of_kinds(CURBS, "line", _NAME):
        for edge in EDGES if kind_of(one) == "back" else (file.word(one, "edge", EDGES),):
            lines[edge].append(one)
    return lines


def _judge_edge(
    result: MappedFile,
    features: Sequence[MappedFeature],
    sections: Sequence[TrueSection],
    tolerance_m: float,
) -> ScoredEdge:
    asked = tuple(section for section in sections if section.is_asked)
    at, of = _all_positions([section.xyz for section in asked])
    lines = PolylineIndex([one.xyz for one in features])
    near = lines.nearest(at, tolerance_m)
    is_found = _mostly(near.line >= 0, of, len(asked))
    used = np.flatnonzero((near.line >= 0) & is_found[of])
    found = _lines_of(near.line[used], of[used])
    return ScoredEdge(
        asked,
        is_found,
        _judged_lines(features, PolylineIndex([one.xyz for one in sections]), lines, tolerance_m),
        near.off_m[used],
        (near.xyz - at)[used, 2],
        np.array(
            [result.number(features[j], "height_m") - asked[i].step_m for i, j in found.items()]
        ),
        sum(kind_of(features[line]) == asked[section].kind for section, line in found.items()),
        sum(section.kind != "back" for section in sections) - len(asked),
    )


def _all_positions(lines: Sequence[Floats]) -> tuple[Floats, Integers]:
    """Judged places along lines, (n, 3), and of which line each is."""
    positions = [middle_positions(line, _STEP_M) for line in lines]
    of = np.repeat(np.arange(len(lines)), [len(one) for one in positions])
    return np.vstack([np.empty((0, 3)), *positions]), of.astype(np.int64)


def _mostly(is_so: NDArray[np.bool_], of: Integers, count: int) -> NDArray[np.bool_]:
    """(count,) whether something is so at most places of each line."""
    whole = np.bincount(of, minlength=count)
    share = np.bincount(of[is_so], minlength=count) / np.maximum(whole, 1)
    return np.asarray(share >= FOUND_SHARE)


def _lines_of(line: Integers, of: Integers) -> dict[int, int]:
    """By section, the line beside the middle of what was found of it."""
    parts = np.split(np.arange(of.size), np.flatnonzero(np.diff(of)) + 1)
    return {int(of[one[0]]): int(line[one[one.size // 2]]) for one in parts if one.size}


def _judged_lines(
    features: Sequence[MappedFeature],
    true_lines: PolylineIndex,
    lines: PolylineIndex,
    tolerance_m: float,
) -> tuple[ScoredLine, ...]:
    """Lines of the result with what no true line, seen or not, accounts for."""
    parts = [pieces_of(one.xyz) for one in features]
    owner = np.repeat(np.arange(len(parts)), [len(one) for one in parts])
    pieces = list(itertools.chain.from_iterable(parts))
    at, of = _all_positions(pieces)
    true = true_lines.nearest(at, tolerance_m)
    is_right = true.line >= 0
    # Of two lines along one true line only the nearer is right.
    beside = lines.nearest(true.xyz[is_right], tolerance_m)
    is_right[is_right] = beside.line == owner[of[is_right]]
    is_piece_right = _mostly(is_right, of, len(pieces))
    positions = np.bincount(owner[of], minlength=len(features))
    share = np.bincount(owner[of[is_right]], minlength=len(features)) / np.maximum(positions, 1)
    ends = np.cumsum([0, *map(len, parts)])
    return tuple(
        ScoredLine(
            feature,
            float(share[number]),
            tuple(
                pieces[one]
                for one in range(ends[number], ends[number + 1])
                if not is_piece_right[one]
            ),
        )
        for number, feature in enumerate(features)
    )


def _edge_errors(edge: str, score: ScoredEdge) -> Iterator[ErrorStatistics]:
    yield errors_of(f"{edge}_plan", _edge_name(edge, "in plan", "の水平距離"), "m", score.plan_off)
    yield errors_of(f"{edge}_height", _edge_name(edge, "height", "の標高"), "m", score.height_off)
    yield errors_of(f"{edge}_step", _edge_name(edge, "curb's step", "の段差"), "m", score.step_off)


def _edge_name(edge: str, english: str, japanese: str) -> tuple[str, str]:
    ja = {"upper": "上端", "lower": "下端"}[edge]
    return f"{edge} edge, {english}", f"{ja}{japanese}"
