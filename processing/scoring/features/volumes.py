"""Volumes against a truth: by what share they are off, and whether they said so themselves."""

from __future__ import annotations

import math
from collections.abc import Mapping

from processing.core.text import Text
from processing.scoring.features.file_scores import FileScore, named_share
from processing.scoring.points.point_scores import NamedFigure

MEASURES = {
    "cut_m3": ("cut", "切土量"),
    "fill_m3": ("fill", "盛土量"),
    "net_m3": ("net", "差引土量"),
    "area_m2": ("area", "面積"),
}
"""What is compared, by its name in the result and in the truth."""

_SEEN = "_where_seen_m3"
_HIDDEN = ("unmeasured_area_m2", "unseen_area_m2")


def volume_score(result: Mapping[str, float], truth: Mapping[str, float]) -> FileScore:
    """Score volumes.

    Parameters
    ----------
    result, truth : mapping of str to float
        Numbers by their names; ``cut_where_seen_m3`` and the like of a truth leave out what no
        point shows. The result's ``uncertainty_m3`` is held against cut, fill and net each.
    """
    off = {name: _gap(result, truth, name) for name in MEASURES}
    figures = [
        NamedFigure(
            f"{name.rpartition('_')[0]}_off",
            Text("{en}: error as a share", "{ja}の相対誤差").filled(en=en, ja=ja),
            _share(off[name], truth.get(name, math.nan)),
        )
        for name, (en, ja) in MEASURES.items()
    ]
    for what in ("cut", "fill"):
        name, (en, ja) = f"{what}{_SEEN}", MEASURES[f"{what}_m3"]
        if name in truth:
            # What it says of measured ground alone, where it does; a truth can't ask more of it.
            told = result.get(f"measured_{what}_m3", result.get(f"{what}_m3", math.nan))
            gap = told - truth[name]
            words = Text("{en} where points are: error as a share", "{ja}（計測範囲）の相対誤差")
            figures.append(
                NamedFigure(
                    f"{what}_where_seen_off", words.filled(en=en, ja=ja), _share(gap, truth[name])
                )
            )
    volumes = [abs(gap) for name, gap in off.items() if name.endswith("_m3") and gap == gap]
    allowed = result.get("uncertainty_m3", math.nan)
    stated = [gap <= allowed for gap in volumes] if not math.isnan(allowed) else []
    hidden = {
        name: round(file[name])
        for name, file in zip(_HIDDEN, (result, truth), strict=True)
        if name in file
    }
    return FileScore(
        "volume",
        shares=(
            named_share(
                "within_uncertainty",
                ("volumes within the stated uncertainty", "結果に示された不確かさの範囲内の土量"),
                sum(stated),
                len(stated),
            ),
        ),
        figures=tuple(figures),
        left_out=hidden,
        limits={} if math.isnan(allowed) else {"uncertainty_m3": allowed},
    )


def _gap(result: Mapping[str, float], truth: Mapping[str, float], name: str) -> float:
    return result.get(name, math.nan) - truth.get(name, math.nan)


def _share(gap: float, of: float) -> float:
    """A gap as a share of the true value; NaN where that is nothing, unless both are."""
    if gap == 0:
        return 0.0
    return gap / abs(of) if of else math.nan
