"""FeatureTally: how many features there are of each kind and run, without reading all each time."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

from processing.map.feature import Feature, Status
from widgets.shared.map_source import MapSource


@dataclass(frozen=True)
class RunOfTool:
    """One run of a tool, by which features were made."""

    tool: str
    run: str


@dataclass(frozen=True)
class RunTally:
    """How many features of a run there are, by what was decided."""

    candidates: int
    accepted: int
    rejected: int

    @property
    def total(self) -> int:
        """All of them."""
        return self.candidates + self.accepted + self.rejected


_Entry = tuple[str, RunOfTool, Status]


class FeatureTally:
    """Counts the document's features; some are counted again when they change.

    Parameters
    ----------
    source : MapSource
    """

    def __init__(self, source: MapSource) -> None:
        self._source = source
        self._entries: dict[str, _Entry] = {}
        self._kinds: Counter[str] = Counter()
        self._runs: Counter[tuple[RunOfTool, Status]] = Counter()

    @property
    def by_kind(self) -> Counter[str]:
        """Features of each kind."""
        return +self._kinds

    @property
    def by_run(self) -> dict[RunOfTool, RunTally]:
        """Features of each run, by what was decided; those drawn by hand are of none."""
        runs = dict.fromkeys(run for (run, _), count in self._runs.items() if count and run.run)
        return {run: RunTally(*(self._runs[run, status] for status in _STATUSES)) for run in runs}

    def read_all(self) -> None:
        """Count all features."""
        self._entries = {feature.id: _entry(feature) for feature in self._source.features()}
        self._kinds = Counter(kind for kind, _, _ in self._entries.values())
        self._runs = Counter((run, status) for _, run, status in self._entries.values())

    def read(self, ids: Iterable[str]) -> None:
        """Count these features again."""
        for id_ in ids:
            feature = self._source.feature(id_)
            before = self._entries.pop(id_, None)
            if before is not None:
                self._count(before, -1)
            if feature is not None:
                self._entries[id_] = _entry(feature)
                self._count(self._entries[id_], 1)

    def _count(self, entry: _Entry, by: int) -> None:
        kind, run, status = entry
        self._kinds[kind] += by
        self._runs[run, status] += by


_STATUSES = (Status.CANDIDATE, Status.ACCEPTED, Status.REJECTED)


def _entry(feature: Feature) -> _Entry:
    origin = RunOfTool(feature.provenance.tool, feature.provenance.run)
    return feature.kind, origin, feature.status
