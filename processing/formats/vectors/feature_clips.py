"""Features as a text for the clipboard, and back: GeoJSON with what GeoJSON lacks beside it.

Other programs read the text as the map it is; from theirs we take shapes and values.
"""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from processing.core.errors import UNCHANGED, MissingInput, OutOfRange
from processing.core.text import Text
from processing.formats.vectors.clip_kinds import (
    KindDescription,
    KindTally,
    describe_kinds,
    read_descriptions,
)
from processing.formats.vectors.clip_members import OURS, clip_member, features_of
from processing.formats.vectors.geojson_shapes import (
    MOST_CHARACTERS,
    WHERE,
    GeoJsonGeometry,
    JsonObject,
    crs_member,
    read_collection,
    refusal,
    shapes_of,
    system_of,
)
from processing.map.catalogue import Catalogue, Geometry
from processing.map.feature import Feature, Vertex
from processing.map.reference_transform import reference_transform

_VERSION = 1


@dataclass(frozen=True)
class PastedFeatures:
    """What a text gives a map.

    Attributes
    ----------
    features : tuple of Feature
        With new ids, in the project's reference system, in the order of the text.
    notes : tuple of Text
        What is to be said of them: transformed, another kind, heights that were missing.
    """

    features: tuple[Feature, ...]
    notes: tuple[Text, ...]


def clip_of(features: Sequence[Feature], crs: str, catalogue: Catalogue) -> str:
    """Features as text: GeoJSON in the project's reference system.

    Parameters
    ----------
    crs : str
        ``EPSG:n`` of their coordinates; empty where it is not known.
    catalogue : Catalogue
        Of their project; says what their kinds are.

    Raises
    ------
    OutOfRange
        They are too many for a clipboard.
    """
    text = json.dumps(
        {
            "type": "FeatureCollection",
            "crs": crs_member(crs),
            OURS: {"version": _VERSION, "kinds": describe_kinds(features, catalogue)},
            "features": [clip_member(feature) for feature in features],
        },
        ensure_ascii=False,
        allow_nan=False,
    )
    if len(text) > MOST_CHARACTERS:
        raise OutOfRange(
            Text(
                "The features are too many to copy at once.",
                "一度にコピーできる量を超えています。",
            ),
            Text(f"{len(features):,} features", f"{len(features):,}個の地物"),
            Text("Copy them in several parts.", "何回かに分けてコピーしてください。"),
        )
    return text


def features_of_clip(
    text: str,
    crs: str,
    catalogue: Catalogue,
    drives: Collection[str],
    *,
    kind_for: Mapping[Geometry, str] | None = None,
) -> PastedFeatures:
    """The features in a text of :func:`clip_of`, or in GeoJSON of another program.

    Parameters
    ----------
    crs : str
        ``EPSG:n`` of the project they come into; empty where it is not known.
    catalogue : Catalogue
        Of that project. A kind that it lacks is replaced by one of the same DM code and geometry;
        where there is none, it stays as it is.
    drives : collection of str
        Ids of that project's drives: vertices keep the measured points of these, as long as
        places are not transformed.
    kind_for : mapping of Geometry to str, optional
        What shapes of another program become, of that catalogue.

    Returns
    -------
    Pasted
        Every shape and value of the text; what had to be altered is in the notes.

    Raises
    ------
    BadFile
        There are no features in the text, or it is damaged; names the feature.
    MissingInput
        Only one of the two reference systems is known.
    Unsuitable
        No transformation between them is exact enough; no kind is given for a shape.
    OutOfRange
        There is no such reference system, or it can't express a place.
    """
    whole, members = read_collection(text)
    described = _read_descriptions(whole)
    shapes = [tuple(shapes_of(one.get("geometry"), at)) for at, one in enumerate(members, 1)]
    source = system_of(whole, [shape for several in shapes for shape in several])
    tally = KindTally(catalogue, described, kind_for or {})
    copies = [
        replace(feature, kind=tally.kind_of(feature.kind, feature.geometry))
        for at, (member, several) in enumerate(zip(members, shapes, strict=True), 1)
        for feature in features_of(member, several, at)
    ]
    moved, notes = _transform_features(copies, source, crs)
    grounded = [_detach_feature(one, drives if source == crs else ()) for one in moved]
    return PastedFeatures(
        tuple(grounded),
        (
            *notes,
            *_notes_of_points(copies, grounded),
            *_notes_of_shapes(shapes),
            *tally.notes(),
        ),
    )


def _read_descriptions(whole: JsonObject) -> dict[str, KindDescription]:
    """The kinds that a text of ours describes."""
    own = whole.get(OURS)
    if own is None:
        return {}
    version = own.get("version") if isinstance(own, dict) else None
    if not isinstance(version, int) or version < 1:
        raise refusal(Text("The text is damaged: version.", "テキストが壊れています（version）。"))
    if version > _VERSION:
        raise refusal(
            Text(
                "The features were copied in a newer version of Zuka.",
                "新しい版のZukaでコピーされた地物です。",
            )
        )
    return read_descriptions(own.get("kinds"))


def _transform_features(
    features: list[Feature], source: str, target: str
) -> tuple[list[Feature], tuple[Text, ...]]:
    """The features in the target's reference system, and what is to be said of it."""
    if source == target or not features:
        unknown = Text(
            "No reference system is known; coordinates were taken as they are.",
            "座標参照系が不明なため、座標をそのまま使いました。",
        )
        return features, () if target or not features else (unknown,)
    if not source or not target:
        raise _one_unknown(source, target)
    transform = reference_transform(source, target)
    positions = np.array([vertex.xyz for one in features for vertex in one.vertices])
    # Each feature takes from the rows as many as it has vertices.
    rows = iter(transform.apply(positions).tolist())
    moved = [
        one.with_vertices(
            tuple(
                Vertex((x, y, height), vertex.measured, is_occluded=vertex.is_occluded)
                for vertex, (x, y, height) in zip(one.vertices, rows, strict=False)
            )
        )
        for one in features
    ]
    return moved, (transform.note,)


def _one_unknown(source: str, target: str) -> MissingInput:
    known = source or target
    if target:
        what = Text(
            "The reference system of what was copied is not known.",
            "コピー元の座標参照系が不明です。",
        )
    else:
        what = Text(
            "The reference system of this project is not known.",
            "このプロジェクトの座標参照系が不明です。",
        )
    return MissingInput(
        what,
        Text("{where}; the other is {known}", "{where}（もう一方は {known}）").filled(
            where=WHERE, known=known
        ),
        Text(
            "Set the reference system where it is missing, then copy and paste again. {unchanged}",
            "座標参照系を設定してから、もう一度コピーして貼り付けてください。{unchanged}",
        ).filled(unchanged=UNCHANGED),
    )


def _detach_feature(feature: Feature, drives: Collection[str]) -> Feature:
    """The feature without measured points, and a run, that its new project does not have."""
    vertices = tuple(
        vertex
        if vertex.measured is None or vertex.measured.drive in drives
        else Vertex(vertex.xyz, is_occluded=vertex.is_occluded)
        for vertex in feature.vertices
    )
    is_at_home = any(vertex.measured is not None for vertex in vertices)
    provenance = feature.provenance if is_at_home else replace(feature.provenance, run="")
    return replace(feature, vertices=vertices, provenance=provenance)


def _notes_of_points(before: list[Feature], after: list[Feature]) -> tuple[Text, ...]:
    lost = sum(map(_measured_count, before)) - sum(map(_measured_count, after))
    if not lost:
        return ()
    return (
        Text(
            "{count} vertices rest on measured points of drives that this project does not have; "
            "they keep their place only.",
            "頂点{count}個は、このプロジェクトにない走行データの計測点に基づいています。"
            "座標だけを引き継ぎました。",
        ).filled(count=f"{lost:,}"),
    )


def _measured_count(feature: Feature) -> int:
    return sum(vertex.measured is not None for vertex in feature.vertices)


def _notes_of_shapes(shapes: list[tuple[GeoJsonGeometry, ...]]) -> tuple[Text, ...]:
    every = [shape for several in shapes for shape in several]
    counted = (
        (
            sum(shape.heightless for shape in every),
            Text(
                "{count} vertices came without a height and lie at 0 m.",
                "頂点{count}個に標高がないため、0 m としました。",
            ),
        ),
        (
            sum(shape.is_hole for shape in every),
            Text(
                "{count} holes of areas became areas of their own.",
                "面の穴{count}個を独立した面にしました。",
            ),
        ),
        (
            sum(not several for several in shapes),
            Text(
                "{count} features without a place were left out.",
                "位置のない地物{count}個を除きました。",
            ),
        ),
        (
            0 if every else 1,
            Text("There was no feature to paste.", "貼り付ける地物がありませんでした。"),
        ),
    )
    return tuple(note.filled(count=f"{count:,}") for count, note in counted if count)
