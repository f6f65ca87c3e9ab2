"""Colours: what numbers and codes look like, chosen to stay readable for every eye.

Ramps rise evenly in lightness and none is a rainbow. Empty pixels are deep blue as in the thesis,
a colour that no ramp comes near.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from processing.recording.columns.classes import point_classes
from processing.recording.columns.error_map import ErrorMapValue

Colours = NDArray[np.uint8]

EMPTY_COLOUR = (8, 24, 88)
"""Pixels without a point: a dark blue, which no attribute has."""

UNKNOWN_COLOUR = (96, 96, 96)
"""Points whose attribute isn't known: too few neighbours, in no camera image."""

ERROR_MAP_COLOURS: Mapping[ErrorMapValue, str] = {
    ErrorMapValue.RIGHTLY_KEPT: "#9a9a9a",
    ErrorMapValue.RIGHTLY_REMOVED: "#56b4e9",
    ErrorMapValue.WRONGLY_REMOVED: "#d55e00",
    ErrorMapValue.WRONGLY_KEPT: "#f0e442",
}
"""Of Okabe and Ito (2008), and a grey: told apart by every eye, the two mistakes also in print."""

_NOT_JUDGED = (64, 64, 64)
"""Points of which no truth is known: darker than what is right."""

HEIGHT_STEPS = 24
"""Bands of heights that are told apart by eye, as on a layer-tinted map."""

SEGMENT_COLOURS = 1024
"""Colours before they repeat: more than a screen shows segments."""

# Low to high: stops of a hypsometric tint whose lightness (CIE L*) rises in even steps.
_HEIGHT_STOPS = ((0, 84, 74), (30, 118, 66), (92, 148, 50), (160, 172, 60), (214, 192, 108),
                 (240, 218, 172), (255, 250, 240))  # fmt: skip
_WALL, _SLOPE, _FLOOR = (70, 140, 255), (225, 225, 225), (225, 60, 30)
"""By how upright a surface stands: blue to red, which colour-blind eyes tell apart, through
grey."""

SHAPE_COLOURS = (230, 159, 0), (86, 180, 233), (204, 121, 167)
"""Lines, planes and scattered points: orange, sky blue and purple of Okabe and Ito (2008)."""

_DOUBT, _HALF, _SURE = (213, 94, 0), (222, 156, 112), (228, 228, 228)
"""By confidence: the orange of Okabe and Ito (2008) for what should be looked at, fading to a
light grey as lightness rises."""

_GOLDEN = 0.6180339887498949
"""The golden section: hues so many turns apart never fall together."""

_LIGHTNESSES, _CHROMAS = (0.72, 0.56, 0.86), (0.13, 0.14, 0.09)
"""Of segments in turn, in Oklab: chroma as much as sRGB holds at that lightness in every hue."""


@lru_cache(maxsize=1)
def grey_ramp() -> Colours:
    """(256, 3) black to white; the dark end stays apart from the empty pixels' blue."""
    return np.repeat(np.arange(256, dtype=np.uint8)[:, None], 3, axis=1)


@lru_cache(maxsize=1)
def height_ramp() -> Colours:
    """(256, 3) from low to high, in steps (段彩)."""
    steps = np.minimum(np.arange(256) * HEIGHT_STEPS // 256, HEIGHT_STEPS - 1)
    return _between(_HEIGHT_STOPS, HEIGHT_STEPS)[steps]


@lru_cache(maxsize=1)
def normal_ramp() -> Colours:
    """(256, 3) from horizontal normals (walls, blue) to vertical ones (floors, red)."""
    return _between((_WALL, _SLOPE, _FLOOR), 256)


@lru_cache(maxsize=1)
def confidence_ramp() -> Colours:
    """(256, 3) from doubtful (orange) to sure (light grey)."""
    return _between((_DOUBT, _HALF, _SURE), 256)


@lru_cache(maxsize=1)
def class_colours() -> Colours:
    """(256, 3) by class code; codes outside the table are grey."""
    table = np.full((256, 3), UNKNOWN_COLOUR, np.uint8)
    for one in point_classes():
        table[one.code] = one.rgb
    return table


@lru_cache(maxsize=1)
def error_map_colours() -> Colours:
    """(256, 3) by `ErrorMapValue`: what is right is grey or blue, what is wrong stands out."""
    table = np.full((256, 3), _NOT_JUDGED, np.uint8)
    for judgement, colour in ERROR_MAP_COLOURS.items():
        table[judgement] = tuple(bytes.fromhex(colour[1:]))
    return table


def segment_colours(segments: NDArray[np.int32]) -> Colours:
    """A colour for each segment number: the same number always has the same colour.

    Parameters
    ----------
    segments : (n,) int32
        Negative numbers are points of no segment.

    Returns
    -------
    (n, 3) uint8
    """
    colours = _distinct_colours()[segments % SEGMENT_COLOURS]
    colours[segments < 0] = UNKNOWN_COLOUR
    return colours


def stretch_values(values: NDArray[np.floating], low: float, high: float) -> NDArray[np.uint8]:
    """Numbers between low and high as 0 to 255; outside they are clipped.

    Where low and high are the same, numbers that are the same too are in the middle.

    Returns
    -------
    (n,) uint8
    """
    if high <= low:
        return np.asarray(128 + np.clip(np.sign(values - low) * 128, -128, 127), dtype=np.uint8)
    scaled = (values - low) * (256 / (high - low))
    return np.asarray(np.clip(scaled, 0, 255), dtype=np.uint8)


@lru_cache(maxsize=1)
def _distinct_colours() -> Colours:
    """Hues a golden angle apart, in three lightnesses: numbers next to each other differ most."""
    numbers = np.arange(SEGMENT_COLOURS)
    hue = 2 * np.pi * (numbers * _GOLDEN % 1)
    lightness = np.array(_LIGHTNESSES)[numbers % 3]
    chroma = np.array(_CHROMAS)[numbers % 3]
    return _from_oklab(lightness, chroma * np.cos(hue), chroma * np.sin(hue))


def _between(stops: tuple[tuple[int, int, int], ...], count: int) -> Colours:
    positions = np.linspace(0, len(stops) - 1, count)
    channels = np.array(stops, dtype=np.float64).T
    mixed = [np.interp(positions, np.arange(len(stops)), channel) for channel in channels]
    return np.asarray(np.rint(np.stack(mixed, axis=1)), dtype=np.uint8)


def _from_oklab(
    lightness: NDArray[np.float64], a: NDArray[np.float64], b: NDArray[np.float64]
) -> Colours:
    """Perceptual colours to sRGB (Ottosson 2020, "A perceptual color space")."""
    cone = np.stack(
        [
            lightness + 0.3963377774 * a + 0.2158037573 * b,
            lightness - 0.1055613458 * a - 0.0638541728 * b,
            lightness - 0.0894841775 * a - 1.2914855480 * b,
        ]
    )
    matrix = np.array(
        [
            [4.0767416621, -3.3077115913, 0.2309699292],
            [-1.2684380046, 2.6097574011, -0.3413193965],
            [-0.0041960863, -0.7034186147, 1.7076147010],
        ]
    )
    linear = np.clip(matrix @ cone**3, 0, 1).T
    curved = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return np.asarray(np.rint(255 * curved), dtype=np.uint8)
