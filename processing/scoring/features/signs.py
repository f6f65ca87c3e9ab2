"""Road signs against a truth: found, at the right place, of the right shape, of the right size.

The thesis counts successes by what was given beforehand (Takahashi 2022, 8.4); here they are
told by what is right, so that either question can be answered. Supplementary plates hang below
signs and are judged apart.
"""

from __future__ import annotations

import numpy as np

from processing.core.arrays import Floats
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
    ObjectMatch,
    is_in_span,
    match_objects,
    shows_enough,
)
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix
from processing.scoring.points.point_scores import NamedShare

SIGNS: dict[str, dict[str, object]] = {
    "sign": {},
    "sign_guide": {},
    "sign_warning": {},
    "sign_regulation": {},
}
"""Kinds of features that are signs."""

SHAPES = ("circle", "triangle", "square", "diamond", "pentagon", "rectangle")

WITHIN_M = 1.0
"""Plates on one post are some 0.6 m apart: a metre finds the partner and not the next post."""

POSITION_M = 0.15
"""A plate is in its place so near: half the size of the smallest standard one is 0.2 m."""

SIZE_SHARE = 0.10
"""Standard sizes differ by a third and more; a tenth tells them apart."""

LEAST_FRONT_POINTS = 10
"""Points on the bright face; a back is dull and hides which sign it is."""

_NAME = Text("signs", "標識")
_ABOVE = 1e-9


def sign_score(result: MappedFile, truth: MappedFile) -> FileScore:
    """Score signs.

    Raises
    ------
    BadFile
        Features aren't signs, or a shape or a measure isn't what it should be.
    """
    true = truth.of_kinds(SIGNS, "point", _NAME)
    for one in true:
        truth.word(one, "shape", SHAPES)
    found = match_objects(
        result.of_kinds(SIGNS, "point", _NAME),
        true,
        [_is_seen(truth, one) for one in true],
        WITHIN_M,
        in_space=True,
    )
    main = [one for one in found.partners if not _is_supplementary(one.truth)]
    differences = Differences(result, truth, tuple(main))
    wanted = [one for one in true if _is_seen(truth, one)]
    signs = sum(not _is_supplementary(one) for one in wanted)
    plates = len(wanted) - signs
    false_plates = sum(map(_is_supplementary, found.alone))
    false_signs = len(found.alone) - false_plates
    off = _off_centre(truth, main)
    return FileScore(
        "signs",
        (
            DetectionCounts(
                "signs", _NAME, BinaryConfusionMatrix(len(main), false_signs, signs - len(main), 0)
            ),
            DetectionCounts(
                "supplementary",
                Text("supplementary plates", "補助標識"),
                BinaryConfusionMatrix(
                    found.counts.hits - len(main),
                    false_plates,
                    plates - found.counts.hits + len(main),
                    0,
                ),
            ),
        ),
        _successes(result, truth, main, off, signs),
        (
            errors_of("place", ("plate's centre", "板の中心位置"), "m", off),
            differences.of("size_m", ("size", "寸法")),
            errors_of(
                "facing_deg", ("facing", "板面の向き"), "°", _measure_turns(result, truth, main)
            ),
            differences.of("height_m", ("height above ground", "地上高")),
        ),
        left_out=found.left_out,
        limits={
            "within_m": WITHIN_M,
            "place_m": POSITION_M,
            "size_share": SIZE_SHARE,
            "least_front_points": LEAST_FRONT_POINTS,
        },
    )


def _successes(
    result: MappedFile, truth: MappedFile, signs: list[ObjectMatch], off: Floats, of: int
) -> tuple[NamedShare, ...]:
    """Of all signs that were asked for, those with this and that right."""
    is_placed = off <= POSITION_M
    has_shape = np.array(
        [one.result.facts.get("shape") == one.truth.facts["shape"] for one in signs], np.bool_
    )
    sizes = [
        (result.number(one.result, "size_m"), truth.number(one.truth, "size_m")) for one in signs
    ]
    # A truth without a size asks for none.
    has_size = np.array(
        [np.isnan(true) or abs(found / true - 1) <= SIZE_SHARE + _ABOVE for found, true in sizes],
        np.bool_,
    )
    asked = (
        ("place", ("place right", "位置が正しい"), is_placed),
        ("place_shape", ("place and shape right", "位置・形が正しい"), is_placed & has_shape),
        (
            "place_shape_size",
            ("place, shape and size right", "位置・形・寸法が正しい"),
            is_placed & has_shape & has_size,
        ),
        ("shape", ("found, shape right", "検出・形が正しい"), has_shape),
        (
            "shape_size",
            ("found, shape and size right", "検出・形・寸法が正しい"),
            has_shape & has_size,
        ),
    )
    return tuple(named_share(id_, name, int(right.sum()), of) for id_, name, right in asked)


def _is_seen(truth: MappedFile, sign: MappedFeature) -> bool:
    has_front = sign.facts.get("front_points") is not None
    name = "front_points" if has_front else "points"
    return is_in_span(sign) and shows_enough(truth, sign, name, LEAST_FRONT_POINTS)


def _is_supplementary(sign: MappedFeature) -> bool:
    return sign.facts.get("supplementary") in (True,)  # 1 in a GeoPackage


def _off_centre(truth: MappedFile, signs: list[ObjectMatch]) -> Floats:
    """(n,) distances of centres, in plan where a side has no height.

    A truth may also know the middle of the plate's outline: who gives that isn't wrong either.
    """
    off = np.empty(len(signs))
    for number, one in enumerate(signs):
        position, centres = one.result.xyz[0], [one.truth.xyz[0]]
        middle = one.truth.facts.get("bbox_centre")
        if middle is not None:
            if not _is_position(middle):
                raise truth.wrong(one.truth, "bbox_centre", Text("a place", "座標"))
            centres.append(np.array(middle, dtype=np.float64))
        away = np.nan_to_num(position - np.array(centres))
        off[number] = np.linalg.norm(away, axis=1).min()
    return off


def _is_position(value: object) -> bool:
    return (
        isinstance(value, list)
        and len(value) == len("xyz")
        and all(isinstance(one, (int, float)) for one in value)
    )


def _measure_turns(result: MappedFile, truth: MappedFile, signs: list[ObjectMatch]) -> list[float]:
    """By how many degrees plates face another way, -180 to 180, clockwise."""
    return [
        (result.number(one.result, "facing_deg") - truth.number(one.truth, "facing_deg") + 180)
        % 360
        - 180
        for one in signs
    ]
