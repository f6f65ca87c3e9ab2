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
            for direction in ((cos(heading), sin(heading)), (-sin(heading), cos(heading))):
                apart = abs(dx * direction[0] + dy * direction[1])
                if apart > self._reach(direction) + other._reach(direction):
                    return False
        return True

    def _reach(self, direction: tuple[float, float]) -> float:
        """How far it reaches from its middle along a way."""
        c, s = cos(self.heading_rad), sin(self.heading_rad)
        along = abs(direction[0] * c + direction[1] * s) * self.half_length
        return along + abs(direction[1] * c - direction[0] * s) * self.half_width
