"""Walls and faces of buildings against known streets of seeds by which nothing was learnt.

``python -m processing.laboratory.accuracy.road_map.walls --markdown docs/accuracy.md``
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Sequence

from processing.core.output_streams import write_every_character
from processing.laboratory.accuracy.filters.filter_tables import markdown_table
from processing.laboratory.accuracy.road_map.line_tables import LinesOfStreet, LineTable
from processing.scoring.features.walls import LEAST_POINTS, wall_score
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix

_HEADING = "## Walls and buildings"
_SEEDS = "9411-9416"
_STYLES = ("urban", "rural", "urban", "rural", "highway", "urban")

_COMMAND = "python -m processing.laboratory.accuracy.road_map.walls --markdown docs/accuracy.md"
_ABOUT = f"""`{_COMMAND}`: \
feet of walls and retaining walls, and faces of buildings, by length in plan within 5 cm, where \
{LEAST_POINTS} points or more lie on a metre of the face up to 3 m above its foot. What is made up \
counts as what it is called. Parapets, noise walls and posts of gates count neither way. Every \
other street is recorded with the errors of good systems. 9414 and 9415 were looked at after they \
were scored.
"""


def section_of(rows: Sequence[LinesOfStreet]) -> str:
    """The section of the page, without its heading."""
    heads = ["street", "walls found, false, missed", "P", "R", "F",
             "faces found, false, missed", "P", "R", "F", "right type", "off, RMS"]  # fmt: skip
    cells = [heads]
    total: Counter[str] = Counter()
    for row in rows:
        both = [row.score.counts_of(name) for name in ("walls", "faces")]
        for name, counts in zip(("walls", "faces"), both, strict=True):
            total.update(_numbered(name, counts))
        kinds = row.score.shares[0].share
        share = f"{100 * kinds.value:.0f} %" if kinds.of else "–"
        off = row.score.errors_of("off")
        told = [share, f"{100 * off.rms:.1f} cm" if kinds.of else "–"]
        cells.append([row.street, *_counted(both[0]), *_counted(both[1]), *told])
    sums = [
        BinaryConfusionMatrix(total[f"{name} 0"], total[f"{name} 1"], total[f"{name} 2"], 0)
        for name in ("walls", "faces")
    ]
    cells.append(["all", *_counted(sums[0]), *_counted(sums[1]), "", ""])
    return f"{_ABOUT}\n{markdown_table(cells)}\n"


def _numbered(name: str, counts: BinaryConfusionMatrix) -> dict[str, int]:
    values = (counts.hits, counts.false_alarms, counts.misses)
    return {f"{name} {k}": value for k, value in enumerate(values)}


def _counted(counts: BinaryConfusionMatrix) -> list[str]:
    """Metres of what was counted in decimetres, and shares."""
    values = (counts.hits, counts.false_alarms, counts.misses)
    hits, false, missed = values
    metres = ", ".join(f"{one / 10:.0f} m" for one in values)
    shares = ((hits, hits + false), (hits, hits + missed), (2 * hits, 2 * hits + false + missed))
    return [metres, *(f"{100 * one / of:.1f} %" if of else "–" for one, of in shares)]


TABLE = LineTable("walls", wall_score, _HEADING, section_of, _SEEDS, _STYLES)


def main(arguments: Sequence[str] | None = None) -> int:
    """The command."""
    TABLE.write(__doc__, arguments)
    return 0


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())
