"""Walls and faces of buildings against known streets of seeds by which nothing was learnt.

``python -m processing.laboratory.accuracy.road_map.walls --markdown docs/accuracy.md``
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


class WallRow(NamedTuple):
    """What was found on one street."""

    street: str
    score: FileScore


def request_of(number: int, seed: int, length_m: float) -> StreetRequest:
    """The street of a seed: styles and scanners take turns, every other one drifts."""
    make = worn_options_of if number % 2 else options_of
    style = _STYLES[number % len(_STYLES)]
    return replace(make(number, seed, length_m), style=style, passes=1, stops=False)


def rows_of(scenes: Iterator[RoadScene]) -> Iterator[WallRow]:
    """What the tool finds with its own parameters on each."""
    for scene in scenes:
        result = found_by("walls", scene.drives).result
        yield WallRow(scene.name, wall_score(result, read_mapped(scene.truth("walls"))))


def section_of(rows: Sequence[WallRow]) -> str:
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
