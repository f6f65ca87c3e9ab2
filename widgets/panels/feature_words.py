"""What features' states, kinds, origins and values are called, the same in every panel."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import QLocale

from processing.core.text import Language, Text
from processing.map.catalogue import AttributeField, Catalogue
from processing.map.feature import AttributeValue, Feature, Status
from processing.map.renewal.map_comparison import COMPARISON, COMPARISON_NAME
from processing.tools.listed.registry import TOOLS

STATUS_NAMES: Mapping[Status, Text] = {
    Status.CANDIDATE: Text("Candidate", "候補"),
    Status.ACCEPTED: Text("Accepted", "採用"),
    Status.REJECTED: Text("Rejected", "却下"),
}

HAND = "hand"
"""What ``Provenance.tool`` says of features drawn by a person."""

_UNSEEN = Text("Accepted, not looked at", "採用（目視なし）")
_BY_HAND = Text("By hand", "手作業")
_YES_NO = {True: Text("yes", "はい"), False: Text("no", "いいえ")}


def name_of_kind(catalogue: Catalogue, kind: str, language: Language) -> str:
    """A kind's name; its id where the catalogue doesn't know it."""
    return catalogue[kind].name.in_language(language) if kind in catalogue else kind


def name_of_status(feature: Feature, language: Language) -> str:
    """What became of a feature; whether somebody looked at it."""
    name = _UNSEEN if feature.provenance.unseen else STATUS_NAMES[feature.status]
    return name.in_language(language)


def name_of_origin(feature: Feature, language: Language) -> str:
    """Who made a feature: a person, or the tool by its name (its id where it is no more)."""
    tool = feature.provenance.tool
    if tool == HAND:
        return _BY_HAND.in_language(language)
    if tool == COMPARISON:
        return COMPARISON_NAME.in_language(language)
    return TOOLS[tool].name.in_language(language) if tool in TOOLS else tool


def words_of_value(value: AttributeValue, field: AttributeField | None, language: Language) -> str:
    """An attribute's value as it is read: numbers in the language's way, choices by name."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return _YES_NO[value].in_language(language)
    if isinstance(value, int | float):
        return number_words(value, language)
    if field is not None and field.type == "choice":
        return field.name_of_choice(value).in_language(language)
    return value


def number_words(value: float, language: Language) -> str:
    """The shortest text that reads back as the same number, digits in groups of three."""
    locale = QLocale(language)
    if isinstance(value, int):
        return locale.toString(value) if abs(value) < 2**63 else f"{value:,}"
    return locale.toString(value, "f", QLocale.FloatingPointPrecisionOption.FloatingPointShortest)
