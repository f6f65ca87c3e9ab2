"""Figures of scores as they stand in tables and in JSON."""

from __future__ import annotations

import math

from processing.core.text import Text
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix
from processing.scoring.points.reliability import ShareInterval

COUNTS_HEAD = (
    Text("precision", "適合率"),
    Text("recall", "再現率"),
    Text("F", "F値"),
    Text.same("TP"),
    Text.same("FP"),
    Text.same("FN"),
    Text.same("TN"),
)


def count_cells(counts: BinaryConfusionMatrix, *, has_rejections: bool = True) -> list[str]:
    """The cells under `COUNTS_HEAD`."""
    shares = (counts.precision, counts.recall, counts.f_measure)
    found = (counts.hits, counts.false_alarms, counts.misses)
    rejected = f"{counts.rejections:,}" if has_rejections else "–"
    return [*map(percent, shares), *(f"{count:,}" for count in found), rejected]


def counts_json(counts: BinaryConfusionMatrix, *, has_rejections: bool = True) -> dict[str, object]:
    """Counts and what is computed from them."""
    return {
        "precision": or_null(counts.precision),
        "recall": or_null(counts.recall),
        "f": or_null(counts.f_measure),
        "tp": counts.hits,
        "fp": counts.false_alarms,
        "fn": counts.misses,
        "tn": counts.rejections if has_rejections else None,
    }


def percent(share: float) -> str:
    """A share in percent; a dash where there is none."""
    return "–" if math.isnan(share) else f"{100 * share:.3f} %"


def figure(value: float) -> str:
    """A number, never minus zero; a dash where there is none."""
    words = f"{value:.4f}"
    return "–" if math.isnan(value) else words.removeprefix("-") if float(words) == 0 else words


def so_many_of(share: ShareInterval) -> str:
    """The two counts of a share."""
    return f"{int(share.hits):,} / {int(share.of):,}"


def or_null(value: float) -> float | None:
    """What JSON has for a number that is none."""
    return None if math.isnan(value) else value
