"""DeliveryOverview: what files chosen for an import hold, before anything of them is read in."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from datetime import date
from enum import Enum
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import OutOfRange, UserError
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.formats.format import Content
from processing.formats.trajectories.image_list import read_image_list
from processing.project.importing.delivery import DeliveredFile, read_delivery
from processing.project.importing.dropped_files import additions_of_files
from processing.project.importing.import_request import ImportRequest
from processing.project.importing.trajectory_choice import (
    NamedTrajectory,
    match_trajectory,
    read_trajectories,
)
from processing.recording.vehicle_path.clock import day_of

_MOST_CORNERS = 400
"""Of a path that is drawn some hundred pixels wide."""


def _no_line() -> NDArray[np.float64]:
    return np.zeros((0, 2))


class TrajectoryState(Enum):
    """Whether a trajectory among the files belongs to points; the value says so to people."""

    FOUND = Text("found", "あり")
    NOT_COVERING = Text("does not cover the times", "時刻が一致しません")
    MISSING = Text("missing", "なし")
    NOT_NEEDED = Text("not needed", "不要")


@dataclass(frozen=True)
class FileOverview:
    """One file, as far as its beginning and its end tell.

    Attributes
    ----------
    count : int
        Points, records or images.
    extent : tuple of float or None
        Lowest easting and northing, highest easting and northing, m.
    crs : str
        ``EPSG:n`` as the file says; empty where it says nothing.
    times : tuple of float or None
        The first and the last, on the file's own clock.
    recording : int
        Points with the same number were recorded together; -1 where that isn't known.
    line : (n, 2) float64
        The way of a trajectory, or where images were taken, m.
    trouble : UserError or None
        Why it can't be read.
    """

    path: Path
    content: Content
    count: int = 0
    extent: tuple[float, float, float, float] | None = None
    crs: str = ""
    scanners: tuple[int, ...] = ()
    times: tuple[float, float] | None = None
    recording: int = -1
    trajectory: TrajectoryState = TrajectoryState.NOT_NEEDED
    line: NDArray[np.float64] = field(default_factory=_no_line)
    trouble: UserError | None = None

    @property
    def day(self) -> date | None:
        """When it was measured, where its clock tells the day."""
        return None if self.times is None else day_of(self.times[0])


@dataclass(frozen=True)
class DeliveryOverview:
    """All files that were chosen, points first.

    Attributes
    ----------
    crs : str
        Of the drawing to be; empty where neither files nor user know it.
    trouble : UserError or None
        Why they can't be imported together.
    """

    files: tuple[FileOverview, ...]
    crs: str = ""
    trouble: UserError | None = None

    @property
    def lacks_trajectory(self) -> bool:
        """Whether points are among them that want a trajectory and have none."""
        lacking = (TrajectoryState.MISSING, TrajectoryState.NOT_COVERING)
        return any(one.trajectory in lacking for one in self.files)


def look_at_delivery(files: Sequence[Path], crs: str, monitor: Monitor) -> DeliveryOverview:
    """Say what files hold and what of them belongs together.

    Parameters
    ----------
    crs : str
        What the user says; empty to go by the files.

    Raises
    ------
    Cancelled
    """
    try:
        request = additions_of_files(tuple(files), crs)
    except UserError as error:
        return DeliveryOverview((), crs, error)
    paths, named = _look_at_trajectories(request, crs)
    looked, system, trouble = _look_at_points(request, crs, monitor)
    points = [
        one if one.trouble is not None else replace(one, trajectory=_state(one, file, named))
        for one, file in looked
    ]
    images = [_look_at_images(path) for path in request.images]
    return DeliveryOverview((*points, *paths, *images), system, trouble)


def _look_at_points(
    request: ImportRequest, crs: str, monitor: Monitor
) -> tuple[list[tuple[FileOverview, DeliveredFile | None]], str, UserError | None]:
    """The point files in the order of the request, and what speaks against taking them together."""
    if not request.inputs:
        return [], crs, None
    try:
        delivery = read_delivery(request.inputs, crs, monitor)
    except UserError as trouble:
        return [_look_at_one(path, crs, monitor) for path in request.inputs], crs, trouble
    together = {
        file.info.path: (number, file)
        for number, recording in enumerate(delivery.recordings)
        for file in recording
    }
    found: list[tuple[FileOverview, DeliveredFile | None]] = []
    for path in request.inputs:
        number, file = together[path]
        found.append((replace(_of_points(file), recording=number), file))
    return found, delivery.crs, None


def _look_at_one(
    path: Path, crs: str, monitor: Monitor
) -> tuple[FileOverview, DeliveredFile | None]:
    try:
        ((file,),) = read_delivery((path,), crs, monitor).recordings
    except UserError as error:
        return FileOverview(path, Content.POINTS, trouble=error), None
    return _of_points(file), file


def _of_points(file: DeliveredFile) -> FileOverview:
    info = file.info
    extent = (*info.lowest[:2], *info.highest[:2])
    return FileOverview(
        info.path,
        Content.POINTS,
        info.count,
        extent if np.isfinite(extent).all() else None,
        info.crs,
        tuple(sorted(file.scanners)) if file.scanner_column else (),
        (file.first_time, file.last_time) if file.has_times else None,
    )


def _state(
    file: FileOverview, delivered: DeliveredFile | None, named: tuple[NamedTrajectory, ...]
) -> TrajectoryState:
    """Whether one of the trajectories covers the times of points."""
    if delivered is None or file.times is None or delivered.has_origins:
        return TrajectoryState.NOT_NEEDED
    if delivered.info.scanner_positions:
        return TrajectoryState.NOT_NEEDED
    try:
        found = match_trajectory(
            np.array(file.times),
            named,
            file.path.name,
            is_adjusted_standard=delivered.info.is_adjusted_standard,
        )
    except OutOfRange:
        return TrajectoryState.NOT_COVERING
    return TrajectoryState.MISSING if found is None else TrajectoryState.FOUND


def _look_at_trajectories(
    request: ImportRequest, crs: str
) -> tuple[list[FileOverview], tuple[NamedTrajectory, ...]]:
    found, named = [], []
    for path in request.trajectories:
        try:
            (one,) = read_trajectories((path,), crs)
        except UserError as error:
            found.append(FileOverview(path, Content.TRAJECTORY, trouble=error))
            continue
        named.append(one)
        way = one.trajectory
        line = way.xyz[:: max(1, way.time.size // _MOST_CORNERS), :2]
        times = float(way.time[0]), float(way.time[-1])
        found.append(
            FileOverview(
                path,
                Content.TRAJECTORY,
                way.time.size,
                _extent_of(way.xyz[:, :2]),
                times=times,
                line=line,
            )
        )
    return found, tuple(named)


def _look_at_images(path: Path) -> FileOverview:
    try:
        images = read_image_list(path)
    except UserError as error:
        return FileOverview(path, Content.IMAGES, trouble=error)
    places = np.array([one.xyz[:2] for one in images]).reshape(-1, 2)
    taken = [one.time_s for one in images]
    return FileOverview(
        path,
        Content.IMAGES,
        len(images),
        _extent_of(places) if taken else None,
        times=(min(taken), max(taken)) if taken else None,
        line=places,
    )


def _extent_of(places: NDArray[np.float64]) -> tuple[float, float, float, float]:
    east, north = places[:, 0], places[:, 1]
    return float(east.min()), float(north.min()), float(east.max()), float(north.max())
