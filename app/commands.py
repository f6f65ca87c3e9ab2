"""Commands: what users do to features, as changes with a label."""

from __future__ import annotations

from dataclasses import dataclass

from processing.project.change import Change
from processing.project.feature import Feature
from processing.text import Text


@dataclass(frozen=True)
class Command:
    """A change and its line in the undo menu."""

    label: Text
    change: Change


def removal_of(features: tuple[Feature, ...]) -> Command:
    """Remove features."""
    count = len(features)
    label = (
        Text("Delete a feature", "地物を削除")
        if count == 1
        else Text("Delete {count} features", "{count}個の地物を削除").filled(count=count)
    )
    return Command(label, Change(removed=features))
