"""Examples for the trees of classes: cells of simulated streets, thinned, shaken, brightened."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.monitor import SilentMonitor
from processing.image.images_of_drives import image_of
from processing.laboratory.accuracy.road.road_scenes import RoadScene
from processing.laboratory.accuracy.road.true_labels import labels_of_drive
from processing.methods.classes.aerial_cells import AerialPoints
from processing.methods.classes.drive_classes import DriveSurroundings
from processing.methods.classes.features import ClassCells
from processing.methods.ground.filters.adaptive import GroundAssumptions, find_ground
from processing.recording.drive import Drive

NOISE = (7, 18)
"""What another tool finds: no class is asked of it."""

_CODES = 256
_MOST_POINTS = 1_500_000
"""Of a variant: what the features of one take is then some 2 GB."""

_THINNINGS = ((1, 1), (1, 2), (2, 1), (2, 2), (3, 2), (4, 2), (3, 3), (5, 3))
"""Every so many rows and points of a row that are kept: from the scanners' own densities down to a
fifteenth, as slower scanners and faster cars give."""

_NOISES_M = (0.0, 0.003, 0.008, 0.015)
"""Standard deviations of what is added along easting, northing and height: phase scanners to
handheld ones."""

_LEAST_GAIN, _MOST_GAIN, _OFFSET = 0.5, 1.6, 0.5
"""Contrast, and doublings by which all intensities are brighter: scanners count light as they
please."""


_DARK = 0.2
"""Share of the variants without intensity, as some deliveries are."""

_EVERY, _STANDING = 3, 2
"""Every third variant is thinned as one scan from one place would be."""

_EYE_M, _NEAREST_M, _FARTHEST_M = 2.0, 1.0, 10.0
"""Height of that place above a point of the street, and range within which all points stay: beyond
it their number falls with the squared range, from 1 m (a few hundred points of a house) to 10 m."""


@dataclass(frozen=True)
class LabelledCells:
    """Cells whose class is known.

    Attributes
    ----------
    cells : ClassCells
    codes : (c,) uint8
        The class of most points of each; 0 where most are noise.
    """

    cells: ClassCells
    codes: NDArray[np.uint8]

    def sample(self, most: int, rng: Generator) -> tuple[Integers, NDArray[np.float64]]:
        """Some cells of each class, and for how many each stands."""
        chosen, weights = [], []
        for code in np.unique(self.codes[self.codes > 0]):
            of_class = np.flatnonzero(self.codes == code)
            some = of_class
            if of_class.size > most:
                some = np.sort(rng.choice(of_class, most, replace=False))
            chosen.append(some)
            weights.append(np.full(some.size, of_class.size / some.size))
        if not chosen:
            return np.zeros(0, np.int64), np.zeros(0)
        return np.concatenate(chosen), np.concatenate(weights)


def labelled_cells(scene: RoadScene, variants: int, seed: int) -> Iterator[LabelledCells]:
    """Cells of each head of a street, as it was recorded or thinned and shaken."""
    truth = scene.delivery / "truth"
    for number, drive in enumerate(scene.drives):
        labels = labels_of_drive(drive, truth)
        around = DriveSurroundings.of(drive, SilentMonitor())
        for variant in range(variants):
            rng = np.random.default_rng((seed, number, variant))
            is_standing = variant % _EVERY == _STANDING
            thinned = _as_one_scan if is_standing else _as_slower_scanner
            yield _variant(around, labels, thinned(drive, rng), rng)


def codes_of_cells(cells: ClassCells, labels: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """(c,) the class of most of each cell's points; 0 where most are noise or unknown."""
    count = cells.rows.shape[0]
    votes = np.bincount(cells.cell_of.astype(np.int64) * _CODES + labels, minlength=count * _CODES)
    codes: NDArray[np.uint8] = votes.reshape(count, _CODES).argmax(axis=1).astype(np.uint8)
    codes[np.isin(codes, NOISE)] = 0
    return codes


def points_above_ground(
    xyz: Floats, is_last: NDArray[np.bool_], is_only: NDArray[np.bool_]
) -> AerialPoints:
    """A cloud with the ground that is found in it, as its cells ask for it.

    Parameters
    ----------
    xyz : (n, 3) float64
        m about an origin near by.
    is_last, is_only : (n,) bool
        Whether a return is its pulse's last, and its only one.
    """
    surface = find_ground(lambda: iter([xyz]), GroundAssumptions(), SilentMonitor())
    heights = xyz[:, 2] - surface.heights_at(xyz[:, :2])
    known = np.where(np.isfinite(heights), heights, 0.0)
    return AerialPoints(xyz, known, surface.is_ground(xyz), is_last, is_only)


def _variant(
    around: DriveSurroundings, labels: NDArray[np.uint8], points: Integers, rng: Generator
) -> LabelledCells:
    drive = around.drive
    if points.size > _MOST_POINTS:
        first = int(rng.integers(points.size - _MOST_POINTS))
        points = points[first : first + _MOST_POINTS]
    local = drive.xyz(points) - around.plan.origin
    noise_m = float(rng.choice(np.array(_NOISES_M)))
    local += rng.normal(0.0, 1.0, local.shape) * noise_m
    intensity = np.asarray(drive.columns["intensity"][points], np.float64)
    gain, offset = rng.uniform(_LEAST_GAIN, _MOST_GAIN), rng.normal(0.0, _OFFSET)
    relative = (intensity + 1) / (around.ground_intensity + 1)
    changed = (around.ground_intensity + 1) * relative**gain * 2**offset - 1
    if rng.random() < _DARK:
        changed[:] = around.ground_intensity
    bright = np.clip(np.rint(changed), 0, np.iinfo(np.uint16).max).astype(np.uint16)
    cells = around.cells_of(local, bright, SilentMonitor())
    return LabelledCells(cells, codes_of_cells(cells, labels[points]))


def _as_slower_scanner(drive: Drive, rng: Generator) -> Integers:
    """Every so many rows, and of these every so many points."""
    rows, places = rows_and_places(drive)
    every_row, every_point = rng.choice(np.array(_THINNINGS)).tolist()
    return np.flatnonzero((rows % every_row == 0) & (places % every_point == 0))


def rows_and_places(drive: Drive) -> tuple[Integers, Integers]:
    """(n,) int64 row of each point, and its place in the row as points were measured."""
    starts = np.asarray(image_of(drive, drive.pixel_kind).row_starts)
    rows = np.repeat(np.arange(starts.size - 1), np.diff(starts))
    return rows, np.arange(drive.count) - starts[rows]


def _as_one_scan(drive: Drive, rng: Generator) -> Integers:
    """As many as a scanner would measure from one place of the street."""
    xyz = drive.xyz(slice(0, drive.count))
    eye = xyz[rng.integers(drive.count)] + (0.0, 0.0, _EYE_M)
    near_m = np.exp(rng.uniform(np.log(_NEAREST_M), np.log(_FARTHEST_M)))
    squared = ((xyz - eye) ** 2).sum(axis=1)
    return np.flatnonzero(rng.random(drive.count) * squared < near_m**2)
