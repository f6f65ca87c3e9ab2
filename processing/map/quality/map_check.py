"""A map looked through before it is handed in: findings, and what was drawn and reviewed."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain, groupby

from processing.core.monitor import Monitor, SilentMonitor
from processing.core.text import Text
from processing.map.catalogue import CHANGE_KIND, Catalogue, FeatureKind, Geometry
from processing.map.feature import Feature, Status
from processing.map.quality.findings import RULES, Finding, RuleId
from processing.map.quality.sheet_edges import has_sheets, sheet_gaps
from processing.map.quality.topology import topology_findings
from processing.map.routes.numbering import NUMBER, ROUTE
from processing.map.sign_numbers import FIELD, is_kind_of_signs

_UNMEASURED = 0.5
"""More than this share of its vertices rests on no measured point."""

_CHECKING = Text("Checking {kind}", "{kind}を点検中")


@dataclass(frozen=True)
class KindCount:
    """What was drawn of a kind.

    Attributes
    ----------
    accepted, candidates, rejected : int
        By status.
    by_tools : int
        Accepted ones that a tool found.
    unseen : int
        Those of them that were accepted for their confidence alone.
    """

    kind: str
    accepted: int
    candidates: int
    rejected: int
    by_tools: int
    unseen: int = 0

    @property
    def decided(self) -> int:
        """Of what tools found, how many a person accepted or rejected."""
        return self.by_tools - self.unseen + self.rejected

    @property
    def precision(self) -> float:
        """Of what tools found and a person judged, the share accepted; NaN without any."""
        return (self.by_tools - self.unseen) / self.decided if self.decided else math.nan

    @property
    def recall(self) -> float:
        """Of what was accepted, the share that tools found: the rest was drawn by hand.

        NaN where tools found none and none was rejected: nobody looked for the kind by tools; and
        where no person accepted, rejected or drew one.
        """
        by_person = self.accepted - self.unseen + self.rejected
        was_sought = self.by_tools + self.rejected > 0 and self.accepted > 0 and by_person > 0
        return self.by_tools / self.accepted if was_sought else math.nan


@dataclass(frozen=True)
class MapCheck:
    """What was found.

    Attributes
    ----------
    findings : tuple of Finding
        By rule, then from west to east.
    kinds : tuple of KindCount
        In the order of the catalogue, those that the map has.
    """

    findings: tuple[Finding, ...]
    kinds: tuple[KindCount, ...]

    @property
    def decided_share(self) -> float:
        """Of what tools found, the share that a person accepted or rejected; 1 without any."""
        decided = sum(one.decided for one in self.kinds)
        every = decided + sum(one.candidates + one.unseen for one in self.kinds)
        return decided / every if every else 1.0

    def count(self, rule: RuleId) -> int:
        """How often a rule is broken."""
        return sum(one.rule == rule for one in self.findings)

    @property
    def errors(self) -> int:
        """Findings that make a delivery wrong."""
        return sum(RULES[one.rule].is_error for one in self.findings)


def check_map(
    features: Iterable[Feature],
    catalogue: Catalogue,
    monitor: Monitor | None = None,
    *,
    crs: str = "",
    drives: Collection[str] | None = None,
) -> MapCheck:
    """Look a map through.

    Parameters
    ----------
    features : iterable of Feature
        All of them: accepted ones are checked, candidates and rejected ones are counted.
    crs : str
        ``EPSG:n``: in a plane rectangular system of Japan lines are looked at where sheets meet.
    drives : collection of str, optional
        Ids of the project's drives: what rests on points of another is told. None where the map
        stands without its project.

    Raises
    ------
    Cancelled
    """
    monitor = monitor or SilentMonitor()
    by_kind = {
        kind: list(members)
        for kind, members in groupby(sorted(features, key=_kind_of), key=_kind_of)
    }
    kinds = [kind for kind in catalogue if kind.id in by_kind and kind.id != CHANGE_KIND]
    findings: list[Finding] = []
    for number, kind in enumerate(kinds):
        monitor.check()
        monitor.report(number / len(kinds), _CHECKING.filled(kind=kind.name))
        members = by_kind[kind.id]
        accepted = [one for one in members if one.status is Status.ACCEPTED]
        found = chain(
            topology_findings(accepted),
            sheet_gaps(accepted) if has_sheets(crs) else (),
            _unmeasured(accepted),
            _unnumbered(accepted) if is_kind_of_signs(kind) else (),
            _not_in_ledgers(accepted, kind),
            _undecided(members),
            _unseen(accepted),
            () if drives is None else _on_other_drives(accepted, drives),
        )
        findings.extend(found)
    order = list(RULES)
    findings.sort(key=lambda one: (order.index(one.rule), one.position))
    return MapCheck(tuple(findings), tuple(_counted(kind.id, by_kind[kind.id]) for kind in kinds))


def _kind_of(feature: Feature) -> str:
    return feature.kind


def _unmeasured(features: Sequence[Feature]) -> Iterator[Finding]:
    for one in features:
        hidden = [vertex for vertex in one.vertices if vertex.is_occluded]
        if len(hidden) > _UNMEASURED * len(one.vertices):
            yield Finding("unmeasured", (one.id,), one.kind, hidden[0].xyz)


def _unnumbered(features: Sequence[Feature]) -> Iterator[Finding]:
    for one in features:
        if one.attributes.get(FIELD) in (None, ""):
            yield Finding("number_missing", (one.id,), one.kind, one.vertices[0].xyz)


def _not_in_ledgers(features: Sequence[Feature], kind: FeatureKind) -> Iterator[Finding]:
    """Things that ledgers list one by one, and that say no number or route.

    They stand at a place, or reach from station to station; edges and centre lines are no such
    things although they can say a route.
    """
    is_thing = kind.geometry is Geometry.POINT or kind.attribute("start_station") is not None
    if not is_thing or None in (kind.attribute(NUMBER), kind.attribute(ROUTE)):
        return
    for one in features:
        if any(one.attributes.get(name) in (None, "") for name in (NUMBER, ROUTE)):
            yield Finding("ledger_missing", (one.id,), one.kind, one.vertices[0].xyz)


def _undecided(features: Sequence[Feature]) -> Iterator[Finding]:
    for one in features:
        if one.status is Status.CANDIDATE:
            yield Finding("undecided", (one.id,), one.kind, one.vertices[0].xyz)


def _unseen(features: Sequence[Feature]) -> Iterator[Finding]:
    for one in features:
        if one.provenance.unseen:
            yield Finding("unseen", (one.id,), one.kind, one.vertices[0].xyz)


def _on_other_drives(features: Sequence[Feature], drives: Collection[str]) -> Iterator[Finding]:
    for one in features:
        for vertex in one.vertices:
            if vertex.measured is not None and vertex.measured.drive not in drives:
                yield Finding("drive_gone", (one.id,), one.kind, vertex.xyz)
                break


def _counted(kind: str, features: Sequence[Feature]) -> KindCount:
    def count(status: Status) -> int:
        return sum(one.status is status for one in features)

    by_tools = sum(
        one.status is Status.ACCEPTED and one.provenance.tool != "hand" for one in features
    )
    return KindCount(
        kind,
        count(Status.ACCEPTED),
        count(Status.CANDIDATE),
        count(Status.REJECTED),
        by_tools,
        sum(one.status is Status.ACCEPTED and one.provenance.unseen for one in features),
    )
