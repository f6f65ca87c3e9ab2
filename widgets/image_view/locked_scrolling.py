"""Locked scrolling: where another picture looks to show the same stretch of the street."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from widgets.image_view.picture import Picture
from widgets.image_view.viewport import Viewport

Floats = NDArray[np.float64]

FARTHEST_M = 50.0
"""Ways of two drives that are farther apart don't show the same street."""


def following(
    leader: Picture, looking: Viewport, picture: Picture, viewport: Viewport
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
    found = place_along(leader, looking.centre, picture)
    if found is None:
        return None
    metres_per_px = _row_step_m(leader) / looking.zoom_u
    zoom_u = _row_step_m(picture) / metres_per_px
    scaled = replace(viewport, zoom=zoom_u / viewport.stretch) if zoom_u > 0 else viewport
    return scaled.centred_on(found[0], viewport.centre[1] if found[1] is None else found[1])


def place_along(
    leader: Picture, centre: tuple[float, float], picture: Picture
) -> tuple[float, float | None] | None:
    """Where in a picture, in u and in v, the place of another one's middle is.

    By the time of measuring where both were measured then, or else by the nearest place of the
    way in plan; a view from above by the measured point next to its middle.

    Returns
    -------
    tuple of float, or None
        None where the picture shows nothing of it; v is None for a street, which stays across.
    """
    if not (picture.image.rows and leader.image.rows):
        return None
    if not (leader.image.kind.follows_way and picture.image.kind.follows_way):
        return _by_point(leader, centre, picture)
    moment = _moment(leader, centre[0])
    times = picture.image.row_times
    if times[0] <= moment <= times[-1]:
        return float(np.interp(moment, times, np.arange(times.size, dtype=np.float64))), None
    row = _nearest_row(picture, leader.lay.plan_at(centre[0]))
    return None if row is None else (row, None)


def _nearest_row(picture: Picture, plan: Floats) -> float | None:
    """The row, with fractions, whose place on the way is nearest; None when that is far."""
    way, rows = picture.lay.plan, picture.lay.sampled_rows
    if rows.size < 2:
        return None
    steps = np.diff(way, axis=0)
    squared = np.maximum((steps**2).sum(axis=1), 1e-12)
    share = np.clip(((plan - way[:-1]) * steps).sum(axis=1) / squared, 0.0, 1.0)
    away = np.hypot(*(way[:-1] + share[:, None] * steps - plan).T)
    nearest = int(away.argmin())
    if away[nearest] > FARTHEST_M:
        return None
    return float(rows[nearest] + share[nearest] * (rows[nearest + 1] - rows[nearest]))


def _moment(picture: Picture, u: float) -> float:
    times = picture.image.row_times
    return float(np.interp(u, np.arange(times.size, dtype=np.float64), times))


def _by_point(
    leader: Picture, centre: tuple[float, float], picture: Picture
) -> tuple[float, float | None] | None:
    row, column = leader.pixel_at(*centre)
    image = leader.image
    row, column = (
        min(max(place, 0), size - 1) for place, size in ((row, image.rows), (column, image.width))
    )
    point = image.nearest_filled(row, column, image.width)
    if point < 0:
        return None
    xyz = leader.drive.xyz(np.array([point]))[0]
    found = picture.drive.nearest_point(xyz, FARTHEST_M)
    if found < 0:
        return None
    rows, columns = picture.image.pixel_of(np.array([found]))
    u, v = picture.places(rows, columns.astype(np.int64))[0].tolist()
    return u, None if picture.image.kind.follows_way else v


def _row_step_m(picture: Picture) -> float:
    return max(picture.lay.length_m, 1e-3) / max(picture.size[0], 1)
