"""Colours of change and of deviations from a design: one place for window, paper and drawing.

Blue is lower (cut, 掘削), red and orange are higher (fill, 盛土). Both differ for colour-blind
eyes, and every class has a lightness of its own, so that the legend can be read in grey too.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.text import Text

# Limits of the classes of change, in shares of the largest that is shown: the middle one, a
# twentieth to either side, is what didn't change. Colours are told apart by lightness, too.
_CHANGE_STEPS = (-1.0, -0.5, -0.2, -0.05, 0.05, 0.2, 0.5, 1.0)
_CHANGE_COLOURS = ("#08306b", "#2b6bb0", "#5f9fd3", "#a9cfe9", "#f6f6f6",
                   "#fde3bd", "#f3a64f", "#d2620f", "#8a1c08")  # fmt: skip
# Limits of the classes of deviations, in per cent of their limit: ±50 and ±80 % as on form 31-2.
_SHARE_STEPS = (-100.0, -80.0, -50.0, 0.0, 50.0, 80.0, 100.0)
_SHARE_COLOURS = ("#1c1160", "#2f70b3", "#7fadd9", "#c9dff2",
                  "#fdf0dc", "#f8b765", "#d9701f", "#8a0f2e")  # fmt: skip
CUT_RGB, FILL_RGB = (95, 159, 211), (243, 166, 79)
"""Of what was taken away and what was put there, where only the two are told apart."""

_LIMIT_PERCENT = 98.0
"""Of all changes that a range chosen for them holds: single strays don't stretch it. By
judgement."""

_SMALLEST_LIMIT_M = 0.02
"""Least range that is chosen: below, colours show the noise of points."""

_LIMIT_STEPS, _ROUNDING = (1, 2, 5, 10, 20), 1e-9
"""Ranges within a decade; the last is for 9.99…, which a logarithm may round up."""

_HATCH_PX, _HATCH_WIDTH_PX, _HATCH_RGB = 8, 2, (120, 120, 120)
"""Distance and width of hatching, pixels, and its grey, which no class has."""

_NOTHING = 255
"""Number of no class."""


@dataclass(frozen=True)
class ColourClass:
    """Values of one colour, ``low`` up to but without ``high``; the outer ones are open.

    Attributes
    ----------
    low, high : float
        Infinite at the ends of the scale.
    rgb : (int, int, int)
    """

    low: float
    high: float
    rgb: tuple[int, int, int]

    def label(self, digits: int, unit: str) -> Text:
        """What stands beside the colour in a legend."""
        low, high = (_signed(value, digits) for value in (self.low, self.high))
        if math.isinf(self.low):
            return Text(f"below {high} {unit}", f"{high} {unit} 未満")
        if math.isinf(self.high):
            return Text(f"above {low} {unit}", f"{low} {unit} 超")
        return Text.same(f"{low} … {high} {unit}")


def change_classes(limit_m: float) -> tuple[ColourClass, ...]:
    """Classes of change between two grounds, lowest first.

    Parameters
    ----------
    limit_m : float
        Where the outermost classes begin, m; steps lie at 5, 20, 50 and 100 % of it.

    Raises
    ------
    ValueError
        The limit is not above zero.
    """
    if not limit_m > 0.0:
        message = f"classes up to {limit_m} m"
        raise ValueError(message)
    return _classes([step * limit_m for step in _CHANGE_STEPS], _CHANGE_COLOURS)


SHARE_CLASSES: tuple[ColourClass, ...]
"""Of deviation ÷ limit, %: from −100 to +100 with steps at ±50 and ±80, and beyond the limit."""


def change_limit(change_m: NDArray[np.float32]) -> float:
    """A round limit (1, 2 or 5 × 10ⁿ m) that all but the largest changes lie within.

    Parameters
    ----------
    change_m : array of float32
        m; NaN is passed over.
    """
    sizes = np.abs(change_m[np.isfinite(change_m)])
    largest = float(np.percentile(sizes, _LIMIT_PERCENT)) if len(sizes) else 0.0
    largest = max(largest, _SMALLEST_LIMIT_M)
    power = 10.0 ** math.floor(math.log10(largest))
    least = largest * (1 - _ROUNDING)
    return next(step * power for step in _LIMIT_STEPS if step * power >= least)


def change_colours(change_m: NDArray[np.float32], limit_m: float) -> NDArray[np.uint8]:
    """Colours of change: (rows, columns, 4) uint8, red, green, blue, opacity; NaN is transparent.

    Parameters
    ----------
    change_m : (rows, columns) float32
        m, positive where the later ground is higher.
    limit_m : float
        See :func:`change_classes`.
    """
    return class_colours(change_m, change_classes(limit_m))


def share_colours(percent: NDArray[np.float32]) -> NDArray[np.uint8]:
    """Colours of deviation ÷ limit in %: (rows, columns, 4) uint8; NaN is transparent."""
    return class_colours(percent, SHARE_CLASSES)


def class_colours(
    values: NDArray[np.float32], classes: tuple[ColourClass, ...]
) -> NDArray[np.uint8]:
    """Each value in its class's colour: the values' shape and 4, uint8; NaN is transparent."""
    table = np.zeros((256, 4), np.uint8)
    table[: len(classes), :3] = [one.rgb for one in classes]
    table[: len(classes), 3] = 255
    return table[class_numbers(values, classes)]


def class_numbers(
    values: NDArray[np.float32], classes: tuple[ColourClass, ...]
) -> NDArray[np.uint8]:
    """Number of each value's class, from 0: the values' shape, uint8; 255 where there is none."""
    # In the values' own precision, or 0.3 would lie below a step at 0.3.
    steps = np.array([one.low for one in classes[1:]], values.dtype)
    numbers = np.searchsorted(steps, values, side="right").astype(np.uint8)
    # What lies on the scale's upper end is within the limit.
    numbers[values == steps[-1]] = len(classes) - 2
    numbers[np.isnan(values)] = _NOTHING
    return numbers


def on_paper(colours: NDArray[np.uint8], is_measured: NDArray[np.bool_]) -> NDArray[np.uint8]:
    """A picture as it is printed: on white, with slanting lines over what was not measured.

    Parameters
    ----------
    colours : (rows, columns, 4) uint8
        Transparent cells become white.
    is_measured : (rows, columns) bool
        The lines are drawn where it is not, within what has a colour.

    Returns
    -------
    (rows, columns, 3) uint8
    """
    is_drawn = colours[..., 3] > 0
    picture: NDArray[np.uint8] = np.where(is_drawn[..., None], colours[..., :3], np.uint8(255))
    rows, columns = is_drawn.shape
    slants = np.arange(rows)[:, None] + np.arange(columns)
    is_line = slants % _HATCH_PX < _HATCH_WIDTH_PX
    picture[is_drawn & ~is_measured & is_line] = _HATCH_RGB
    return picture


def _signed(value: float, digits: int) -> str:
    words = f"{value:+.{digits}f}".replace("-", "−")
    return words[1:] if math.isfinite(value) and float(f"{value:.{digits}f}") == 0 else words


def _classes(steps: list[float], colours: tuple[str, ...]) -> tuple[ColourClass, ...]:
    bounds = [-math.inf, *steps, math.inf]
    return tuple(
        ColourClass(low, high, (int(code[1:3], 16), int(code[3:5], 16), int(code[5:7], 16)))
        for low, high, code in zip(bounds[:-1], bounds[1:], colours, strict=True)
    )


SHARE_CLASSES = _classes(list(_SHARE_STEPS), _SHARE_COLOURS)
