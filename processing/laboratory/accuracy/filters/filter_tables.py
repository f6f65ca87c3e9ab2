"""What filters scored, as Markdown tables, with the figures that others published beside them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from processing.laboratory.accuracy.filters.filter_scenes import NOISE_KINDS, SITE_KINDS, THIN_KINDS
from processing.scoring.points.point_scores import PointScore

NOT_INSTALLED = "not installed"


@dataclass(frozen=True)
class FilterResult:
    """What one method scored on one scene.

    Attributes
    ----------
    scene, method, settings : str
    ours : bool
    score : PointScore or None
        None where a peer isn't installed.
    """

    scene: str
    method: str
    settings: str
    ours: bool
    score: PointScore | None


def noise_table(found: Sequence[FilterResult]) -> str:
    """Kept points as the study scores them, noise points, and what is kept of thin things."""
    thin = [NOISE_KINDS[kind] for kind in THIN_KINDS]
    head = ["scene", "method", "settings", "kept P", "R", "**F**", "noise P", "R", "**F**"]
    rows = [[*head, *(f"{name} kept" for name in thin), "thin, mean"]]
    for one in found:
        cells = [one.scene, one.method, one.settings]
        if one.score is None:
            rows.append([*cells, NOT_INSTALLED, *[""] * (len(rows[0]) - 4)])
            continue
        kept, noise = one.score.class_of("kept"), one.score.class_of("noise")
        shares = (kept.precision, kept.recall, kept.f_measure)
        cells += [_percent(share, 3) for share in shares]
        cells += [_figure(one) for one in (noise.precision, noise.recall, noise.f_measure)]
        right = _right(one.score)
        of_thin = [right.get(kind, math.nan) for kind in THIN_KINDS]
        known = [share for share in of_thin if not math.isnan(share)]
        mean = sum(known) / len(known) if known else math.nan
        rows.append(cells + [_percent(share, 1) for share in (*of_thin, mean)])
    rows += [
        ["published: road, Nihon University", method, settings, *figures, *["–"] * (4 + len(thin))]
        for method, settings, *figures in _PUBLISHED_NOISE
    ]
    return markdown_table(rows)


def sites_table(found: Sequence[FilterResult]) -> str:
    """Both classes, both types of error, and kappa."""
    rows = [
        [
            "scene", "method", "settings", "object P", "R", "**F**", "ground P", "R", "**F**",
            "ground lost (I)", "objects left (II)", "total", "kappa",
        ]
    ]  # fmt: skip
    for one in found:
        cells = [one.scene, one.method, one.settings]
        if one.score is None:
            rows.append([*cells, NOT_INSTALLED, *[""] * (len(rows[0]) - 4)])
            continue
        for counts in (one.score.class_of("removed"), one.score.class_of("ground")):
            shares = (counts.precision, counts.recall, counts.f_measure)
            cells += [_figure(share) for share in shares]
        errors = {share.id: share.share.value for share in one.score.shares}
        cells += [_percent(errors[id_], 2) for id_ in ("type_1", "type_2", "total_error")]
        rows.append([*cells, _figure(one.score.figures[0].value)])
    rows += [
        ["published: Kako River", method, settings, *figures, *["–"] * 4]
        for method, settings, *figures in _PUBLISHED_GROUND
    ]
    return markdown_table(rows)


def kinds_table(found: Iterable[FilterResult], names: Mapping[int, str] = SITE_KINDS) -> str:
    """Which share of the points of each kind got the right class, one column a method."""
    scored = [one for one in found if one.score is not None and one.score.kinds]
    kinds = sorted({kind for one in scored for kind in _right_of(one)}, key=lambda k: (k < 0, k))
    rows = [["scene", "method", "settings", *(names.get(kind, f"{kind}") for kind in kinds)]]
    for one in scored:
        right = _right_of(one)
        shares = [_percent(right.get(kind, math.nan), 1) for kind in kinds]
        rows.append([one.scene, one.method, one.settings, *shares])
    return markdown_table(rows)


def airborne_table(found: Sequence[FilterResult]) -> str:
    """Total errors by sample, their mean, and the mean kappa."""
    samples = sorted({one.scene for one in found})
    rows = [["method", "settings", *samples, "**mean**", "mean kappa", "mean of all 15"]]
    methods = dict.fromkeys((one.method, one.settings) for one in found)
    for method, settings in methods:
        own = [one for one in found if (one.method, one.settings) == (method, settings)]
        scores = [one.score for one in own if one.score is not None]
        if len(scores) < len(own):
            rows.append([method, settings, NOT_INSTALLED, *[""] * (len(rows[0]) - 3)])
            continue
        errors = [score.class_of("ground").total_error for score in scores]
        kappa = sum(score.class_of("ground").kappa for score in scores) / len(scores)
        shown = [_percent(error, 2) for error in errors]
        mean = _percent(sum(errors) / len(errors), 2)
        rows.append([method, settings, *shown, f"**{mean}**", _figure(kappa), ""])
    for method, settings, errors_by, of_all in _PUBLISHED_AIRBORNE:
        known = [errors_by.get(sample, math.nan) for sample in samples]
        printed = [_percent(error / 100, 2) for error in (*known, sum(known) / len(known))]
        rows.append([method, settings, *printed, "–", f"{of_all:.2f} %"])
    return markdown_table(rows)


# Kogure et al. 2022 (road surface), table 1; kept points.
_PUBLISHED_NOISE = (
    ("radius", "0.5 m, 113", "98.928 %", "99.978 %", "99.450 %"),
    ("statistical", "113, 1.5 σ", "98.928 %", "99.996 %", "99.459 %"),
)
# Sakurai et al. (removal of machines), table 2, and the ground's figures from its counts.
_PUBLISHED_GROUND = (
    ("published", "g = 1 m", "0.85", "0.84", "0.84", "0.943", "0.947", "0.945"),
    ("published", "g = 3 m", "0.91", "0.83", "0.87", "0.941", "0.970", "0.955"),
    ("published", "g = 10 m", "0.63", "0.86", "0.73", "0.942", "0.818", "0.875"),
    ("lowest points", "g = 1 m", "0.42", "0.88", "0.56", "0.928", "0.562", "0.700"),
    ("lowest points", "g = 3 m", "0.33", "0.95", "0.49", "0.944", "0.304", "0.460"),
    ("lowest points", "g = 10 m", "0.27", "0.98", "0.42", "0.861", "0.045", "0.085"),
)
# Total errors in percent: Sithole and Vosselman 2004 (Axelsson's), Pingel and others 2013.
_PUBLISHED_AIRBORNE: tuple[tuple[str, str, Mapping[str, float], float], ...] = (
    (
        "published: PTD (Axelsson)",
        "tuned by its author",
        {"samp12": 3.25, "samp22": 3.63, "samp31": 4.78, "samp51": 2.72, "samp54": 3.23},
        4.82,
    ),
    (
        "published: SMRF",
        "best for each sample",
        {"samp12": 2.92, "samp22": 3.35, "samp31": 0.91, "samp51": 1.43, "samp54": 2.27},
        2.97,
    ),
    ("published: CSF", "by kind of terrain", {}, 4.58),
)


def _right_of(found: FilterResult) -> dict[int, float]:
    return {} if found.score is None else _right(found.score)


def _right(score: PointScore) -> dict[int, float]:
    return {one.kind: one.right.value for one in score.kinds if one.group == "kind"}


def markdown_table(rows: Sequence[Sequence[str]]) -> str:
    """Rows of cells as a Markdown table; the first is its head."""
    lines = ["| " + " | ".join(row) + " |" for row in rows]
    lines.insert(1, "|" + "---|" * len(rows[0]))
    return "\n".join(lines) + "\n"


def _percent(share: float, decimals: int) -> str:
    return "–" if math.isnan(share) else f"{100 * share:.{decimals}f} %"


def _figure(share: float) -> str:
    return "–" if math.isnan(share) else f"{share:.3f}".replace("-0.000", "0.000")
