"""Crops of streets as they could have been recorded otherwise: what a network learns from.

References
----------
Takahashi 2022, section 4.6: mirrored, scaled and cropped, blurred, skewed, with noise, at random.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from processing.core.arrays import Flags, Floats

CROP_PX = 257
"""Side of a crop: a quarter of a tile's pixels, so that four times as many are seen in a minute."""

_LEAST_SCALE, _MOST_SCALE = 0.75, 1.5
"""Pixels of the image that a pixel of a crop steps over."""

_FEWEST_COLUMNS = 800
"""Pulses a turn of the slowest scanners on vehicles: rows of more are thinned at most so far."""

_MOST_SKEW = 0.3
"""Columns that each row is shifted by: some 17°."""

_BLURRED = 0.3
"""Share of the crops that are smoothed."""

_NOISE = 0.05
"""Standard deviation of what is added, in spreads of a channel."""


@dataclass(frozen=True)
class LearntImage:
    """A street as a network sees it.

    Attributes
    ----------
    values : (channels, rows, columns) float16
        0 in the middle of what is usual, 1 its spread; 0 where empty, the last channel 1 where not.
    targets : (rows, columns) int16
        Number of the class, −1 where none is asked.
    """

    values: NDArray[np.float16]
    targets: NDArray[np.int16]


def random_crop(
    image: LearntImage, rng: Generator, size: int = CROP_PX
) -> tuple[NDArray[np.float32], NDArray[np.int64]]:
    """A crop around a pixel of a class that is drawn first, so that rare ones are met.

    Returns
    -------
    values : (channels, size, size) float32
    targets : (size, size) int64
        −1 where none is asked, and beyond the border.
    """
    row, column = _middle(image.targets, rng)
    rows, columns = image.targets.shape
    down = _any_scale(_MOST_SCALE, rng)
    across = _any_scale(max(_MOST_SCALE, columns / _FEWEST_COLUMNS), rng)
    across *= -1.0 if rng.random() < 0.5 else 1.0  # mirrored
    steps = np.arange(size) - size // 2
    skew = rng.uniform(-_MOST_SKEW, _MOST_SKEW)
    from_rows = np.broadcast_to(np.rint(row + down * steps)[:, None], (size, size))
    from_columns = np.rint(column + across * steps[None, :] + skew * steps[:, None])
    inside: Flags = (from_rows >= 0) & (from_rows < rows)
    inside &= (from_columns >= 0) & (from_columns < columns)
    at = (
        np.clip(from_rows, 0, rows - 1).astype(np.int64),
        np.clip(from_columns, 0, columns - 1).astype(np.int64),
    )
    values = image.values[:, at[0], at[1]].astype(np.float32) * inside
    targets = np.where(inside, image.targets[at], -1).astype(np.int64)
    is_filled = values[-1] > 0
    values[:-1] += rng.normal(0.0, _NOISE, values[:-1].shape).astype(np.float32) * is_filled
    if rng.random() < _BLURRED:
        _blur(values)
    return values, targets


def _middle(targets: NDArray[np.int16], rng: Generator) -> tuple[int, int]:
    """A pixel of any class, each class as often."""
    asked = targets[targets >= 0]
    if not asked.size:
        return targets.shape[0] // 2, targets.shape[1] // 2
    rows, columns = np.nonzero(targets == rng.choice(np.unique(asked)))
    one = rng.integers(rows.size)
    return int(rows[one]), int(columns[one])


def _any_scale(most: float, rng: Generator) -> float:
    """As often halfway, by factors, to either end."""
    return float(np.exp(rng.uniform(np.log(_LEAST_SCALE), np.log(most))))


def _blur(values: NDArray[np.float32]) -> None:
    """Smooth filled pixels over filled ones around, 1 2 1 down and across; the mask stays."""
    mask = values[-1].copy()
    sums = _smoothed(values[:-1] * mask)
    weights: Floats = _smoothed(mask[None])[0]
    values[:-1] = np.where(mask > 0, sums / np.maximum(weights, 1e-6), 0)


def _smoothed(values: NDArray[np.float32]) -> NDArray[np.float32]:
    for axis in (1, 2):
        before, after = np.roll(values, 1, axis), np.roll(values, -1, axis)
        values = (before + 2 * values + after) / np.float32(4)
    return values
