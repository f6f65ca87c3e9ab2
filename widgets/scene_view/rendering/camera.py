"""SceneCamera: from where and how the 3D view looks; a value, so that a gesture gives a new one."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from processing.core.arrays import Floats
from processing.image.search.tile_choice import Camera3D

Triple = tuple[float, float, float]

ANGLE_DEG = 45.0
_NEAREST_M, _FARTHEST_M = 0.3, 20_000.0


@dataclass(frozen=True)
class SceneCamera:
    """A camera that never rolls.

    Attributes
    ----------
    position : tuple of float
        Metres from the view's local origin.
    heading_deg : float
        Clockwise from grid north.
    pitch_deg : float
        Upwards positive, −90 to 90.
    distance_m : float
        To what it looks at: the scale of panning and zooming over nothing.
    angle_deg : float
        Vertical opening.
    is_parallel : bool
        Whether far things are drawn as large as near ones: as large as what it looks at.
    """

    position: Triple
    heading_deg: float = 0.0
    pitch_deg: float = -30.0
    distance_m: float = 30.0
    angle_deg: float = ANGLE_DEG
    is_parallel: bool = False

    @property
    def axes(self) -> Floats:
        """(3, 3): rows are the right, upward and forward unit vectors."""
        heading, pitch = math.radians(self.heading_deg), math.radians(self.pitch_deg)
        right = np.array([math.cos(heading), -math.sin(heading), 0.0])
        forward = np.array(
            [
                math.sin(heading) * math.cos(pitch),
                math.cos(heading) * math.cos(pitch),
                math.sin(pitch),
            ]
        )
        return np.stack([right, np.cross(right, forward), forward])

    @property
    def focal_point(self) -> Floats:
        """(3,): what it looks at, metres from the origin."""
        focal_point: Floats = np.array(self.position) + self.axes[2] * self.distance_m
        return focal_point

    def orbited(self, pivot: Floats, right_deg: float, up_deg: float) -> SceneCamera:
        """Turned about a place, which stays where it is in the picture."""
        in_view = self.axes @ (pivot - np.array(self.position))
        turned = replace(
            self,
            heading_deg=(self.heading_deg + right_deg) % 360.0,
            pitch_deg=min(max(self.pitch_deg + up_deg, -90.0), 90.0),
        )
        return replace(turned, position=_triple(pivot - in_view @ turned.axes))

    def panned(self, right_m: float, up_m: float) -> SceneCamera:
        """Moved in the plane of the picture."""
        right, up, _ = self.axes
        return replace(
            self, position=_triple(np.array(self.position) + right * right_m + up * up_m)
        )

    def advanced(self, forward_m: float) -> SceneCamera:
        """Moved in the direction it looks."""
        return replace(self, position=_triple(np.array(self.position) + self.axes[2] * forward_m))

    def zoomed(self, pivot: Floats, factor: float) -> SceneCamera:
        """Nearer to a place (factor above 1), which stays where it is in the picture."""
        distance_m = min(max(self.distance_m / factor, _NEAREST_M), _FARTHEST_M)
        offset = np.array(self.position) - pivot
        if self.is_parallel:
            # Without perspective the scale is the distance; it has ends, the place has none.
            factor = self.distance_m / distance_m
            return replace(self, position=_triple(pivot + offset / factor), distance_m=distance_m)
        away = float(np.linalg.norm(offset)) / factor
        if not _NEAREST_M <= away <= _FARTHEST_M:
            return self
        return replace(self, position=_triple(pivot + offset / factor), distance_m=distance_m)

    def centred_on(self, position: Floats, distance_m: float | None = None) -> SceneCamera:
        """With the place in the middle, seen from the same side."""
        away = self.distance_m if distance_m is None else distance_m
        away = min(max(away, _NEAREST_M), _FARTHEST_M)
        return replace(self, position=_triple(position - self.axes[2] * away), distance_m=away)

    def from_above(self, height_m: float) -> SceneCamera:
        """Straight down on what it looks at, north up, without perspective as on a map."""
        turned = replace(self, heading_deg=0.0, pitch_deg=-90.0, is_parallel=True)
        return turned.centred_on(self.focal_point, height_m)

    @property
    def height_m(self) -> float:
        """How much of a surface at what it looks at is seen, from below to above."""
        return 2 * self.distance_m * math.tan(math.radians(self.angle_deg) / 2)

    def for_tiles(self, origin: Floats, width_px: int, height_px: int) -> Camera3D:
        """The same as the choice of tiles asks for it."""
        _, up, forward = self.axes
        return Camera3D(
            origin=_triple(origin),
            position=self.position,
            direction=_triple(forward),
            up=_triple(up),
            width_px=width_px,
            height_px=height_px,
            angle_deg=self.angle_deg,
            parallel_height_m=self.height_m if self.is_parallel else None,
        )


def _triple(values: Floats) -> Triple:
    return float(values[0]), float(values[1]), float(values[2])
