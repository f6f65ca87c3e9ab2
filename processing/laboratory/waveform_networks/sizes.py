"""Sizes of the local-global network: the published ones, and smaller ones of the same shape.

References
----------
Shinohara 2022, section 3.3: figures of the local and the global block; section 3.4: patches.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

SAMPLES = 160
CLASSES = 6

_PUBLISHED_POINTS = 50_000
_LEAST_MAPS, _LEAST_REPRESENTATIVES = 4, 8


@dataclass(frozen=True)
class NetworkSizes:
    """Numbers of points, of members of a neighbourhood, and of maps.

    Attributes
    ----------
    points : int
        Of a patch.
    representatives : tuple of int
        Points that are left at each level of the encoder.
    radii_m : tuple of float
    members : tuple of int
        At most so many points of a ball.
    maps : tuple of int
        Of the three levels, and of the three layers of the local block; the decoder has them the
        other way round.
    hidden_maps : int
        Of the first layer over a waveform in the global block.
    dropout : float
        Before the last layer.
    inner_dropout : float
        Behind the layers before: none is published.
    """

    points: int = _PUBLISHED_POINTS
    representatives: tuple[int, int, int] = (8_192, 4_096, 2_048)
    radii_m: tuple[float, float, float] = (1.0, 5.0, 15.0)
    members: tuple[int, int, int] = (16, 64, 128)
    maps: tuple[int, int, int] = (256, 512, 1_024)
    hidden_maps: int = 128
    dropout: float = 0.5
    inner_dropout: float = 0.1

    def scaled(self, width: float, points: int) -> NetworkSizes:
        """The same with fewer maps, and smaller patches with as many fewer representatives."""
        share, (first, second, third) = points / self.points, self.representatives
        near, middle, far = self.maps

        def some(count: int) -> int:
            return max(_LEAST_REPRESENTATIVES, round(count * share))

        def narrow(maps: int) -> int:
            return max(_LEAST_MAPS, round(maps * width))

        return replace(
            self,
            points=points,
            representatives=(some(first), some(second), some(third)),
            maps=(narrow(near), narrow(middle), narrow(far)),
            hidden_maps=narrow(self.hidden_maps),
        )

    def with_radii(self, factor: float) -> NetworkSizes:
        """The same with balls of other radii."""
        first, second, third = self.radii_m
        return replace(self, radii_m=(first * factor, second * factor, third * factor))
