"""``python -m processing.score.gutter_training``: what tells lids and gratings, from known streets.

Simulates streets of ``--seeds``, finds covers on them without leaving any out, and fits the weights
of `processing.road.gutters.gutter_confidence` and `processing.road.gutters.grating_confidence` to
which of them are right; streets of ``--check`` are not learnt from. ``--deliveries`` are further
streets to learn from, recorded before. Prints the weights and how many covers of each confidence
are right: of streets learnt from by weights that were fitted without the street itself.
"""

from __future__ import annotations

import argparse
import itertools
import math
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

from processing.formats.mapped_shapes import read_mapped
from processing.monitor import SilentMonitor
from processing.road.gutters.grating_confidence import GratingTerms, terms_of
from processing.road.gutters.gutter_confidence import CoverFacts
from processing.score.gutters import judged_gutters
from processing.score.learnt_chances import (
    Expected,
    Known,
    chances,
    fitted,
    left_out,
    reliability,
    weights_told,
)
from processing.score.mapped_features import Floats, MappedFeature, MappedFile
from processing.score.road_scenes import RoadScene, given_scenes, simulated_scenes
from processing.tools.gutters import GutterParameters, gutter_evidence

_FACTS = {"lids": CoverFacts._fields, "gratings": GratingTerms._fields}
_EXPECTED = {
    "lids": Expected(
        (-4.0, *CoverFacts(0.8, 1.0, 1.0, 0.5, -10.0, -0.5, -0.5, -0.5, -0.5, -2.0)),
        (3.0, *CoverFacts(0.5, 0.7, 0.7, 0.4, 10.0, 0.5, 0.5, 0.5, 0.5, 1.5)),
    ),
    "gratings": Expected(
        (-12.0, *GratingTerms(2.0, 0.5, 4.0, 2.0, 1.5, -10.0)),
        (6.0, *GratingTerms(2.0, 0.5, 3.0, 1.5, 1.0, 10.0)),
    ),
}

# Terms, whether it is right, its worth, its street.
_Row = tuple[Sequence[float], bool, float, int]


def known_covers(scenes: Iterator[RoadScene]) -> dict[str, Known]:
    """All covers on some streets, by where they are from: rows of joints, open rectangles."""
    rows: dict[str, list[_Row]] = {name: [] for name in _FACTS}
    for number, scene in enumerate(scenes):
        for name, terms, is_right, worth in _judged(scene):
            rows[name].append((terms, is_right, worth, number))
        counts = ", ".join(f"{len(rows[name])} {name}" for name in rows)
        sys.stderr.write(f"{scene.name}: {counts}\n")
    return {name: Known.of(rows[name], len(_FACTS[name])) for name in rows}


def _judged(scene: RoadScene) -> Iterator[tuple[str, Sequence[float], bool, float]]:
    truth = read_mapped(scene.truth("gutters"))
    laid, gratings = gutter_evidence(scene.drives, GutterParameters(), SilentMonitor())
    for one in laid:
        # Covers of one gutter are right or wrong together.
        worth = 1.0 / math.sqrt(len(one.covers))
        corners = [(cover.corners, cover.is_grating) for cover in one.covers]
        for number, is_right in _which_are_right(corners, truth):
            yield "lids", one.facts[number], is_right, worth
    corners = [(found.corners, True) for found in gratings]
    for number, is_right in _which_are_right(corners, truth):
        yield "gratings", terms_of(gratings[number].facts), is_right, 1.0


def _which_are_right(
    covers: Sequence[tuple[Floats, bool]], truth: MappedFile
) -> Iterator[tuple[int, bool]]:
    """Places among covers, and whether each is right; not of those on what nobody can see."""
    features = tuple(
        MappedFeature(
            number,
            "area",
            corners,
            {
                "kind": "gutter_grating" if is_grating else "gutter_lid",
                "type": "grating" if is_grating else "lid",
            },
        )
        for number, (corners, is_grating) in enumerate(covers)
    )
    result = MappedFile(Path("gutters.geojson"), truth.crs, features)
    for feature, is_right in judged_gutters(result, truth).is_right:
        yield feature.number, is_right


def main(arguments: Sequence[str] | None = None) -> int:
    """The command."""
    parser = argparse.ArgumentParser(prog="python -m processing.score.gutter_training")
    parser.add_argument("--seeds", default="500-529", help="streets to learn from")
    parser.add_argument("--check", default="530-539", help="streets to check with")
    parser.add_argument("--length", type=float, default=60.0, help="m of each")
    parser.add_argument("--deliveries", type=Path, nargs="*", default=[])
    asked = parser.parse_args(arguments)
    learnt = simulated_scenes(_seeds(asked.seeds), asked.length)
    known = known_covers(itertools.chain(learnt, given_scenes(asked.deliveries)))
    check = known_covers(simulated_scenes(_seeds(asked.check), asked.length))
    for name, expected in _EXPECTED.items():
        weights = fitted(known[name], expected)
        sys.stdout.write(f"{name}\n{weights_told(_FACTS[name], weights)}")
        sys.stdout.write(f"\n{reliability(known[name], left_out(known[name], expected))}\n")
        sys.stdout.write(f"\n{reliability(check[name], chances(check[name], weights))}\n")
    return 0


def _seeds(text: str) -> range:
    """Numbers from one to another; of nothing none."""
    first, _, last = text.partition("-")
    return range(int(first), int(last or first) + 1) if first else range(0)


if __name__ == "__main__":
    sys.exit(main())
