"""Waveforms by the physical model that the thesis compares with: a beam on the lowest points.

References
----------
Shinohara 2022, equations 4.15 to 4.17. Not given there and chosen here: a footprint of 0.3 m at
half its brightness, cells as wide as the points lie apart, the height of a full echo.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Iterator

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.methods.ground.filters.morphology import fill_heights
from processing.methods.waveforms.estimation.packet_inputs import SystemResponse
from processing.methods.waveforms.estimation.pulse_returns import (
    FIRST_SAMPLE_NS,
    HALF_LIGHT_M_NS,
    SAMPLES,
)
from processing.tools.tool import MadePoints
from processing.tools.waveform_points import WAVEFORM_ESTIMATE

_FOOTPRINT_M = 0.3
_PARTS = 5
"""Sub-beams along a side of the footprint: 6 cm apart."""

_REACH = 1.0
"""Of the footprint to each side: the brightness has fallen to a sixteenth there."""

_FULL_COUNTS = 100.0
_STEPS_OF_COUNT = 256.0
"""As the tool's descriptor has them."""

_LEAST_CELL_M = 0.1
_AT_ONCE = 4_096


class LowestSurface:
    """The lowest points of a cloud by square cells, the gaps between them filled.

    Parameters
    ----------
    xyz : (n, 3) float64
        m.
    cell_m : float
        Side of a cell, 0.1 m at least.
    """

    def __init__(self, xyz: Floats, cell_m: float) -> None:
        self._cell_m = max(_LEAST_CELL_M, cell_m)
        self._low = xyz.min(axis=0)
        row, column = self._cells(xyz)
        lowest = np.full((row.max() + 1, column.max() + 1), np.inf, np.float32)
        np.minimum.at(lowest, (row, column), (xyz[:, 2] - self._low[2]).astype(np.float32))
        self._heights = fill_heights(lowest, np.isfinite(lowest))

    def at(self, xy: Floats) -> Floats:
        """(n,) heights at places (n, 2), m; beyond the cloud those of its edge."""
        row, column = self._cells(xy)
        rows, columns = self._heights.shape
        found = self._heights[np.clip(row, 0, rows - 1), np.clip(column, 0, columns - 1)]
        return np.asarray(found + self._low[2], np.float64)

    def _cells(self, xy: Floats) -> tuple[Integers, Integers]:
        cells = np.floor((xy[:, :2] - self._low[:2]) / self._cell_m).astype(np.int64)
        return cells[:, 1], cells[:, 0]


def physical_waveforms(
    made: Iterable[MadePoints], surface: LowestSurface, pulse: SystemResponse
) -> Iterator[MadePoints]:
    """Made points with their packets, the samples replaced by those of the model.

    Parameters
    ----------
    made : iterable of MadePoints
        As ``waveform-estimate`` makes them: a packet's first return lies at sample 12.5.
    """
    for one in made:
        packets = one.packets
        if packets is None:
            raise TypeError(WAVEFORM_ESTIMATE.id)
        order = np.lexsort((packets.location_ps, packets.packet))
        _, first = np.unique(packets.packet[order], return_index=True)
        samples = _samples(one.xyz[order[first]], surface, pulse)
        yield dataclasses.replace(one, packets=dataclasses.replace(packets, samples=samples))


def _samples(first: Floats, surface: LowestSurface, pulse: SystemResponse) -> NDArray[np.uint16]:
    """(k, SAMPLES) of beams from above onto (k, 3) first returns."""
    side = _FOOTPRINT_M * _REACH * np.linspace(-1.0, 1.0, _PARTS)
    u, v = (one.ravel() for one in np.meshgrid(side, side))
    weights = np.exp(-4.0 * np.log(2.0) * (u**2 + v**2) / _FOOTPRINT_M**2)
    weights *= _FULL_COUNTS * _STEPS_OF_COUNT / weights.sum()
    times = np.arange(SAMPLES) - FIRST_SAMPLE_NS
    waves = np.zeros((len(first), SAMPLES))
    for start in range(0, len(first), _AT_ONCE):
        some = first[start : start + _AT_ONCE]
        for east, north, weight in zip(u, v, weights, strict=True):
            below = some[:, 2] - surface.at(some[:, :2] + [east, north])
            later = times - (below / HALF_LIGHT_M_NS)[:, None]
            waves[start : start + _AT_ONCE] += weight * pulse.at(later)
    return np.rint(waves).astype(np.uint16)
