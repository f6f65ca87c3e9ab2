"""Curbs and covered gutters at two speeds and by two kinds of scanner, by side of the road.

``python -m processing.laboratory.accuracy.road.speeds_and_scanners --markdown docs/accuracy.md``
drives the same simulated streets at both speeds with both scanners and runs the tools with one set
of parameters, their own, as Takahashi 2022, section 6.5, did with his streets.
"""

from __future__ import annotations

import argparse
import sys
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.formats.vectors.mapped_shapes import read_mapped
from processing.laboratory.accuracy.filters.filter_tables import markdown_table
from processing.laboratory.accuracy.filters.filters import write_sections
from processing.laboratory.accuracy.road.road_scenes import (
    RoadScene,
    found_by,
    opened_scene,
)
from processing.laboratory.accuracy.road.road_tables import percent
from processing.laboratory.simulate.requests import StreetRequest
from processing.laboratory.simulate.streets import simulate_street
from processing.methods.road.curbs.edges.curb_fronts import PathSides
from processing.scoring.features.curb_lines import score_edges
from processing.scoring.features.gutters import score_gutters
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix

SPEEDS_KM_H = (20.0, 50.0)
SCANNERS = {"vq250": "pulses, 100 turns/s", "zf9012": "phase, 200 turns/s"}
"""Of the two kinds with which the thesis recorded: MX-8 and Pegasus:Two."""

STREETS = {7401: "urban", 7402: "rural"}
LENGTH_M = 50.0
SIDES = ("left", "right")

_HEADING = "## Curbs and gutters at two speeds and by two kinds of scanner"
_ABOUT = """`python -m processing.laboratory.accuracy.road.speeds_and_scanners --markdown \
docs/accuracy.md`: the same simulated streets of seeds that nobody looked at, driven at both \
speeds with both scanners (all heads of each), by side of the road as seen in driving direction; \
one set of parameters, the tools' own. Curbs in 2 m sections of both edges within 10 cm, without \
dropped ones, gutters in slots of 0.6 m. The thesis tells its own curbs so (table 6-4: the left \
head of an MX-8 at two speeds that it doesn't name); it compares its gutters by head only.
"""
_THESIS = (
    ("thesis, cloud A, left", "95.37 %", "93.71 %", "94.53 %"),
    ("thesis, cloud A, right", "94.96 %", "93.62 %", "94.29 %"),
    ("thesis, cloud B, left", "96.50 %", "92.45 %", "94.43 %"),
    ("thesis, cloud B, right", "92.80 %", "92.41 %", "92.60 %"),
)
_NONE = BinaryConfusionMatrix(0, 0, 0, 0)


class SideOfCloud(NamedTuple):
    """One side of the road in one of the clouds."""

    scanner: str
    speed_km_h: float
    side: str


@dataclass(frozen=True)
class SideCounts:
    """Sections of curbs and slots of gutters that were found, false and missed."""

    curbs: BinaryConfusionMatrix = _NONE
    gutters: BinaryConfusionMatrix = _NONE

    def __add__(self, other: SideCounts) -> SideCounts:
        """Of two streets together."""
        return SideCounts(self.curbs + other.curbs, self.gutters + other.gutters)


def score_sides(scene: RoadScene) -> dict[str, SideCounts]:
    """What both tools find on either side of a street."""
    sides = PathSides(scene.drives)
    truth = {tool: read_mapped(scene.truth(tool)) for tool in ("curbs", "gutters")}
    found = {tool: found_by(tool, scene.drives).result for tool in truth}
    edges = score_edges(found["curbs"], truth["curbs"])
    covers = score_gutters(found["gutters"], truth["gutters"])
    sections = [
        (sides.is_left(one.xyz), is_found)
        for edge in edges.values()
        for one, is_found in zip(edge.asked, edge.is_found.tolist(), strict=True)
        if one.kind != "dropped"
    ]
    false = [
        sides.is_left(part) for edge in edges.values() for line in edge.lines for part in line.false
    ]
    slots = [(sides.is_left(one[None]), True) for one in covers.found]
    slots += [(sides.is_left(one[None]), False) for one in covers.missed]
    beside = [one[None] for one in covers.false] + [one.xyz for one in covers.beside]
    wrong = [sides.is_left(one) for one in beside]
    return {
        name: SideCounts(
            _count(sections, false, is_left=is_left), _count(slots, wrong, is_left=is_left)
        )
        for name, is_left in zip(SIDES, (True, False), strict=True)
    }


def section_of(counts: dict[SideOfCloud, SideCounts]) -> str:
    """The section of the page, without its heading."""
    heads = ["cloud", "side", "curbs: found, false, missed", "P", "R", "**F**"]
    heads += ["gutters: found, false, missed", "P", "R", "**F**"]
    rows = [heads]
    for one, both in counts.items():
        cloud = f"{one.scanner} ({SCANNERS[one.scanner]}), {one.speed_km_h:g} km/h"
        rows.append([cloud, one.side, *_figures(both.curbs), *_figures(both.gutters)])
    for side in SIDES:
        total = sum((both for one, both in counts.items() if one.side == side), SideCounts())
        rows.append(["**all**", side, *_figures(total.curbs), *_figures(total.gutters)])
    rows += [[name, "", "–", *figures, *["–"] * 4] for name, *figures in _THESIS]
    return f"{_ABOUT}\n{markdown_table(rows)}\n"


def main(arguments: Sequence[str] | None = None) -> int:
    """Write the table to a page, or to standard output."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--markdown", type=Path)
    parser.add_argument("--length", type=float, default=LENGTH_M)
    options = parser.parse_args(arguments)
    counts: dict[SideOfCloud, SideCounts] = defaultdict(SideCounts)
    for scanner, speed_km_h, scene in _clouds(options.length):
        sys.stderr.write(f"{scene.name}: {scene.points:,} points\n")
        for side, both in score_sides(scene).items():
            counts[SideOfCloud(scanner, speed_km_h, side)] += both
    write_sections(options.markdown, {_HEADING: section_of(counts)})
    return 0


def _clouds(length_m: float) -> Iterator[tuple[str, float, RoadScene]]:
    for scanner in SCANNERS:
        for speed_km_h in SPEEDS_KM_H:
            for seed, style in STREETS.items():
                request = StreetRequest(
                    seed=seed,
                    length_m=length_m,
                    style=style,
                    sensor=scanner,
                    speed_km_h=speed_km_h,
                    images=False,
                )
                name = f"{style} {scanner} {speed_km_h:g} km/h {seed}"
                with TemporaryDirectory(prefix="zuka-") as position:
                    folder = Path(position) / "street"
                    simulate_street(request, folder, SilentMonitor())
                    with opened_scene(name, folder) as scene:
                        yield scanner, speed_km_h, scene


def _count(
    asked: Sequence[tuple[bool, bool]], false: Sequence[bool], *, is_left: bool
) -> BinaryConfusionMatrix:
    """Of one side, from (is it left, is it found) of what is asked for, and what is false."""
    ours = [is_found for side, is_found in asked if side == is_left]
    return BinaryConfusionMatrix(
        sum(ours), sum(side == is_left for side in false), len(ours) - sum(ours), 0
    )


def _figures(counts: BinaryConfusionMatrix) -> list[str]:
    told = f"{counts.hits:,}, {counts.false_alarms:,}, {counts.misses:,}"
    return [told, *map(percent, (counts.precision, counts.recall, counts.f_measure))]


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())
