"""Rows over a flat or sloping road with holes, as a line scanner at 45 degrees measures them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from processing.methods.road.gutters.notches.notch_kernels import Sweeps

Floats = NDArray[np.float64]
Openings = Callable[[Floats, Floats], NDArray[np.bool_]]

LID_M, HOLE_LONG_M, HOLE_WIDE_M = 0.6, 0.03, 0.10
HOLES_FROM_M = (3.05, 3.25)  # across, of the twin holes' near sides
DEEP_M = 0.25
SCANNER_M = 2.65
GRATING = ((4.0, 4.5), (3.0, 3.4))  # along, across
BARS_M = 0.03


def is_hole(along: Floats, across: Floats) -> NDArray[np.bool_]:
    """Whether a place of the road is open: twin holes every lid."""
    to_joint = np.abs(along - LID_M * np.round(along / LID_M))
    is_across = np.zeros(along.shape, np.bool_)
    for near in HOLES_FROM_M:
        is_across |= (across >= near) & (across <= near + HOLE_WIDE_M)
    return is_across & (to_joint <= HOLE_LONG_M / 2)


def is_between_bars(along: Floats, across: Floats) -> NDArray[np.bool_]:
    """Whether a place is open: one grating with bars across the way."""
    (first, last), (near, far) = GRATING
    inside = (along >= first) & (along <= last) & (across >= near) & (across <= far)
    return inside & (np.mod(along - first, 2 * BARS_M) < BARS_M)


class NotchRows:
    """Rows at 45 degrees to a way along x: one after another, from left to right.

    Attributes
    ----------
    xyz : (n, 3) float64
    pulse : (n,) int64
    sweeps : as the kernel takes them
    """

    def __init__(
        self,
        is_open: Openings,
        *,
        noise_m: float = 0.002,
        slope: float = 0.0,
        fall: float = 0.0,
        lost_share: float = 0.0,
        rows: int = 60,
    ) -> None:
        random = np.random.default_rng(0)
        across = np.arange(-5.0, 5.0, 0.010)
        positions, rights, parts, pulses, starts = [], [], [], [], [0]
        for row in range(rows):
            at = 0.11 * row
            x, y = at + across, -across
            low = np.where(is_open(x, across), DEEP_M, 0.0)
            z = slope * x + fall * across - low + random.normal(0.0, noise_m, across.size)
            # A beam that falls into a hole goes on outwards.
            beyond = low * across / SCANNER_M
            x, y = x + beyond, y - beyond
            kept = random.random(across.size) >= lost_share
            parts.append(np.column_stack([x, y, z])[kept])
            pulses.append((row * 2 * across.size + np.arange(across.size))[kept])
            starts.append(starts[-1] + int(kept.sum()))
            positions.append([at, 0.0, slope * at])
            rights.append([0.0, -1.0])
        self.xyz = np.concatenate(parts)
        self.pulse = np.concatenate(pulses).astype(np.int64)
        spans = np.column_stack([starts[:-1], starts[1:]])
        self.sweeps = Sweeps(spans, np.array(positions), np.array(rights))
