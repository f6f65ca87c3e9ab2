"""Covers against known streets of seeds that nobody looked at.

``python -m processing.laboratory.accuracy.road_map.covers --markdown docs/accuracy.md``
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

from processing.core.output_streams import write_every_character
from processing.laboratory.accuracy.filters.filter_tables import markdown_table
from processing.laboratory.accuracy.road_map.line_tables import LinesOfStreet, LineTable
from processing.scoring.features.covers import (
    LEAST_COVERED,
    LEAST_PER_M2,
    LEAST_POINTS,
    WITHIN_M,
    cover_score,
)
from processing.scoring.features.file_scores import FileScore
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix

_HEADING = "## Covers and inlets"
_SEEDS = "9561-9572"
_STYLES = ("urban", "urban", "rural")

_ABOUT = f"""\
`python -m processing.laboratory.accuracy.road_map.covers --markdown docs/accuracy.md`: \
manholes, valves, hand holes and gratings of basins one to one, middles within \
{100 * WITHIN_M:.0f} cm, where at least {LEAST_POINTS} points and {LEAST_PER_M2:.0f} a m² lie on \
them and {100 * LEAST_COVERED:.0f} % of their pieces were seen. Neither gratings between lids of \
gutters nor covers that the points don't show count. Every other street is worn and recorded with \
the errors of good systems. Nobody looked at the streets before.
"""


def section_of(rows: Sequence[LinesOfStreet]) -> str:
    """The section of the page, without its heading."""
    heads = ["street", "found, false, missed", "P", "R", "F", "right shape", "within 5 cm",
             "sized within 5 cm", "off, RMS"]  # fmt: skip
    cells = [heads]
    total = BinaryConfusionMatrix(0, 0, 0, 0)
    shares = {"shape": [0.0, 0.0], "near": [0.0, 0.0], "sized": [0.0, 0.0]}
    for row in rows:
        counts = row.score.counts_of("covers")
        total += counts
        for one in row.score.shares:
            shares[one.id][0] += one.share.hits
            shares[one.id][1] += one.share.of
        told = [_share(one.share.hits, one.share.of) for one in row.score.shares]
        cells.append([row.street, *_counted(counts), *told, _error(row.score)])
    sums = [_share(hits, of) for hits, of in shares.values()]
    cells.append(["all", *_counted(total), *sums, ""])
    return f"{_ABOUT}\n{markdown_table(cells)}\n"


def _share(hits: float, of: float) -> str:
    return f"{hits:.0f} of {of:.0f}" if of else "–"


def _error(score: FileScore) -> str:
    error = score.errors_of("place")
    return f"{100 * error.rms:.1f} cm" if error.count else "–"


def _counted(counts: BinaryConfusionMatrix) -> list[str]:
    hits, false, missed = values = (counts.hits, counts.false_alarms, counts.misses)
    shares = ((hits, hits + false), (hits, hits + missed), (2 * hits, 2 * hits + false + missed))
    told = (f"{100 * one / of:.1f} %" if of else "–" for one, of in shares)
    return [", ".join(map(str, values)), *told]


TABLE = LineTable("covers", cover_score, _HEADING, section_of, _SEEDS, _STYLES)


def main(arguments: Sequence[str] | None = None) -> int:
    """The command."""
    TABLE.write(__doc__, arguments)
    return 0


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())
