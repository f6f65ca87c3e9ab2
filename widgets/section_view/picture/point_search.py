"""From a place in the picture of a section to the measured point there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from PySide6.QtGui import QPolygonF

from processing.core.arrays import Floats
from processing.image.images_of_drives import image_of
from processing.map.feature import PointReference
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from processing.section.points_in_cut import points_in_cut, section_points
from widgets.feature_drawing.outlines import are_inside
from widgets.plane_view.viewport import PlaneViewport
from widgets.section_view.picture.feed import SectionPicture
from widgets.section_view.picture.projection import SectionProjection
from widgets.shared.cursor import PickedPosition

_LEAST_M = 1e-3

_ALIKE = 1 / 24
"""Points whose distances from the mouse differ by less than this share of the reach are equally
near: half a pixel."""


def shown_point(picture: SectionPicture, at: Floats, reach: Floats) -> PickedPosition | None:
    """The nearest of the points that are painted.

    Parameters
    ----------
    at : (2,) float64
        Offset and height.
    reach : (2,) float64
        Half axes of the ellipse that is a circle in the picture, m.

    Returns
    -------
    Place or None
        The point nearest in the picture; of equally near ones that nearest to the plane.
    """
    section = picture.section
    start, stop = np.searchsorted(section[:, 0], [at[0] - reach[0], at[0] + reach[0]])
    found = _nearest(section[start:stop], at, reach)
    if found < 0:
        return None
    number = int(start) + found
    drive = picture.request.drives[int(picture.drive_numbers[number])]
    return position_of(drive, int(picture.points[number]))


def measured_point(picture: SectionPicture, at: Floats, reach: Floats) -> PickedPosition | None:
    """The nearest of all measured points in the slab; as :func:`shown_point` else."""
    if not picture.is_thinned:
        return shown_point(picture, at, reach)
    cut = picture.request.cut
    east, north, _ = cut.to_space([[at[0], 0.0, 0.0]])[0].tolist()
    around = replace(cut, middle=(east, north, cut.middle[2]), half_length_m=float(reach[0]))
    best: tuple[Floats, Drive, int] | None = None
    for drive in picture.request.drives:
        near = section_points(
            drive, around, drive.count, hides_noise=picture.request.look.hides_noise
        )
        section = near.section + np.array([at[0], 0.0, 0.0])
        found = _nearest(section, at, reach)
        if found < 0:
            continue
        if best is None or _nearest(np.stack([best[0], section[found]]), at, reach) == 1:
            best = section[found], drive, int(near.points[found])
    return None if best is None else position_of(best[1], best[2])


def points_within(
    picture: SectionPicture, viewport: PlaneViewport, outline: QPolygonF
) -> dict[str, NDArray[np.int64]]:
    """All measured points of the slab in an outline in the widget: drive id to points, rising.

    But for noise while it is hidden.
    """
    hides_noise = picture.request.look.hides_noise
    cut, bounds = picture.request.cut, outline.boundingRect()
    projection = SectionProjection(cut)
    ends = [viewport.to_plane(x, 0.0)[0] for x in (bounds.left(), bounds.right())]
    middle_m, half_m = sum(ends) / 2, max(abs(ends[1] - ends[0]) / 2, _LEAST_M)
    east, north, _ = cut.to_space([[middle_m, 0.0, 0.0]])[0].tolist()
    around = replace(cut, middle=(east, north, cut.middle[2]), half_length_m=half_m)
    found = {}
    for drive in picture.request.drives:
        points = points_in_cut(drive, around, drive.count, hides_noise=hides_noise)
        section = cut.to_section(drive.xyz(points))
        inside = are_inside(viewport.to_screen(projection.on_plane(section)), outline)
        inside &= np.abs(section[:, 0]) <= cut.half_length_m
        if inside.any():
            found[drive.id] = points[inside]
    return found


def can_search(drive: Drive) -> bool:
    """Whether a drive's points can be looked for without waiting for its tiles."""
    kind: ImageKind = drive.image_kinds[-1]
    return drive.count == 0 or image_of(drive, kind).pyramid.is_ready


def position_of(drive: Drive, point: int) -> PickedPosition:
    """A measured point with its exact coordinate."""
    easting, northing, height = drive.xyz(np.array([point]))[0].tolist()
    return PickedPosition((easting, northing, height), PointReference(drive.id, point))


def _nearest(section: Floats, at: Floats, reach: Floats) -> int:
    if not len(section):
        return -1
    away = np.hypot(*((section[:, :2] - at) / reach).T)
    inside = np.flatnonzero(away <= 1.0)
    if not inside.size:
        return -1
    steps = np.floor(away[inside] / _ALIKE)
    best = np.lexsort((away[inside], np.abs(section[inside, 2]), steps))[0]
    return int(inside[best])
