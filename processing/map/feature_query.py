"""FeatureQuery: a rule by which features are found: words, kind, status, vertices, attributes.

The table's filter makes it; whoever selects by a rule asks it.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from enum import Enum

from processing.map.catalogue import AttributeField, Catalogue
from processing.map.feature import AttributeValue, Feature, Status

_DIGITS = re.compile(r"(\d+)")
_FEWEST_OF_ID = 4
_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")


class ValueComparison(Enum):
    """How an attribute's value is held against another."""

    EQUAL = "="
    NOT_EQUAL = "≠"
    LESS = "<"
    GREATER = ">"
    CONTAINS = "contains"
    EMPTY = "is empty"


@dataclass(frozen=True)
class AttributeCondition:
    """What an attribute must be.

    Attributes
    ----------
    attribute : str
        The attribute's id.
    comparison : ValueComparison
    value : str
        As it is typed, full-width digits and letters allowed; of a choice, the stored value or its
        name in either language. Nothing is read for ``EMPTY``.
    """

    attribute: str
    comparison: ValueComparison
    value: str = ""


@dataclass(frozen=True)
class FeatureQuery:
    """A rule; a feature must fit every part that says something.

    Attributes
    ----------
    text : str
        Words that must all be found, in any case: in the kind's names in both languages, its id or
        layer, in attribute values; or the feature's id begins with the word (of 4 letters at least,
        as any two digits are somewhere in most ids).
    kinds : frozenset of str
        Kinds of which the feature must have one; empty: any.
    statuses : frozenset of Status
        The same for its status.
    has_occluded : bool
        Whether only features with occluded vertices are found.
    conditions : tuple of AttributeCondition
        All must hold. A feature whose kind doesn't know the attribute, and that doesn't carry it
        either, fits none: a curb has no height that could be empty.
    """

    text: str = ""
    kinds: frozenset[str] = frozenset()
    statuses: frozenset[Status] = frozenset()
    has_occluded: bool = False
    conditions: tuple[AttributeCondition, ...] = ()

    @property
    def finds_everything(self) -> bool:
        """Whether it says nothing."""
        return not (
            self.text.strip() or self.kinds or self.statuses or self.has_occluded or self.conditions
        )

    def matches(self, feature: Feature, catalogue: Catalogue) -> bool:
        """Whether a feature is found; for many, ask one :class:`QueryTest`."""
        return bool(QueryTest(self, catalogue).found((feature,)))


class SearchTexts:
    """The words in which features' attributes are searched, kept until a feature changes."""

    def __init__(self, catalogue: Catalogue) -> None:
        self._catalogue = catalogue
        self._kept: dict[str, tuple[Feature, str]] = {}
        self._of_choices: dict[tuple[str, str], Mapping[str, str]] = {}

    def of(self, feature: Feature) -> str:
        """The feature's attribute values one below the other, folded."""
        if not feature.attributes:
            return ""
        kept = self._kept.get(feature.id)
        if kept is not None and kept[0] is feature:
            return kept[1]
        words = self._write_value(feature)
        self._kept[feature.id] = feature, words
        return words

    def forget(self, id_: str) -> None:
        """Keep nothing of a feature that is no more."""
        self._kept.pop(id_, None)

    def _write_value(self, feature: Feature) -> str:
        kind = feature.kind
        words = []
        for id_, value in feature.attributes.items():
            if isinstance(value, str):
                choices = self._of_choices.get((kind, id_))
                if choices is None:
                    choices = self._words_of_choices(kind, id_)
                words.append(choices.get(value, value))
            elif value is not None:
                words.append(str(value))
        return fold_text("\n".join(words))

    def _words_of_choices(self, kind: str, id_: str) -> Mapping[str, str]:
        field = _field_of(self._catalogue, kind, id_)
        names = {} if field is None else {one: _words_of(one, field) for one in field.choices}
        words = {value: "\n".join(written) for value, written in names.items()}
        self._of_choices[kind, id_] = words
        return words


class QueryTest:
    """A query made ready to be asked for many features.

    Parameters
    ----------
    query : FeatureQuery
    catalogue : Catalogue
        Where kinds and attributes are looked up; it may lack a feature's kind.
    texts : SearchTexts or None
        Kept from one test to the next, so that typing in a filter is quick.
    """

    def __init__(
        self, query: FeatureQuery, catalogue: Catalogue, texts: SearchTexts | None = None
    ) -> None:
        self._query = query
        self._catalogue = catalogue
        self._texts = SearchTexts(catalogue) if texts is None else texts
        self._words = tuple(fold_text(query.text).split())
        self._left_of_kind: dict[str, tuple[str, ...]] = {}
        self._conditions = tuple(_ReadyCondition(one, catalogue) for one in query.conditions)

    def found(self, features: Iterable[Feature]) -> list[Feature]:
        """The features that fit, in the order in which they come."""
        query = self._query
        left = list(features)
        if query.kinds:
            left = [one for one in left if one.kind in query.kinds]
        if query.statuses:
            left = [one for one in left if one.status in query.statuses]
        if self._words:
            left = [one for one in left if self._has_words(one)]
        for condition in self._conditions:
            left = [one for one in left if condition.holds(one)]
        if query.has_occluded:
            left = [one for one in left if any(vertex.is_occluded for vertex in one.vertices)]
        return left

    def _has_words(self, feature: Feature) -> bool:
        words = self._left_of_kind.get(feature.kind)
        if words is None:
            names = self._names_of(feature.kind)
            words = tuple(word for word in self._words if word not in names)
            self._left_of_kind[feature.kind] = words
        if not words:
            return True
        text = self._texts.of(feature)
        for word in words:
            if word not in text and not (
                len(word) >= _FEWEST_OF_ID and feature.id.startswith(word)
            ):
                return False
        return True

    def _names_of(self, kind_id: str) -> str:
        if kind_id not in self._catalogue:
            return fold_text(kind_id)
        kind = self._catalogue[kind_id]
        return fold_text("\n".join((kind.id, kind.name.en, kind.name.ja, kind.layer)))


class _ReadyCondition:
    """A condition whose value is read once."""

    def __init__(self, condition: AttributeCondition, catalogue: Catalogue) -> None:
        self._id = condition.attribute
        self._wanted = fold_text(condition.value).strip()
        self._number = number_in(condition.value)
        self._fields = {kind.id: kind.attribute(self._id) for kind in catalogue}
        self._fits: Callable[[AttributeValue, AttributeField | None], bool] = {
            ValueComparison.EQUAL: self._is_equal,
            ValueComparison.NOT_EQUAL: self._is_other,
            ValueComparison.LESS: self._is_less,
            ValueComparison.GREATER: self._is_greater,
            ValueComparison.CONTAINS: self._contains,
            ValueComparison.EMPTY: _is_empty,
        }[condition.comparison]

    def holds(self, feature: Feature) -> bool:
        field = self._fields.get(feature.kind)
        if field is None and self._id not in feature.attributes:
            return False
        return self._fits(feature.attributes.get(self._id), field)

    def _is_equal(self, value: AttributeValue, field: AttributeField | None) -> bool:
        if _is_empty(value, field):
            return False
        number = _number_of(value)
        if number is not None and self._number is not None:
            return number == self._number
        return any(fold_text(word).strip() == self._wanted for word in _words_of(value, field))

    def _is_other(self, value: AttributeValue, field: AttributeField | None) -> bool:
        return not self._is_equal(value, field)

    def _contains(self, value: AttributeValue, field: AttributeField | None) -> bool:
        if _is_empty(value, field):
            return False
        return any(self._wanted in fold_text(word) for word in _words_of(value, field))

    def _is_less(self, value: AttributeValue, field: AttributeField | None) -> bool:
        return not _is_empty(value, field) and self._order(value) < 0

    def _is_greater(self, value: AttributeValue, field: AttributeField | None) -> bool:
        return not _is_empty(value, field) and self._order(value) > 0

    def _order(self, value: AttributeValue) -> int:
        """-1, 0 or 1: the value comes before what is wanted, is equal or has no order, is after.

        Two numbers are compared as numbers, two texts (dates) as texts with numbers in them; a
        number and a word have no order.
        """
        number = _number_of(value)
        if number is not None and self._number is not None:
            return (number > self._number) - (number < self._number)
        if number is not None or self._number is not None or not self._wanted:
            return 0
        here, there = natural_key(str(value)), natural_key(self._wanted)
        return (here > there) - (here < there)


def fold_text(text: str) -> str:
    """A text for comparing: full-width forms as half-width ones, capitals as small letters."""
    return text.lower() if text.isascii() else unicodedata.normalize("NFKC", text).casefold()


def natural_key(text: str) -> tuple[str | int, ...]:
    """A key by which ``No. 9`` comes before ``No. 10``: texts and numbers by turns."""
    parts = _DIGITS.split(fold_text(text))
    return tuple(int(part) if i % 2 else part for i, part in enumerate(parts))


def number_in(text: str) -> float | None:
    """The number that a text is, full-width digits allowed; None when it is none."""
    plain = unicodedata.normalize("NFKC", text).strip().replace("−", "-").replace(",", ".")
    return float(plain) if _NUMBER.fullmatch(plain) else None


def _number_of(value: AttributeValue) -> float | None:
    if isinstance(value, str):
        return number_in(value)
    return None if value is None or isinstance(value, bool) else float(value)


def _is_empty(value: AttributeValue, _field: AttributeField | None) -> bool:
    return value is None or value == ""


def _field_of(catalogue: Catalogue, kind: str, id_: str) -> AttributeField | None:
    return catalogue[kind].attribute(id_) if kind in catalogue else None


def _words_of(value: AttributeValue, field: AttributeField | None) -> tuple[str, ...]:
    """All ways in which a value is written: as it is stored, and the names of a choice."""
    written = str(value)
    if field is None or field.type != "choice":
        return (written,)
    name = field.name_of_choice(written)
    return written, name.en, name.ja
