"""StreetRaster: a drive's reversible image as a network sees it, channels by rows and columns.

References
----------
Takahashi 2022, sections 3.6 (rows of the most frequent width) and 4.6 (channels, empty pixels).
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Flags, Floats, Integers
from processing.core.monitor import SilentMonitor
from processing.image.images_of_drives import image_of
from processing.laboratory.class_training.point_samples import BRIGHTNESS, brightness_of
from processing.methods.point_features.drive_features import computable_features, drive_features
from processing.recording.columns.point_features import POINT_FEATURES, SELECTED
from processing.recording.drive import Drive

CHANNELS = (*SELECTED, "height", BRIGHTNESS)
"""The thesis' 17 (table 4-1)."""

COLOUR_CHANNELS = ("red", "green", "blue", "is_seen")
"""Further ones, where asked for: 0 to 255, and 1 where a camera sees the point."""

WIRE = 14

_MOST_PIXELS = 1_000_000
"""Of a street: every one counts alike then, and its features take half a minute of a core."""

_MOST_HOLE_PX = 2
"""Empty pixels beside each other that are filled (section 4.6)."""

_CLOSE_M = 0.3
"""Between the ends of a hole on one surface: the thesis' step between neighbours of a scan line
(section 4.5). Used where no labels say that both ends are of one thing."""

_EVERY = 3
"""Points of a stretch of scan line of which one is looked around in space; those between are some
2 cm away and get what lies between. It takes a third of the time."""


@dataclass(frozen=True)
class Holes:
    """Short runs of empty pixels between filled ones of a row.

    Attributes
    ----------
    rows, before, after : (h,) int64
        The row, and the columns of the filled pixels on both sides.
    """

    rows: Integers
    before: Integers
    after: Integers

    def of(self, chosen: Flags) -> Holes:
        """Some of them."""
        return Holes(self.rows[chosen], self.before[chosen], self.after[chosen])

    def pixels(self) -> Iterator[tuple[Holes, Integers, Floats]]:
        """Their first empty pixels, then the second ones: whose, columns, shares of the way."""
        for step in range(1, _MOST_HOLE_PX + 1):
            some = self.of(self.after - self.before > step)
            yield some, some.before + step, step / (some.after - some.before)


@dataclass(frozen=True)
class StreetRaster:
    """The pixels of a drive.

    Attributes
    ----------
    values : (channels, rows, columns) float16
        By `CHANNELS`, and by `COLOUR_CHANNELS` where colours were asked for; 0 where empty.
    codes : (rows, columns) uint8
        True classes; 0 where empty or unknown.
    filled : (rows, columns) bool
    far_holes : (rows, columns) uint8
        Not 0 behind a hole whose ends are farther apart than points of one surface are.
    first_point : int
        Of the rows, in the drive.
    rows_of_points, columns_of_points : (n,) int32
        The pixel that speaks for each point of the rows, column −1 where there is none.
    """

    values: NDArray[np.float16]
    codes: NDArray[np.uint8]
    filled: Flags
    far_holes: NDArray[np.uint8]
    first_point: int
    rows_of_points: NDArray[np.int32]
    columns_of_points: NDArray[np.int32]

    @property
    def is_coloured(self) -> bool:
        """Whether it has `COLOUR_CHANNELS`."""
        return len(self.values) > len(CHANNELS)

    @property
    def is_seen(self) -> Flags:
        """(rows, columns): pixels with a colour; filled ones only where both ends have one."""
        seen: Flags = self.values[-1] >= 1
        return seen

    def with_colours(self, colours: NDArray[np.uint8]) -> StreetRaster:
        """The same with `COLOUR_CHANNELS`, (4, rows, columns)."""
        return replace(self, values=np.concatenate([self.values, colours.astype(np.float16)]))

    def without_holes(self, *, by_labels: bool) -> StreetRaster:
        """The same with its short holes filled.

        Parameters
        ----------
        by_labels : bool
            Where both ends are of the same class, and not of wire, as for learning; the hole is of
            that class then. Else where the ends are close together: a hole gets no class.
        """
        holes = holes_of(self.filled)
        before = self.codes[holes.rows, holes.before]
        if by_labels:
            is_one = before == self.codes[holes.rows, holes.after]
            holes = holes.of(is_one & (before != WIRE) & (before > 0))
        else:
            holes = holes.of(self.far_holes[holes.rows, holes.after] == 0)
        values, filled, codes = self.values.copy(), self.filled.copy(), self.codes.copy()
        fill_holes(values, holes)
        for some, columns, _ in holes.pixels():
            filled[some.rows, columns] = True
            if by_labels:
                codes[some.rows, columns] = self.codes[some.rows, some.before]
        return replace(self, values=values, codes=codes, filled=filled)

    def pixels_of(self, points: Integers) -> tuple[Integers, Integers]:
        """Rows and columns of points of the drive that are in these rows."""
        own = points - self.first_point
        rows, columns = self.rows_of_points[own], self.columns_of_points[own]
        return rows.astype(np.int64), columns.astype(np.int64)

    def write(self, path: Path) -> None:
        """Keep it as a file that :meth:`read` reads."""
        with path.open("wb") as file:
            np.savez(file, **vars(self))

    @staticmethod
    def read(path: Path) -> StreetRaster:
        """What :meth:`write` kept."""
        with np.load(path) as kept:
            values = {name: kept[name] for name in kept.files}
        return StreetRaster(**values | {"first_point": int(values["first_point"])})


def holes_of(filled: Flags) -> Holes:
    """Runs of one or two empty pixels between filled ones of a row.

    Parameters
    ----------
    filled : (rows, columns) bool
    """
    rows, columns = np.nonzero(filled)
    is_same = rows[1:] == rows[:-1]
    wide = columns[1:] - columns[:-1]
    is_hole = is_same & (wide > 1) & (wide <= _MOST_HOLE_PX + 1)
    at = np.flatnonzero(is_hole)
    return Holes(rows[at], columns[at], columns[at + 1])


def fill_holes(values: NDArray[np.float16], holes: Holes) -> None:
    """Give the empty pixels of holes what lies between their ends, along the row."""
    for some, columns, share in holes.pixels():
        first = values[:, some.rows, some.before].astype(np.float32)
        last = values[:, some.rows, some.after].astype(np.float32)
        values[:, some.rows, columns] = first + (last - first) * share


def middle_rows(drive: Drive) -> range:
    """Rows in the middle of a drive that hold a million pixels at most: streets count alike."""
    image = image_of(drive, drive.pixel_kind)
    count = min(image.rows, _MOST_PIXELS // max(1, image.mode_width))
    first = (image.rows - count) // 2
    return range(first, first + count)


def raster_of(drive: Drive, labels: NDArray[np.uint8], rows: range) -> StreetRaster:
    """The raster of a drive with scan lines and a trajectory.

    Parameters
    ----------
    labels : (n,) uint8
        True classes of its points.
    rows : range
        Of its image.
    """
    image = image_of(drive, drive.pixel_kind)
    fixed = image.fixed_raster(rows)
    shown, filled = np.maximum(fixed.points, 0), fixed.points >= 0
    values = np.zeros((len(CHANNELS), *shown.shape), np.float16)
    xyz = drive.xyz(slice(0, drive.count))
    own = slice(fixed.first_point, fixed.first_point + fixed.row_of_point.size)
    columns = _feature_columns(drive, xyz, own)
    columns["height"] = xyz[:, 2].astype(np.float32)
    columns[BRIGHTNESS] = brightness_of(drive)
    for at, name in enumerate(CHANNELS):
        if name in columns:
            values[at][filled] = np.nan_to_num(columns[name][shown[filled]])
    holes = holes_of(filled)
    ends = xyz[shown[holes.rows, holes.after]] - xyz[shown[holes.rows, holes.before]]
    far = np.zeros(shown.shape, np.uint8)
    far[holes.rows, holes.after] = (ends**2).sum(axis=1) >= _CLOSE_M**2
    return StreetRaster(
        values,
        np.where(filled, labels[shown], 0).astype(np.uint8),
        filled,
        far,
        fixed.first_point,
        fixed.row_of_point.astype(np.int32),
        fixed.column_of_point.astype(np.int32),
    )


def pixel_colours(drive: Drive, points: NDArray[np.uint8], rows: range) -> NDArray[np.uint8]:
    """(4, rows, columns) colours of the points that are shown; 0 where empty.

    Parameters
    ----------
    points : (n, 4) uint8
        By `COLOUR_CHANNELS`.
    rows : range
        Of its image, as :func:`raster_of`.
    """
    shown = image_of(drive, drive.pixel_kind).fixed_raster(rows).points
    own = np.where((shown >= 0)[..., None], points[np.maximum(shown, 0)], 0)
    return np.ascontiguousarray(np.moveaxis(own, -1, 0), np.uint8)


def _feature_columns(drive: Drive, xyz: Floats, own: slice) -> dict[str, NDArray[np.float32]]:
    """The selected features of some points of a drive, in the order of measuring."""
    names, _ = computable_features(drive, SELECTED)
    in_space = [name for name in names if POINT_FEATURES[name].group.startswith("sphere")]
    is_own = np.zeros(drive.count, np.bool_)
    is_own[own] = True
    is_looked_at = is_own & some_of_lines(xyz)
    columns = {name: np.zeros(drive.count, np.float32) for name in names}
    with tempfile.TemporaryDirectory(prefix="zuka-") as position:
        for number, wanted in enumerate((is_own, is_looked_at)):
            some = [name for name in names if (name in in_space) == (number == 1)]
            scratch = Path(position) / str(number)
            scratch.mkdir()
            asked = {name: columns[name] for name in some}
            drive_features(drive, asked, scratch, SilentMonitor(), wanted=wanted)
    every, looked_at = np.arange(drive.count), np.flatnonzero(is_looked_at)
    for name in in_space:
        columns[name] = np.interp(every, looked_at, columns[name][looked_at]).astype(np.float32)
    return columns


def some_of_lines(xyz: Floats) -> Flags:
    """Every third point of each stretch of a scan line, and its ends.

    Parameters
    ----------
    xyz : (n, 3) float64
        m, in the order of measuring.

    Returns
    -------
    (n,) bool
    """
    if not len(xyz):
        return np.zeros(0, np.bool_)
    steps = ((xyz[1:] - xyz[:-1]) ** 2).sum(axis=1)
    begins = np.concatenate([[True], ~(steps <= _CLOSE_M**2)])
    ends = np.concatenate([begins[1:], [True]])
    first = np.maximum.accumulate(np.where(begins, np.arange(len(xyz)), 0))
    chosen: Flags = begins | ends | ((np.arange(len(xyz)) - first) % _EVERY == 0)
    return chosen
