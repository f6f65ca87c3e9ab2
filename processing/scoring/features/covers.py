"""Covers against a truth, one to one: round ones by place and diameter, square ones by two sides.

A place is right within 20 cm, and how far it is off is told apart, as sizes are: whoever draws a
cover by hand sees at once what was meant.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

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
    ObjectMatch,
    is_in_span,
    match_objects,
    shows_enough,
)

ROUND_KINDS = tuple(
    f"manhole{one}" for one in ("", "_duct", "_gas", "_phone", "_power", "_sewer", "_water")
)
COVERS: Mapping[str, Mapping[str, object]] = {
    **{one: {"shape": "round"} for one in (*ROUND_KINDS, "valve_cover")},
    **{f"{one}_area": {"shape": "square"} for one in ROUND_KINDS},
    "rain_inlet": {"shape": "square"},
    "gutter_grating": {"shape": "square"},
}
"""Kinds of features that are covers, with the shape that a kind implies."""

WITHIN_M = 0.2
"""Covers lie farther apart; a valve has half this size."""

NEAR_M, ALIKE_M = 0.05, 0.05
"""How near a place and a size are that are told to be exact."""

LEAST_POINTS, LEAST_PER_M2, LEAST_COVERED = 50, 400.0, 0.7
"""Of what is asked for: a point every 5 cm, which is what places and sizes are asked to, and most
of its pieces seen. Fewer leave its size to chance."""

_NAME = Text("covers", "蓋")


def cover_score(result: MappedFile, truth: MappedFile) -> FileScore:
    """Score covers.

    Raises
    ------
    BadFile
        Features aren't covers, or a measure is no number.
    """
    true = _covers(truth)
    asked = [_is_asked(truth, one) for one in true]
    found = match_objects(
        [_at_middle(one) for one in _covers(result)],
        [_at_middle(one) for one in true],
        asked,
        WITHIN_M,
    )
    pairs = found.partners
    alike = [one for one in pairs if _shape(one.result) == _shape(one.truth)]
    off = np.array([np.hypot(*(one.result.xyz - one.truth.xyz)[0, :2]) for one in pairs])
    sizes = [_sizes_off(result, truth, one) for one in alike]
    exact = sum(bool(one <= NEAR_M) for one in off)
    sized = sum(bool(np.nanmax(np.abs(one)) <= ALIKE_M) for one in sizes)
    rounds = [one[0] for one in sizes if len(one) == 1]
    sides = [value for one in sizes if len(one) > 1 for value in one]
    return FileScore(
        "covers",
        (DetectionCounts("covers", _NAME, found.counts),),
        (
            named_share(
                "shape", ("found with the right shape", "形も正しい蓋"), len(alike), len(pairs)
            ),
            named_share("near", ("placed within 5 cm", "位置が5 cm以内の蓋"), exact, len(pairs)),
            named_share("sized", ("sized within 5 cm", "寸法が5 cm以内の蓋"), sized, len(alike)),
        ),
        (
            errors_of("place", ("middle in plan", "中心の水平位置"), "m", off),
            errors_of("diameter", ("diameter", "直径"), "m", rounds),
            errors_of("sides", ("sides", "辺長"), "m", sides),
        ),
        left_out=found.left_out,
        limits={
            "within_m": WITHIN_M,
            "near_m": NEAR_M,
            "alike_m": ALIKE_M,
            "least_points": LEAST_POINTS,
            "least_points_per_m2": LEAST_PER_M2,
            "least_covered": LEAST_COVERED,
        },
    )


def _covers(file: MappedFile) -> list[MappedFeature]:
    """Covers of both geometries."""
    points = replace(file, features=tuple(one for one in file.features if one.shape == "point"))
    others = replace(file, features=tuple(one for one in file.features if one.shape != "point"))
    if not points.features:
        return others.of_kinds(COVERS, "area", _NAME)
    if not others.features:
        return points.of_kinds(COVERS, "point", _NAME)
    known = [one for one in file.features if one.facts.get("kind") in (None, *COVERS)]
    if not known:
        file.of_kinds(COVERS, "area", _NAME)
    kept = replace(file, features=tuple(known))
    areas = replace(kept, features=tuple(one for one in known if one.shape != "point"))
    points = replace(kept, features=tuple(one for one in known if one.shape == "point"))
    return [*points.of_kinds(COVERS, "point", _NAME), *areas.of_kinds(COVERS, "area", _NAME)]


def _is_asked(truth: MappedFile, cover: MappedFeature) -> bool:
    area = _area(truth, cover)
    least = max(LEAST_POINTS, LEAST_PER_M2 * area)
    return (
        is_in_span(cover)
        and cover.facts.get("is_asked") in (None, True)
        and shows_enough(truth, cover, "points", least)
        and shows_enough(truth, cover, "covered", LEAST_COVERED)
    )


def _area(file: MappedFile, cover: MappedFeature) -> float:
    """m²; 0 where the file doesn't tell."""
    if cover.shape == "point":
        diameter = file.number(cover, "diameter_m")
        return 0.0 if np.isnan(diameter) else float(np.pi * diameter**2 / 4)
    x, y = (cover.xyz[:, :2] - cover.xyz[0, :2]).T
    return float(abs(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2)


def _at_middle(cover: MappedFeature) -> MappedFeature:
    """The same at the middle of its corners; they stay in its facts."""
    facts = {**cover.facts, "corners": cover.xyz}
    return replace(cover, xyz=cover.xyz.mean(axis=0)[None], facts=facts)


def _shape(cover: MappedFeature) -> object:
    return cover.facts.get("shape")


def _sizes_off(result: MappedFile, truth: MappedFile, pair: ObjectMatch) -> Floats:
    """Found minus true diameter; or both sides, the shorter first."""
    if _shape(pair.truth) == "round":
        names: tuple[str, ...] = ("diameter_m",)
    else:
        names = ("width_m", "length_m")
    found, true = (
        np.sort([file.number(one, name) for name in names])
        for file, one in ((result, pair.result), (truth, pair.truth))
    )
    return np.asarray(found - true)
