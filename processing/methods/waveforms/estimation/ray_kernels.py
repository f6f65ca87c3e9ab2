"""What neighbouring pulses met along a ray: where their returns lie, projected onto it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel
from processing.methods.waveforms.estimation.pulse_returns import (
    FIRST_SAMPLE_NS,
    HALF_LIGHT_M_NS,
    SAMPLES,
)


class PlanGrid(NamedTuple):
    """Points by the square cells that they lie in, seen from above.

    ``low`` (2,) float64, m; ``side`` m; ``shape`` of the cells; ``starts`` (cells + 1,) int64 into
    ``order`` (n,) int64.
    """

    low: Floats
    side: float
    shape: tuple[int, int]
    starts: Integers
    order: Integers


def plan_grid(xyz: Floats, side: float) -> PlanGrid:
    """The cells of points, (n, 3) m."""
    low = xyz[:, :2].min(axis=0)
    cell = ((xyz[:, :2] - low) / side).astype(np.int64)
    rows, columns = (int(one) + 1 for one in cell.max(axis=0))
    number = cell[:, 0] * columns + cell[:, 1]
    order = np.argsort(number, kind="stable")
    starts = np.searchsorted(number[order], np.arange(rows * columns + 1))
    return PlanGrid(low, side, (rows, columns), starts.astype(np.int64), order)


class Neighbours(NamedTuple):
    """Returns around.

    ``xyz`` (m, 3) float64 m; ``energy`` (m,) float32 in any unit; ``packet`` (m,) int64;
    ``is_first`` (m,) bool, of its packet.
    """

    xyz: Floats
    energy: NDArray[np.float32]
    packet: Integers
    is_first: NDArray[np.bool_]


@kernel
def profile_kernel(
    grid: PlanGrid,
    around: Neighbours,
    rays: tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.int64]],
    radii: NDArray[np.float64],
    into: NDArray[np.float32],
) -> None:
    """Energy and number of neighbours' returns per nanosecond and pulse, near the ray and around.

    Parameters
    ----------
    rays : (k, 3), (k, 3), (k,)
        First return, m; unit vector away from the sensor; packet, whose own returns don't count.
    radii : (r,) float64
        Rising standard deviations of the weight that falls with the distance from the ray, m;
        nothing counts beyond two of them.
    into : (k, 2 r, SAMPLES) float32
        Energy for each of the radii, then numbers.
    """
    origins, directions, packets = rays
    reach = 2.0 * radii[-1]
    for ray in range(len(origins)):
        origin, direction, own = origins[ray], directions[ray], packets[ray]
        weights = np.zeros(radii.size)
        rows, columns = _cells_along(grid, origin, direction, reach)
        for row in range(rows[0], rows[1] + 1):
            for column in range(columns[0], columns[1] + 1):
                if _is_aside(grid, (row, column), origin, direction, reach):
                    continue
                cell = row * grid.shape[1] + column
                for at in range(grid.starts[cell], grid.starts[cell + 1]):
                    point = grid.order[at]
                    if around.packet[point] != own:
                        _add_return(around, point, (origin, direction, radii, weights), into[ray])
        for wide in range(radii.size):
            # One pulse more, as if one had met nothing: few neighbours tell little.
            by = 1.0 / (1.0 + weights[wide])
            for sample in range(SAMPLES):
                into[ray, wide, sample] *= by
                into[ray, radii.size + wide, sample] *= by


@kernel
def _cells_along(
    grid: PlanGrid,
    origin: NDArray[np.float64],
    direction: NDArray[np.float64],
    reach: float,
) -> tuple[tuple[int, int], tuple[int, int]]:
    """First and last row and column of cells along a packet, from its first sample to its last."""
    begin = -FIRST_SAMPLE_NS * HALF_LIGHT_M_NS
    end = (SAMPLES - FIRST_SAMPLE_NS) * HALF_LIGHT_M_NS
    x = origin[0] - grid.low[0], direction[0]
    y = origin[1] - grid.low[1], direction[1]
    x_low, x_high = min(begin * x[1], end * x[1]), max(begin * x[1], end * x[1])
    y_low, y_high = min(begin * y[1], end * y[1]), max(begin * y[1], end * y[1])
    low_row = max(0, int((x[0] + x_low - reach) / grid.side))
    high_row = min(grid.shape[0] - 1, int((x[0] + x_high + reach) / grid.side))
    low_column = max(0, int((y[0] + y_low - reach) / grid.side))
    high_column = min(grid.shape[1] - 1, int((y[0] + y_high + reach) / grid.side))
    return (low_row, high_row), (low_column, high_column)


@kernel
def _is_aside(
    grid: PlanGrid,
    cell: tuple[int, int],
    origin: NDArray[np.float64],
    direction: NDArray[np.float64],
    reach: float,
) -> bool:
    """Whether a cell lies farther aside of the ray, seen from above, than matters."""
    slant = np.hypot(direction[0], direction[1])
    if slant < 1e-6:
        return False
    x = grid.low[0] + (cell[0] + 0.5) * grid.side - origin[0]
    y = grid.low[1] + (cell[1] + 0.5) * grid.side - origin[1]
    # .71: from a cell's middle to its corner.
    return bool(abs(y * direction[0] - x * direction[1]) > slant * (reach + 0.71 * grid.side))


@kernel
def _add_return(
    around: Neighbours,
    point: int,
    ray: tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]],
    into: NDArray[np.float32],
) -> None:
    """Add a neighbour's return, as far as it lies near the ray, at its range."""
    origin, direction, radii, weights = ray
    along, square = 0.0, 0.0
    for axis in range(3):
        off = around.xyz[point, axis] - origin[axis]
        along += off * direction[axis]
        square += off * off
    aside = square - along * along
    place = along / HALF_LIGHT_M_NS + FIRST_SAMPLE_NS
    whole = int(np.floor(place))
    part = place - whole
    for wide in range(radii.size):
        scaled = aside / (radii[wide] * radii[wide])
        if scaled > 4.0:
            continue
        weight = np.exp(-0.5 * scaled)
        if around.is_first[point]:
            weights[wide] += weight
        if whole >= 0 and whole + 1 < SAMPLES:
            energy, number = weight * around.energy[point], radii.size + wide
            into[wide, whole] += energy * (1.0 - part)
            into[wide, whole + 1] += energy * part
            into[number, whole] += weight * (1.0 - part)
            into[number, whole + 1] += weight * part
