"""Wires against a truth, by length: which of it was found within 5 cm, and what was made up.

Wires hang side by side and one above the other, so distances are those in space, and each place of
a true wire is found once: a second line along it is false.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.text import Text
from processing.scoring.features.file_scores import (
    DetectionCounts,
    ErrorStatistics,
    FileScore,
    errors_of,
)
from processing.scoring.features.mapped_features import MappedFeature, MappedFile
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix

WIRES: dict[str, dict[str, object]] = {"wire": {}}
"""Kinds of features that are wires."""

TOLERANCE_M = 0.05
"""In space; half the distance between wires that hang close together."""

STEP_M = 0.1
"""Between judged places; counts are in decimetres."""

_FINE_M = 0.01
"""Between places that others are measured to: half of it adds a millimetre at 1 cm."""

_SAME_SHARE = 0.8
"""Of a true wire that must be found by one line to compare their sags: shorter ones sag less."""

_NAME = Text("wires, in decimetres", "架線（延長、0.1 m単位）")


@dataclass(frozen=True)
class ScoredWires:
    """Places along wires, judged.

    Attributes
    ----------
    counts : BinaryConfusionMatrix
        Decimetres found, made up and missed.
    unseen : int
        Decimetres that the points don't show.
    off_m : (n,) float64
        How far found places lie off the nearest line.
    is_right : tuple of (k,) bool
        Of each line's places those along true wires.
    sag_off_m : tuple of float
        Of lines that cover a true wire.
    """

    counts: BinaryConfusionMatrix
    unseen: int
    off_m: Floats
    is_right: tuple[NDArray[np.bool_], ...]
    sag_off_m: tuple[float, ...]


def wire_score(result: MappedFile, truth: MappedFile) -> FileScore:
    """Score wires.

    Raises
    ------
    BadFile
        Features aren't lines of wires.
    """
    judged = score_wires(result, truth)
    errors: tuple[ErrorStatistics, ...] = (
        errors_of("off", ("distance to the wire", "架線までの距離"), "m", judged.off_m),
        errors_of("sag", ("sag", "弛度"), "m", list(judged.sag_off_m)),
    )
    return FileScore(
        "wires",
        (DetectionCounts("wires", _NAME, judged.counts),),
        errors=errors,
        left_out={"unseen": judged.unseen},
        limits={"tolerance_m": TOLERANCE_M},
    )


def score_wires(result: MappedFile, truth: MappedFile) -> ScoredWires:
    """Judge all places along wires.

    Raises
    ------
    BadFile
        As :func:`wire_score`.
    """
    from scipy.spatial import cKDTree

    found = result.of_kinds(WIRES, "line", _NAME)
    true = truth.of_kinds(WIRES, "line", _NAME)
    places, owner = _places([one.xyz for one in found], STEP_M)
    true_places, true_owner = _places([one.xyz for one in true], STEP_M)
    asked = _asked(true, true_places, true_owner)
    off = np.full(len(true_places), np.inf)
    line = np.full(len(true_places), -1, np.int64)
    if len(places) and len(true_places):
        fine, of = _places([one.xyz for one in found], _FINE_M)
        distances, nearest = cKDTree(fine).query(true_places)
        off = np.asarray(distances)
        line = of[nearest]
    is_near = off <= TOLERANCE_M
    right = np.zeros(len(places), np.bool_)
    if len(places) and len(true_places):
        fine, of = _places([one.xyz for one in true], _FINE_M)
        away, nearest = cKDTree(fine).query(places)
        # The line nearest to a true place accounts for it; beside it others are false.
        _, at = cKDTree(true_places).query(fine[nearest])
        right = (away <= TOLERANCE_M) & (line[at] == owner)
    hits, wanted = int((is_near & asked).sum()), int(asked.sum())
    made_up = int((~right).sum())
    counts = BinaryConfusionMatrix(hits, made_up, wanted - hits, 0)
    sags = _sags((result, found), (truth, true), np.where(is_near, line, -1), true_owner)
    ends = np.cumsum(np.bincount(owner, minlength=len(found)))[:-1]
    parts = tuple(np.split(right, ends)) if found else ()
    return ScoredWires(counts, int((~asked).sum()), off[is_near & asked], parts, tuple(sags))


def _places(lines: Sequence[Floats], step_m: float) -> tuple[Floats, Integers]:
    """Middles of equal pieces of lines, about so long, and the line of each."""
    parts: list[Floats] = []
    for line in lines:
        ends = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
        count = max(1, round(float(ends[-1]) / step_m))
        at = (np.arange(count) + 0.5) * ends[-1] / count
        parts.append(np.column_stack([np.interp(at, ends, axis) for axis in line.T]))
    owner = np.repeat(np.arange(len(parts)), [len(part) for part in parts]).astype(np.int64)
    return np.concatenate([np.empty((0, 3)), *parts]), owner


def _asked(wires: Sequence[MappedFeature], places: Floats, owner: Integers) -> NDArray[np.bool_]:
    """Places on pieces that the points show and the vehicle passed; all, where nothing is told."""
    asked = np.ones(len(places), np.bool_)
    for number, wire in enumerate(wires):
        mine = np.flatnonzero(owner == number)
        steps = np.linalg.norm(np.diff(wire.xyz, axis=0), axis=1)
        ends = np.cumsum(steps)
        at = (np.arange(mine.size) + 0.5) * ends[-1] / mine.size
        piece = np.minimum(np.searchsorted(ends, at), steps.size - 1)
        for name in ("piece_points", "piece_in_span"):
            told = wire.facts.get(name)
            if isinstance(told, list) and len(told) == steps.size:
                asked[mine] &= np.array([bool(one) for one in told])[piece]
    return asked


def _sags(
    result: tuple[MappedFile, Sequence[MappedFeature]],
    truth: tuple[MappedFile, Sequence[MappedFeature]],
    line: Integers,
    owner: Integers,
) -> list[float]:
    """Sag of lines less that of the true wires that they cover."""
    off: list[float] = []
    for number, wire in enumerate(truth[1]):
        mine = line[owner == number]
        if mine.size == 0:
            continue
        best = int(np.bincount(mine + 1).argmax()) - 1
        if best >= 0 and np.count_nonzero(mine == best) >= _SAME_SHARE * mine.size:
            told = result[0].number(result[1][best], "sag_m")
            off.append(told - truth[0].number(wire, "sag_m"))
    return [one for one in off if np.isfinite(one)]
