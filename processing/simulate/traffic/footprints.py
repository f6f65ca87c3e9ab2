"""Rectangles that bodies take on the ground, and whether two of them touch."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, sin


@dataclass(frozen=True)
class Footprint:
    """A turned rectangle.

    Attributes
    ----------
    x, y : float
        Its middle, m.
    heading_rad : float
        Of its length, anticlockwise from x.
    half_length, half_width : float
        m.
    """

    x: float
    y: float
    heading_rad: float
    half_length: float
    half_width: float

    def touches(self, other: Footprint) -> bool:
        """Whether two rectangles share a place: no line of their sides' ways parts them."""
        dx, dy = other.x - self.x, other.y - self.y
        for heading in (self.heading_rad, other.heading_rad):
            for way in ((cos(heading), sin(heading)), (-sin(heading), cos(heading))):
                apart = abs(dx * way[0] + dy * way[1])
                if apart > self._reach(way) + other._reach(way):
                    return False
        return True

    def _reach(self, way: tuple[float, float]) -> float:
        """How far it reaches from its middle along a way."""
        c, s = cos(self.heading_rad), sin(self.heading_rad)
        along = abs(way[0] * c + way[1] * s) * self.half_length
        return along + abs(way[1] * c - way[0] * s) * self.half_width
