"""Street trees against a truth: which were found, and how well each was measured.

Counted as the thesis does (Takahashi 2022, 5.3), but one to one, and trees with stakes are
measured too, in a row of their own: stakes are what makes trunks seem thick.
"""

from __future__ import annotations

import math

import numpy as np

from processing.core.text import Text
from processing.scoring.features.file_scores import (
    DetectionCounts,
    ErrorStatistics,
    FileScore,
    errors_of,
)
from processing.scoring.features.mapped_features import MappedFeature, MappedFile
from processing.scoring.features.object_matches import (
    Differences,
    ObjectMatch,
    is_in_span,
    match_objects,
    shows_enough,
)

TREES: dict[str, dict[str, object]] = {
    "tree": {},
    "street_tree": {},
    "tree_broadleaf": {},
    "tree_conifer": {},
}
"""Kinds of features that are trees."""

WITHIN_M = 2.0
"""Mms.md 5.3: a computed tree is right within 2 m of a true one."""

LEAST_TRUNK_POINTS = 20
"""With fewer on the trunk between the ground and the crown nobody could tell that it is one."""

LEAST_ARC_DEG = 60.0
"""Such an arc rises over its chord by 13 % of the radius, a centimetre on a usual trunk: that is
the noise of a scan, and a shorter arc leaves the diameter open."""

_NAME = Text("trees", "樹木")
_DBH = ("DBH", "胸高直径")


def tree_score(result: MappedFile, truth: MappedFile) -> FileScore:
    """Score trees.

    Raises
    ------
    BadFile
        Features aren't trees, or a measure is no number.
    """
    true = truth.of_kinds(TREES, "point", _NAME)
    asked = [
        is_in_span(one) and shows_enough(truth, one, "trunk_points", LEAST_TRUNK_POINTS)
        for one in true
    ]
    found = match_objects(result.of_kinds(TREES, "point", _NAME), true, asked, WITHIN_M)
    measured = [
        one for one in found.partners if shows_enough(truth, one.truth, "arc_deg", LEAST_ARC_DEG)
    ]
    has_stakes = [truth.number(one.truth, "stakes") > 0 for one in measured]
    free = [one for one, staked in zip(measured, has_stakes, strict=True) if not staked]
    staked = [one for one, staked in zip(measured, has_stakes, strict=True) if staked]
    differences = Differences(result, truth, found.partners)
    off = differences.positions()
    return FileScore(
        "trees",
        (DetectionCounts("trees", _NAME, found.counts),),
        errors=(
            _dbh(result, truth, free, "dbh", (f"{_DBH[0]}, no stakes", f"{_DBH[1]}（支木なし）")),
            _dbh(
                result,
                truth,
                staked,
                "dbh_with_stakes",
                (f"{_DBH[0]}, with stakes", f"{_DBH[1]}（支木あり）"),
            ),
            errors_of(
                "place", ("foot in plan", "根元の水平位置"), "m", np.hypot(off[:, 0], off[:, 1])
            ),
            errors_of("foot_height", ("height of the foot", "根元の標高"), "m", off[:, 2]),
            differences.of("height_m", ("height of the tree", "樹高")),
            differences.of("crown_m", ("width of the crown", "枝張り")),
        ),
        left_out={**found.left_out, "trunk_arc_too_short": found.counts.hits - len(measured)},
        limits={
            "within_m": WITHIN_M,
            "least_trunk_points": LEAST_TRUNK_POINTS,
            "least_arc_deg": LEAST_ARC_DEG,
        },
    )


def _dbh(
    result: MappedFile,
    truth: MappedFile,
    partners: list[ObjectMatch],
    id_: str,
    name: tuple[str, str],
) -> ErrorStatistics:
    off = [_dbh_m(result, one.result) - _dbh_m(truth, one.truth) for one in partners]
    return errors_of(id_, name, "m", off)


def _dbh_m(file: MappedFile, tree: MappedFeature) -> float:
    """Diameter at breast height, from the girth where only that is given; NaN without both."""
    dbh_m = file.number(tree, "dbh_m")
    return file.number(tree, "girth_m") / math.pi if math.isnan(dbh_m) else dbh_m
