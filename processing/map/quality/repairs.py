"""What can be mended by rule: copies and slips are deleted, ends are put onto what they miss."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import replace

from processing.map.change import Change, Replacement
from processing.map.feature import Feature, Vertex
from processing.map.quality.findings import Finding, RuleId
from processing.map.quality.sheet_edges import EDGE_REACH_M
from processing.map.quality.topology import GAP_M

MENDABLE: frozenset[RuleId] = frozenset({"duplicate", "too_small", "gap", "sheet_gap"})
"""Rules whose findings can be mended without asking what was meant."""

_REACH_M: Mapping[RuleId, float] = {"gap": GAP_M, "sheet_gap": EDGE_REACH_M}
"""How far an end is moved to another's end."""


def repair(findings: Iterable[Finding], features: Mapping[str, Feature]) -> Change:
    """One step that mends findings.

    A feature is changed once in a step: what concerns it besides is found again by the next check.

    Parameters
    ----------
    features : mapping of str to Feature
        By id, as they are now; findings about others are left out.
    """
    removed: list[Feature] = []
    replaced: list[Replacement] = []
    touched: set[str] = set()
    for one in findings:
        involved = [features[id_] for id_ in one.features if id_ in features]
        if len(involved) < len(one.features) or touched & set(one.features):
            continue
        if one.rule in ("duplicate", "too_small"):
            gone = min(reversed(involved), key=_known)
            removed.append(gone)
        elif one.rule in _REACH_M:
            before, after = involved[0], _joined(involved[0], involved[-1], one)
            replaced.append(Replacement(before, after))
        else:
            continue
        touched |= set(one.features)
    return Change(replaced=tuple(replaced), removed=tuple(removed))


def _known(feature: Feature) -> int:
    """How much is known about a feature: of two copies the fuller one stays."""
    return sum(value not in (None, "") for value in feature.attributes.values())


def _joined(line: Feature, other: Feature, gap: Finding) -> Feature:
    """A line whose end near the gap lies on the other's end, or where the gap's far side is."""
    if line.id == other.id:
        return line.with_vertices((*line.vertices[:-1], line.vertices[0]))
    ends = (0, len(line.vertices) - 1)
    end = min(ends, key=lambda number: math.dist(line.vertices[number].xyz, gap.position))
    target = min(
        (other.vertices[0], other.vertices[-1]),
        key=lambda vertex: math.dist(vertex.xyz[:2], line.vertices[end].xyz[:2]),
    )
    if math.dist(target.xyz[:2], line.vertices[end].xyz[:2]) > _REACH_M[gap.rule]:
        # It stops short of the other's middle: the finding's place is on it.
        target = Vertex(gap.position, is_occluded=line.vertices[end].is_occluded)
    vertices = list(line.vertices)
    vertices[end] = replace(target)
    return line.with_vertices(tuple(vertices))
