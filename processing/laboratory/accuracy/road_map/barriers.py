"""Barriers against known streets of seeds that nobody looked at.

``python -m processing.laboratory.accuracy.road_map.barriers --markdown docs/accuracy.md``
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

from processing.core.output_streams import write_every_character
from processing.laboratory.accuracy.filters.filter_tables import markdown_table
from processing.laboratory.accuracy.road_map.line_tables import LinesOfStreet, LineTable
from processing.scoring.features.barriers import LEAST_POINTS, barrier_score
from processing.scoring.features.file_scores import FileScore
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix

_HEADING = "## Barriers"
_SEEDS = "9401-9412"
_STYLES = ("urban", "rural", "highway")

_ABOUT = f"""\
`python -m processing.laboratory.accuracy.road_map.barriers --markdown docs/accuracy.md`: \
feet of guard rails, guard pipes, guard cables, fences, concrete barriers and noise walls by \
length in plan within 10 cm, where at least {LEAST_POINTS} points lie on a metre. Neither what \
the points don't show nor fences on top of walls count. Every other street is worn and recorded \
with the errors of good systems. Nobody looked at the streets before.
"""


def section_of(rows: Sequence[LinesOfStreet]) -> str:
    """The section of the page, without its heading."""
    heads = ["street", "found, false, missed", "P", "R", "F", "right type", "off, RMS",
             "height off, RMS", "spacing of posts off, RMS"]  # fmt: skip
    cells = [heads]
    hits = false = missed = 0
    for row in rows:
        counts, kinds = row.score.counts_of("lines"), row.score.shares[0].share
        hits, false = hits + counts.hits, false + counts.false_alarms
        missed += counts.misses
        share = f"{100 * kinds.value:.0f} %" if kinds.of else "–"
        errors = [_error(row.score, one) for one in ("off", "height", "posts")]
        cells.append([row.street, *_counted(counts), share, *errors])
    cells.append(["all", *_counted(BinaryConfusionMatrix(hits, false, missed, 0)), "", "", "", ""])
    return f"{_ABOUT}\n{markdown_table(cells)}\n"


def _error(score: FileScore, name: str) -> str:
    error = score.errors_of(name)
    return f"{100 * error.rms:.1f} cm" if error.count else "–"


def _counted(counts: BinaryConfusionMatrix) -> list[str]:
    """Metres, from decimetres, and shares."""
    hits, false, missed = values = (counts.hits, counts.false_alarms, counts.misses)
    metres = ", ".join(f"{one / 10:.0f} m" for one in values)
    shares = ((hits, hits + false), (hits, hits + missed), (2 * hits, 2 * hits + false + missed))
    return [metres, *(f"{100 * one / of:.1f} %" if of else "–" for one, of in shares)]


TABLE = LineTable("barriers", barrier_score, _HEADING, section_of, _SEEDS, _STYLES)


def main(arguments: Sequence[str] | None = None) -> int:
    """The command."""
    TABLE.write(__doc__, arguments)
    return 0


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())
