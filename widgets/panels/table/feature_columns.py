"""The columns of the feature table: what each says of a feature, and by what it is sorted."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache, partial
from typing import Any

from PySide6.QtCore import QLocale

from processing.core.text import Language, Text
from processing.map.catalogue import AttributeField, Catalogue, FeatureKind, Geometry
from processing.map.feature import AttributeValue, Feature, Status
from processing.map.feature_query import natural_key
from widgets.panels.feature_words import (
    HAND,
    name_of_kind,
    name_of_origin,
    name_of_status,
    words_of_value,
)
from widgets.panels.geometry_facts import area_m2, length_m

SortKey = tuple[Any, ...]
"""Numbers and texts by turns; the keys of one column can be compared with each other."""

KIND = "kind"
_LENGTH, _AREA = "length", "area"
_ORDER_OF_STATUS = {Status.CANDIDATE: 0, Status.ACCEPTED: 1, Status.REJECTED: 2}
_ATTRIBUTE = "attribute:"


@dataclass(frozen=True)
class FeatureColumn:
    """One column.

    Attributes
    ----------
    id : str
        Stays the same when other columns come and go.
    title : str
        With the unit, as it stands in the header.
    tip : str
        What it means, in a sentence or less.
    text : callable
        What a cell shows; empty where there is nothing to say.
    key : callable
        By what a feature is sorted; None comes last in either direction.
    is_number : bool
        Stands at the right.
    """

    id: str
    title: str
    tip: str
    text: Callable[[Feature], str]
    key: Callable[[Feature], SortKey | None]
    is_number: bool = False


class FeatureColumns:
    """Makes columns for one catalogue in one language.

    Parameters
    ----------
    catalogue : Catalogue
    language : Language
    """

    def __init__(self, catalogue: Catalogue, language: Language) -> None:
        self._catalogue = catalogue
        self._language = language
        self._locale = QLocale(language)
        # A map has a hundred kinds and a handful of tools, but a hundred thousand features.
        self._name_of_kind = lru_cache(partial(name_of_kind, catalogue, language=language))
        self._key_of_name = lru_cache(natural_key)

    def of_all(self) -> tuple[FeatureColumn, ...]:
        """The columns that every feature fills."""
        return (
            self._words(
                KIND,
                Text("Kind", "種別"),
                Text("What it is", "地物の種別"),
                lambda one: self._name_of_kind(one.kind),
            ),
            self._status(),
            self._words(
                "layer",
                Text("Layer", "レイヤ"),
                Text("Layer of the DXF", "DXFのレイヤ"),
                self._layer,
            ),
            *self._numbers(),
            self._words(
                "origin",
                Text("Origin", "作成元"),
                Text(
                    "Drawn by hand, or the tool that found it", "手作業、または抽出した処理ツール"
                ),
                lambda one: name_of_origin(one, self._language),
            ),
        )

    def of_kind(self, kind: FeatureKind) -> tuple[FeatureColumn, ...]:
        """The columns of one kind: those that fit its geometry, then its attributes."""
        foreign = {Geometry.POINT: (_LENGTH, _AREA), Geometry.LINE: (_AREA,)}
        without = foreign.get(kind.geometry, (_LENGTH,))
        return (
            *(column for column in self.of_all() if column.id not in without),
            *(self._attribute(field) for field in kind.attributes),
        )

    def _numbers(self) -> tuple[FeatureColumn, ...]:
        return (
            self._number(
                _LENGTH,
                Text("Length (m)", "延長 (m)"),
                Text("Length of a line along its slope", "線の延長（斜距離）"),
                _length_of,
                3,
            ),
            self._number(
                _AREA,
                Text("Area (m²)", "面積 (m²)"),
                Text("Area seen from above", "水平面積"),
                _area_of,
                3,
            ),
            self._number(
                "vertices",
                Text("Vertices", "頂点数"),
                Text("Number of vertices", "頂点の数"),
                lambda one: len(one.vertices),
                0,
            ),
            self._number(
                "occluded",
                Text("Occluded", "遮蔽点数"),
                Text(
                    "Vertices without a measured point: their height comes from neighbours",
                    "計測点のない頂点の数。高さは周囲から補ったものです",
                ),
                lambda one: occluded_count(one) or None,
                0,
            ),
            self._number(
                "confidence",
                Text("Confidence (%)", "信頼度 (%)"),
                Text("How sure the tool was", "処理ツールの確からしさ"),
                _confidence_percent,
                0,
            ),
        )

    def _words(
        self, id_: str, title: Text, tip: Text, text: Callable[[Feature], str]
    ) -> FeatureColumn:
        def key(feature: Feature) -> SortKey | None:
            words = text(feature)
            return self._key_of_name(words) if words else None

        language = self._language
        return FeatureColumn(id_, title.in_language(language), tip.in_language(language), text, key)

    def _status(self) -> FeatureColumn:
        language = self._language
        return FeatureColumn(
            "status",
            Text("Status", "状態").in_language(language),
            Text("Whether a person has agreed to it", "人による判定の状態").in_language(language),
            lambda one: name_of_status(one, language),
            lambda one: (_ORDER_OF_STATUS[one.status],),
        )

    def _number(
        self,
        id_: str,
        title: Text,
        tip: Text,
        value: Callable[[Feature], float | None],
        decimals: int,
    ) -> FeatureColumn:
        def text(feature: Feature) -> str:
            number = value(feature)
            return "" if number is None else self._locale.toString(float(number), "f", decimals)

        def key(feature: Feature) -> SortKey | None:
            number = value(feature)
            return None if number is None or not math.isfinite(number) else (number,)

        language = self._language
        return FeatureColumn(
            id_, title.in_language(language), tip.in_language(language), text, key, is_number=True
        )

    def _attribute(self, field: AttributeField) -> FeatureColumn:
        language = self._language
        name = field.name.in_language(language)

        def text(feature: Feature) -> str:
            return words_of_value(feature.attributes.get(field.id), field, language)

        def key(feature: Feature) -> SortKey | None:
            return _key_of_value(feature.attributes.get(field.id), text(feature))

        return FeatureColumn(
            f"{_ATTRIBUTE}{field.id}",
            f"{name} ({field.unit})" if field.unit else name,
            name,
            text,
            key,
            is_number=field.type in ("number", "count"),
        )

    def _layer(self, feature: Feature) -> str:
        catalogue = self._catalogue
        return catalogue[feature.kind].layer if feature.kind in catalogue else ""


def occluded_count(feature: Feature) -> int:
    """How many of a feature's vertices have no measured point."""
    return sum(vertex.is_occluded for vertex in feature.vertices)


def _length_of(feature: Feature) -> float | None:
    return length_m(feature) if feature.geometry is Geometry.LINE else None


def _area_of(feature: Feature) -> float | None:
    return area_m2(feature) if feature.geometry is Geometry.AREA else None


def _confidence_percent(feature: Feature) -> float | None:
    # A person is always sure: a column full of 100 would hide the tools' numbers.
    provenance = feature.provenance
    is_known = provenance.tool != HAND and math.isfinite(provenance.confidence)
    return provenance.confidence * 100 if is_known else None


def _key_of_value(value: AttributeValue, text: str) -> SortKey | None:
    """Numbers before texts, whatever the field's type: a value may be of the wrong one."""
    if isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value):
        return (0, value)
    return (1, natural_key(text)) if text else None
