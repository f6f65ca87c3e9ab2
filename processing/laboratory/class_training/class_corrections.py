"""How much five minutes of painting help in a strange city.

``python -m processing.laboratory.class_training.class_corrections FOLDER… --markdown FILE``

A street is classified, somebody corrects its first half, the program learns, and the other half is
classified again. The painter is made of the truth: fifty times, six seconds each, a class is chosen
and a place of it, every other time one that is wrong. Ground, road, grass and curbs get a stroke of
5 m with a brush of 0.4 m; of other things the connected segment within 5 m is clicked. What is no
thing of that class isn't painted, and what has its class already isn't changed, as in the window.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.laboratory.accuracy.parts_of_points import parts_of_points
from processing.laboratory.accuracy.road.road_scenes import RoadScene, given_scenes
from processing.laboratory.accuracy.road.true_labels import labels_of_drive
from processing.laboratory.class_training.examples import (
    NOISE,
)
from processing.methods.classes.class_models import ClassModels, shipped_models, shipped_sample
from processing.methods.classes.drive_classes import classify_drive
from processing.methods.classes.found_things import FoundThings
from processing.methods.classes.learning import learnt_forest
from processing.methods.classes.painted_cells import PaintedCells, PaintedLabels, painted_cells
from processing.recording.drive import Drive
from processing.scoring.points.class_scores import class_score
from processing.scoring.points.confusion_matrix import ConfusionMatrix
from processing.tools.found_things import look_for_things

_STROKES = 50
_BRUSHED = (2, 3, 11, 67)
_BRUSH_M, _STROKE_M, _SEGMENT_M, _LINK_M = 0.4, 5.0, 5.0, 0.3
_CELL_M = 0.1
_APART_M = 5.0
"""Of the street's middle to either side that is neither painted nor scored: as far as features
see."""

_HEAD = "| street | painted points | mean F before | after | gain |"
M = SilentMonitor()


@dataclass(frozen=True)
class StreetPoints:
    """All points of a street's drives, one after the other.

    Attributes
    ----------
    xyz : (n, 3) float64
        m.
    truth, said : (n,) uint8
    along_m : (n,) float64
        Metres along the street from its middle.
    things : FoundThings
        What tools found along it.
    """

    xyz: Floats
    truth: NDArray[np.uint8]
    said: NDArray[np.uint8]
    along_m: Floats
    things: FoundThings


def main(arguments: Sequence[str] | None = None) -> int:
    """Write a row for each street and painter."""
    parser = argparse.ArgumentParser(prog="class_corrections")
    parser.add_argument("folders", type=Path, nargs="+")
    parser.add_argument("--painters", type=int, default=2, help="of each street, seeds from 0")
    parser.add_argument("--markdown", type=Path)
    options = parser.parse_args(arguments)
    rows = [_HEAD, "|---|---|---|---|---|"]
    for scene in given_scenes(options.folders):
        street = _street_of(scene, shipped_models())
        for seed in range(options.painters):
            rows.append(_row_of(scene, street, seed))
            sys.stdout.write(f"{rows[-1]}\n")
            sys.stdout.flush()
    if options.markdown is not None:
        options.markdown.write_text("\n".join(rows) + "\n", encoding="utf-8")
    return 0


def _row_of(scene: RoadScene, street: StreetPoints, seed: int) -> str:
    shipped = shipped_models()
    painted = painted_codes(street, np.random.default_rng(seed))
    cells, start = list[PaintedCells](), 0
    for drive in scene.drives:
        own = slice(start, start + drive.count)
        labels = PaintedLabels(
            painted[own], np.where(painted[own] == 0, street.said[own], 0).astype(np.uint8)
        )
        with TemporaryDirectory(prefix="zuka-") as scratch:
            cells += painted_cells(drive, labels, Path(scratch), M, models=shipped)
        start += drive.count
    forest = learnt_forest(PaintedCells.joined(cells), shipped_sample(), shipped, M)
    learnt = replace(shipped, again=forest, is_own=True)
    after = np.concatenate([_said_of(drive, learnt, street.things) for drive in scene.drives])
    rest = street.along_m > _APART_M
    before_f, after_f = (_mean_f(street.truth[rest], one[rest]) for one in (street.said, after))
    name = f"{scene.name}, painter {seed}"
    count = np.count_nonzero(painted)
    return f"| {name} | {count:,} | {before_f:.3f} | {after_f:.3f} | {after_f - before_f:+.3f} |"


def painted_codes(street: StreetPoints, rng: Generator) -> NDArray[np.uint8]:
    """(n,) what somebody paints on the first half of a street; 0 elsewhere."""
    is_seen = (street.along_m < -_APART_M) & (street.truth > 0) & ~np.isin(street.truth, NOISE)
    painted = np.zeros(street.truth.size, np.uint8)
    for number in range(_STROKES):
        is_right = street.said == street.truth
        is_meant = is_seen & (painted == 0) & (is_right if number % 2 else ~is_right)
        pool = np.flatnonzero(is_meant)
        if not pool.size:
            continue
        code = rng.choice(np.unique(street.truth[pool]))
        start = int(rng.choice(pool[street.truth[pool] == code]))
        alike = np.flatnonzero(is_seen & (street.truth == code))
        near = alike[np.abs(street.xyz[alike] - street.xyz[start]).max(axis=1) < _SEGMENT_M]
        touched = _stroke if code in _BRUSHED else _segment
        painted[near[touched(street.xyz[near] - street.xyz[start])]] = code
    painted[painted == street.said] = 0
    return painted


def _stroke(about: Floats) -> NDArray[np.bool_]:
    """Which points a straight stroke meets that goes along what is near."""
    sample = about[:: max(1, len(about) // 2000)]
    along = np.linalg.svd(sample - sample.mean(axis=0), full_matrices=False)[2][0]
    metres = about @ along
    away = np.linalg.norm(about - metres[:, None] * along, axis=1)
    is_met: NDArray[np.bool_] = (np.abs(metres) <= _STROKE_M / 2) & (away <= _BRUSH_M)
    return is_met


def _segment(about: Floats) -> NDArray[np.bool_]:
    """Which points hang together with the one in the middle."""
    parts = parts_of_points(about, _CELL_M, _LINK_M)
    middle = parts[int(np.argmin((about**2).sum(axis=1)))]
    return np.asarray(parts == middle)


def _street_of(scene: RoadScene, models: ClassModels) -> StreetPoints:
    xyz = np.concatenate([drive.xyz(slice(0, drive.count)) for drive in scene.drives])
    truth = np.concatenate(
        [labels_of_drive(drive, scene.delivery / "truth") for drive in scene.drives]
    )
    things = look_for_things(scene.drives, M).things
    said = np.concatenate([_said_of(drive, models, things) for drive in scene.drives])
    flat = xyz[:, :2] - xyz[:, :2].mean(axis=0)
    along = flat @ np.linalg.svd(flat[:: max(1, len(flat) // 10_000)], full_matrices=False)[2][0]
    return StreetPoints(xyz, truth, said, along - np.median(along), things)


def _said_of(drive: Drive, models: ClassModels, things: FoundThings) -> NDArray[np.uint8]:
    codes, confidence = np.zeros(drive.count, np.uint8), np.zeros(drive.count, np.float32)
    with TemporaryDirectory(prefix="zuka-") as scratch:
        classify_drive(drive, codes, confidence, Path(scratch), M, models=models, things=things)
    return codes


def _mean_f(truth: NDArray[np.uint8], said: NDArray[np.uint8]) -> float:
    score = class_score(ConfusionMatrix.of(truth, said))
    return {one.id: one.value for one in score.figures}["mean_f_ground_joined"]


if __name__ == "__main__":
    write_every_character()
    raise SystemExit(main())
