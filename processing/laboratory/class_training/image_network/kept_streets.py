"""Streets for the image network, kept in a folder: rasters, samples and colours take minutes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import SilentMonitor
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
    pixel_colours,
    raster_of,
)
from processing.laboratory.class_training.point_samples import PointSample, sample_of
from processing.laboratory.simulate.requests import StreetRequest
from processing.recording.drive import Drive
from processing.scoring.points.class_scores import NOT_KNOWN
from processing.tools.colour import ColourParameters
from processing.tools.running.runner import RunRequest, columns_of, run

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
    colours_path : Path
        Of the colours of its points and pixels, where they were asked for.
    """

    name: str
    sample: PointSample
    raster_path: Path
    colours_path: Path

    @property
    def raster(self) -> StreetRaster:
        """Its pixels, read anew: they are some 50 MB."""
        return StreetRaster.read(self.raster_path)

    @property
    def coloured_raster(self) -> StreetRaster:
        """The same with the colours of its pixels as further channels."""
        with np.load(self.colours_path) as kept:
            return self.raster.with_colours(kept["pixels"])

    @property
    def colours(self) -> NDArray[np.float32]:
        """(k, 3) red, green and blue of the sample's points, 0 to 255; −1 where no camera sees."""
        with np.load(self.colours_path) as kept:
            own = kept["points"][self.sample.points].astype(np.float32)
        return np.where(own[:, 3:] > 0, own[:, :3], np.float32(-1))


@dataclass(frozen=True)
class StreetFolder:
    """Where streets are kept: what isn't there is made when it is asked for.

    Attributes
    ----------
    folder : Path
    length_m : float
        Of simulated streets.
    asks_colours : bool
        Whether colours from camera images are needed too: streets are photographed then.
    """

    folder: Path
    length_m: float
    asks_colours: bool

    def simulated(
        self, seeds: Iterable[int], most: int, *, is_mounted: bool = False
    ) -> list[KeptStreet]:
        """Streets of seeds, one pass each; those by heads of any mounting too."""
        found = []
        for seed in seeds:
            scenes = (
                mounted_scenes([seed], self.length_m, images=self.asks_colours)
                if is_mounted
                else simulated_scenes([seed], self.length_m, self._one_pass)
            )
            found.append(self._kept(str(seed), scenes, most))
        return found

    def delivered(self, deliveries: Sequence[Path], most: int) -> list[KeptStreet]:
        """Deliveries with ``truth/``."""
        return [self._kept(one.name, given_scenes([one]), most) for one in deliveries]

    def _one_pass(self, number: int, seed: int, length_m: float) -> StreetRequest:
        del number
        options = options_of(seed % _TURNS_OF_SEEDS, seed, length_m)
        return replace(options, passes=1, images=self.asks_colours)

    def _kept(self, name: str, scenes: Iterator[RoadScene], most: int) -> KeptStreet:
        """What is in the folder, or goes there; colours may come later than all else."""
        sample, raster, colours = (
            self.folder / f"{name}.{what}.npz" for what in ("sample", "raster", "colours")
        )
        is_known = sample.exists() and raster.exists()
        is_coloured = colours.exists() or not self.asks_colours
        if not (is_known and is_coloured):
            for scene in scenes:
                if not is_known:
                    _write_street(scene, raster, sample, most)
                if not is_coloured:
                    _write_colours(scene, colours)
        return KeptStreet(name, PointSample.read(sample).asked(), raster, colours)


def _write_street(scene: RoadScene, raster: Path, sample: Path, most: int) -> None:
    drive = scene.drives[0]
    labels = labels_of_drive(drive, scene.delivery / "truth")
    kept = raster_of(drive, labels, middle_rows(drive))
    kept.write(raster)
    others = np.ones(drive.count, np.bool_)
    others[kept.first_point : kept.first_point + kept.rows_of_points.size] = False
    labels[others] = NOT_KNOWN
    sample_of(drive, labels, most).write(sample)


def _write_colours(scene: RoadScene, path: Path) -> None:
    drive = scene.drives[0]
    points = seen_colours(scene.drives)
    pixels = pixel_colours(drive, points, middle_rows(drive))
    with path.open("wb") as file:
        np.savez_compressed(file, points=points, pixels=pixels)


def seen_colours(drives: Sequence[Drive]) -> NDArray[np.uint8]:
    """Colours of the first drive's points from its camera images, by the tool that users have.

    Parameters
    ----------
    drives : sequence of Drive
        Of a street: all of them hide points from cameras.

    Returns
    -------
    (n, 4) uint8
        By `COLOUR_CHANNELS`; 0 where no camera sees the point.
    """
    drive, *beside = drives
    points = np.zeros((drive.count, 4), np.uint8)
    if drive.images:
        request = RunRequest("colour", drive, ColourParameters(), tuple(beside))
        with TemporaryDirectory(prefix="zuka-") as position:
            found = columns_of(run(request, SilentMonitor(), into=Path(position) / "found"))
            points[:, :3], points[:, 3] = found["seen_color"], found["is_seen"]
    return points
