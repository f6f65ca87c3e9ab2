"""Maps that were delivered before, as features of a project: what each thing on them is."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from processing.core.arrays import Floats
from processing.core.errors import OutOfRange, Unsuitable, use_one_of
from processing.core.text import Text
from processing.formats.vectors.map_place import check_place
from processing.map.catalogue import RESERVED_ATTRIBUTES, Catalogue, FeatureKind, Geometry
from processing.map.feature import AttributeValue, Feature, Provenance, Status, Vertex
from processing.map.feature import new_feature_id as new_id
from processing.map.map_extent import Bounds
from processing.map.reference_transform import reference_transform
from processing.scoring.features.mapped_features import MappedFeature, MappedFile

_CANDIDATE_SUFFIX = "_候補"
_CODE = re.compile(r"\d{4}")
_OWN_ID = re.compile(r"[0-9a-f]{32}")
_PASSED = RESERVED_ATTRIBUTES | {"layer", "dm_code"}
_MOST_NAMED = 6


@dataclass(frozen=True)
class ReadMap:
    """A delivered map as features.

    Attributes
    ----------
    notes : tuple of Text
        What was left out or filled in.
    """

    features: tuple[Feature, ...]
    notes: tuple[Text, ...]


def features_of_map(
    mapped: MappedFile,
    catalogue: Catalogue,
    *,
    crs: str,
    known: frozenset[str],
    kind: str = "",
    around: Bounds | None = None,
) -> ReadMap:
    """The features of a map, each of the kind that it says or that its layer or code stands for.

    Kinds are found by their id, by the whole name of a layer, by the class code that a layer's
    name begins with, in this order, and only in the shape that the catalogue draws them in.

    Parameters
    ----------
    mapped : MappedFile
        In the system that it names.
    crs : str
        Of the project: places are brought into it.
    known : frozenset of str
        Ids that the project has: what comes back to it is not added twice.
    kind : str
        Of what has no other; empty: such things are left out.
    around : Bounds or None
        Where the project is; None where that isn't known.

    Raises
    ------
    OutOfRange
        There is no such kind.
    Unsuitable
        The systems can't be brought together; the map lies elsewhere; nothing on it is of a kind.
    """
    fallback = _kind_named(kind, catalogue)
    places, notes = _places_in(mapped, crs)
    check_place(mapped, places, crs, around)
    features: list[Feature] = []
    unknown: Counter[str] = Counter()
    again = heightless = 0
    taken = set(known)
    for one, xyz in zip(mapped.features, places, strict=True):
        found = _kind_of(one, catalogue) or fallback
        if found is None or found.geometry.value != one.shape:
            unknown[_called(one)] += 1
            continue
        own = str(one.facts.get("id", ""))
        if own in known:
            again += 1
            continue
        id_ = own if _OWN_ID.fullmatch(own) and own not in taken else new_id()
        taken.add(id_)
        heightless += bool(np.isnan(xyz[:, 2]).any())
        features.append(_feature(id_, found, one, xyz, mapped))
    if not features and not again:
        raise _nothing(mapped, unknown)
    return ReadMap(tuple(features), notes + _notes(unknown, again, heightless))


def _kind_named(kind: str, catalogue: Catalogue) -> FeatureKind | None:
    if kind and kind not in catalogue:
        raise OutOfRange(
            Text("The catalogue has no such kind.", "カタログにない種別です。"),
            Text.same(kind),
            use_one_of(one.id for one in catalogue),
        )
    return catalogue[kind] if kind else None


def _places_in(mapped: MappedFile, crs: str) -> tuple[list[Floats], tuple[Text, ...]]:
    """The places of each feature in a system, and what was done to them."""
    if mapped.crs == crs:
        return [one.xyz for one in mapped.features], ()
    transform = reference_transform(mapped.crs, crs)
    moved = []
    for one in mapped.features:
        flat = np.where(np.isnan(one.xyz), 0.0, one.xyz)
        xyz = transform.apply(flat)
        xyz[np.isnan(one.xyz)] = np.nan
        moved.append(xyz)
    return moved, (transform.note,)


def _kind_of(one: MappedFeature, catalogue: Catalogue) -> FeatureKind | None:
    own = str(one.facts.get("kind", ""))
    if own in catalogue and catalogue[own].geometry.value == one.shape:
        return catalogue[own]
    layer = str(one.facts.get("layer", "")).removesuffix(_CANDIDATE_SUFFIX)
    fitting = [kind for kind in catalogue if kind.geometry.value == one.shape]
    begins = _CODE.match(layer)
    code = str(one.facts.get("dm_code") or (begins[0] if begins else ""))
    by_layer = (kind for kind in fitting if layer and layer in (kind.layer, kind.id))
    by_code = (kind for kind in fitting if code and kind.dm_code == code)
    return next(by_layer, None) or next(by_code, None)


def _called(one: MappedFeature) -> str:
    """What a map calls a thing: its layer, kind or code."""
    words = (one.facts.get(name) for name in ("layer", "kind", "dm_code"))
    return next((str(word) for word in words if word), "–")


def _feature(
    id_: str,
    kind: FeatureKind,
    one: MappedFeature,
    xyz: Floats,
    mapped: MappedFile,
) -> Feature:
    vertices = tuple(
        Vertex((x, y, 0.0 if np.isnan(z) else z), is_occluded=bool(np.isnan(z)))
        for x, y, z in xyz.tolist()
    )
    is_candidate = one.facts.get("status") == Status.CANDIDATE.value or str(
        one.facts.get("layer", "")
    ).endswith(_CANDIDATE_SUFFIX)
    status = Status.CANDIDATE if is_candidate else Status.ACCEPTED
    provenance = Provenance(parameters={"map": mapped.path.name})
    attributes = _attributes(one.facts)
    return Feature(id_, kind.id, Geometry(one.shape), vertices, attributes, status, provenance)


def _attributes(facts: Mapping[str, object]) -> dict[str, AttributeValue]:
    return {
        name: value if isinstance(value, (str, float, int, bool)) else str(value)
        for name, value in facts.items()
        if name not in _PASSED and value is not None and value != ""
    }


def _notes(unknown: Counter[str], again: int, heightless: int) -> tuple[Text, ...]:
    notes = []
    if unknown:
        notes.append(
            Text(
                "Left out, because the catalogue has no kind for it: {what}.",
                "カタログに該当する種別がないため、次は取り込まれていません: {what}",
            ).filled(what=_listed(unknown))
        )
    if again:
        notes.append(
            Text(
                "{count} features are in the project already and were not added again.",
                "{count}個の地物はすでにプロジェクトにあるため、追加していません。",
            ).filled(count=f"{again:,}")
        )
    if heightless:
        notes.append(
            Text(
                "{count} features have no heights in the file: they lie at height 0, marked as"
                " unmeasured.",
                "{count}個の地物はファイルに標高がないため、標高0（計測点なし）としました。",
            ).filled(count=f"{heightless:,}")
        )
    return tuple(notes)


def _listed(unknown: Counter[str]) -> str:
    named = [f"{name} ({count:,})" for name, count in unknown.most_common(_MOST_NAMED)]
    return ", ".join([*named, "…"] if len(unknown) > _MOST_NAMED else named)


def _nothing(mapped: MappedFile, unknown: Counter[str]) -> Unsuitable:
    return Unsuitable(
        Text(
            "Nothing on the map is of a kind that the catalogue has in this shape.",
            "カタログの種別（形状を含む）に該当するものが、図面にありません。",
        ),
        Text.same(f"{mapped.path}: {_listed(unknown) or '–'}"),
        Text(
            "Give a kind for things without one (--kind), or add layers to the catalogue; nothing"
            " was changed.",
            "種別のない地物の種別（--kind）を指定するか、カタログに画層を追加してください。"
            "何も変更されていません。",
        ),
    )
