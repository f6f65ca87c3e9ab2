"""PointSample: some points of each class of a street, with all that the thesis asks of a point."""

from __future__ import annotations

import tempfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from processing.core.arrays import Flags, Integers
from processing.core.monitor import SilentMonitor
from processing.laboratory.accuracy.road.road_scenes import RoadScene
from processing.laboratory.accuracy.road.true_labels import labels_of_drive
from processing.laboratory.class_training.examples import (
    NOISE,
)
from processing.methods.point_features.drive_features import computable_features, drive_features
from processing.recording.columns.point_features import POINT_FEATURES
from processing.recording.drive import Drive

BRIGHTNESS = "brightness"
"""log2 of the intensity over the recording's median: scanners count light as they please."""

NAMES = (*POINT_FEATURES, "height", "intensity", BRIGHTNESS)
"""All 102, in the order of the columns of a sample, and the intensity in another unit."""

MMS = ("path_height", "path_distance", "scan_line_length", "scan_line_curvature", "height",
       "intensity", BRIGHTNESS)  # fmt: skip
"""The thesis' A; all others are its M, with the six that it doesn't name."""

ABSOLUTE = tuple(name for name in NAMES if name == "height" or name.startswith("mean_height"))
"""Heights above the sea: they belong to the place that was learnt from."""

_NOT_KNOWN = 0
_NOT_ASKED = (_NOT_KNOWN, 1, *NOISE)
"""No class, “other”, noise: neither learnt nor scored, as in the thesis."""

_BRIGHTNESS_SAMPLE = 100_000
"""Points that a recording's median intensity is taken of."""


@dataclass(frozen=True)
class PointSample:
    """Some points of a drive or of several.

    Attributes
    ----------
    rows : (k, 103) float32
        Features; NaN where a drive lacks one.
    codes : (k,) uint8
        True classes.
    points : (k,) int64
        Numbers of the points in their drive.
    counts : mapping of int to int
        How many points of each class there are in all.
    """

    rows: NDArray[np.float32]
    codes: NDArray[np.uint8]
    points: Integers
    counts: Mapping[int, int]

    def of(self, chosen: Flags) -> PointSample:
        """Some of the points; as many as before are there in all."""
        return PointSample(
            self.rows[chosen], self.codes[chosen], self.points[chosen], dict(self.counts)
        )

    def asked(self) -> PointSample:
        """Without “other” and noise."""
        return self.of(~np.isin(self.codes, _NOT_ASKED))

    def values(self, columns: Sequence[int]) -> NDArray[np.float32]:
        """(k, columns) what a forest sees; a feature that a drive lacks is 0."""
        rows: NDArray[np.float32] = np.nan_to_num(self.rows[:, list(columns)], nan=0.0)
        return rows

    @staticmethod
    def joined(parts: Sequence[PointSample]) -> PointSample:
        """Those of several drives, one at least."""
        codes = {code for part in parts for code in part.counts}
        return PointSample(
            np.concatenate([part.rows for part in parts]),
            np.concatenate([part.codes for part in parts]),
            np.concatenate([part.points for part in parts]),
            {code: sum(part.counts.get(code, 0) for part in parts) for code in sorted(codes)},
        )

    def write(self, path: Path) -> None:
        """Keep it as a file that :meth:`read` reads."""
        counts = np.array([*self.counts.items()], np.int64).reshape(-1, 2)
        with path.open("wb") as file:
            np.savez(file, rows=self.rows, codes=self.codes, points=self.points, counts=counts)

    @staticmethod
    def read(path: Path) -> PointSample:
        """What :meth:`write` kept."""
        with np.load(path) as kept:
            counts = {int(code): int(count) for code, count in kept["counts"]}
            return PointSample(kept["rows"], kept["codes"], kept["points"], counts)


def samples_of(scenes: Iterable[RoadScene], most: int) -> Iterator[tuple[str, PointSample]]:
    """Some points of each street, of all its heads, of the classes that are asked for."""
    for scene in scenes:
        truth = scene.delivery / "truth"
        parts = [sample_of(one, labels_of_drive(one, truth), most) for one in scene.drives]
        yield scene.name, PointSample.joined(parts).asked()


def sample_of(drive: Drive, labels: NDArray[np.uint8], most: int) -> PointSample:
    """Some points of each class, with their features.

    Parameters
    ----------
    labels : (n,) uint8
        True classes.
    most : int
        Points of a class.
    """
    wanted, counts = _drawn(labels, most, np.random.default_rng(0))
    names, _ = computable_features(drive, tuple(POINT_FEATURES))
    with tempfile.TemporaryDirectory(prefix="zuka-") as folder:
        columns: dict[str, NDArray[np.float32]] = {
            name: np.memmap(Path(folder) / name, np.float32, "w+", shape=(drive.count,))
            for name in names
        }
        drive_features(drive, columns, Path(folder), SilentMonitor(), wanted=wanted)
        points = np.flatnonzero(wanted)
        rows = np.full((points.size, len(NAMES)), np.nan, np.float32)
        for at, name in enumerate(POINT_FEATURES):
            if name in columns:
                rows[:, at] = columns[name][points]
    rows[:, NAMES.index("height")] = drive.xyz(points)[:, 2]
    rows[:, NAMES.index("intensity")] = drive.columns["intensity"][points]
    rows[:, NAMES.index(BRIGHTNESS)] = brightness_of(drive)[points]
    return PointSample(rows, labels[points], points, counts)


def _drawn(labels: NDArray[np.uint8], most: int, rng: Generator) -> tuple[Flags, dict[int, int]]:
    """Points of each class, as far as there are, and how many there are in all."""
    wanted, counts = np.zeros(labels.size, np.bool_), {}
    for code in np.setdiff1d(labels, [_NOT_KNOWN]).tolist():
        points = np.flatnonzero(labels == code)
        counts[code] = points.size
        wanted[rng.choice(points, min(points.size, most), replace=False)] = True
    return wanted, counts


def brightness_of(drive: Drive) -> NDArray[np.float32]:
    """(n,) log2 of the intensities over the recording's median."""
    intensity = np.asarray(drive.columns["intensity"][: drive.count]).astype(np.float32)
    bright: NDArray[np.float32] = np.log2(intensity + 1)
    every = max(1, bright.size // _BRIGHTNESS_SAMPLE)
    return bright - np.median(bright[::every])
