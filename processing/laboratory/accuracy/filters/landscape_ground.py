"""Ground of simulated landscapes recorded from the air, as a table, ours beside peers'.

``python -m processing.laboratory.accuracy.filters.landscape_ground --markdown docs/accuracy.md``
makes the page's section; without ``--markdown`` it is written to standard output. ``--seeds`` says
how many landscapes of each kind are drawn.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from processing.core.output_streams import write_every_character
from processing.laboratory.accuracy.filters.filter_methods import FilterMethod, airborne_methods
from processing.laboratory.accuracy.filters.filter_scenes import FilterScene
from processing.laboratory.accuracy.filters.filter_tables import markdown_table
from processing.laboratory.accuracy.filters.filters import write_sections
from processing.laboratory.simulate.airborne.flight import fly_over
from processing.laboratory.simulate.airborne.landscapes import landscape_of
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix, ConfusionMatrix

HEADING = "## Ground of simulated landscapes from the air"

_FIRST_SEED, _SEEDS = 2001, 2
"""Landscapes that no value of the filter was chosen by."""

_METHODS = ("adaptive", "PTD (Axelsson)", "roller")
"""Ours, and the peers that need no installation, with their first settings."""

_GROUND, _OBJECT = 2, 1


@dataclass(frozen=True)
class Flight:
    """Side of a landscape and distance of the points in a strip, m."""

    extent_m: float
    spacing_m: float


FLIGHTS: Mapping[str, Flight] = {
    "hillside": Flight(200.0, 1.4),
    "town": Flight(200.0, 1.3),
    "station": Flight(200.0, 1.3),
    "bridge": Flight(200.0, 1.5),
    "river": Flight(300.0, 3.2),
    "quarry": Flight(300.0, 3.2),
    "embankment": Flight(300.0, 3.2),
}
"""As the ISPRS filter test has them: towns at 1 to 1.5 m, the country at 2 to 3.5 m."""


def main(arguments: list[str]) -> int:
    """Score the filters on landscapes of every kind."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--markdown", type=Path)
    parser.add_argument("--seeds", type=int, default=_SEEDS)
    chosen = parser.parse_args(arguments)
    seeds = range(_FIRST_SEED, _FIRST_SEED + chosen.seeds)
    table = markdown_table(list(landscape_rows(FLIGHTS, seeds)))
    write_sections(chosen.markdown, {HEADING: f"{_ABOUT}\n{table}"})
    return 0


def landscape_rows(flights: Mapping[str, Flight], seeds: Sequence[int]) -> Iterator[list[str]]:
    """Rows of cells, the head first: one for each kind, over all its seeds, and the mean."""
    methods = {one.name: one for one in reversed(airborne_methods()) if one.name in _METHODS}
    head = ["kind", "spacing", "points"]
    yield [*head, *(f"{name}, {word}" for name in _METHODS for word in ("total", "kappa"))]
    figures = []
    for kind, flight in flights.items():
        sums = np.zeros((len(_METHODS), 4), np.int64)
        for seed in seeds:
            scene = _scene(kind, seed, flight)
            sums += [_counts(scene, methods[name]) for name in _METHODS]
        found = [BinaryConfusionMatrix(*(int(one) for one in own)) for own in sums]
        figures.append([figure for one in found for figure in (one.total_error, one.kappa)])
        points = int(sums[0].sum())
        yield [kind, f"{flight.spacing_m:g} m", f"{points:,}", *_shown(figures[-1])]
    yield ["**mean**", "", "", *_shown(np.mean(figures, axis=0).tolist())]


def _scene(kind: str, seed: int, flight: Flight) -> FilterScene:
    points = fly_over(landscape_of(kind, seed, flight.extent_m), seed, flight.spacing_m)
    truth = np.where(points.is_ground, _GROUND, _OBJECT).astype(np.uint8)
    return FilterScene(f"{kind} {seed}", None, None, points.xyz, truth, {})


def _counts(scene: FilterScene, method: FilterMethod) -> tuple[int, int, int, int]:
    """Ground found, things taken for it, ground lost and things found."""
    with tempfile.TemporaryDirectory(prefix="zuka-") as folder:
        codes = method.codes(scene, Path(folder))
    if codes is None:
        raise TypeError(f"{method.name} gave no codes")
    one = ConfusionMatrix.of(scene.truth, codes).against_rest((_GROUND,))
    return one.hits, one.false_alarms, one.misses, one.rejections


def _shown(figures: Sequence[float]) -> list[str]:
    """Total error and kappa, by turns."""
    return [
        f"{figure:.3f}" if number % 2 else f"{100 * figure:.2f} %"
        for number, figure in enumerate(figures)
    ]


_ABOUT = """\
`python -m processing.laboratory.accuracy.filters.landscape_ground --markdown docs/accuracy.md` \
makes this section: two landscapes of each kind that the ISPRS filter test names as hard, drawn \
anew and recorded from the air by first and last returns of two crossing strips, with seeds that \
no value was chosen by. The peers have their first settings, which know no truth; none is given a \
cloud without the points that lie metres below the ground.
"""


if __name__ == "__main__":
    write_every_character()
    sys.exit(main(sys.argv[1:]))
