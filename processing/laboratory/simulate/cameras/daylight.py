"""Sun and sky over a street: where light comes from, and what is seen where nothing stands."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from processing.laboratory.simulate.cameras.grain_kernels import Singles, grain
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.mesh import Floats

_HORIZON, _ZENITH = np.array([0.62, 0.74, 0.88]), np.array([0.12, 0.27, 0.62])
_CLOUD, _FAR_LAND = np.array([0.8, 0.81, 0.82]), np.array([0.2, 0.22, 0.19])
_CLOUDS_HIGH = 1.6
_HAZE_M = 900.0


@dataclass(frozen=True)
class Daylight:
    """The light of a day.

    Attributes
    ----------
    sun : (3,) float64
        Towards it, unit vector.
    strength : float
        Of the sun, beside a sky of 1 when it is clear and low when it is overcast.
    clouds : float
        How much of the sky they cover, 0 to 1.
    """

    sun: Floats
    strength: float
    clouds: float

    def sky(self, directions: Floats) -> Singles:
        """What is seen where nothing is met: (n, 3) float32 linear red, green, blue."""
        high = np.clip(directions[:, 2], 0, 1)[:, None]
        share = (high**0.5).astype(np.float32)
        colours = _HORIZON + (_ZENITH - _HORIZON) * share
        near = np.clip(directions @ self.sun, 0, 1)[:, None] ** 60
        colours = colours + (1 - self.clouds) * 0.8 * near
        flat = directions / np.maximum(directions[:, 2:], 0.08) * _CLOUDS_HIGH
        flat[:, 2] = 0.0
        cover = 0.5 + 0.35 * grain(flat, 1.0) + 0.15 * grain(flat, 0.37) + (self.clouds - 0.5) * 1.6
        thick = np.clip(cover * 1.4, 0, 1)[:, None] * np.clip(high * 6, 0, 1)
        colours = colours + (_CLOUD * (1 - 0.25 * self.clouds) - colours) * thick
        land = np.clip(-directions[:, 2] * 12, 0, 1)[:, None]
        return np.asarray(colours + (_FAR_LAND - colours) * land, np.float32)

    def haze(self, ranges: Floats) -> Singles:
        """Share of the horizon's light before what is so far away: (n,) float32."""
        return np.asarray(1 - np.exp(-ranges / _HAZE_M), np.float32)

    def falling_on(self, normals: Floats, is_lit: Floats) -> Singles:
        """Light on surfaces: (n, 3) float32 linear.

        Parameters
        ----------
        normals : (n, 3) float64
            Unit vectors towards the camera's side.
        is_lit : (n,) float64
            1 where the sun reaches, 0 in shadow.
        """
        upward = 0.5 + 0.5 * normals[:, 2:]
        from_sky = np.array([0.42, 0.46, 0.54]) * (0.35 + 0.65 * upward)
        from_sun = np.maximum(normals @ self.sun, 0.0) * is_lit * self.strength
        return np.asarray(from_sky + from_sun[:, None] * np.array([1.0, 0.95, 0.86]), np.float32)


def daylight_of(seed: int) -> Daylight:
    """The light on a seed's day."""
    random = chance(seed, "daylight")
    azimuth = float(random.uniform(0, 2 * np.pi))
    high = float(np.radians(random.uniform(22, 68)))
    sun = np.array([np.cos(high) * np.cos(azimuth), np.cos(high) * np.sin(azimuth), np.sin(high)])
    clouds = float(random.beta(1.2, 1.6))
    return Daylight(sun, 1.15 * (1 - clouds) ** 0.7 + 0.05, clouds)
