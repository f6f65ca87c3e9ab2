"""Road markings against known streets of seeds that nobody looked at.

``python -m processing.laboratory.accuracy.road_map.markings --markdown docs/accuracy.md``
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Sequence

from processing.core.output_streams import write_every_character
from processing.laboratory.accuracy.filters.filter_tables import markdown_table
from processing.laboratory.accuracy.road_map.line_tables import LinesOfStreet, LineTable
from processing.scoring.features.markings import LEAST_POINTS, marking_score
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix

_HEADING = "## Road markings"
_SEEDS = "8201-8204"
_STYLES = ("urban", "urban", "rural", "highway", "urban", "rural")

_ABOUT = f"""\
`python -m processing.laboratory.accuracy.road_map.markings --markdown docs/accuracy.md`: \
lines by length in plan within 3 cm of their middle, a broken line with its gaps, where at least \
{LEAST_POINTS} points lie on a metre of paint; bars of crossings one to one by their middles \
within 20 cm. Neither arrows and figures nor what lies beside them counts. Every other street is \
worn and recorded with the errors of good systems. Nobody looked at the streets before.
"""


def section_of(rows: Sequence[LinesOfStreet]) -> str:
    """The section of the page, without its heading."""
    heads = ["street", "lines found, false, missed", "P", "R", "F", "right type", "off, RMS",
             "width off, RMS", "bars found, false, missed", "F"]  # fmt: skip
    cells = [heads]
    total: Counter[str] = Counter()
    for row in rows:
        lines, bars = row.score.counts_of("lines"), row.score.counts_of("bars")
        total.update(_numbered("lines", lines))
        total.update(_numbered("bars", bars))
        kinds = row.score.shares[0].share
        errors = [f"{100 * row.score.errors_of(one).rms:.1f} cm" for one in ("off", "width")]
        share = f"{100 * kinds.value:.0f} %" if kinds.of else "–"
        cells.append([row.street, *_counted(lines, 10), share, *errors, *_bars(bars)])
    lines, bars = (
        BinaryConfusionMatrix(total[f"{name} 0"], total[f"{name} 1"], total[f"{name} 2"], 0)
        for name in ("lines", "bars")
    )
    cells.append(["all", *_counted(lines, 10), "", "", "", *_bars(bars)])
    return f"{_ABOUT}\n{markdown_table(cells)}\n"


def _numbered(name: str, counts: BinaryConfusionMatrix) -> dict[str, int]:
    values = (counts.hits, counts.false_alarms, counts.misses)
    return {f"{name} {k}": value for k, value in enumerate(values)}


def _counted(counts: BinaryConfusionMatrix, per_metre: int) -> list[str]:
    values = (counts.hits, counts.false_alarms, counts.misses)
    hits, false, missed = values
    metres = ", ".join(f"{one / per_metre:.0f} m" for one in values)
    shares = ((hits, hits + false), (hits, hits + missed), (2 * hits, 2 * hits + false + missed))
    return [metres, *(f"{100 * one / of:.1f} %" if of else "–" for one, of in shares)]


def _bars(counts: BinaryConfusionMatrix) -> list[str]:
    values = (counts.hits, counts.false_alarms, counts.misses)
    of = 2 * values[0] + values[1] + values[2]
    return [", ".join(map(str, values)), f"{200 * values[0] / of:.1f} %" if of else "–"]


TABLE = LineTable("markings", marking_score, _HEADING, section_of, _SEEDS, _STYLES, length_m=50.0)


def main(arguments: Sequence[str] | None = None) -> int:
    """The command."""
    TABLE.write(__doc__, arguments)
    return 0


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())
