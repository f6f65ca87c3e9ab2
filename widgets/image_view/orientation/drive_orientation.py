"""How a drive lies in its image: metres along the rows, proportions, and which side is up."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.image.point_image import PointCloudImage
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind

_MOST_SAMPLES = 2_000
_PROBED_ROWS = 24
_POINTS_PER_ROW = 64
_MOST_STRETCH = 24.0
_LEAST_OF_SWEEP = 8


@dataclass(frozen=True, eq=False)
class DriveOrientation:
    """Where the rows of an image are along the drive, and how its columns run.

    Attributes
    ----------
    sampled_rows : (k,) float64
        Rising; rows whose distance is known.
    distances_m : (k,) float64
        Metres from the first row, along the drive.
    stretch : float
        Length of a row step over length of a column step on the ground near the trajectory.
    left_columns_are_high : bool
        Whether columns grow towards the left side of the drive.
    plan : (k, 2) float64
        Easting and northing of the way at the sampled rows, m; NaN without a way.
    rows_go_left : bool
        Whether a scanner that stood swept from right to left.
    start_m : float
        Where the first row is along the vehicle's path, m: one place has one station in all
        drives and sections, though recordings begin after their trajectory.
    """

    sampled_rows: Floats
    distances_m: Floats
    stretch: float
    left_columns_are_high: bool
    plan: Floats
    rows_go_left: bool = False
    start_m: float = 0.0

    def station_m(self, rows: Floats) -> Floats:
        """Metres along the vehicle's path at rows; fractions count."""
        return self.start_m + self.distance_m(rows)

    def rows_at_stations(self, stations_m: Floats) -> Floats:
        """Rows at stations of the vehicle's path."""
        return self.rows_at(stations_m - self.start_m)

    @property
    def length_m(self) -> float:
        """Length of the drive."""
        return float(self.distances_m[-1])

    def distance_m(self, rows: Floats) -> Floats:
        """Metres along the drive at rows; fractions count."""
        return np.interp(rows, self.sampled_rows, self.distances_m)

    def plan_at(self, row: float) -> Floats:
        """(2,): easting and northing of the way at a row."""
        return np.array([np.interp(row, self.sampled_rows, axis) for axis in self.plan.T])

    def rows_at(self, distances_m: Floats) -> Floats:
        """Rows at distances along the drive; where it stood, the first of them."""
        return np.interp(distances_m, self.distances_m, self.sampled_rows)


def orientation_of(drive: Drive, image: PointCloudImage) -> DriveOrientation:
    """Measure how a drive lies in its image, from a few of its rows."""
    if image.kind is ImageKind.SCAN:
        return _orientation_of_scan(drive, image)
    if image.kind is ImageKind.TOP_VIEW:
        ends = np.array([0.0, max(image.width, 1)])
        unknown = np.full((2, 2), np.nan)
        return DriveOrientation(
            ends, ends * drive.info.cell_m, 1.0, left_columns_are_high=False, plan=unknown
        )
    rows = np.unique(np.linspace(0, max(image.rows - 1, 0), _MOST_SAMPLES).astype(np.int64))
    positions = _positions_of_rows(drive, image, rows)
    steps = np.hypot(*np.diff(positions[:, :2], axis=0).T)
    distances = np.concatenate([[0.0], np.cumsum(steps)])
    row_step_m = float(distances[-1]) / max(image.rows - 1, 1)
    probed = np.linspace(0, rows.size - 1, min(_PROBED_ROWS, rows.size)).astype(np.int64)
    profiles = [(index, _profile(drive, image, int(rows[index]))) for index in probed]
    column_step_m = _column_step_m([profile for _, profile in profiles])
    stretch = row_step_m / column_step_m if column_step_m > 0 and row_step_m > 0 else 1.0
    turns = sum(_sense(profile, _heading(positions, index)) for index, profile in profiles)
    return DriveOrientation(
        rows.astype(np.float64),
        distances,
        float(np.clip(stretch, 1 / _MOST_STRETCH, _MOST_STRETCH)),
        left_columns_are_high=turns > 0,
        plan=positions[:, :2],
        start_m=_start_m(drive, image),
    )


def _start_m(drive: Drive, image: PointCloudImage) -> float:
    """How far the vehicle had come along its path when the first row was measured."""
    trajectory, first = drive.trajectory, image.row_times[:1]
    if trajectory is None or not first.size or not np.isfinite(first).all():
        return 0.0
    before = trajectory.xyz[trajectory.time <= first[0], :2]
    here = trajectory.positions_at(np.clip(first, trajectory.time[0], trajectory.time[-1]))
    way = np.vstack([before, here[:, :2]])
    return float(np.hypot(*np.diff(way, axis=0).T).sum())


def _orientation_of_scan(drive: Drive, image: PointCloudImage) -> DriveOrientation:
    """Sweeps of a scanner that stood: the sky is up, and one sees them from where it stood."""
    rows = np.unique(np.linspace(0, max(image.rows - 1, 0), _MOST_SAMPLES).astype(np.int64))
    filled = np.flatnonzero(np.diff(image.row_starts) >= _LEAST_OF_SWEEP)
    probed = filled[np.linspace(0, filled.size - 1, min(_PROBED_ROWS, filled.size)).astype(int)]
    profiles = [_profile(drive, image, int(row)) for row in probed]
    rises = [_rise(profile) for profile in profiles]
    column_step_m = _column_step_m(profiles)
    row_step_m = _row_step_m(drive, image, probed)
    stretch = row_step_m / column_step_m if column_step_m > 0 and row_step_m > 0 else 1.0
    return DriveOrientation(
        rows.astype(np.float64),
        rows.astype(np.float64) * (row_step_m or column_step_m),
        float(np.clip(stretch, 1 / _MOST_STRETCH, _MOST_STRETCH)),
        left_columns_are_high=bool(np.sum(np.sign(rises)) > 0),
        plan=np.full((rows.size, 2), np.nan),
        rows_go_left=_sweeps_go_left(drive, image, filled),
    )


def _row_step_m(drive: Drive, image: PointCloudImage, rows: NDArray[np.int64]) -> float:
    """Distance of neighbours in sweeps that follow each other; as `_column_step_m` takes it."""
    steps = [np.empty(0)]
    for row in rows[rows + 1 < image.rows].tolist():
        pair = image.raster(range(row, row + 2), range(image.width))
        both = pair[:, (pair >= 0).all(axis=0)]
        steps.append(np.linalg.norm(drive.xyz(both[1]) - drive.xyz(both[0]), axis=1))
    joined = np.concatenate(steps)
    return float(np.percentile(joined, 20)) if joined.size else 0.0


def _rise(profile: _Profile) -> float:
    """Correlation of heights with columns."""
    heights = profile.xyz[:, 2] - profile.xyz[:, 2].mean()
    columns = profile.columns - profile.columns.mean()
    size = float(np.linalg.norm(heights) * np.linalg.norm(columns))
    return float(heights @ columns) / size if size > 0 else 0.0


def _sweeps_go_left(drive: Drive, image: PointCloudImage, filled: NDArray[np.int64]) -> bool:
    """Whether the sweeps followed one another counter-clockwise about the scanner."""
    position = drive.info.scanner_position
    if position is None or filled.size < 2:
        return False
    sampled = filled[np.linspace(0, filled.size - 1, min(_MOST_SAMPLES, filled.size)).astype(int)]
    starts, ends = image.row_starts[sampled], image.row_starts[sampled + 1]
    # One beam of each sweep, level enough to tell a direction.
    bearings = [
        _bearing(drive.xyz(slice(int(start), int(end), max(1, (end - start) // 16))) - position)
        for start, end in zip(starts.tolist(), ends.tolist(), strict=True)
    ]
    turned = np.diff(np.unwrap(np.array(bearings)))
    return bool(np.median(turned) > 0)


def _bearing(beams: Floats) -> float:
    """Direction in plan of the beam that is longest in plan, rad counter-clockwise from east."""
    east, north = beams[np.hypot(beams[:, 0], beams[:, 1]).argmax(), :2]
    return float(np.arctan2(north, east))


def _positions_of_rows(drive: Drive, image: PointCloudImage, rows: NDArray[np.int64]) -> Floats:
    """(k, 3) where the vehicle, or failing that the middle of the row's points, was."""
    trajectory = drive.trajectory
    times = image.row_times[rows]
    if trajectory is not None and np.isfinite(times).all():
        return trajectory.positions_at(np.clip(times, trajectory.time[0], trajectory.time[-1]))
    starts, ends = image.row_starts[rows], image.row_starts[rows + 1]
    positions = np.empty((rows.size, 3))
    last = drive.xyz(slice(0, 1))[0] if drive.count else np.zeros(3)
    for index, (start, end) in enumerate(zip(starts, ends, strict=True)):
        if end > start:
            step = max(1, int(end - start) // _POINTS_PER_ROW)
            last = np.median(drive.xyz(slice(int(start), int(end), step)), axis=0)
        positions[index] = last
    return _smooth_positions(positions)


def _smooth_positions(positions: Floats) -> Floats:
    """Middles of rows jump from wall to wall; a running mean leaves the way of the drive."""
    reach = min(25, (positions.shape[0] - 1) // 2)
    if reach < 1:
        return positions
    window = np.ones(2 * reach + 1) / (2 * reach + 1)
    padded = np.pad(positions, ((reach, reach), (0, 0)), mode="edge")
    return np.column_stack([np.convolve(padded[:, axis], window, "valid") for axis in range(3)])


@dataclass(frozen=True, eq=False)
class _Profile:
    """The points of one row, by column."""

    columns: NDArray[np.int32]
    xyz: Floats


def _profile(drive: Drive, image: PointCloudImage, row: int) -> _Profile:
    start, end = int(image.row_starts[row]), int(image.row_starts[row + 1])
    _, columns = image.pixel_of(np.arange(start, end))
    return _Profile(columns, drive.xyz(slice(start, end)))


def _column_step_m(profiles: list[_Profile]) -> float:
    """Distance of neighbours near the scanner, where the ground below it is."""
    steps = [
        np.linalg.norm(np.diff(profile.xyz, axis=0), axis=1)[np.diff(profile.columns) == 1]
        for profile in profiles
    ]
    joined = np.concatenate([np.empty(0), *steps])
    return float(np.percentile(joined, 20)) if joined.size else 0.0


def _heading(positions: Floats, index: int) -> Floats:
    """(2,) unit vector of the motion in plan about a sample; zeros where there is none."""
    reach = max(1, positions.shape[0] // 50)
    ahead = positions[min(index + reach, positions.shape[0] - 1), :2]
    motion = ahead - positions[max(index - reach, 0), :2]
    length = float(np.hypot(*motion))
    return motion / length if length > 0 else np.zeros(2)


def _sense(profile: _Profile, heading: Floats) -> float:
    """+1 where columns go from below to the left, −1 to the right.

    The row is a ring about the scanner, so the sign of its area seen along the motion tells
    which way the scanner turns, wherever the row begins and whatever it leaves out.
    """
    if profile.columns.size < 3:
        return 0.0
    centred = profile.xyz - profile.xyz.mean(axis=0)
    left = centred[:, 0] * -heading[1] + centred[:, 1] * heading[0]
    up = centred[:, 2]
    twice_area = np.sum(left * np.roll(up, -1) - np.roll(left, -1) * up)
    return float(np.sign(twice_area))
