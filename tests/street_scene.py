"""StreetScene: road, curbs, sidewalks, walls and poles that beams are intersected with exactly."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats

CURB_AT_M = 4.0
CURB_HEIGHT_M = 0.15
WALL_AT_M = 8.0
WALL_HEIGHT_M = 5.0
CROSSFALL = 0.02
POLE_AT_M = 5.5
POLE_RADIUS_M = 0.12
POLE_HEIGHT_M = 4.5
POLE_EVERY_M = 8.0
FARTHEST_M = 60.0


@dataclass(frozen=True)
class Rays:
    """Beams: origins and unit directions, (n, 3), east, north, up about the scene's start."""

    origin: Floats
    direction: Floats

    def at(self, distance: Floats) -> Floats:
        """(n, 3) places on the beams."""
        return self.origin + distance[:, None] * self.direction


class StreetScene:
    """A street that starts at the origin and leads north, bending with a constant curvature."""

    def __init__(self, curve: float, length_m: float) -> None:
        self._curve = curve
        self._length_m = length_m

    def ranges(
        self, rays: Rays, random: np.random.Generator
    ) -> tuple[Floats, NDArray[np.uint8], NDArray[np.uint16]]:
        """Distance to what a beam hits first (inf: sky), what it is, and the intensity."""
        best = np.full(rays.origin.shape[0], np.inf)
        surface = np.zeros(best.size, dtype=np.uint8)
        for code, distance in self._hits(rays):
            nearer = (distance < best) & (distance < FARTHEST_M)
            best[nearer] = distance[nearer]
            surface[nearer] = code
        along, across = self.along_across(rays.at(np.where(np.isfinite(best), best, 0.0)))
        grey = np.array([9_000.0, 22_000.0, 14_000.0, 18_000.0, 30_000.0])[surface]
        is_line = (surface == 0) & (np.abs(np.abs(across) - 3.5) < 0.1)
        grey[is_line] = 50_000.0
        grey[(surface == 3) & (along % 4.0 < 0.5)] = 34_000.0
        return best, surface, (grey + random.uniform(0, 1_500, grey.size)).astype(np.uint16)

    def along_across(self, positions: Floats) -> tuple[Floats, Floats]:
        """Distance along the road's middle line and to the left of it."""
        east, north = positions[:, 0], positions[:, 1]
        if self._curve == 0.0:
            return north, -east
        radius = 1.0 / self._curve
        side = np.sign(radius)
        from_centre = np.hypot(north, -east - radius)
        angle = np.arctan2(north, side * (radius + east))
        return abs(radius) * angle, radius - side * from_centre

    def _hits(self, rays: Rays) -> list[tuple[int, Floats]]:
        side_of = np.abs(self._across_at(rays, road := self._on_road(rays)))
        hits = [(0, np.where(side_of <= CURB_AT_M, road, np.inf))]
        low = -CROSSFALL * CURB_AT_M
        walk = self._on_level(rays, low + CURB_HEIGHT_M)
        beside = np.abs(self._across_at(rays, walk))
        on_walk = (beside > CURB_AT_M) & (beside <= WALL_AT_M)
        hits.append((2, np.where(on_walk, walk, np.inf)))
        for side in (-1.0, 1.0):
            hits.append((1, self._on_wall(rays, side * CURB_AT_M, low, low + CURB_HEIGHT_M)))
            hits.append((3, self._on_wall(rays, side * WALL_AT_M, low, WALL_HEIGHT_M)))
        poles = np.arange(2.0, self._length_m, POLE_EVERY_M)
        return hits + [(4, self._on_pole(rays, along, s)) for along in poles for s in (-1.0, 1.0)]

    def _across_at(self, rays: Rays, distance: Floats) -> Floats:
        return self.along_across(rays.at(np.where(np.isfinite(distance), distance, 0.0)))[1]

    def _on_road(self, rays: Rays) -> Floats:
        distance = self._on_level(rays, 0.0)
        # The crossfall bends the road's surface a little: a few fixed-point steps are exact.
        for _ in range(8):
            distance = self._on_level(rays, -CROSSFALL * np.abs(self._across_at(rays, distance)))
        return distance

    def _on_level(self, rays: Rays, height: Floats | float) -> Floats:
        down = rays.direction[:, 2]
        with np.errstate(divide="ignore"):
            distance = (height - rays.origin[:, 2]) / down
        return np.where((down < -1e-3) & (distance > 0), distance, np.inf)

    def _on_wall(self, rays: Rays, across: float, low: float, high: float) -> Floats:
        distance = self._to_line(rays, across)
        height = (
            rays.origin[:, 2]
            + np.where(np.isfinite(distance), distance, 0.0) * (rays.direction[:, 2])
        )
        return np.where((height >= low) & (height <= high), distance, np.inf)

    def _to_line(self, rays: Rays, across: float) -> Floats:
        """Distance to the vertical surface above a line parallel to the road."""
        if self._curve == 0.0:
            with np.errstate(divide="ignore"):
                distance = (-across - rays.origin[:, 0]) / rays.direction[:, 0]
            return np.where(distance > 1e-6, distance, np.inf)
        centre = np.array([-1.0 / self._curve, 0.0])
        return _to_circle(rays, centre, abs(1.0 / self._curve - across))

    def _on_pole(self, rays: Rays, along: float, side: float) -> Floats:
        turned = self._curve * along
        foot = np.array([0.0, along])
        if self._curve != 0.0:
            foot = np.array([np.cos(turned) - 1.0, np.sin(turned)]) / self._curve
        foot = foot + side * POLE_AT_M * np.array([-np.cos(turned), -np.sin(turned)])
        distance = np.full(rays.origin.shape[0], np.inf)
        near = np.hypot(*(rays.origin[:, :2] - foot).T) < 25.0
        close = Rays(rays.origin[near], rays.direction[near])
        reach = _to_circle(close, foot, POLE_RADIUS_M)
        height = close.origin[:, 2] + np.where(np.isfinite(reach), reach, 0) * close.direction[:, 2]
        distance[near] = np.where((height > 0) & (height < POLE_HEIGHT_M), reach, np.inf)
        return distance


def _to_circle(rays: Rays, centre: Floats, radius: float) -> Floats:
    """Distance to a vertical cylinder: the nearer place in front of the beam's origin."""
    start = rays.origin[:, :2] - centre
    way = rays.direction[:, :2]
    a = (way * way).sum(axis=1)
    b = (start * way).sum(axis=1)
    inside = b * b - a * ((start * start).sum(axis=1) - radius * radius)
    with np.errstate(invalid="ignore", divide="ignore"):
        root = np.sqrt(inside)
        near, far = (-b - root) / a, (-b + root) / a
    nearest = np.where(near > 1e-6, near, np.where(far > 1e-6, far, np.inf))
    return np.where(inside > 0, nearest, np.inf)
