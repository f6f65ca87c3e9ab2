"""FeatureTally: how many features there are of each kind and run, without reading all each time."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

from processing.project.feature import Feature
from widgets.shared.map_source import MapSource


@dataclass(frozen=True)
class RunOfTool:
    """One run of a tool, by which features were made."""

    tool: str
    run: str


class FeatureTally:
    """Counts the document's features; some are counted again when they change.

    Parameters
    ----------
    source : MapSource
    """

    def __init__(self, source: MapSource) -> None:
        self._source = source
        self._entries: dict[str, tuple[str, RunOfTool]] = {}

    @property
    def by_kind(self) -> Counter[str]:
        """Features of each kind."""
        return Counter(kind for kind, _ in self._entries.values())

    @property
    def by_run(self) -> Counter[RunOfTool]:
        """Features of each run; those drawn by hand are of none."""
        return Counter(run for _, run in self._entries.values() if run.run)

    def read_all(self) -> None:
        """Count all features."""
        self._entries = {feature.id: _entry(feature) for feature in self._source.features()}

    def read(self, ids: Iterable[str]) -> None:
        """Count these features again."""
        for id_ in ids:
            feature = self._source.feature(id_)
            if feature is None:
                self._entries.pop(id_, None)
            else:
                self._entries[id_] = _entry(feature)


def _entry(feature: Feature) -> tuple[str, RunOfTool]:
    return feature.kind, RunOfTool(feature.provenance.tool, feature.provenance.run)
