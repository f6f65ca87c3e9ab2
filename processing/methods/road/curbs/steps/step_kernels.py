"""Loops over scanlines that look for steps: two straight pieces of ground, one higher.

Each scanline is put into narrow cells; the height in a cell is the mean of what lies lowest there.
At every cell a straight piece before it (the foot) and one beyond a face of some width (the top)
are fitted from running sums, and the step is how far the top lies above the foot, in terms of how
well both are known. Slopes are held near what pavements have, so that pieces of 8 cm do.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.methods.road.curbs.steps import step_columns as of

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]
_Step = tuple[int, int, int]  # cell, sign, face
_Piece = tuple[float, float, float, float, float, float, float]

CELL_M = 0.02
_LOWEST_M = 0.06  # what lies so near above the lowest point of a cell is ground with it
_OVERHEAD_M = 0.7  # what lies so high above the ground is over it: crowns, a stake
_STEEPEST_RISE = 0.05  # of ground, in m a cell
_WALL_M = 0.50  # a cell that reaches so high holds a wall, a plant or a vehicle
_FOOT_CELLS, _LEAST_FOOT = 12, 4
_FOOT_POINTS, _TOP_POINTS, _FEWEST = 5, 4, 2  # far from the vehicle pieces are made longer
_SLOPE_SD, _TOP_SLOPE_SD = 0.15, 0.10  # of pavements about level, of tops about the foot
_LEAST_NOISE_M, _MOST_NOISE_M, _SAMPLED_CELLS = 0.003, 0.02, 10
_MODEL_M = 0.003  # pavement isn't straight
_LEAST_SURE, _LOOK_CELLS, _HINT = 3.0, 5, 1.0
_SHADOW_TOP, _MOST_SHADOW, _SHADOW_MORE_M = 8, 60, 0.15
_APART_CELLS = 5
_SEEN_CELLS = 30  # ground before and behind is followed for 60 cm
_OFF_M, _OFF_SHARE = 0.025, 0.10
_GAPS = np.array([1, 3, 6, 9, 1, 3], np.int64)  # cells that the face takes
_TOPS = np.array([8, 8, 8, 8, 4, 4], np.int64)  # cells of the top


class _Line(NamedTuple):
    """The cells that a scanline is put into, counted from ``-half`` on.

    ``sums`` are running sums over cells of 1, u, v, u², uv, v² and of walls.
    """

    half: float
    level: _Floats
    low: _Floats
    high: _Floats
    counts: _Floats
    sums: _Floats
    rises: _Floats
    shadows: _Integers


@kernel
def steps_kernel(
    across: _Floats, height: _Floats, starts: _Integers, limits: _Floats, found: _Floats
) -> int:
    """The steps of scanlines; gives how many there are: beyond the room they are counted only.

    ``across`` and ``height`` (n,) are vertices, left to right, m; ``starts`` (s + 1,) where the
    scanlines begin; ``limits`` least and greatest step, m, greatest slope of the ground, half the
    width looked at and least height of a scanner, m. ``found`` (k, of.STEP_COLUMNS) is filled in
    the order of the scanlines.
    """
    cells = int(2 * limits[3] / CELL_M)
    flat, sums = np.empty((5, cells)), np.empty((cells + 1, 7))
    shadows, chosen, sure = np.empty(cells, np.int64), np.empty(cells, np.int64), np.empty(cells)
    line = _Line(limits[3], flat[0], flat[1], flat[2], flat[3], sums, flat[4], shadows)
    count = 0
    for section in range(starts.size - 1):
        part = slice(starts[section], starts[section + 1])
        if part.stop - part.start < 2 * _LEAST_FOOT:
            continue
        _fill_cells(across[part], height[part], line)
        _sum_up(line)
        _look_over(sums, line.rises, shadows)
        noise = _noise(sums)
        for sign in (1, -1):
            _judge_cells(line, sign, limits, noise, (sure, chosen))
            for cell in range(cells):
                if sure[cell] < _LEAST_SURE or not _is_peak(sure, cell):
                    continue
                row = found[min(count, found.shape[0] - 1)]
                if _describe(line, (cell, sign, chosen[cell]), limits, noise, row):
                    row[of.SECTION] = section
                    row[of.SIGNIFICANCE] = sure[cell]
                    count += 1
    return count


@kernel
def _fill_cells(x: _Floats, h: _Floats, line: _Line) -> None:
    """Lowest, highest and mean of the lowest heights of each cell."""
    half, level, low, high, counts = line.half, line.level, line.low, line.high, line.counts
    counts[:] = 0.0
    level[:] = 0.0
    low[:], high[:] = math.inf, -math.inf
    for i in range(x.size):
        cell = int((x[i] + half) / CELL_M)
        if 0 <= cell < level.size:
            low[cell] = min(low[cell], h[i])
    for i in range(x.size):
        cell = int((x[i] + half) / CELL_M)
        if 0 <= cell < level.size and h[i] <= low[cell] + _OVERHEAD_M:
            high[cell] = max(high[cell], h[i])
            if h[i] <= low[cell] + _LOWEST_M:
                counts[cell] += 1.0
                level[cell] += h[i]
    for cell in range(level.size):
        if counts[cell] > 0:
            level[cell] /= counts[cell]
    _drop_overhead(level, counts)


@kernel
def _drop_overhead(level: _Floats, counts: _Floats) -> None:
    """Empty cells in which only something above the ground was met: a leaning stake, twigs."""
    near = np.empty((2, level.size))
    for vehicle_path in range(2):
        ground = math.inf
        for k in range(level.size):
            cell = k if vehicle_path == 0 else level.size - 1 - k
            ground += _STEEPEST_RISE
            if counts[cell] > 0:
                ground = min(ground, level[cell])
            near[vehicle_path, cell] = ground
    for cell in range(level.size):
        if level[cell] > min(near[0, cell], near[1, cell]) + _WALL_M:
            counts[cell] = 0.0


@kernel
def _sum_up(line: _Line) -> None:
    """Running sums over cells."""
    level, low, high, counts, sums = line.level, line.low, line.high, line.counts, line.sums
    sums[0] = 0.0
    for cell in range(level.size):
        row = sums[cell + 1]
        row[:] = sums[cell]
        if counts[cell] == 0:
            continue
        u, v = (cell + 0.5) * CELL_M, level[cell]
        row[0] += 1
        row[1] += u
        row[2] += v
        row[3] += u * u
        row[4] += u * v
        row[5] += v * v
        if high[cell] - low[cell] > _WALL_M:
            row[6] += 1


@kernel
def _noise(sums: _Floats) -> float:
    """Mean square of how far cells lie off straight pieces of a scanline, m²: the median piece."""
    rough = np.empty(sums.shape[0] // _SAMPLED_CELLS + 1)
    count = 0
    for cell in range(0, sums.shape[0] - 1 - _FOOT_CELLS, _SAMPLED_CELLS):
        piece = _piece(sums, cell, cell + _FOOT_CELLS, (0.0, 1.0, _LEAST_NOISE_M**2))
        if piece[0] > _LEAST_FOOT:
            rough[count] = piece[6] * piece[0] / (piece[0] - 2)
            count += 1
    usual = np.median(rough[:count]) if count > 0 else _MOST_NOISE_M**2
    return float(min(max(usual, _LEAST_NOISE_M**2), _MOST_NOISE_M**2))


@kernel
def _piece(sums: _Floats, begin: int, end: int, known: tuple[float, float, float]) -> _Piece:
    """A straight piece through cells, its slope held as ``known``: slope, deviation, noise.

    How many there are (0: none); their middle, its height; slope; mean square off with what is
    known before; what holds the slope; mean square off.
    """
    slope, slope_sd, noise = known
    if begin == end or sums[end, 0] - sums[begin, 0] < 1 or sums[end, 6] > sums[begin, 6]:
        return 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0
    n = sums[end, 0] - sums[begin, 0]
    u = (sums[end, 1] - sums[begin, 1]) / n
    v = (sums[end, 2] - sums[begin, 2]) / n
    uu = sums[end, 3] - sums[begin, 3] - n * u * u
    uv = sums[end, 4] - sums[begin, 4] - n * u * v
    vv = sums[end, 5] - sums[begin, 5] - n * v * v
    held = noise / slope_sd**2
    found = (uv + held * slope) / (uu + held)
    squares = max(vv - 2 * found * uv + found * found * uu, 0.0)
    return n, u, v, found, (squares + 2 * noise) / (n + 2), uu + held, squares / n


@kernel
def _error(piece: _Piece, at: float) -> float:
    """Squared error of a piece's height at a place."""
    n, u, _, _, mean_square, held, _ = piece
    return mean_square / n + mean_square * (at - u) ** 2 / held + _MODEL_M**2


@kernel
def _enough(sums: _Floats, edge: int, sign: int, width: int, wanted: int) -> int:
    """How many cells from an edge on hold enough for a straight piece; 0: not within reach."""
    for factor in range(3):
        reach = width << factor
        far = edge + sign * reach
        if far < 0 or far >= sums.shape[0]:
            return 0
        n = abs(sums[far, 0] - sums[edge, 0])
        if n >= wanted or (factor == 2 and n >= _FEWEST):
            return reach
    return 0


@kernel
def _foot(sums: _Floats, cell: int, sign: int, noise: float) -> _Piece:
    """The ground before a step, which ends at the cell."""
    edge = cell if sign > 0 else cell + 1
    reach = _enough(sums, edge, -sign, _FOOT_CELLS, _FOOT_POINTS)
    far = edge - sign * reach
    return _piece(sums, min(edge, far), max(edge, far), (0.0, _SLOPE_SD, noise))


@kernel
def _top_cells(sums: _Floats, step: _Step) -> tuple[int, int, float]:
    """First and behind the last cell of the ground behind a step, and the middle of its face.

    A face is a row of `_GAPS` and `_TOPS`, or minus the cells in shadow.
    """
    cell, sign, face = step
    edge = cell if sign > 0 else cell + 1
    gap, cells = (_GAPS[face] if face >= 0 else -face), (_TOPS[face] if face >= 0 else _SHADOW_TOP)
    near = edge + sign * gap
    far = near + sign * _enough(sums, near, sign, cells, _TOP_POINTS if cells > 4 else 3)
    return min(near, far), max(near, far), (edge + sign * gap / 2) * CELL_M


@kernel
def _height(piece: _Piece, at: float) -> float:
    return piece[2] + piece[3] * (at - piece[1])


@kernel
def _look_over(sums: _Floats, rises: _Floats, shadows: _Integers) -> None:
    """How much higher the cells to the right of each are than those before it: a quick look.

    0 where too few are filled. ``shadows`` are the empty cells beyond a foot on the far side of
    the way, at the cell where the foot ends.
    """
    cells = rises.size
    shadows[:] = 0
    last = cells
    for cell in range(cells):
        rises[cell] = _rise(sums, cell)
        if sums[cell + 1, 0] == sums[cell, 0]:
            continue
        empty = cell - last - 1
        if _GAPS[2] < empty <= _MOST_SHADOW:
            if last + 1 < cells // 2:
                shadows[last + 1] = empty
            if cell - 1 > cells // 2:
                shadows[cell - 1] = empty
        last = cell


@kernel
def _rise(sums: _Floats, cell: int) -> float:
    """How much higher the cells from the third after a place on are than those before it."""
    for factor in range(4):
        reach = _LOOK_CELLS << factor
        if cell < reach or cell + 3 + reach >= sums.shape[0]:
            break
        m = sums[cell, 0] - sums[cell - reach, 0]
        n = sums[cell + 3 + reach, 0] - sums[cell + 3, 0]
        if min(m, n) >= _FEWEST:
            rise = (sums[cell + 3 + reach, 2] - sums[cell + 3, 2]) / n
            return float(rise - (sums[cell, 2] - sums[cell - reach, 2]) / m)
    return 0.0


@kernel
def _judge_cells(
    line: _Line, sign: int, limits: _Floats, noise: float, best: tuple[_Floats, _Integers]
) -> None:
    """How sure a step at each cell is, in standard deviations, and which width of face is best.

    Less than the least that counts may be given as 0.
    """
    sure, chosen = best
    sums, rises = line.sums, line.rises
    middle = sure.size // 2
    sure[:] = 0.0
    for cell in range(sure.size):
        shadow = line.shadows[cell] if (cell - middle) * sign < 0 else 0
        # What rises to the right of a place falls to the left of one two cells on.
        rise = rises[cell] if sign > 0 else -rises[max(cell - 2, 0)]
        if shadow == 0 and rise < _HINT * limits[0]:
            continue
        foot = _foot(sums, cell, sign, noise)
        if foot[0] == 0 or abs(foot[3]) > limits[2]:
            continue
        squares = _error(foot, (cell if sign > 0 else cell + 1) * CELL_M) + _MODEL_M**2
        unit = 0.999 * math.sqrt(max(foot[6] - noise, 0.0) + squares)
        for face in range(-1 if shadow > 0 else 0, _GAPS.size):
            form = face if face >= 0 else -shadow
            least = max(max(sure[cell], _LEAST_SURE) * unit, limits[0])
            value = _significance(sums, (cell, sign, form), limits, (noise, least), foot)
            if value > sure[cell]:
                sure[cell] = value
                chosen[cell] = form


@kernel
def _significance(
    sums: _Floats, step: _Step, limits: _Floats, known: tuple[float, float], foot: _Piece
) -> float:
    """Height of a step in its standard deviations; 0 where it is none or lower than a least.

    ``known`` are noise and that least height.
    """
    noise, least = known
    begin, end, at = _top_cells(sums, step)
    n, base = sums[end, 0] - sums[begin, 0], _height(foot, at)
    if n == 0.0:
        return 0.0
    # Most of rough ground is left here, before anything is fitted: no slope makes it high enough.
    level, away = (sums[end, 2] - sums[begin, 2]) / n, (sums[end, 1] - sums[begin, 1]) / n - at
    if level + limits[2] * abs(away) < base + least:
        return 0.0
    top = _piece(sums, begin, end, (foot[3], _TOP_SLOPE_SD, noise))
    high = _height(top, at) - base
    if top[0] == 0 or abs(top[3]) > limits[2] or not least <= high <= limits[1]:
        return 0.0
    if step[2] < 0:
        away = abs(step[0] * CELL_M - limits[3])
        if -step[2] * CELL_M > high * away / limits[4] + _SHADOW_MORE_M:
            return 0.0
    misfit = max(foot[6] - noise, 0.0) + max(top[6] - noise, 0.0)
    return float(high / math.sqrt(_error(foot, at) + _error(top, at) + misfit))


@kernel
def _is_peak(sure: _Floats, cell: int) -> bool:
    """Whether no cell nearby is surer; of equal ones the first counts."""
    for other in range(max(0, cell - _APART_CELLS), min(sure.size, cell + _APART_CELLS + 1)):
        if sure[other] > sure[cell] or (other < cell and sure[other] == sure[cell]):
            return False
    return True


@kernel
def _describe(line: _Line, step: _Step, limits: _Floats, noise: float, row: _Floats) -> bool:
    """What is known of a step from the cells."""
    cell, sign, face = step
    foot = _foot(line.sums, cell, sign, noise)
    begin, end, at = _top_cells(line.sums, step)
    top = _piece(line.sums, begin, end, (foot[3], _TOP_SLOPE_SD, noise))
    if foot[0] == 0 or top[0] == 0:
        return False
    low, high = _height(foot, at), _height(top, at)
    half_face = (_GAPS[face] if face >= 0 else -face) * CELL_M / 2
    row[of.SIGN] = sign
    row[of.FOOT_SLOPE], row[of.TOP_SLOPE] = foot[3] * sign, top[3] * sign
    row[of.LOWER_HEIGHT], row[of.UPPER_HEIGHT] = low, high
    row[of.LOWER_ACROSS] = at - sign * half_face - line.half
    row[of.UPPER_ACROSS] = at + sign * half_face - line.half
    row[of.FOOT_M] = _follow(line, at - sign * half_face, (low, foot[3]), -sign)
    row[of.TOP_M] = _follow(line, at + sign * half_face, (high, top[3]), sign)
    return bool(limits[0] <= high - low <= limits[1])


@kernel
def _follow(line: _Line, edge: float, piece: tuple[float, float], sign: int) -> float:
    """How far ground goes on from an edge as a straight piece (height, slope), m."""
    height, slope = piece
    level, sums = line.level, line.sums
    cell = int(edge / CELL_M)
    seen = 0
    for k in range(1, _SEEN_CELLS + 1):
        at = cell + sign * k
        if at < 0 or at >= level.size:
            break
        if sums[at + 1, 0] == sums[at, 0]:
            continue
        if sums[at + 1, 6] > sums[at, 6]:
            break
        away = (at + 0.5) * CELL_M - edge
        off = level[at] - height - slope * away
        if abs(off) > _OFF_M + _OFF_SHARE * abs(away):
            break
        seen = k
    return seen * CELL_M


def warm_up() -> None:
    """Compile the kernels."""
    line, limits = np.zeros(9), np.array([0.01, 0.45, 0.36, 1.5, 1.5])
    steps_kernel(line, line, np.array([0, 9]), limits, np.empty((8, of.STEP_COLUMNS)))
