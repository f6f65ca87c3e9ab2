"""What it gives curbs that the road's surface is looked for first.

``python -m processing.laboratory.accuracy.road.road_surface_first --markdown docs/accuracy.md``
scores lines of curbs on simulated streets with what the tool knows of the road's surface, and
without it.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.formats.vectors.mapped_shapes import read_mapped
from processing.laboratory.accuracy.filters.filter_tables import markdown_table
from processing.laboratory.accuracy.filters.filters import write_sections
from processing.laboratory.accuracy.road.road_scenes import (
    RoadScene,
    country_options_of,
    map_candidate,
    simulated_scenes,
    worn_options_of,
)
from processing.laboratory.accuracy.road.road_tables import percent
from processing.methods.road.curbs.edges.curb_features import CurbFeature, features_of
from processing.methods.road.curbs.steps.curb_confidence import CurbFacts, chance_of
from processing.scoring.features.curb_lines import score_edges
from processing.scoring.features.mapped_features import MappedFile
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix
from processing.tools.curbs import (
    CurbParameters,
    MeasuredCurb,
    curb_candidates,
    measure_curbs,
    step_settings,
    survey_runs,
)

COUNTRY, TOWN = range(7501, 7507), range(7511, 7514)
LENGTH_M = 60.0

_HEADING = "## Curbs with the road's surface looked for first"
_ABOUT = """`python -m processing.laboratory.accuracy.road.road_surface_first --markdown \
docs/accuracy.md`: the thesis suggests for its future that what is known of the road's surface \
should help to find curbs (section 9.2). Here the surface is what is as even as that which the \
vehicle drives on, and a line behind ground that isn't is doubted unless another curb stands \
between. The same lines of streets of seeds that nobody looked at (2 m sections of both edges \
within 10 cm, with dropped curbs), with that fact and without it; the other weights are the same.
"""


@dataclass(frozen=True)
class SurfaceRow:
    """Sections found, false and missed on a street, with the road's surface and without it."""

    name: str
    with_surface: BinaryConfusionMatrix
    without: BinaryConfusionMatrix


def score_street(scene: RoadScene) -> SurfaceRow:
    """The same lines of a street, taken for curbs with the road's surface and without it."""
    parameters, monitor = CurbParameters(), SilentMonitor()
    runs = survey_runs(scene.drives, step_settings(parameters), monitor)
    curbs = tuple(measure_curbs(scene.drives, runs, parameters, monitor))
    truth = read_mapped(scene.truth("curbs"))

    def count(facts_of: Callable[[CurbFacts], CurbFacts]) -> BinaryConfusionMatrix:
        edges = score_edges(_likely(curbs, facts_of, parameters), truth)
        counts = [one.counts(with_dropped=True) for one in edges.values()]
        return sum(counts, BinaryConfusionMatrix(0, 0, 0, 0))

    return SurfaceRow(
        scene.name, count(lambda facts: facts), count(lambda facts: facts._replace(verge_m=0.0))
    )


def section_of(streets: Sequence[SurfaceRow]) -> str:
    """The section of the page, without its heading."""
    rows = [["street", "without: found, false, missed", "F", "with: found, false, missed", "F"]]
    rows += [[one.name, *_cells(one.without), *_cells(one.with_surface)] for one in streets]
    none = BinaryConfusionMatrix(0, 0, 0, 0)
    totals = [
        sum((one.without for one in streets), none),
        sum((one.with_surface for one in streets), none),
    ]
    rows.append(["**all**", *_cells(totals[0]), *_cells(totals[1])])
    return f"{_ABOUT}\n{markdown_table(rows)}\n"


def main(arguments: Sequence[str] | None = None) -> int:
    """Write the table to a page, or to standard output."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--markdown", type=Path)
    parser.add_argument("--length", type=float, default=LENGTH_M)
    options = parser.parse_args(arguments)
    streets = [score_street(scene) for scene in _scenes(options.length)]
    write_sections(options.markdown, {_HEADING: section_of(streets)})
    return 0


def _scenes(length_m: float) -> Iterator[RoadScene]:
    yield from simulated_scenes(COUNTRY, length_m, country_options_of)
    yield from simulated_scenes(TOWN, length_m, worn_options_of)


def _likely(
    curbs: Sequence[MeasuredCurb],
    facts_of: Callable[[CurbFacts], CurbFacts],
    parameters: CurbParameters,
) -> MappedFile:
    """What is delivered of some lines if their facts are told otherwise."""
    features: list[CurbFeature] = []
    for one in curbs:
        chance = chance_of(facts_of(one.facts))
        if chance >= parameters.least_confidence:
            features.extend(features_of(one.approximate_line, one.line, one.measured, chance))
    candidates = enumerate(curb_candidates(features), start=1)
    mapped = tuple(map_candidate(one, number) for number, one in candidates)
    return MappedFile(Path("curbs.geojson"), "EPSG:6677", mapped)


def _cells(counts: BinaryConfusionMatrix) -> tuple[str, str]:
    told = f"{counts.hits:,}, {counts.false_alarms:,}, {counts.misses:,}"
    return told, percent(counts.f_measure)


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())
