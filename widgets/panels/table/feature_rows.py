"""FeatureRows: the features that a query finds, in the order of a column; knows no Qt model.

A change of one feature costs a search by halves and no walk through all.
"""

from __future__ import annotations

from bisect import bisect_left
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from itertools import count
from operator import attrgetter

from processing.map.catalogue import Catalogue
from processing.map.feature import Feature
from processing.map.feature_query import FeatureQuery, QueryTest, SearchTexts
from widgets.panels.table.feature_columns import SortKey

_Place = tuple[bool, SortKey, int]
"""Whether there is nothing to sort by, the column's key, the number in the order of drawing."""

_kind_of = attrgetter("kind")


class FeatureRows:
    """All features, and those of them that are rows.

    Parameters
    ----------
    catalogue : Catalogue
    """

    def __init__(self, catalogue: Catalogue) -> None:
        self._catalogue = catalogue
        self._texts = SearchTexts(catalogue)
        self._query = FeatureQuery()
        self._test = QueryTest(self._query, catalogue, self._texts)
        self._key: Callable[[Feature], SortKey | None] = _as_drawn
        self._is_descending = False
        self._numbers: dict[str, int] = {}
        self._features: dict[str, Feature] = {}
        self._positions: dict[str, _Place] = {}
        self._sorted: list[Feature] = []
        self._shown: list[Feature] = []
        self._blank_from = 0
        self._kinds: Counter[str] = Counter()
        self._shown_kinds: Counter[str] = Counter()

    def __len__(self) -> int:
        return len(self._shown)

    @property
    def total(self) -> int:
        """How many features there are, shown or not."""
        return len(self._features)

    @property
    def query(self) -> FeatureQuery:
        """By what the rows are found."""
        return self._query

    @property
    def kinds(self) -> Counter[str]:
        """All features by kind; not to be changed."""
        return self._kinds

    @property
    def shown_kinds(self) -> Counter[str]:
        """The rows by kind; not to be changed."""
        return self._shown_kinds

    def at(self, row: int) -> Feature:
        """The feature in a row."""
        return self._shown[self._index_of(row)]

    def between(self, top: int, bottom: int) -> Sequence[Feature]:
        """The features of the rows ``top`` to ``bottom``, both counted."""
        if not self._is_descending:
            return self._shown[top : bottom + 1]
        return [self.at(row) for row in range(top, bottom + 1)]

    def row_of(self, id_: str) -> int:
        """The row of a feature; −1 when it is in none."""
        position = self._positions.get(id_)
        if position is None:
            return -1
        index = bisect_left(self._shown, position, key=self._position_of)
        is_there = index < len(self._shown) and self._shown[index].id == id_
        return self._index_of(index) if is_there else -1

    def read(self, features: Iterable[Feature], catalogue: Catalogue) -> None:
        """Begin anew with these features, in the order of drawing."""
        if catalogue is not self._catalogue:
            self._catalogue = catalogue
            self._texts = SearchTexts(catalogue)
            self._test = QueryTest(self._query, catalogue, self._texts)
        self._features = {feature.id: feature for feature in features}
        self._numbers = dict(zip(self._features, count(), strict=False))
        self._arrange()

    def sort(self, key: Callable[[Feature], SortKey | None] | None, *, descending: bool) -> None:
        """Order by a column's key; None: as they were drawn."""
        self._key = key or _as_drawn
        self._is_descending = descending
        self._arrange()

    def find(self, query: FeatureQuery) -> None:
        """Show what another query finds."""
        self._query = query
        self._test = QueryTest(query, self._catalogue, self._texts)
        self._choose()

    def keeps_position(self, feature: Feature) -> bool:
        """Whether a changed feature stays in the row in which it was."""
        before = self._features.get(feature.id)
        return (
            before is not None
            and before.kind == feature.kind
            and self._positions[feature.id] == self._new_position(feature)
            and self._is_found(feature)
        )

    def replace(self, feature: Feature) -> None:
        """Take over a changed feature that keeps its place."""
        position = self._positions[feature.id]
        self._features[feature.id] = feature
        for features in (self._sorted, self._shown):
            features[bisect_left(features, position, key=self._position_of)] = feature

    def remove(self, id_: str) -> None:
        """Take a feature out; nothing happens when it isn't there."""
        feature = self._features.pop(id_, None)
        if feature is None:
            return
        position = self._positions[id_]
        index = bisect_left(self._shown, position, key=self._position_of)
        if index < len(self._shown) and self._shown[index].id == id_:
            del self._shown[index]
            _count_less(self._shown_kinds, feature.kind)
            self._blank_from -= not position[0]
        del self._sorted[bisect_left(self._sorted, position, key=self._position_of)]
        _count_less(self._kinds, feature.kind)
        del self._positions[id_]
        self._texts.forget(id_)

    def row_for(self, feature: Feature) -> int:
        """The row that a feature not yet there would come into; −1 where it is not found."""
        if not self._is_found(feature):
            return -1
        position = self._new_position(feature)
        index = bisect_left(self._shown, position, key=self._position_of)
        if not self._is_descending:
            return index
        return index if position[0] else self._blank_from - index

    def insert(self, feature: Feature) -> None:
        """Take a feature in."""
        self._numbers.setdefault(feature.id, len(self._numbers))
        position = self._new_position(feature)
        self._features[feature.id] = feature
        self._positions[feature.id] = position
        self._kinds[feature.kind] += 1
        self._sorted.insert(bisect_left(self._sorted, position, key=self._position_of), feature)
        if self._is_found(feature):
            self._shown.insert(bisect_left(self._shown, position, key=self._position_of), feature)
            self._shown_kinds[feature.kind] += 1
            self._blank_from += not position[0]

    def change_many(self, changed: Iterable[tuple[str, Feature | None]]) -> None:
        """Take over many features at once; None for one that is no more."""
        for id_, feature in changed:
            if feature is None:
                self._features.pop(id_, None)
                self._texts.forget(id_)
            else:
                self._numbers.setdefault(id_, len(self._numbers))
                self._features[id_] = feature
        self._arrange()

    @property
    def features(self) -> tuple[Feature, ...]:
        """All features, shown or not."""
        return tuple(self._sorted)

    def search_texts_of(self, features: Iterable[Feature]) -> None:
        """Read the words of some features ahead of the first search."""
        for feature in features:
            self._texts.of(feature)

    def _arrange(self) -> None:
        numbers, key = self._numbers, self._key
        if key is _as_drawn:
            self._positions = {id_: (False, (), numbers[id_]) for id_ in self._features}
        else:
            self._positions = {
                id_: _position(key(feature), numbers[id_])
                for id_, feature in self._features.items()
            }
        positions = self._positions
        self._sorted = sorted(self._features.values(), key=lambda one: positions[one.id])
        self._kinds = Counter(map(_kind_of, self._sorted))
        self._choose()

    def _choose(self) -> None:
        if self._query.finds_everything:
            self._shown = list(self._sorted)
            self._shown_kinds = Counter(self._kinds)
        else:
            self._shown = self._test.found(self._sorted)
            self._shown_kinds = Counter(map(_kind_of, self._shown))
        self._blank_from = bisect_left(self._shown, True, key=self._is_blank)  # noqa: FBT003

    def _position_of(self, feature: Feature) -> _Place:
        return self._positions[feature.id]

    def _is_blank(self, feature: Feature) -> bool:
        return self._positions[feature.id][0]

    def _new_position(self, feature: Feature) -> _Place:
        return _position(self._key(feature), self._numbers.get(feature.id, len(self._numbers)))

    def _is_found(self, feature: Feature) -> bool:
        return self._query.finds_everything or bool(self._test.found((feature,)))

    def _index_of(self, row: int) -> int:
        """A row's index, and an index's row: what has nothing to sort by is last either way."""
        if self._is_descending and row < self._blank_from:
            return self._blank_from - 1 - row
        return row


def _as_drawn(_feature: Feature) -> SortKey:
    return ()


def _position(key: SortKey | None, number: int) -> _Place:
    return (True, (), number) if key is None else (False, key, number)


def _count_less(kinds: Counter[str], kind: str) -> None:
    kinds[kind] -= 1
    if not kinds[kind]:
        del kinds[kind]
