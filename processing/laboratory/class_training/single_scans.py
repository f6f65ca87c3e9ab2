"""Makes the models for single scans of spinning heads anew.

``python -m processing.laboratory.class_training.single_scans``

Needs the extra ``train``. Streets of ``--seeds`` are measured by single turns of spinning heads
with any number of beams; streets of ``--profiles`` and, by heads of any mounting, of ``--mounted``
are recorded and thinned until most places have a few points only. Spinning scans of ``--check`` are
only scored. ``--score-only`` leaves the models as they are. The same seeds give the same models.
"""

from __future__ import annotations

import argparse
import itertools
import sys
from collections.abc import Iterator, Sequence
from functools import reduce
from operator import add

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.laboratory.accuracy.road.road_scenes import (
    RoadScene,
    mounted_scenes,
    simulated_scenes,
)
from processing.laboratory.accuracy.road.true_labels import labels_of_drive
from processing.laboratory.class_training.examples import (
    LabelledCells,
    codes_of_cells,
    points_above_ground,
    rows_and_places,
)
from processing.laboratory.class_training.fitting import AveragedSize, ForestSize
from processing.laboratory.class_training.two_forests import (
    FOLDS,
    ForestPlan,
    SampledCells,
    make_averaged_trees,
    make_two_forests,
)
from processing.laboratory.progress_lines import say
from processing.laboratory.seed_ranges import seeds_of
from processing.laboratory.simulate.spinning_head import SCANS, scanned_streets
from processing.methods.classes.aerial_cells import aerial_cells
from processing.methods.classes.class_models import (
    SCAN_AGAIN,
    SCAN_ALONE,
    SCAN_AVERAGED,
    SCAN_CELL_M,
    scan_models,
)
from processing.methods.classes.drive_classes import shares_of_cells
from processing.recording.density import points_a_place
from processing.recording.drive import Drive
from processing.scoring.points.class_scores import class_score
from processing.scoring.points.confusion_matrix import ConfusionMatrix

_PLAN = ForestPlan(
    SCAN_ALONE,
    ForestSize(rounds=40, leaves=24, rate=0.2),
    SCAN_AGAIN,
    ForestSize(rounds=30, leaves=20, rate=0.2),
)

_AVERAGED = AveragedSize(trees=30, leaves=3000, asked=0.13)

_CELLS = 250
"""Of each class and cloud that are learnt from."""

_PLACES = ((1.0, 2.5), (2.5, 6.0))
"""Of a recording that is thinned: points in half of its places, at most, of its two variants."""

_STEPS, _ROWS = 20, 0.6
"""Steps of thinning at most, and how often one leaves out rows rather than points of a row."""

_NOISES_M = (0.0, 0.005, 0.015)
"""Standard deviations of what is added to recordings along each axis."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Make the models, or only score those that are there."""
    parser = argparse.ArgumentParser(
        prog="python -m processing.laboratory.class_training.single_scans"
    )
    parser.add_argument("--seeds", default="4000-4063", help="streets of spinning heads")
    parser.add_argument("--profiles", default="3000-3003", help="streets that are thinned")
    parser.add_argument("--mounted", default="3140-3147", help="those by heads of any mounting")
    parser.add_argument("--check", default="4064-4075", help="spinning heads that are only scored")
    parser.add_argument("--length", type=float, default=60.0, help="m of thinned streets")
    parser.add_argument("--score-only", action="store_true")
    options = parser.parse_args(arguments)
    if not options.score_only:
        _make(options)
    matrices = [_matrix_of(one) for one in _spinning(seeds_of(options.check))]
    if matrices:
        score = class_score(reduce(add, matrices))
        by_class = " ".join(f"{one.id}:{one.counts.f_measure:.2f}" for one in score.classes)
        say(f"spinning heads {options.check}: {by_class}")
    return 0


def _make(options: argparse.Namespace) -> None:
    rng = np.random.default_rng(0)
    folds: list[list[SampledCells]] = [[] for _ in range(FOLDS)]
    scenes = itertools.chain(
        simulated_scenes(seeds_of(options.profiles), options.length),
        mounted_scenes(seeds_of(options.mounted), options.length),
    )
    clouds = itertools.chain(
        _spinning(seeds_of(options.seeds)),
        itertools.chain.from_iterable(_thinned(scene, rng) for scene in scenes),
    )
    for number, cells in enumerate(clouds):
        folds[number // SCANS % FOLDS].append(SampledCells.of(cells, _CELLS, rng))
    make_two_forests(folds, _PLAN)
    make_averaged_trees(itertools.chain(*folds), SCAN_AVERAGED, _AVERAGED)
    scan_models.cache_clear()


def _spinning(seeds: Sequence[int]) -> Iterator[LabelledCells]:
    """Single scans of streets of any style."""
    for _, scans in scanned_streets(seeds):
        for scan in scans:
            yield labelled_scan_cells(scan.xyz, scan.labels)


def _thinned(scene: RoadScene, rng: Generator) -> Iterator[LabelledCells]:
    """Recordings of a street, thinned until most places have a few points only."""
    truth = scene.delivery / "truth"
    for drive in scene.drives:
        labels, xyz = labels_of_drive(drive, truth), drive.xyz(slice(0, drive.count))
        for bounds in _PLACES:
            kept = _sparse_points(drive, xyz, rng.uniform(*bounds), rng)
            shaken = rng.normal(0.0, rng.choice(_NOISES_M), (kept.size, 3))
            yield labelled_scan_cells(xyz[kept] - xyz[kept].min(axis=0) + shaken, labels[kept])


def _sparse_points(drive: Drive, xyz: Floats, most: float, rng: Generator) -> Integers:
    """Every so many rows and points of a row, so that half of the places have no more points."""
    rows, places = rows_and_places(drive)
    every_row = every_point = 1
    kept = np.arange(drive.count)
    for _ in range(_STEPS):
        kept = np.flatnonzero((rows % every_row == 0) & (places % every_point == 0))
        if points_a_place(xyz[kept]) <= most:
            break
        if rng.random() < _ROWS:
            every_row += 1
        else:
            every_point += 1
    return kept


def labelled_scan_cells(xyz: Floats, labels: NDArray[np.uint8]) -> LabelledCells:
    """Cells of a sparse cloud as ``classify`` makes them, with their classes.

    Parameters
    ----------
    xyz : (n, 3) float64
        m about an origin near by.
    labels : (n,) uint8
        Codes of the contract.
    """
    alone = np.ones(len(xyz), np.bool_)
    points = points_above_ground(xyz - xyz.min(axis=0), alone, alone)
    cells = aerial_cells(points, SCAN_CELL_M, SilentMonitor())
    return LabelledCells(cells, codes_of_cells(cells, labels))


def _matrix_of(cells: LabelledCells) -> ConfusionMatrix:
    models = scan_models()
    shares = shares_of_cells(cells.cells, models, SilentMonitor())
    return ConfusionMatrix.of(cells.codes, models.again.codes[shares.argmax(axis=1)])


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())
