"""The classes of clouds from the air: all strips that were flown together, a part at a time.

1. The ground is found as :mod:`processing.methods.ground` finds it.
2. Points are taken together in cells as wide as they lie apart, and described as a street's are
   (:mod:`processing.methods.classes.aerial_cells`).
3. Two sets of trees say what a cell is, as on streets.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.errors import report_as_user_error
from processing.core.monitor import Monitor, PartMonitor
from processing.methods.classes.aerial_cells import AerialPoints, aerial_cells, last_and_only
from processing.methods.classes.class_models import ClassModels
from processing.methods.classes.drive_classes import classes_of_cells
from processing.methods.classes.features import REACH
from processing.methods.classes.found_things import FoundThings, NearThings
from processing.methods.ground.drive_ground import adaptive_ground
from processing.methods.ground.drive_points import DrivePoints
from processing.methods.ground.filters.adaptive import GroundAssumptions
from processing.methods.ground.ground_columns import CLASS, GROUND, HEIGHT
from processing.methods.noise.tiles_of_space import TiledCloud
from processing.recording.columns.columns import COLUMN_TYPES, column_path
from processing.recording.columns.counted_classes import class_columns
from processing.recording.drive import Drive

_TILE_M = 4.0
_POINTS_PER_PART = 1_000_000
"""Points in memory at a time, with those around."""

_POINTS_AT_ONCE = 1 << 18
_GROUND, _SORTED = 0.4, 0.5
"""Of the progress: when the ground is known, and when points lie in tiles."""


class Strips:
    """Points of several drives, numbered one drive after the other.

    Parameters
    ----------
    drives : sequence of Drive
    ground : sequence of Path
        For each a folder with what the ground filter says of its points.
    """

    def __init__(self, drives: Sequence[Drive], ground: Sequence[Path]) -> None:
        self._drives, self._ground = drives, ground
        self.starts = np.cumsum([0, *(drive.count for drive in drives)])
        self._classes = [class_columns(drive.columns) for drive in drives]
        self.count = int(self.starts[-1])

    def xyz(self, points: Integers | slice) -> Floats:
        """(n, 3) m, project CRS."""
        if isinstance(points, slice):
            points = np.arange(*points.indices(self.count))
        xyz = np.empty((points.size, 3))
        for number, own, local in self.by_drive(points):
            self._drives[number].columns.give_back()
            xyz[own] = self._drives[number].xyz(local)
        return xyz

    def are_noise(self, points: Integers) -> NDArray[np.bool_]:
        """(n,) whether points are known to be noise."""
        found = np.zeros(points.size, np.bool_)
        for number, own, local in self.by_drive(points):
            found[own] = self._classes[number].are_noise(local)
        return found

    def points(self, points: Integers, xyz: Floats) -> AerialPoints:
        """What the features of points need; ``xyz`` (n, 3) m, where they are."""
        heights, is_ground = np.zeros(points.size), np.zeros(points.size, np.bool_)
        is_last, is_only = np.empty(points.size, np.bool_), np.empty(points.size, np.bool_)
        for number, own, local in self.by_drive(points):
            heights[own] = np.nan_to_num(self._ground_column(number, HEIGHT)[local], nan=0.0)
            is_ground[own] = self._ground_column(number, CLASS)[local] == GROUND
            is_last[own], is_only[own] = last_and_only(self._drives[number], local)
        return AerialPoints(xyz - xyz.min(axis=0), heights, is_ground, is_last, is_only)

    def give(
        self,
        points: Integers,
        values: NDArray[np.generic],
        into: Sequence[NDArray[np.generic]],
    ) -> None:
        """Put values of points into the arrays of their drives."""
        for number, own, local in self.by_drive(points):
            into[number][local] = values[own]

    def by_drive(self, points: Integers) -> list[tuple[int, NDArray[np.bool_], Integers]]:
        """Of each drive with some of the points: its number, which, their numbers there."""
        of = np.searchsorted(self.starts, points, side="right") - 1
        return [(n, of == n, points[of == n] - self.starts[n]) for n in np.unique(of).tolist()]

    def _ground_column(self, number: int, name: str) -> NDArray[np.generic]:
        dtype, _ = COLUMN_TYPES[name]
        path, count = column_path(self._ground[number], name), self._drives[number].count
        return np.memmap(path, dtype, "r", shape=(count,))


def classify_thin_cloud(
    drives: Sequence[Drive],
    codes: Sequence[NDArray[np.uint8]],
    confidence: Sequence[NDArray[np.float32]],
    scratch: Path,
    monitor: Monitor,
    *,
    models: ClassModels,
    cell_m: float,
) -> None:
    """Find the class of every point that isn't known to be noise.

    Parameters
    ----------
    drives : sequence of Drive
        Strips that were flown together; each has points.
    codes : sequence of (n,) uint8
        For each drive, zero; gets the classes.
    confidence : sequence of (n,) float32
        For each drive, zero; gets how sure they are.
    scratch : Path
        A folder for files meanwhile; the caller deletes it.
    models : ClassModels
        What says how likely each class is.
    cell_m : float
        How far apart the points lie, as :func:`spacing_m` tells.

    Raises
    ------
    OutOfRange
        Points at fewer than three positions.
    NoSpace, Cancelled
    """
    folders = [scratch / f"ground {number}" for number in range(len(drives))]
    for folder in folders:
        with report_as_user_error(folder):
            folder.mkdir()
    finding = PartMonitor(monitor, 0.0, _GROUND)
    points = DrivePoints(tuple(drives), _POINTS_AT_ONCE, finding)
    adaptive_ground(points, GroundAssumptions(), folders, scratch / "surface", finding)
    strips = Strips(drives, folders)
    sorting = PartMonitor(monitor, _GROUND, _SORTED)
    cloud = TiledCloud(strips.xyz, strips.count, scratch / "order", _TILE_M, monitor=sorting)
    rest, done = PartMonitor(monitor, _SORTED, 1.0), 0
    nothing = FoundThings()
    for part in cloud.parts(REACH * cell_m, _POINTS_PER_PART):
        rest.check()
        rest.report(done / cloud.count)
        numbers = np.concatenate([part.own, part.around])
        xyz = strips.xyz(numbers)
        asked = ~strips.are_noise(numbers) & np.isfinite(xyz).all(axis=1)
        own = int(np.count_nonzero(asked[: part.own.size]))
        if own:
            numbers, xyz = numbers[asked], xyz[asked]
            cells = aerial_cells(strips.points(numbers, xyz), cell_m, rest)
            told = NearThings(nothing).told(xyz[:own])
            found = classes_of_cells(cells, models, told, nothing.sought, rest)
            strips.give(numbers[:own], found.codes[:own], codes)
            strips.give(numbers[:own], found.confidence[:own], confidence)
        done += part.own.size
