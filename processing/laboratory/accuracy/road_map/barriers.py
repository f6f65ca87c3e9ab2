"""Barriers against known streets of seeds that nobody looked at.

``python -m processing.laboratory.accuracy.road_map.barriers --markdown docs/accuracy.md``
"""

from __future__ import annotations

import argparse
import sys
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


class BarrierRow(NamedTuple):
    """What was found on one street."""

    street: str
    score: FileScore


def request_of(number: int, seed: int, length_m: float) -> StreetRequest:
    """The street of a seed: styles and scanners take turns, every other one is worn."""
    make = worn_options_of if number % 2 else options_of
    style = _STYLES[number % len(_STYLES)]
    return replace(make(number, seed, length_m), style=style, passes=1, stops=False)


def rows_of(scenes: Iterator[RoadScene]) -> Iterator[BarrierRow]:
    """What the tool finds with its own parameters on each."""
    for scene in scenes:
        result = found_by("barriers", scene.drives).result
        yield BarrierRow(scene.name, barrier_score(result, read_mapped(scene.truth("barriers"))))


def section_of(rows: Sequence[BarrierRow]) -> str:
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


def main(arguments: Sequence[str] | None = None) -> int:
    """Write the table to a page, or to standard output."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--markdown", type=Path)
    parser.add_argument("--seeds", default=_SEEDS)
    parser.add_argument("--length", type=float, default=60.0)
    parser.add_argument("--deliveries", type=Path, nargs="*", default=[])
    options = parser.parse_args(arguments)
    rows = list(rows_of(simulated_scenes(seeds_of(options.seeds), options.length, request_of)))
    rows += rows_of(given_scenes(options.deliveries))
    write_sections(options.markdown, {_HEADING: section_of(rows)})
    return 0


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())
