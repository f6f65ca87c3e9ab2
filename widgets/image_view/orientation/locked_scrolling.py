"""Locked scrolling: where another picture looks to show the same stretch of the street."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from processing.core.arrays import Floats
from processing.image.search.nearest import nearest_point
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from widgets.image_view.orientation.oriented_image import OrientedImage
from widgets.image_view.orientation.viewport import Viewport

FARTHEST_M = 50.0
"""Ways of two drives that are farther apart don't show the same street."""

_ONE_VEHICLE_M = 10.0
"""Scanners that measure at the same time are no farther apart."""
_BESIDE_M = 6.0
"""Two passages of one place may be lanes apart."""
_ABOUT_M = 2.0
_MOST_UNEVEN = 8.0


def following(
    leader: OrientedImage, looking: Viewport, picture: OrientedImage, viewport: Viewport
) -> Viewport | None:
    """What a picture shows when it follows another one along the street.

    What is in the middle of the leader along the street comes into the middle, at the same
    metres per pixel; where the middle is across the street stays, but for a view from above.

    Parameters
    ----------
    leader, looking : Picture, Viewport
        What is followed.
    picture, viewport : Picture, Viewport
        What follows.

    Returns
    -------
    Viewport or None
        None where the picture shows nothing of that place.
    """
    found = position_along(leader, looking.centre, picture, viewport.centre[0])
    if found is None:
        return None
    shown_m = _shown_m(leader, looking)
    metres_per_px = _row_step_m(leader, looking.centre[0], shown_m) / looking.zoom_u
    zoom_u = _row_step_m(picture, found[0], shown_m) / metres_per_px
    scaled = replace(viewport, zoom=zoom_u / viewport.stretch) if zoom_u > 0 else viewport
    return scaled.centred_on(found[0], viewport.centre[1] if found[1] is None else found[1])


def position_along(
    leader: OrientedImage, centre: tuple[float, float], picture: OrientedImage, before: float = 0.0
) -> tuple[float, float | None] | None:
    """Where in a picture, in u and in v, the place of another one's middle is.

    By the time of measuring where both were there then, or else by the nearest place of the way
    in plan; a view from above by the measured point next to its middle.

    Parameters
    ----------
    before : float
        The u that the picture shows now: of several passages of the same place, the one about
        which it is looked at is followed.

    Returns
    -------
    tuple of float, or None
        None where the picture shows nothing of it; v is None for a street, which stays across.
    """
    if not (picture.image.rows and leader.image.rows):
        return None
    if not (leader.follows_path and picture.follows_path):
        return _by_point(leader, centre, picture)
    plan = leader.orientation.plan_at(centre[0])
    moment, times = _moment(leader, centre[0]), picture.image.row_times
    if times[0] <= moment <= times[-1]:
        row = float(np.interp(moment, times, np.arange(times.size, dtype=np.float64)))
        # Clocks that start anew each week show the same time on two days.
        if np.hypot(*(picture.orientation.plan_at(row) - plan)) <= _ONE_VEHICLE_M:
            return row, None
    found = _nearest_row(picture, plan, before)
    return None if found is None else (found, None)


def is_opposite(
    leader: OrientedImage, centre: tuple[float, float], drive: Drive, kind: ImageKind
) -> bool:
    """Whether a drive went the other way where it passed the middle of a picture."""
    if not (kind.follows_path and leader.follows_path):
        return False
    picture = OrientedImage.of(drive, kind)
    found = position_along(leader, centre, picture)
    if found is None:
        return False
    ways = (_direction(leader, centre[0]), _direction(picture, found[0]))
    return bool(np.dot(*ways) < 0.0)


def _direction(picture: OrientedImage, row: float) -> Floats:
    """(2,): where the way leads about a row, m; zeros where it stays."""
    metres = float(picture.orientation.distance_m(np.array([row]))[0])
    ends = picture.orientation.rows_at(np.array([metres - _ABOUT_M, metres + _ABOUT_M]))
    return picture.orientation.plan_at(float(ends[1])) - picture.orientation.plan_at(float(ends[0]))


def _nearest_row(picture: OrientedImage, plan: Floats, before: float) -> float | None:
    """The row, with fractions, whose place on the way is nearest; None when that is far."""
    way, rows = picture.orientation.plan, picture.orientation.sampled_rows
    if rows.size < 2:
        return None
    steps = np.diff(way, axis=0)
    squared = np.maximum((steps**2).sum(axis=1), 1e-12)
    share = np.clip(((plan - way[:-1]) * steps).sum(axis=1) / squared, 0.0, 1.0)
    away = np.hypot(*(way[:-1] + share[:, None] * steps - plan).T)
    if away.min() > FARTHEST_M:
        return None
    # Each passage of the place is a stretch of the way that is hardly farther than the nearest.
    near = np.flatnonzero(away <= away.min() + _BESIDE_M)
    passages = np.split(near, np.flatnonzero(np.diff(near) > 1) + 1)
    found = [passage[away[passage].argmin()] for passage in passages]
    at = [float(rows[one] + share[one] * (rows[one + 1] - rows[one])) for one in found]
    return min(at, key=lambda row: abs(row - before))


def _moment(picture: OrientedImage, u: float) -> float:
    times = picture.image.row_times
    return float(np.interp(u, np.arange(times.size, dtype=np.float64), times))


def _by_point(
    leader: OrientedImage, centre: tuple[float, float], picture: OrientedImage
) -> tuple[float, float | None] | None:
    row, column = leader.pixel_at(*centre)
    image = leader.image
    row, column = (
        min(max(position, 0), size - 1)
        for position, size in ((row, image.rows), (column, image.width))
    )
    point = image.nearest_filled(row, column, image.width)
    if point < 0:
        return None
    xyz = leader.drive.xyz(np.array([point]))[0]
    found = nearest_point(picture.drive, xyz, FARTHEST_M)
    if found < 0:
        return None
    rows, columns = picture.image.pixel_of(np.array([found]))
    u, v = picture.positions(rows, columns.astype(np.int64))[0].tolist()
    return u, None if picture.follows_path else v


def _shown_m(picture: OrientedImage, viewport: Viewport) -> float:
    """How long a stretch of the way is seen."""
    seen = viewport.span
    ends = np.clip([seen.left, seen.right], 0.0, max(picture.size[0] - 1, 0))
    return float(np.diff(picture.orientation.distance_m(ends))[0])


def _row_step_m(picture: OrientedImage, row: float, stretch_m: float) -> float:
    """Metres from row to row in a stretch about a row; within limits: vehicles stop and hurry."""
    orientation, rows = picture.orientation, picture.size[0]
    mean = max(orientation.length_m, 1e-3) / max(rows, 1)
    if not picture.follows_path:
        return mean
    metres = orientation.distance_m(np.array([row])) + np.array([-0.5, 0.5]) * stretch_m
    ends = orientation.rows_at(np.clip(metres, 0.0, orientation.length_m))
    if ends[1] <= ends[0]:
        return mean
    step = float(np.diff(orientation.distance_m(ends))[0] / (ends[1] - ends[0]))
    return float(np.clip(step, mean / _MOST_UNEVEN, mean * _MOST_UNEVEN))
