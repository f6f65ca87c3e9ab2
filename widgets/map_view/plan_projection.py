"""PlanProjection: the map from above, north up."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.image.from_above.plan_raster import PlanFrame
from processing.map.feature import Position
from widgets.mouse_tools.mouse_tool import Ray
from widgets.plane_view.viewport import PlaneViewport

MapPoint = tuple[float, float]

_EYE_M = 10_000.0
_MARGIN_SHARE = 0.12


class PlanProjection:
    """Metres to the east, and metres to the south."""

    def to_plane(self, xyz: Floats) -> Floats:
        """(n, 2) places on the plane of (n, 3) in space."""
        return on_plan(xyz)

    def lines_on_plane(self, xyz: Floats, ends: NDArray[np.int64]) -> list[Floats]:
        """Straight lines stay straight."""
        return list(on_plan(xyz)[ends])

    def ray(self, position: MapPoint) -> Ray:
        """Straight down."""
        return Ray((position[0], -position[1], _EYE_M), (0.0, 0.0, -1.0))

    def reach_m(self, position: MapPoint, reach: float, at: Position | None) -> float:  # noqa: ARG002
        """The plane's unit is the metre."""
        return reach

    def is_near(self, xyz: Floats) -> NDArray[np.bool_]:
        """All of them."""
        return np.ones(len(xyz), dtype=bool)


def on_plan(east_north: Floats) -> Floats:
    """(n, 2) places on the plane; (n, 2) or (n, 3) easting, northing and perhaps height."""
    positions: Floats = east_north[:, :2] * np.array([1.0, -1.0])
    return positions


def frame_of(viewport: PlaneViewport, ratio: float) -> PlanFrame:
    """What is seen and some more on every side, so that a short push needs no other picture.

    Parameters
    ----------
    ratio : float
        Pixels of the screen per unit of the window.
    """
    seen = viewport.seen
    wide, high = seen.width() * _MARGIN_SHARE, seen.height() * _MARGIN_SHARE
    px_per_m = viewport.scale * ratio
    return PlanFrame(
        west=seen.left() - wide,
        north=-(seen.top() - high),
        px_per_m=px_per_m,
        width=max(1, round((seen.width() + 2 * wide) * px_per_m)),
        height=max(1, round((seen.height() + 2 * high) * px_per_m)),
    )
