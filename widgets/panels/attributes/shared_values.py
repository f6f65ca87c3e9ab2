"""What several features have in common: fields of their kinds, and values."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TypeVar

from processing.map.catalogue import AttributeField, Catalogue
from processing.map.feature import Feature
from widgets.panels.attributes.attribute_field import SEVERAL, MixedValue

SharedT = TypeVar("SharedT")


def common_fields(features: Iterable[Feature], catalogue: Catalogue) -> tuple[AttributeField, ...]:
    """The attributes that the kinds of all features know, in the order of the first kind.

    Attributes of the same id but of another type, unit or list of choices are not the same.
    """
    kinds = list(dict.fromkeys(feature.kind for feature in features))
    if not kinds or any(kind not in catalogue for kind in kinds):
        return ()
    first, *others = (catalogue[kind].attributes for kind in kinds)
    return tuple(
        field
        for field in first
        if all(any(_are_same(field, other) for other in fields) for fields in others)
    )


def common_value(
    features: Iterable[Feature], value_of: Callable[[Feature], SharedT]
) -> SharedT | MixedValue | None:
    """The value that all features have; ``SEVERAL`` where they differ, None for no features."""
    values = map(value_of, features)
    first = next(values, None)
    return first if all(value == first for value in values) else SEVERAL


def _are_same(one: AttributeField, other: AttributeField) -> bool:
    return (one.id, one.type, one.unit, one.choices) == (
        other.id,
        other.type,
        other.unit,
        other.choices,
    )
