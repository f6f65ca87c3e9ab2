"""Street trees: how many are found, and how well their trunks are measured.

``python -m processing.laboratory.accuracy.road.trees --samples FOLDER… --real FILE…
--markdown docs/accuracy.md``. Scores the tool on own streets of unlearnt seeds and on
deliveries, measures the same trunks as others do, and compares trunks that were scanned by
themselves.
"""

from __future__ import annotations

import argparse
import itertools
import math
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path

from processing.core.output_streams import write_every_character
from processing.laboratory.accuracy.filters.filters import write_sections
from processing.laboratory.accuracy.road.baselines.tree_baselines import WAYS, own_diameter
from processing.laboratory.accuracy.road.road_tables import reliability_table
from processing.laboratory.accuracy.road.tree_labellings import (
    FoundTrees,
    found_trees,
    labellings_table,
)
from processing.laboratory.accuracy.road.tree_scenes import (
    ScoredTrees,
    given_tree_scenes,
    own_scenes,
    score_scene,
    standing_trees,
    trunk_points,
)
from processing.laboratory.accuracy.road.tree_tables import (
    MeasuredTrunk,
    failures_of,
    heads_table,
    kinds_table,
    real_table,
    streets_table,
    ways_table,
)
from processing.scoring.features.object_matches import shows_enough
from processing.scoring.features.trees import LEAST_ARC_DEG
from processing.scoring.points.reliability import reliability_of_pairs

_COMMAND = "`python -m processing.laboratory.accuracy.road.trees --markdown docs/accuracy.md`"
_ABOUT = f"""{_COMMAND} (with `--samples FOLDER…`, deliveries of another simulator, and `--real \
FILE…`): own streets of 60 m, avenues with large touching crowns over posts and \
lamps, and usual streets, all with the tool's own parameters. Those of seeds below 9601 were \
looked at, while the method was made or since they were first scored. A tree counts as the thesis \
has it, within 2 m, but one to one, if 20 points on its trunk show it. Diameters are those of \
trunks of which 60° and more were seen, stakes included; “within” is the share whose error is no \
greater than `dbh_within_m`, which should be 95 %.
"""
_LABELLINGS = "### Trees as the thesis finds them"
_ABOUT_KINDS = """The same trees; of deliveries by what is special about them, where they say so.
"""
_ABOUT_WAYS = """The same trunks, with the points within 0.9 m of the true foot, measured in \
other ways: RMS and greatest error of those that were measured at all.
"""
_ABOUT_LABELLINGS = """The thesis' own way of finding trees needs classes of points that are \
known before: it keeps crowns, posts and buildings of one head, wires their pixels, and takes \
components with a column of circles whose smoothed edges point anywhere. Its thresholds are \
not told; chosen ones were not calibrated. This program needs no classes.
"""
_ABOUT_REAL = """Trees that were scanned by themselves; nobody taped them, so this compares and \
does not judge.
"""


def main(arguments: Sequence[str] | None = None) -> int:
    """Write the tables to a page, or to standard output."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--markdown", type=Path)
    parser.add_argument("--samples", type=Path, nargs="*", default=[])
    parser.add_argument("--real", type=Path, nargs="*", default=[])
    parser.add_argument("--only-samples", action="store_true")
    parser.add_argument("--labellings", action="store_true")
    options = parser.parse_args(arguments)
    own = () if options.only_samples else own_scenes()
    streets: list[ScoredTrees] = []
    trunks: list[MeasuredTrunk] = []
    labelled: list[FoundTrees] = []
    for scene in itertools.chain(own, given_tree_scenes(options.samples)):
        streets.append(score_scene(scene))
        trunks += measured_trunks(streets[-1])
        labelled += found_trees(streets[-1]) if options.labellings else []
        sys.stderr.write(f"{scene.name}: {streets[-1].matches.counts}\n")
    sections = sections_of(streets, trunks, options.real)
    if labelled:
        sections[_LABELLINGS] = f"{_ABOUT_LABELLINGS}\n{labellings_table(labelled)}\n"
    write_sections(options.markdown, sections)
    return 0


def measured_trunks(street: ScoredTrees) -> Iterable[MeasuredTrunk]:
    """The trunks of a street in all ways."""
    truth = street.scene.truth
    found = {one.truth.number: street.number(one, "dbh_m") for one in street.matches.partners}
    for true, points in zip(truth.features, trunk_points(street.scene), strict=True):
        if true.number in found and shows_enough(truth, true, "arc_deg", LEAST_ARC_DEG):
            heads = [
                own_diameter(points.of_drive(number)) for number in range(len(street.scene.drives))
            ]
            yield MeasuredTrunk(
                street.scene.group,
                truth.number(true, "dbh_m"),
                is_staked=truth.number(true, "stakes") > 0,
                is_multiple=truth.number(true, "stems") > 1,
                by_way={
                    "this program": found[true.number],
                    **{name: way(points) for name, way in WAYS.items()},
                },
                by_head=tuple(one for one in heads if not math.isnan(one)),
            )


def sections_of(
    streets: Sequence[ScoredTrees], trunks: Sequence[MeasuredTrunk], real: Sequence[Path]
) -> dict[str, str]:
    """The sections of the page by their headings."""
    judged = [pair for one in streets for pair in one.judged]
    sections = {
        "## Street trees": f"{_ABOUT}\n{streets_table(streets)}\n",
        "### Trees by species and leaves": f"{_ABOUT_KINDS}\n{kinds_table(streets)}\n",
        "### Trunks measured otherwise": f"{_ABOUT_WAYS}\n{ways_table(trunks)}\n\n"
        f"{heads_table(trunks)}\n",
        "### Confidence of trees": "All candidates of these streets, unlikely ones included.\n\n"
        f"{reliability_table({'trees': reliability_of_pairs(judged)})}\n",
        "### Trees that were not found, and what was taken for trees": failures_of(streets),
    }
    if real:
        told = {name: one for path in real for name, one in standing_trees(path).items()}
        ways = {name: {way: f(one) for way, f in WAYS.items()} for name, one in told.items()}
        sections["### Trees scanned by themselves"] = f"{_ABOUT_REAL}\n{real_table(ways)}\n"
    return sections


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())
