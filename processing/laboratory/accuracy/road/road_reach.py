"""How far from the vehicle's path curbs and gutters lie, and how many of them are found there."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.laboratory.accuracy.filters.filter_tables import markdown_table
from processing.laboratory.accuracy.road.road_surroundings import StreetSurroundings
from processing.scoring.features.curb_lines import ScoredEdge
from processing.scoring.features.gutters import ScoredGutters

BANDS_M = (0.0, 4.0, 6.5, 10.0, 15.0, np.inf)
"""The thesis looks for gutters up to 6.5 m from the vehicle's path (Takahashi 2022,
table 7-3)."""

Reached = Mapping[str, NDArray[np.int64]]
"""By tool, how many were found and missed in each band: (bands, 2)."""


def count_by_reach(
    edges: Mapping[str, ScoredEdge], gutters: ScoredGutters, around: StreetSurroundings
) -> Reached:
    """What was asked for on one street, by how far away it lies."""
    sections = [
        (one.xyz, is_found)
        for judged in edges.values()
        for one, is_found in zip(judged.asked, judged.is_found.tolist(), strict=True)
    ]
    slots = [(one[None], True) for one in gutters.found]
    slots += [(one[None], False) for one in gutters.missed]
    return {"curbs": _count_by_reach(sections, around), "gutters": _count_by_reach(slots, around)}


def reach_table(streets: Sequence[Reached]) -> str:
    """All streets together."""
    rows = [["from the path", "curbs: found, missed", "R", "gutters: found, missed", "R"]]
    for band, (low, high) in enumerate(pairwise(BANDS_M)):
        name = f"beyond {low:g} m" if np.isinf(high) else f"{low:g} to {high:g} m"
        rows.append([name, *_cells(streets, band)])
    return markdown_table(rows)


def _cells(streets: Sequence[Reached], band: int) -> Iterator[str]:
    for tool in ("curbs", "gutters"):
        found, missed = sum((one[tool][band] for one in streets), np.zeros(2, np.int64)).tolist()
        yield f"{found:,}, {missed:,}"
        yield f"{100 * found / (found + missed):.1f} %" if found + missed else "–"


def _count_by_reach(
    positions: Sequence[tuple[Floats, bool]], around: StreetSurroundings
) -> NDArray[np.int64]:
    counts = np.zeros((len(BANDS_M) - 1, 2), np.int64)
    for xyz, is_found in positions:
        away_m = around.away_m(xyz)
        band = int(np.searchsorted(BANDS_M, away_m, "right")) - 1
        counts[min(band, len(counts) - 1), 0 if is_found else 1] += 1
    return counts
