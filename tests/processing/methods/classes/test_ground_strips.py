"""A road is a long strip of one tone, whatever that tone is, and a field is not."""

from __future__ import annotations

import numpy as np
import pytest

from processing.core.monitor import SilentMonitor
from processing.methods.classes.ground_strips import RANKS, STRIP_COLUMNS, strip_columns

_SPACING_M = 0.5
_ROAD_M = 6.0
_SHORTEST, _LONGEST, _LOW, _HIGH = 7, 9, 10, 11


@pytest.mark.parametrize("tone", [-2.0, -0.8, 1.0])
def test_a_road_is_as_wide_as_it_is_and_goes_on(tone: float) -> None:
    """Darker or brighter than the land: its width, a length beyond it, and what is beside it."""
    north, east = _SPACING_M * (0.5 + np.indices((160, 160)).reshape(2, -1))
    on_road = np.abs(east + 0.3 * north - 50.0) < _ROAD_M / 2 * np.hypot(1.0, 0.3)
    tones = np.where(on_road, tone, 0.0) + np.random.default_rng(1).normal(0, 0.1, east.size)
    ranks = np.quantile(tones, np.linspace(0, 1, RANKS))
    found = strip_columns(
        np.column_stack([east, north]),
        tones.astype(np.float32),
        np.ones(east.size, np.bool_),
        ranks,
        cell_m=_SPACING_M,
        monitor=SilentMonitor(),
    )
    assert found.shape == (east.size, STRIP_COLUMNS)
    inner = on_road & (np.abs(north - 40.0) < 10.0)
    middle = np.median(found[inner], axis=0)
    assert middle[_SHORTEST] == pytest.approx(_ROAD_M, abs=1.5)
    assert middle[_LONGEST] > 3 * _ROAD_M
    assert middle[[_LOW, _HIGH]] == pytest.approx([-tone, -tone], abs=0.2)


def test_without_ground_nothing_is_told() -> None:
    """Zeros, which trees take as they are."""
    xy = np.random.default_rng(1).uniform(0, 20.0, (500, 2))
    found = strip_columns(
        xy,
        np.zeros(500, np.float32),
        np.zeros(500, np.bool_),
        np.zeros(RANKS),
        cell_m=_SPACING_M,
        monitor=SilentMonitor(),
    )
    assert not found.any()
