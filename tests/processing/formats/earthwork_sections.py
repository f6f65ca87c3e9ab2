"""Sections of both grounds, made in a line."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from processing.earthwork.cross_sections import CrossSection, Moments

_NOTHING = Moments(0.0, 0.0, 0.0, 0.0)


def cross_section(
    station_m: float,
    offsets: Sequence[float],
    before: Sequence[float],
    after: Sequence[float],
    *,
    cut_m2: float = 0.0,
    fill_m2: float = 0.0,
) -> CrossSection:
    """A section whose whole width counts."""
    return CrossSection(
        station_m,
        np.zeros(2),
        np.array([0.0, 1.0]),
        np.array(offsets, dtype=np.float64),
        np.array(before, dtype=np.float64),
        np.array(after, dtype=np.float64),
        np.ones(len(offsets) - 1, np.bool_),
        Moments(cut_m2, fill_m2, 0.0, 0.0),
        _NOTHING,
    )
