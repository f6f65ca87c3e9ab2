"""Kernels that look at a window of a profile: which layers are filled, how even, how flat."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel
from processing.methods.road.barriers.strip_profiles import LAYER_M

TOE_LAYER, LOW_LAYER, RAIL_LAYER = 2, 3, 6
"""Layers of the foot of a wall, from 0.1 m; above the ground with its grass, 0.15 m; and where the
lowest rail may be, 0.3 m."""

_FILLED_SHARE = 0.5
"""Of the fullest layer, from which a layer counts as one of the barrier."""

_GAP_LAYERS = 10
"""From rail to rail less than 0.5 m: what hangs higher is another thing."""

_LOWEST_TOP, _LEAST_FALL = 8, 0.2
"""The lowest top of a barrier, 0.45 m, and by how much the share of filled columns falls there."""

MOST_TOPS = 4

_EVEN_LAYERS, _OVER_LAYERS = 1, 4

_FEW = 0.1
"""Of a window's usual points in a cell, below which a cell holds stray points only."""

_LEAST_CELLS = 4


@kernel
def layers_kernel(counts: NDArray[np.float32], filled: NDArray[np.bool_], share: Floats) -> None:
    """Which cells hold points, and the share of the columns that each layer fills."""
    columns, layers = counts.shape
    total = number = 0.0
    for column in range(columns):
        for layer in range(RAIL_LAYER, layers):
            if counts[column, layer] > 0:
                total += counts[column, layer]
                number += 1
    least = max(1.0, _FEW * total / max(number, 1.0))
    for column in range(columns):
        for layer in range(layers):
            if counts[column, layer] >= least:
                filled[column, layer] = True
                share[layer] += 1.0 / columns


@kernel
def tops_kernel(share: Floats, tops: Integers) -> int:
    """Layers that may be the top of a barrier, the sharpest ends first; how many.

    Plants and houses behind it fill layers above it, but less: its top is where the share of filled
    columns falls.
    """
    layers = share.size
    most = share[RAIL_LAYER:].max()
    overall = -1
    for layer in range(RAIL_LAYER, layers):
        if share[layer] >= _FILLED_SHARE * most:
            if overall >= 0 and layer - overall > _GAP_LAYERS:
                break
            overall = layer
    tops[0] = overall
    count = 1
    falls = np.zeros(layers)
    for layer in range(_LOWEST_TOP, layers - 1):
        fall = share[layer] - share[layer + 1]
        if layer != overall and share[layer] >= _FILLED_SHARE and fall >= _LEAST_FALL:
            falls[layer] = fall
    while count < tops.size:
        layer = int(np.argmax(falls))
        if falls[layer] <= 0.0:
            break
        tops[count] = layer
        falls[max(layer - 1, 0) : layer + 2] = 0.0
        count += 1
    return count


@kernel
def ends_kernel(filled: NDArray[np.bool_], top: int) -> tuple[float, float, float]:
    """How many columns are filled below a top, have their own there, and something above."""
    columns, layers = filled.shape
    full = even = over = 0
    for column in range(columns):
        highest = -1
        for layer in range(RAIL_LAYER, min(top + _OVER_LAYERS - 1, layers)):
            if filled[column, layer]:
                highest = layer
        full += highest >= 0
        even += abs(highest - top) <= _EVEN_LAYERS
        for layer in range(top + _OVER_LAYERS, layers):
            if filled[column, layer]:
                over += 1
                break
    return full / columns, even / max(full, 1), over / columns


class LayerSums(NamedTuple):
    """Of each column and layer of a window: points, and the sums of how far aside they lie."""

    counts: NDArray[np.float32]
    aside: NDArray[np.float32]
    squares: NDArray[np.float32]


@kernel
def leaning_kernel(
    sums: LayerSums, filled: NDArray[np.bool_], top: int
) -> tuple[float, float, float]:
    """How far a window's cells lie off a plane, m; how much it leans, m/m; its toe, m."""
    low = TOE_LAYER
    slope = _slope(sums, filled, low, top)
    if np.isnan(slope):
        return 0.1, 0.0, 0.0
    off = np.empty(filled.size)
    own = np.empty(len(filled))
    found = 0
    k = sh = so = shh = sho = toe_sum = toes = 0.0
    for layer in range(low, top + 1):
        here = 0
        for column in range(len(filled)):
            if filled[column, layer]:
                mean = sums.aside[column, layer] / sums.counts[column, layer]
                own[here] = mean - slope * column
                off[found + here] = sums.squares[column, layer] / sums.counts[column, layer]
                off[found + here] = max(off[found + here] - mean * mean, 0.0)
                here += 1
        if here == 0:
            continue
        middle = np.median(own[:here])
        for number in range(here):
            off[found + number] = np.sqrt((own[number] - middle) ** 2 + off[found + number])
        found += here
        if layer < RAIL_LAYER:
            toe_sum, toes = toe_sum + middle, toes + 1
            continue
        # On the uppermost layers lie points of its upper side, as far back as it is thick.
        if layer > max(top - 2, RAIL_LAYER + 2):
            continue
        high = layer * LAYER_M
        k += 1
        sh += high
        so += middle
        shh += high * high
        sho += high * middle
    spread = shh - sh * sh / max(k, 1.0)
    lean = (sho - sh * so / k) / spread if k > 2 and spread > 0 else 0.0
    toe = abs(toe_sum / toes - so / k) if toes > 0 and k > 0 else 0.0
    return float(np.median(off[:found])), lean, toe


@kernel
def _slope(sums: LayerSums, filled: NDArray[np.bool_], low: int, top: int) -> float:
    """How far cells lie aside from column to column, m; NaN for too few of them."""
    n = st = sv = stt = stv = 0.0
    for column in range(len(filled)):
        for layer in range(low, top + 1):
            if filled[column, layer]:
                mean = sums.aside[column, layer] / sums.counts[column, layer]
                n += 1
                st += column
                sv += mean
                stt += column * column
                stv += column * mean
    if n < _LEAST_CELLS:
        return np.nan
    spread = stt - st * st / n
    return (stv - st * sv / n) / spread if spread > 0 else 0.0
