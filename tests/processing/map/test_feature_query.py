"""Which features a rule finds."""

from __future__ import annotations

import pytest

from processing.core.text import Text
from processing.map.catalogue import AttributeField, Catalogue, FeatureKind, Geometry
from processing.map.feature import AttributeValue, Feature, Status, Vertex
from processing.map.feature_query import (
    AttributeCondition,
    FeatureQuery,
    QueryTest,
    SearchTexts,
    ValueComparison,
    natural_key,
)

SIDE = AttributeField(
    "side",
    Text("Side", "左右"),
    "choice",
    choices=("left", "right"),
    choice_names=(Text("Left", "左"), Text("Right", "右")),
)
HEIGHT = AttributeField("height_m", Text("Height", "高さ"), "number", "m")
KINDS = Catalogue(
    (
        FeatureKind(
            "curb",
            Text("Curb", "縁石"),
            Geometry.LINE,
            "",
            "2213_縁石",
            "#e69f00",
            30,
            attributes=(SIDE,),
        ),
        FeatureKind(
            "pole",
            Text("Pole", "電柱"),
            Geometry.POINT,
            "",
            "4142_電柱",
            "#009e73",
            96,
            attributes=(HEIGHT, AttributeField("number", Text("Number", "番号"), "text")),
        ),
    )
)
POSITION = Vertex((1.0, 2.0, 3.0))


def pole(**attributes: AttributeValue) -> Feature:
    return Feature("a1b2c3d4", "pole", Geometry.POINT, (POSITION,), attributes)


CURB = Feature("ffee0011", "curb", Geometry.LINE, (POSITION, POSITION), {"side": "left"})


def finds(feature: Feature, **rule: object) -> bool:
    return FeatureQuery(**rule).matches(feature, KINDS)  # type: ignore[arg-type]


def test_an_empty_rule_finds_everything() -> None:
    assert FeatureQuery().finds_everything
    assert FeatureQuery(text="  ").finds_everything
    assert finds(CURB)


@pytest.mark.parametrize(
    "words",
    ["curb", "CURB", "縁石", "2213", "left", "左", "ｃｕｒｂ", "curb left", "ffee", "縁 左"],
)
def test_words_are_found_in_both_languages_layers_values_and_ids(words: str) -> None:
    assert finds(CURB, text=words)


@pytest.mark.parametrize("words", ["pole", "curb right", "ee00", "ff", "zz"])
def test_words_that_a_feature_lacks_do_not_find_it(words: str) -> None:
    assert not finds(CURB, text=words)


def test_numbers_and_full_width_values_are_found() -> None:
    assert finds(pole(height_m=8.25), text="8.25")
    assert finds(pole(number="Ｎｏ．１２"), text="no.12")


def test_kind_and_status_must_be_among_those_asked_for() -> None:
    assert finds(CURB, kinds=frozenset({"curb", "lid"}))
    assert not finds(CURB, kinds=frozenset({"pole"}))
    assert finds(CURB, statuses=frozenset({Status.ACCEPTED}))
    assert not finds(CURB, statuses=frozenset({Status.CANDIDATE}))


def test_occluded_vertices_are_asked_for() -> None:
    occluded = CURB.with_vertices((POSITION, Vertex((1.0, 2.0, 3.0), is_occluded=True)))
    assert finds(occluded, has_occluded=True)
    assert not finds(CURB, has_occluded=True)


@pytest.mark.parametrize(
    ("value", "comparison", "wanted", "is_found"),
    [
        (8.25, "=", "8.25", True),
        (8.25, "=", "８．２５", True),
        (8.25, "=", "8,25", True),
        (8, "=", "8.0", True),
        (8.25, "≠", "8.25", False),
        (None, "≠", "8.25", True),
        (8.25, "<", "10", True),
        (10.0, "<", "10", False),
        (10.5, ">", "10", True),
        (-1.5, "<", "−1", True),
        (None, "<", "10", False),
        (None, ">", "10", False),
        ("tall", "<", "10", False),
        ("tall", "=", "TALL", True),
        ("12", ">", "9", True),
        ("B-2", "<", "B-2", False),
        ("B-2", ">", "B-2", False),
        (8.25, "contains", ".2", True),
        (None, "contains", "", False),
        (None, "is empty", "", True),
        ("", "is empty", "", True),
        (0, "is empty", "", False),
        (float("nan"), "=", "1", False),
        (True, "=", "true", True),
    ],
)
def test_attributes_are_compared_as_what_they_are(
    value: AttributeValue, comparison: str, wanted: str, is_found: bool
) -> None:
    condition = AttributeCondition("height_m", ValueComparison(comparison), wanted)
    feature = pole() if value is None else pole(height_m=value)
    assert finds(feature, conditions=(condition,)) is is_found


def test_a_kind_without_the_attribute_is_never_found_by_it() -> None:
    for comparison in ValueComparison:
        condition = AttributeCondition("height_m", comparison, "5")
        assert not finds(CURB, conditions=(condition,))


def test_dates_and_numbered_texts_are_ordered() -> None:
    before = AttributeCondition("number", ValueComparison.LESS, "No. 10")
    assert finds(pole(number="No. 9"), conditions=(before,))
    assert not finds(pole(number="No. 11"), conditions=(before,))
    assert natural_key("No. 9") < natural_key("no. 10")


@pytest.mark.parametrize("name", ["left", "Left", "左"])
def test_a_choice_is_found_by_its_value_and_its_names(name: str) -> None:
    condition = AttributeCondition("side", ValueComparison.EQUAL, name)
    assert finds(CURB, conditions=(condition,))


def test_a_kind_that_the_catalogue_lacks_is_found_by_its_id_and_values() -> None:
    stray = Feature("00112233", "old_kind", Geometry.POINT, (POSITION,), {"note": "broken"})
    assert finds(stray, text="old_kind broken")
    assert finds(stray, conditions=(AttributeCondition("note", ValueComparison.EQUAL, "broken"),))
    assert not finds(stray, conditions=(AttributeCondition("side", ValueComparison.EMPTY),))


def test_kept_words_follow_a_change() -> None:
    texts = SearchTexts(KINDS)
    test = QueryTest(FeatureQuery(text="oak"), KINDS, texts)
    assert test.found([pole(number="oak")]) == [pole(number="oak")]
    assert test.found([pole(number="elm")]) == []


def test_the_found_keep_their_order() -> None:
    features = [pole(height_m=float(height)) for height in (3, 9, 1, 7)]
    over_two = FeatureQuery(
        conditions=(AttributeCondition("height_m", ValueComparison.GREATER, "2"),)
    )
    found = QueryTest(over_two, KINDS).found(features)
    assert [one.attributes["height_m"] for one in found] == [3, 9, 7]
