"""Streets for the image network, with rasters and samples kept in a folder: they take minutes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from processing.laboratory.accuracy.road.road_scenes import (
    RoadScene,
    given_scenes,
    mounted_scenes,
    options_of,
    simulated_scenes,
)
from processing.laboratory.accuracy.road.true_labels import labels_of_drive
from processing.laboratory.class_training.image_network.street_rasters import (
    StreetRaster,
    middle_rows,
    raster_of,
)
from processing.laboratory.class_training.point_samples import PointSample, sample_of
from processing.laboratory.simulate.requests import StreetRequest
from processing.scoring.points.class_scores import NOT_KNOWN

LEARNT_OF_A_CLASS = 1_000
SCORED_OF_A_CLASS = 8_000
"""Points of each class: so few of a wall that is taken for a sign count for many where it is
scored."""

_TURNS_OF_SEEDS = 100
"""Styles and sensors take turns by the last two digits of a seed, whatever others are asked for."""


@dataclass(frozen=True)
class KeptStreet:
    """The first head of a street, the middle of it.

    Attributes
    ----------
    name : str
    sample : PointSample
        “Other” and noise left out.
    raster_path : Path
        Of its `StreetRaster`.
    """

    name: str
    sample: PointSample
    raster_path: Path

    @property
    def raster(self) -> StreetRaster:
        """Its pixels, read anew: they are some 50 MB."""
        return StreetRaster.read(self.raster_path)


def simulated_streets(folder: Path, seeds: Iterable[int], length_m: float, most: int,
                      *, is_mounted: bool = False) -> list[KeptStreet]:  # fmt: skip
    """Streets of seeds, one pass each; those by heads of any mounting too."""
    found = []
    for seed in seeds:
        scenes = (
            mounted_scenes([seed], length_m)
            if is_mounted
            else simulated_scenes([seed], length_m, _one_pass)
        )
        found.append(_kept(folder, str(seed), scenes, most))
    return found


def delivered_streets(folder: Path, deliveries: Sequence[Path], most: int) -> list[KeptStreet]:
    """Deliveries with ``truth/``."""
    return [_kept(folder, one.name, given_scenes([one]), most) for one in deliveries]


def _one_pass(number: int, seed: int, length_m: float) -> StreetRequest:
    del number
    return replace(options_of(seed % _TURNS_OF_SEEDS, seed, length_m), passes=1)


def _kept(folder: Path, name: str, scenes: Iterator[RoadScene], most: int) -> KeptStreet:
    """What is in the folder, or goes there: nothing is simulated twice."""
    sample, raster = folder / f"{name}.sample.npz", folder / f"{name}.raster.npz"
    if not (sample.exists() and raster.exists()):
        for scene in scenes:
            drive = scene.drives[0]
            labels = labels_of_drive(drive, scene.delivery / "truth")
            rows = middle_rows(drive)
            kept = raster_of(drive, labels, rows)
            kept.write(raster)
            others = np.ones(drive.count, np.bool_)
            others[kept.first_point : kept.first_point + kept.rows_of_points.size] = False
            labels[others] = NOT_KNOWN
            sample_of(drive, labels, most).write(sample)
    return KeptStreet(name, PointSample.read(sample).asked(), raster)
