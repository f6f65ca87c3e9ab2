"""Edges of the carriageway without a step against known streets of seeds that nobody looked at.

``python -m processing.laboratory.accuracy.road_map.edges --markdown docs/accuracy.md``
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace

from processing.core.output_streams import write_every_character
from processing.laboratory.accuracy.filters.filter_tables import markdown_table
from processing.laboratory.accuracy.road_map.line_tables import LinesOfStreet, LineTable
from processing.laboratory.simulate.requests import StreetRequest
from processing.scoring.features.edges import LEAST_POINTS, edge_score
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix

_HEADING = "## Edges of the carriageway without a step"
_SEEDS = "9521-9532"
_STYLES = ("urban", "rural", "highway")
_CURBS_OF = 4
"""Every fourth street has the curbs that such streets have."""

_COMMAND = "python -m processing.laboratory.accuracy.road_map.edges --markdown docs/accuracy.md"
_ABOUT = f"""`{_COMMAND}`: \
where the carriageway ends without a curb, by length in plan within 10 cm, where at least \
{LEAST_POINTS} points lie on a metre of the 30 cm on either side. Three of four streets have flush \
walks, gutters and shoulders of gravel or soil in place of most curbs. Neither the asphalt's edge \
in front of a gutter with a curb behind nor corners of side streets count. Every other street is \
worn and recorded with the errors of good systems. Nobody looked at the streets; they were scored \
twice, before and after entrances over lowered curbs were left to curbs, which other streets showed.
"""


def section_of(rows: Sequence[LinesOfStreet]) -> str:
    """The section of the page, without its heading."""
    heads = ["street", "found, false, missed", "P", "R", "F", "right type", "off, RMS"]
    cells = [heads]
    total = BinaryConfusionMatrix(0, 0, 0, 0)
    for row in rows:
        counts, kinds = row.score.counts_of("lines"), row.score.shares[0].share
        total = BinaryConfusionMatrix(
            total.hits + counts.hits,
            total.false_alarms + counts.false_alarms,
            total.misses + counts.misses,
            0,
        )
        share = f"{100 * kinds.value:.0f} %" if kinds.of else "–"
        off = f"{100 * row.score.errors_of('off').rms:.1f} cm" if kinds.of else "–"
        cells.append([row.street, *_counted(counts), share, off])
    cells.append(["all", *_counted(total), "", ""])
    return f"{_ABOUT}\n{markdown_table(cells)}\n"


def _counted(counts: BinaryConfusionMatrix) -> list[str]:
    """Metres of what was counted in decimetres, and shares."""
    hits, false, missed = counts.hits, counts.false_alarms, counts.misses
    metres = ", ".join(f"{one / 10:.0f} m" for one in (hits, false, missed))
    shares = ((hits, hits + false), (hits, hits + missed), (2 * hits, 2 * hits + false + missed))
    return [metres, *(f"{100 * one / of:.1f} %" if of else "–" for one, of in shares)]


@dataclass(frozen=True)
class EdgeTable(LineTable):
    """The same streets as of other tools, most of them without curbs."""

    def request_of(self, number: int, seed: int, length_m: float) -> StreetRequest:
        """The street of a seed."""
        usual = super().request_of(number, seed, length_m)
        return replace(usual, flush=number % _CURBS_OF != _CURBS_OF - 1)


TABLE = EdgeTable("edges", edge_score, _HEADING, section_of, _SEEDS, _STYLES)


def main(arguments: Sequence[str] | None = None) -> int:
    """The command."""
    TABLE.write(__doc__, arguments)
    return 0


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())
