"""Poles against a truth: which were found, and their type, height and diameter."""

from __future__ import annotations

import numpy as np

from processing.core.text import Text
from processing.scoring.features.file_scores import (
    DetectionCounts,
    FileScore,
    errors_of,
    named_share,
)
from processing.scoring.features.mapped_features import MappedFeature, MappedFile
from processing.scoring.features.object_matches import (
    Differences,
    is_in_span,
    match_objects,
    shows_enough,
)

POLES: dict[str, dict[str, object]] = {
    "pole": {},
    "wired_pole": {},
    "phone_pole": {},
    "power_pole": {},
    "street_light": {"type": "street_light"},
    "security_light": {},
    "mirror": {"type": "mirror_pole"},
}
"""Kinds of features that are poles, with the type that a kind implies."""

TYPES = (
    "utility_pole",
    "street_light",
    "signal_pole",
    "sign_pole",
    "mirror_pole",
    "arm_pole",
    "bollard",
    "delineator",
    "other",
)
"""What a pole may be; whatever else a truth knows (banners, posts of bus stops) is another pole."""

WITHIN_M = 0.5
"""Twice the thickness of a utility pole: nearer poles are one thing and its stay."""

LEAST_POINTS = 20
"""Fewer are a few scan lines of anything."""

_NAME = Text("poles", "柱状物")


def known_type(pole: MappedFeature) -> object:
    """The type of a true pole as results tell it."""
    kind = pole.facts.get("type")
    return kind if kind in TYPES else "other"


def pole_score(result: MappedFile, truth: MappedFile) -> FileScore:
    """Score poles.

    Raises
    ------
    BadFile
        Features aren't poles, or a measure is no number.
    """
    true = truth.of_kinds(POLES, "point", _NAME)
    asked = [is_in_span(one) and shows_enough(truth, one, "points", LEAST_POINTS) for one in true]
    found = match_objects(result.of_kinds(POLES, "point", _NAME), true, asked, WITHIN_M)
    typed = [one for one in found.partners if one.truth.facts.get("type") is not None]
    right = [one for one in typed if one.result.facts.get("type") == known_type(one.truth)]
    differences = Differences(result, truth, found.partners)
    off = differences.positions()
    return FileScore(
        "poles",
        (DetectionCounts("poles", _NAME, found.counts),),
        (
            named_share(
                "type", ("found with the right type", "種類も正しい柱状物"), len(right), len(typed)
            ),
        ),
        (
            errors_of(
                "place", ("foot in plan", "根元の水平位置"), "m", np.hypot(off[:, 0], off[:, 1])
            ),
            errors_of("foot_height", ("height of the foot", "根元の標高"), "m", off[:, 2]),
            differences.of("height_m", ("height of the pole", "高さ")),
            differences.of("diameter_m", ("diameter", "直径")),
        ),
        left_out=found.left_out,
        limits={"within_m": WITHIN_M, "least_points": LEAST_POINTS},
    )
