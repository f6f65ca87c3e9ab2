"""Road markings against known streets of seeds that nobody looked at.

``python -m processing.laboratory.accuracy.road.markings --markdown docs/accuracy.md``
"""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from processing.core.output_streams import write_every_character
from processing.formats.vectors.mapped_shapes import read_mapped
from processing.laboratory.accuracy.filters.filter_tables import markdown_table
from processing.laboratory.accuracy.filters.filters import write_sections
from processing.laboratory.accuracy.road.road_scenes import (
    RoadScene,
    found_by,
    given_scenes,
    options_of,
    simulated_scenes,
    worn_options_of,
)
from processing.laboratory.seed_ranges import seeds_of
from processing.laboratory.simulate.requests import StreetRequest
from processing.scoring.features.file_scores import FileScore
from processing.scoring.features.markings import LEAST_POINTS, marking_score
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix

_HEADING = "## Road markings"
_SEEDS = "8201-8204"
_STYLES = ("urban", "urban", "rural", "highway", "urban", "rural")

_ABOUT = f"""`python -m processing.laboratory.accuracy.road.markings --markdown docs/accuracy.md`: \
lines by length in plan within 3 cm of their middle, a broken line with its gaps, where at least \
{LEAST_POINTS} points lie on a metre of paint; bars of crossings one to one by their middles \
within 20 cm. Neither arrows and figures nor what lies beside them counts. Every other street is \
worn and recorded with the errors of good systems. Nobody looked at the streets before.
"""


class MarkingRow(NamedTuple):
    """What was found on one street."""

    street: str
    score: FileScore


def request_of(number: int, seed: int, length_m: float) -> StreetRequest:
    """The street of a seed: styles and scanners take turns, every other one is worn."""
    make = worn_options_of if number % 2 else options_of
    style = _STYLES[number % len(_STYLES)]
    return replace(make(number, seed, length_m), style=style, passes=1, stops=False)


def rows_of(scenes: Iterator[RoadScene]) -> Iterator[MarkingRow]:
    """What the tool finds with its own parameters on each."""
    for scene in scenes:
        result = found_by("markings", scene.drives).result
        yield MarkingRow(scene.name, marking_score(result, read_mapped(scene.truth("markings"))))


def section_of(rows: Sequence[MarkingRow]) -> str:
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


def main(arguments: Sequence[str] | None = None) -> int:
    """Write the table to a page, or to standard output."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--markdown", type=Path)
    parser.add_argument("--seeds", default=_SEEDS)
    parser.add_argument("--length", type=float, default=50.0)
    parser.add_argument("--deliveries", type=Path, nargs="*", default=[])
    options = parser.parse_args(arguments)
    rows = list(rows_of(simulated_scenes(seeds_of(options.seeds), options.length, request_of)))
    rows += rows_of(given_scenes(options.deliveries))
    write_sections(options.markdown, {_HEADING: section_of(rows)})
    return 0


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())
