"""Rows kept by small steps are those that sorting and filtering everything would give."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from processing.map.catalogue import Geometry
from processing.map.feature import Feature, Vertex
from processing.map.feature_query import FeatureQuery
from tests.widgets.builders import KINDS
from widgets.panels.table.feature_columns import SortKey
from widgets.panels.table.feature_rows import FeatureRows


def feature(number: int, value: float | None, kind: str) -> Feature:
    attributes = {} if value is None else {"value": value}
    return Feature(f"{number:03}", kind, Geometry.POINT, (Vertex((0.0, 0.0, 0.0)),), attributes)


def by_value(one: Feature) -> SortKey | None:
    value = one.attributes.get("value")
    return None if value is None else (value,)


def expected(features: dict[str, Feature], kind: str, *, descending: bool) -> list[Feature]:
    """Numbers are ids, so the order of drawing is that of ids."""
    found = sorted((f for f in features.values() if f.kind == kind), key=lambda f: f.id)
    valued = sorted((f for f in found if by_value(f)), key=lambda f: by_value(f) or ())
    if descending:
        valued.reverse()
    return [*valued, *(f for f in found if not by_value(f))]


@pytest.mark.parametrize("descending", [False, True])
def test_any_sequence_of_changes_leaves_the_rows_as_if_made_anew(descending: bool) -> None:
    chance = np.random.default_rng(7)
    kinds = ("curb", "lid")

    def some(number: int) -> Feature:
        value = float(chance.integers(5)) if chance.random() < 0.5 else None
        return feature(number, value, kinds[chance.integers(2)])

    features = {one.id: one for one in map(some, range(30))}
    rows = FeatureRows(KINDS)
    rows.read(features.values(), KINDS)
    rows.sort(by_value, descending=descending)
    rows.find(FeatureQuery(kinds=frozenset({"curb"})))
    for _ in range(500):
        number = int(chance.integers(30))
        id_ = f"{number:03}"
        new = None if chance.random() < 0.3 else some(number)
        if new is not None and rows.row_of(id_) >= 0 and rows.keeps_position(new):
            rows.replace(new)
        else:
            rows.remove(id_)
            if new is not None:
                row = rows.row_for(new)
                rows.insert(new)
                assert rows.row_of(id_) == row
        if new is None:
            features.pop(id_, None)
        else:
            features[id_] = new
        shown = [rows.at(row) for row in range(len(rows))]
        assert shown == expected(features, "curb", descending=descending)
        assert rows.between(0, len(rows) - 1) == shown
        assert rows.kinds == Counter(one.kind for one in features.values())
        assert rows.total == len(features)
        assert all(rows.row_of(one.id) == row for row, one in enumerate(shown))
