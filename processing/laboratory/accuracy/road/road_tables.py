"""What curbs and gutters scored, as Markdown tables, with the thesis' figures beside them."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from processing.laboratory.accuracy.filters.filter_tables import markdown_table
from processing.laboratory.accuracy.road.road_failures import CURB_TYPES
from processing.laboratory.accuracy.road.road_gutter_failures import GUTTER_TYPES
from processing.laboratory.accuracy.road.road_surroundings import Failure
from processing.scoring.features.file_scores import ErrorStatistics, FileScore
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix
from processing.scoring.points.reliability import Reliability

ALL = "**all**"


@dataclass(frozen=True)
class ScoredStreet:
    """What a tool scored on a street.

    Attributes
    ----------
    name : str
    head : str
        Whose points it had.
    score : FileScore
    candidates : int
    """

    name: str
    head: str
    score: FileScore
    candidates: int


def curbs_table(streets: Sequence[ScoredStreet]) -> str:
    """Sections of 2 m, and errors in plan and height."""
    rows = [
        ["street", "without dropped: found, false, missed", "P", "R", "**F**",
         "with dropped: found, false, missed", "P", "R", "**F**", "right type",
         "upper edge, RMS in plan and height (cm)", "lower edge", "candidates"],
    ]  # fmt: skip
    for one in streets:
        score = one.score
        cells = [one.name]
        for id_ in ("without_dropped", "all"):
            cells += _figures(score.counts_of(id_))
        errors = [[score.errors_of(f"{edge}_{what}")] for edge, what in _EDGES]
        rows.append([*cells, percent(score.share_of("type")), *_pairs(errors), f"{one.candidates}"])
    cells = [ALL]
    for id_ in ("without_dropped", "all"):
        cells += _figures(sum_counts(streets, id_))
    errors = [[one.score.errors_of(f"{edge}_{what}") for one in streets] for edge, what in _EDGES]
    types = [one.score.share_of("type") for one in streets]
    hits = [one.score.counts_of("all").hits for one in streets]
    right = sum(share * hit for share, hit in zip(types, hits, strict=True) if hit)
    share = right / sum(hits) if sum(hits) else math.nan
    total = sum(one.candidates for one in streets)
    rows.append([*cells, percent(share), *_pairs(errors), f"{total}"])
    rows += [
        ["thesis, both scanners and speeds", "–", "94.89 %", "93.01 %", "93.94 %", *["–"] * 8],
        ["to reach", "–", "", "", "98 %", "–", "", "", "96 %", "", "2.0, 1.0", "2.0, 1.0", ""],
    ]
    return markdown_table(rows)


def gutters_table(streets: Sequence[ScoredStreet]) -> str:
    """Slots of 0.6 m, covers one by one, and their corners."""
    rows = [
        ["street", "slots: found, false, missed", "P", "R", "**F**",
         "lids: found, false, missed", "P", "R", "**F**",
         "gratings: found, false, missed", "P", "R", "**F**",
         "corners, RMS in plan and height (cm)"],
    ]  # fmt: skip
    kinds = ("slots", "lids", "gratings")
    for one in streets:
        cells = [cell for kind in kinds for cell in _figures(one.score.counts_of(kind))]
        rows.append([one.name, *cells, *_pairs([[one.score.errors_of(name)] for name in _CORNERS])])
    cells = [cell for kind in kinds for cell in _figures(sum_counts(streets, kind))]
    errors = [[one.score.errors_of(name) for one in streets] for name in _CORNERS]
    rows.append([ALL, *cells, *_pairs(errors)])
    thesis = ["3,088, 900, 713", "77.4 %", "81.2 %", "79.3 %", *["–"] * 9]
    fused = ["3,499, 1,385, 302", "71.6 %", "92.1 %", "80.6 %", *["–"] * 9]
    wanted = ["–", "", "", "93 %", "–", "", "", "90 %", "–", "", "", "", "3.0, –"]
    rows += [["thesis, left scanner", *thesis], ["thesis, both", *fused], ["to reach", *wanted]]
    return markdown_table(rows)


def heads_table(curbs: Sequence[ScoredStreet], gutters: Sequence[ScoredStreet]) -> str:
    """One head alone beside both together, over all streets that have both."""
    heads = list(dict.fromkeys(one.head for one in (*curbs, *gutters)))
    rows = [
        ["heads", "curbs without dropped: P", "R", "**F**", "gutters, slots: TP", "TN", "FP", "FN",
         "P", "R", "**F**"],
    ]  # fmt: skip
    for head in heads:
        lines = sum_counts([one for one in curbs if one.head == head], "without_dropped")
        slots = sum_counts([one for one in gutters if one.head == head], "slots")
        counts = (slots.hits, slots.rejections, slots.false_alarms, slots.misses)
        rows.append([head, *_shares(lines), *(f"{count:,}" for count in counts), *_shares(slots)])
    rows += [[name, *["–"] * 3, *figures] for name, *figures in _THESIS_HEADS]
    return markdown_table(rows)


def failures_table(failures: Sequence[Failure]) -> str:
    """How many failures there are of each type."""
    counts = Counter((one.tool, one.what, one.type) for one in failures)
    rows = [["what", "type", "how many"]]
    for tool, types in (("curbs", CURB_TYPES), ("gutters", GUTTER_TYPES)):
        unit = {"curbs": "2 m sections of edges", "gutters": "slots and covers"}[tool]
        for what, names in types.items():
            for name in names:
                count = counts[tool, what, name]
                if count:
                    rows.append([f"{tool}, {unit}, {what}", name, f"{count}"])
    return markdown_table(rows)


def reliability_table(of_tools: Mapping[str, Reliability]) -> str:
    """Candidates by their confidence, and which share of them is right."""
    rows = [["confidence", *(f"{tool}: right of all" for tool in of_tools)]]
    for number, one in enumerate(next(iter(of_tools.values())).bins):
        cells = [f"{one.low:.1f} to {one.high:.1f}"]
        for reliability in of_tools.values():
            share = reliability.bins[number].accepted
            words = f"{share.hits:.0f} of {share.of:.0f} ({100 * share.value:.0f} %)"
            cells.append(words if share.of else "–")
        rows.append(cells)
    errors = [f"{one.calibration_error:.3f}" for one in of_tools.values()]
    rows.append(["expected calibration error", *errors])
    return markdown_table(rows)


def sum_counts(streets: Sequence[ScoredStreet], id_: str) -> BinaryConfusionMatrix:
    """Counts of one name over all streets."""
    return sum((one.score.counts_of(id_) for one in streets), BinaryConfusionMatrix(0, 0, 0, 0))


def percent(share: float) -> str:
    """A share in percent; a dash where there is none."""
    return "–" if math.isnan(share) else f"{100 * share:.1f} %"


_EDGES = (("upper", "plan"), ("upper", "height"), ("lower", "plan"), ("lower", "height"))
_CORNERS = ("corner_plan", "corner_height")
# Takahashi 2022, section 7.5.
_THESIS_HEADS = (
    ("thesis, left", "3,088", "1,203", "900", "713", "77.4 %", "81.2 %", "79.3 %"),
    ("thesis, right", "2,870", "1,065", "1,038", "931", "73.4 %", "75.5 %", "74.5 %"),
    ("thesis, both", "3,499", "718", "1,385", "302", "71.6 %", "92.1 %", "80.6 %"),
)


def _figures(counts: BinaryConfusionMatrix) -> list[str]:
    told = f"{counts.hits:,}, {counts.false_alarms:,}, {counts.misses:,}"
    return [told, *_shares(counts)]


def _shares(counts: BinaryConfusionMatrix) -> list[str]:
    return [percent(one) for one in (counts.precision, counts.recall, counts.f_measure)]


def _pairs(errors: Sequence[Sequence[ErrorStatistics]]) -> list[str]:
    """Of plan and height in turns: “1.2, 0.4”."""
    values = [_rms_cm(one) for one in errors]
    return [f"{plan}, {height}" for plan, height in zip(values[::2], values[1::2], strict=True)]


def _rms_cm(errors: Sequence[ErrorStatistics]) -> str:
    """Over all places of all streets."""
    count = sum(one.count for one in errors)
    if not count:
        return "–"
    square = sum(one.count * one.rms**2 for one in errors if one.count)
    return f"{100 * math.sqrt(square / count):.1f}"
