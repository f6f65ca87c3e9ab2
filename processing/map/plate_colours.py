"""The colour of a sign's plate by what cameras show of it, for choosing among legal signs.

Which colours there are: 道路標識、区画線及び道路標示に関する命令, 別表第二, 備考.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

SignColour = Literal["blue", "green", "yellow", "red", "white"]

SIGN_COLOURS: tuple[SignColour, ...] = get_args(SignColour)

_HUES_DEG: Mapping[SignColour, tuple[float, float]] = {
    "yellow": (28.0, 75.0),
    "green": (75.0, 180.0),
    "blue": (180.0, 270.0),
}
"""Between neighbouring colours of the order (JIS Z 9103: red 0, yellow 50, green 150, blue 210);
the rest of the circle is red."""

_GREY = 0.25
"""Chroma over the brightest part of a pixel, below which it has no hue: daylight of a shaded plate
gives white a tenth or two of blue."""

_DARK = 0.3
"""Of the brightness of a plate's bright parts (their 95th percentile): black symbols and rims."""

_FEWEST = 12
"""Pixels or points of a plate: of fewer an average would be chance."""

_MOST_RED = 2.0
"""Red over the next colour, from which it is the ground: rims and bars have up to as much as what
they surround (規制標識: a rim of a tenth of the diameter, 36 % of the disc, and a bar)."""

_LEAST_SHARE = 0.3
"""Of a plate's points that its ground must have."""


def ground_colour(rgb: NDArray[np.uint8]) -> SignColour | None:
    """The colour of a plate's ground; None where there is too little to tell it by.

    Parameters
    ----------
    rgb : (n, 3) uint8
        Red, green, blue of pixels or points on its face.

    Notes
    -----
    Red counts as the ground where little else is there, since rims and bars of other signs are red.
    """
    if len(rgb) < _FEWEST:
        return None
    part = rgb.astype(np.float64)
    bright = part.max(axis=1)
    chroma = bright - part.min(axis=1)
    is_seen = bright > _DARK * np.quantile(bright, 0.95)
    has_hue = is_seen & (chroma >= _GREY * np.maximum(bright, 1.0))
    hue = _hues_deg(part, bright, chroma)
    shares: dict[SignColour, float] = {
        name: float((has_hue & (hue >= low) & (hue < high)).mean())
        for name, (low, high) in _HUES_DEG.items()
    }
    red = float(has_hue.mean()) - sum(shares.values())
    shares["white"] = float((is_seen & ~has_hue).mean())
    name, share = max(shares.items(), key=lambda one: one[1])
    if red >= _LEAST_SHARE and red > _MOST_RED * share:
        return "red"
    return name if share >= _LEAST_SHARE else None


def _hues_deg(
    part: NDArray[np.float64], bright: NDArray[np.float64], chroma: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Hue of each colour, 0 to 360: 0 red, 120 green, 240 blue."""
    red, green, blue = part.T
    whole = np.where(chroma > 0, chroma, 1.0)
    hue = np.select(
        [bright == red, bright == green],
        [(green - blue) / whole, 2.0 + (blue - red) / whole],
        4.0 + (red - green) / whole,
    )
    return np.asarray(60.0 * hue % 360.0)
