"""Removing features, as it is asked for by every tool that has a Delete key."""

from __future__ import annotations

from processing.core.text import Text
from processing.map.change import Change
from processing.map.feature import Feature


def removal_of(features: tuple[Feature, ...]) -> tuple[Text, Change]:
    """The change that removes features in one step, and its line in the undo menu."""
    count = len(features)
    label = (
        Text("Delete a feature", "地物を削除")
        if count == 1
        else Text("Delete {count} features", "{count}個の地物を削除").filled(count=count)
    )
    return label, Change(removed=features)
