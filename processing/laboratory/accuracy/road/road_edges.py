"""Curbs and covered gutters on streets whose truth is known: how good, where not, how certain.

``python -m processing.laboratory.accuracy.road.road_edges --markdown docs/accuracy.md`` simulates
streets of seeds that nobody looked at, imports them and runs both tools with their own parameters.
``--samples FOLDER…`` adds deliveries with ``truth/``; ``--pictures FOLDER`` paints every failure on
sheets; ``--seeds`` takes other streets.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import chain
from pathlib import Path

from processing.core.output_streams import write_every_character
from processing.core.safe_write import write_safely
from processing.formats.vectors.mapped_shapes import read_mapped
from processing.laboratory.accuracy.filters.filters import replace_section
from processing.laboratory.accuracy.road.reliability_svg import reliability_svg
from processing.laboratory.accuracy.road.road_failures import curb_failures
from processing.laboratory.accuracy.road.road_gutter_failures import gutter_failures
from processing.laboratory.accuracy.road.road_pictures import (
    Picture,
    RoadMaps,
    paint_failure,
    write_sheets,
)
from processing.laboratory.accuracy.road.road_reach import Reached, count_by_reach, reach_table
from processing.laboratory.accuracy.road.road_scenes import (
    BOTH,
    LENGTH_M,
    RoadRun,
    RoadScene,
    cloud_of,
    found_by,
    given_scenes,
    simulated_scenes,
)
from processing.laboratory.accuracy.road.road_surroundings import Failure, StreetSurroundings
from processing.laboratory.accuracy.road.road_tables import (
    ScoredStreet,
    curbs_table,
    failures_table,
    gutters_table,
    heads_table,
    reliability_table,
)
from processing.scoring.features.curb_lines import curb_score, score_edges
from processing.scoring.features.gutters import gutter_score, score_gutters
from processing.scoring.features.mapped_features import MappedFile
from processing.scoring.points.reliability import Reliability, reliability_of_pairs

SEEDS = range(1007, 1019)
TOOLS = ("curbs", "gutters")
LEAST_RIGHT = 0.8
"""So much of a line must lie along true edges for it to be right as a candidate."""
PLOT = "reliability_road.svg"

_SCORES = {"curbs": curb_score, "gutters": gutter_score}
_COMMAND = "`python -m processing.laboratory.accuracy.road.road_edges --markdown docs/accuracy.md`"


@dataclass
class RoadScores:
    """What is known so far.

    Attributes
    ----------
    streets : dict
        By tool, what it scored on each street with each head.
    judged : dict
        By tool, the confidence of each candidate and whether it is right.
    reached : list of Reached
        What was asked for on each street, by how far from the vehicle's path it lies.
    failures : list of Failure
    pictures : list
        Of the failures, where they were wanted.
    notes : list of str
        What tools said of streets on which they found little.
    """

    streets: dict[str, list[ScoredStreet]] = field(default_factory=lambda: {t: [] for t in TOOLS})
    judged: dict[str, list[tuple[float, bool]]] = field(
        default_factory=lambda: {t: [] for t in TOOLS}
    )
    reached: list[Reached] = field(default_factory=list)
    failures: list[Failure] = field(default_factory=list)
    pictures: list[tuple[Failure, Picture]] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    def add(self, scene: RoadScene, *, with_pictures: bool) -> None:
        """Run both tools on a street, with each head and with both, and score them."""
        truths = {tool: read_mapped(scene.truth(tool)) for tool in TOOLS}
        runs: dict[str, RoadRun] = {}
        for head, drives in scene.heads().items():
            for tool in TOOLS:
                runs[tool] = found_by(tool, drives)
                self.streets[tool].append(
                    ScoredStreet(
                        scene.name,
                        head,
                        _SCORES[tool](runs[tool].result, truths[tool]),
                        len(runs[tool].result.features),
                    )
                )
        for tool in TOOLS:
            self.judged[tool] += certainties(tool, runs[tool].result, truths[tool])
            self.notes += [f"{scene.name}, {tool}: {note}" for note in runs[tool].notes]
        self._add_failures(scene, runs, truths, with_pictures=with_pictures)

    def of_both(self, tool: str) -> list[ScoredStreet]:
        """What was scored with all heads together."""
        return [one for one in self.streets[tool] if one.head == BOTH]

    def reliabilities(self) -> dict[str, Reliability]:
        """Of each tool, over all streets."""
        return {tool: reliability_of_pairs(pairs) for tool, pairs in self.judged.items()}

    def _add_failures(
        self,
        scene: RoadScene,
        runs: dict[str, RoadRun],
        truths: dict[str, MappedFile],
        *,
        with_pictures: bool,
    ) -> None:
        around = StreetSurroundings(scene, cloud_of(scene.delivery))
        edges = score_edges(runs["curbs"].result, truths["curbs"])
        covers = score_gutters(runs["gutters"].result, truths["gutters"])
        found = [
            *curb_failures(scene.name, edges, around),
            *gutter_failures(scene.name, covers, truths["gutters"], around, truths["curbs"]),
        ]
        self.failures += found
        self.reached.append(count_by_reach(edges, covers, around))
        if with_pictures:
            maps = {tool: RoadMaps(truths[tool], runs[tool].result) for tool in TOOLS}
            self.pictures += [(one, paint_failure(one, maps[one.tool], around)) for one in found]


def certainties(tool: str, result: MappedFile, truth: MappedFile) -> list[tuple[float, bool]]:
    """Each candidate's confidence, and whether it is right.

    A line is right if `LEAST_RIGHT` of it lies along true edges, a cover if it shares half of its
    area with a true one of its type; covers on what nobody can see count neither way.
    """
    if tool == "gutters":
        covers = score_gutters(result, truth).is_right
        return [(result.number(one, "confidence"), is_right) for one, is_right in covers]
    lines = chain.from_iterable(edge.lines for edge in score_edges(result, truth).values())
    return [
        (result.number(one.feature, "confidence"), one.right_share >= LEAST_RIGHT) for one in lines
    ]


def sections_of(answers: RoadScores) -> dict[str, str]:
    """The sections of the page, by their headings."""
    curbs, gutters = answers.of_both("curbs"), answers.of_both("gutters")
    heads = {
        tool: [one for one in answers.streets[tool] if _has_heads(one, answers.streets[tool])]
        for tool in TOOLS
    }
    lack = "\n".join(f"- {note}" for note in answers.notes)
    return {
        "## Curbs": f"{_COMMAND}{_ABOUT_CURBS}\n{curbs_table(curbs)}",
        "## Covered gutters": f"{_ABOUT_GUTTERS}\n{gutters_table(gutters)}",
        "## Curbs and gutters with one head and with both": (
            f"{_ABOUT_HEADS}\n{heads_table(heads['curbs'], heads['gutters'])}"
        ),
        "## How far curbs and gutters are found": (
            f"{_ABOUT_REACH}\n{reach_table(answers.reached)}"
        ),
        "## Where curbs and gutters fail": (
            f"{_ABOUT_FAILURES}\n{failures_table(answers.failures)}"
            + (f"\nWhat the tools said of these streets:\n\n{lack}\n" if lack else "")
        ),
        "## Confidence of curbs and gutters": (
            f"{_ABOUT_CONFIDENCE}\n{reliability_table(answers.reliabilities())}"
            f"\n![Share that is right, by confidence]({PLOT})\n"
        ),
    }


def main(arguments: Sequence[str] | None = None) -> int:
    """Write the tables to a page, or to standard output."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--markdown", type=Path)
    parser.add_argument("--samples", type=Path, nargs="*", default=[])
    parser.add_argument("--seeds", type=int, nargs="*", default=list(SEEDS))
    parser.add_argument("--length", type=float, default=LENGTH_M)
    parser.add_argument("--pictures", type=Path)
    options = parser.parse_args(arguments)
    answers = RoadScores()
    for scene in _scenes(options):
        sys.stderr.write(f"{scene.name}: {scene.points:,} points\n")
        answers.add(scene, with_pictures=options.pictures is not None)
    if options.pictures is not None:
        write_sheets(answers.pictures, options.pictures)
    for heading, body in sections_of(answers).items():
        section = f"{heading}\n{body}"
        if options.markdown is None:
            sys.stdout.write(f"{section}\n")
            continue
        page = replace_section(options.markdown.read_text("utf-8"), heading, section)
        with write_safely(options.markdown) as path:
            path.write_text(page, "utf-8")
    if options.markdown is not None:
        curves = answers.reliabilities()
        with write_safely(options.markdown.with_name(PLOT)) as path:
            path.write_text(reliability_svg(curves, "confidence", "share that is right"), "utf-8")
    return 0


def _scenes(options: argparse.Namespace) -> Iterator[RoadScene]:
    yield from given_scenes(options.samples)
    yield from simulated_scenes(options.seeds, options.length)


def _has_heads(one: ScoredStreet, all_of_them: Sequence[ScoredStreet]) -> bool:
    """Whether a street was recorded by two heads."""
    return sum(other.name == one.name for other in all_of_them) > 2


_ABOUT_CURBS = """: simulated streets of 120 m of seeds that nobody looked at (styles, sensors, \
waits and second passes take turns), imported and run with the tool's own parameters. Counted as \
the thesis does: 2 m sections of each edge within 10 cm; what no points show counts neither way, \
what a vehicle hides in part is asked for.
"""
_ABOUT_GUTTERS = f"""{_COMMAND}: the same streets. Slots of 0.6 m along the gutter as the thesis \
counts them; lids and gratings one by one count from half of what both cover together.
"""
_ABOUT_HEADS = f"""{_COMMAND}: streets recorded by two heads, each alone and both in one run.
"""
_ABOUT_REACH = f"""{_COMMAND}: all that is asked for, 2 m sections of edges with dropped curbs and \
slots of 0.6 m, by how far from the vehicle's path it lies: on other lanes and in side streets few \
points fall, at flat angles.
"""
_ABOUT_FAILURES = f"""{_COMMAND} `--pictures FOLDER`: every failure of the tables above, sorted by \
the truth's labels and things around it; a failure counts under the first type that fits. With \
`--pictures` each is painted, with its section, on sheets.
"""
_ABOUT_CONFIDENCE = f"""{_COMMAND}: all candidates of these streets. A line is right if 80 % of it \
lies along true edges, a lid if it shares half of what both cover with a true one.
"""


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())
