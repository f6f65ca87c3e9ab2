"""Covered gutters by heads of any height, tilt and rate: how good, how far, how certain.

``python -m processing.laboratory.accuracy.road.gutter_mountings --markdown docs/accuracy.md``
simulates streets of seeds that nobody looked at, each recorded by other heads, and runs the tool
with its own parameters. ``--samples FOLDER…`` adds deliveries with ``truth/``, which the program's
own simulator did not make and nothing was learnt from; what confidence means is told of both apart.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from processing.core.arrays import Floats
from processing.core.output_streams import write_every_character
from processing.core.safe_write import write_safely
from processing.formats.vectors.mapped_shapes import read_mapped
from processing.laboratory.accuracy.filters.filter_tables import markdown_table
from processing.laboratory.accuracy.filters.filters import replace_section
from processing.laboratory.accuracy.road.road_edges import certainties
from processing.laboratory.accuracy.road.road_scenes import (
    BOTH,
    RoadScene,
    found_by,
    given_scenes,
    mounted_scenes,
)
from processing.laboratory.accuracy.road.road_tables import (
    ScoredStreet,
    gutters_table,
    reliability_table,
)
from processing.recording.passes import passes_of
from processing.scoring.features.gutters import gutter_score, score_gutters
from processing.scoring.points.reliability import Reliability, reliability_of_pairs

SEEDS = range(2210, 2220)
LENGTH_M = 60.0
_TOOL = "gutters"
_BANDS_M = (0.0, 4.0, 5.0, 5.5, 6.0, 6.5, np.inf)
"""As far as gutters are found, half a metre at a time."""

_HEADING = "## Covered gutters by heads of any height, tilt and rate"
_COMMAND = (
    "`python -m processing.laboratory.accuracy.road.gutter_mountings --markdown docs/accuracy.md`"
)
_ABOUT = f"""{_COMMAND}: streets of 60 m of seeds that nobody looked at, each recorded by one head \
or two that are mounted 1.6 to 3.9 m above the road, look across, ahead or back, tilted by 10 to \
45°, turn 50 to 250 times a second and measure 200,000 to 1,000,000 points a second with 1 to 8 mm \
of noise. Streets by name are deliveries of another simulator (`--samples`), from which nothing \
was learnt. Counted as above. What is missed most are whole rows of lids where the scanner turns \
slowly: at 54 turns a second and 44 km/h rows lie 23 cm apart, so that one in eight crosses a hole \
of 3 cm, and from some 4.5 m beams come in so flat that most of those meet its rim. Fewer gratings \
than lids are found, for from afar their bars hide what is between them.
"""
_ABOUT_REACH = """Slots of 0.6 m by how far from the vehicle's path they lie:
"""
_ABOUT_CONFIDENCE = """What confidence means, of the own simulator's streets and of the other's:
"""

_Judged = list[tuple[float, bool]]


class MountingScores:
    """What is known so far: scores, slots by distance, candidates by confidence."""

    def __init__(self) -> None:
        self.streets: list[ScoredStreet] = []
        self.slots: list[tuple[float, bool]] = []
        self.judged: dict[str, _Judged] = {"own streets": [], "the other's": []}

    def add(self, scene: RoadScene, simulator: str) -> None:
        """Run the tool on a street, with all heads, and score it."""
        truth = read_mapped(scene.truth(_TOOL))
        result = found_by(_TOOL, scene.drives).result
        count = len(result.features)
        self.streets.append(ScoredStreet(scene.name, BOTH, gutter_score(result, truth), count))
        self.judged[simulator] += certainties(_TOOL, result, truth)
        covers, way = score_gutters(result, truth), cKDTree(_way(scene))
        for places, is_found in ((covers.found, True), (covers.missed, False)):
            away, _ = way.query(places[:, :2])
            self.slots += [(float(one), is_found) for one in np.atleast_1d(away)]

    def reliabilities(self) -> dict[str, Reliability]:
        """Of each simulator's streets."""
        return {name: reliability_of_pairs(pairs) for name, pairs in self.judged.items()}

    def section(self) -> str:
        """Of the page."""
        rows = [["from the vehicle's path", "slots: found, missed", "R"]]
        for low, high in pairwise(_BANDS_M):
            inside = [is_found for away, is_found in self.slots if low <= away < high]
            found, missed = sum(inside), len(inside) - sum(inside)
            name = f"beyond {low:g} m" if np.isinf(high) else f"{low:g} to {high:g} m"
            share = f"{100 * found / len(inside):.1f} %" if inside else "–"
            rows.append([name, f"{found:,}, {missed:,}", share])
        return (
            f"{_HEADING}\n{_ABOUT}\n{gutters_table(self.streets)}\n{_ABOUT_REACH}\n"
            f"{markdown_table(rows)}\n{_ABOUT_CONFIDENCE}\n{reliability_table(self.reliabilities())}"
        )


def _way(scene: RoadScene) -> Floats:
    """(n, 2) places of the vehicle's paths."""
    passes = [one for drive in scene.drives for one in passes_of(drive)]
    return np.vstack([one.vehicle_path.positions[:, :2] + one.origin[:2] for one in passes])


def main(arguments: Sequence[str] | None = None) -> int:
    """Write the tables to a page, or to standard output."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--markdown", type=Path)
    parser.add_argument("--samples", type=Path, nargs="*", default=[])
    parser.add_argument("--seeds", type=int, nargs="*", default=list(SEEDS))
    parser.add_argument("--length", type=float, default=LENGTH_M)
    options = parser.parse_args(arguments)
    scores = MountingScores()
    for scene, simulator in _scenes(options):
        sys.stderr.write(f"{scene.name}: {scene.points:,} points\n")
        scores.add(scene, simulator)
    section = scores.section()
    if options.markdown is None:
        sys.stdout.write(f"{section}\n")
        return 0
    page = replace_section(options.markdown.read_text("utf-8"), _HEADING, section)
    with write_safely(options.markdown) as path:
        path.write_text(page, "utf-8")
    return 0


def _scenes(options: argparse.Namespace) -> Iterator[tuple[RoadScene, str]]:
    for scene in given_scenes(options.samples):
        yield scene, "the other's"
    for scene in mounted_scenes(options.seeds, options.length):
        yield scene, "own streets"


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())
