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

# Cells are counts; lengths in metres are theirs times `CELL_M`. "By trial": chosen while the tool
# was made; no measurement of the single value is recorded.

CELL_M = 0.02
"""Width of a cell: a few points of a near scanner fall into each, and the least foot and top, of 8
cm each, still have four."""

_LOWEST_M = 0.06
"""What lies so near above the lowest point of a cell is ground with it: three times what the
noisiest scanner scatters (`_MOST_NOISE_M`)."""

_OVERHEAD_M = 0.7
"""What lies so high above the ground is over it: crowns, a leaning stake. By trial."""

_STEEPEST_RISE_M = 0.05
"""How much ground may rise in a cell, to tell what hangs over it from it: 68°, so that kerbs and
banks remain. By trial."""

_WALL_M = 0.50
"""A cell that reaches so high holds a wall, a plant or a vehicle: more than the highest curb of 45
cm (Takahashi 2022, Table 6-1)."""

_FOOT_CELLS, _LEAST_FOOT_CELLS = 12, 4
"""Length of ground before a step, 24 cm: that of a gutter's apron. With fewer filled cells than the
least no roughness is known. By trial."""

_FOOT_POINTS, _TOP_POINTS, _NARROW_TOP_POINTS, _FEWEST = 5, 4, 3, 2
"""Filled cells that a foot, a top and a narrow top must have. Far from the vehicle, where fewer are
filled, pieces are made longer, twice, and at last have to do with the fewest: the slope is held."""

_LEDGE_CELLS, _LEDGE_POINTS, _BROKEN_M = 3, 3, 0.03
"""An open gutter may lie so near before a curb that its wall, 8 cm wide (JIS A 5372: 4.5 to 9 cm),
is all that the curb stands on: where a foot is broken by so much, m RMS (half of a step as low as 6
cm), what is next to the face counts alone if it is even."""

_LENGTHENED, _LOOKS_LENGTHENED = 3, 4
"""How many lengths of a piece are tried, each twice the one before: a foot of up to 96 cm, a quick
look of up to 80 cm. More would reach over an edging or a gutter. By trial."""

_SLOPE_SD, _TOP_SLOPE_SD = 0.15, 0.10
"""Standard deviations of slopes, m per m, by which short pieces are held: of pavements about level,
and of a top about its foot, since both drain alike. By trial."""

_LEAST_NOISE_M, _MOST_NOISE_M, _SAMPLED_CELLS = 0.003, 0.02, 10
"""Bounds of a scanline's noise, m: pavement's own texture, and what would hide a step of 3 cm; one
piece every 20 cm is asked."""

_MODEL_M = 0.003
"""How far pavement departs from a straight piece, m: the evenness of asphalt over some decimetres.
By trial."""

_LEAST_SURE = 3.0
"""Least height of a step in its standard deviations: noise alone exceeds it at one place in 740."""

_LOOK_CELLS, _HINT = 5, 1.0
"""The quick look before anything is fitted compares 10 cm on either side; what rises by less than
the least step times the latter is left out. Results are the same with less time (measured when it
was introduced)."""

_GAP_OF_LOOK = 3
"""Cells between the two sides of the quick look, 6 cm: the width of a chamfered face."""

_SHADOW_TOP_CELLS, _MOST_SHADOW_CELLS, _SHADOW_MORE_M = 8, 60, 0.15
"""Length of a top behind a shadow, 16 cm, as behind other faces; the longest shadow, 1.2 m, of a
curb of 45 cm some metres away; how much longer than a ray over the edge says it may be, for what a
rough edge adds. By trial."""

_APART_CELLS = 5
"""Steps nearer than 10 cm are one: an edging stone is wider. By trial."""

_SEEN_CELLS = 30
"""Ground before and behind is followed for 60 cm: more makes a curb no surer (see `_WIDEST_M` in
`curb_confidence`)."""

_OFF_M, _OFF_SHARE = 0.025, 0.10
"""How far ground that goes on may lie off its straight piece: at once, m, and per metre, the
standard deviation of a top's slope. By trial."""

_GAPS = np.array([1, 3, 6, 9, 1, 3], np.int64)
"""Cells that the face takes: 2 cm of an upright one, 6 and 12 cm of bevels, 18 cm of ramp
stones."""

_TOPS = np.array([8, 8, 8, 8, 4, 4], np.int64)
"""Cells of the top behind each: 16 cm, that of a kerb stone; 8 cm where something grows behind
it."""

_NARROW_TOP_CELLS = 4
"""A top of no more cells than this is narrow."""

_NEARLY = 0.999
"""Guard of rounding: what could just reach the least height is fitted."""

_SUMS = 7
_ONES, _U, _V, _UU, _UV, _VV, _WALLS = range(_SUMS)
"""Columns of the running sums over cells: of 1, place u, height v, their products, and walls."""


class StepLimits(NamedTuple):
    """What the steps of scanlines may be.

    Attributes
    ----------
    least_m, most_m : float
        Height of a step.
    steepest : float
        Slope of ground, m per m.
    half_m : float
        Half the width looked at.
    scanner_m : float
        Least height of a scanner above the road; infinite where lines don't run from it.
    """

    least_m: float
    most_m: float
    steepest: float
    half_m: float
    scanner_m: float


class _Step(NamedTuple):
    """Where a step is looked for: cell; 1 up to the right, −1 to the left; kind of face.

    A face is a row of `_GAPS` and `_TOPS`, or minus the cells in shadow.
    """

    cell: int
    sign: int
    face: int


class _Piece(NamedTuple):
    """A straight piece of ground through the cells of a scanline.

    Attributes
    ----------
    filled : float
        Filled cells; 0: there is no piece.
    at, height : float
        Their middle, m.
    slope : float
        m per m.
    square : float
        Mean square off it, with what is known before, m².
    held : float
        What holds the slope, m².
    own_square : float
        Mean square off it, m².
    """

    filled: float
    at: float
    height: float
    slope: float
    square: float
    held: float
    own_square: float


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
    across: _Floats, height: _Floats, starts: _Integers, limits: StepLimits, found: _Floats
) -> int:
    """The steps of scanlines; gives how many there are: beyond the room they are counted only.

    ``across`` and ``height`` (n,) are vertices, left to right, m; ``starts`` (s + 1,) where the
    scanlines begin. ``found`` (k, of.STEP_COLUMNS) is filled in the order of the scanlines.
    """
    cells = int(2 * limits.half_m / CELL_M)
    flat, sums = np.empty((5, cells)), np.empty((cells + 1, _SUMS))
    shadows, chosen, sure = np.empty(cells, np.int64), np.empty(cells, np.int64), np.empty(cells)
    line = _Line(limits.half_m, flat[0], flat[1], flat[2], flat[3], sums, flat[4], shadows)
    count = 0
    for section in range(starts.size - 1):
        part = slice(starts[section], starts[section + 1])
        if part.stop - part.start < 2 * _LEAST_FOOT_CELLS:
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
                if _describe(line, _Step(cell, sign, chosen[cell]), limits, noise, row):
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
    for pass_number in range(2):
        ground = math.inf
        for k in range(level.size):
            cell = k if pass_number == 0 else level.size - 1 - k
            ground += _STEEPEST_RISE_M
            if counts[cell] > 0:
                ground = min(ground, level[cell])
            near[pass_number, cell] = ground
    for cell in range(level.size):
        if level[cell] > min(near[0, cell], near[1, cell]) + _WALL_M:
            counts[cell] = 0.0


@kernel
def _sum_up(line: _Line) -> None:
    """Running sums over cells."""
    level, low, high, counts, sums = line.level, line.low, line.high, line.counts, line.sums
    ones, su, sv, suu, suv, svv, walls = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    sums[0] = 0.0
    for cell in range(level.size):
        if counts[cell] > 0:
            u, v = (cell + 0.5) * CELL_M, level[cell]
            ones += 1
            su += u
            sv += v
            suu += u * u
            suv += u * v
            svv += v * v
            if high[cell] - low[cell] > _WALL_M:
                walls += 1
        # Written one by one: copying rows took fifteen times as long.
        k = cell + 1
        sums[k, _ONES], sums[k, _U], sums[k, _V], sums[k, _WALLS] = ones, su, sv, walls
        sums[k, _UU], sums[k, _UV], sums[k, _VV] = suu, suv, svv


@kernel
def _noise(sums: _Floats) -> float:
    """Mean square of how far cells lie off straight pieces of a scanline, m²: the median piece."""
    rough = np.empty(sums.shape[0] // _SAMPLED_CELLS + 1)
    count = 0
    for cell in range(0, sums.shape[0] - 1 - _FOOT_CELLS, _SAMPLED_CELLS):
        piece = _piece(sums, cell, cell + _FOOT_CELLS, (0.0, 1.0, _LEAST_NOISE_M**2))
        if piece.filled > _LEAST_FOOT_CELLS:
            rough[count] = piece.own_square * piece.filled / (piece.filled - 2)
            count += 1
    usual = np.median(rough[:count]) if count > 0 else _MOST_NOISE_M**2
    return float(min(max(usual, _LEAST_NOISE_M**2), _MOST_NOISE_M**2))


@kernel
def _piece(sums: _Floats, begin: int, end: int, known: tuple[float, float, float]) -> _Piece:
    """A straight piece through cells, its slope held as ``known``: slope, deviation, noise."""
    slope, slope_sd, noise = known
    if (
        begin == end
        or sums[end, _ONES] - sums[begin, _ONES] < 1
        or sums[end, _WALLS] > sums[begin, _WALLS]
    ):
        return _Piece(0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)
    n = sums[end, _ONES] - sums[begin, _ONES]
    u = (sums[end, _U] - sums[begin, _U]) / n
    v = (sums[end, _V] - sums[begin, _V]) / n
    uu = sums[end, _UU] - sums[begin, _UU] - n * u * u
    uv = sums[end, _UV] - sums[begin, _UV] - n * u * v
    vv = sums[end, _VV] - sums[begin, _VV] - n * v * v
    held = noise / slope_sd**2
    found = (uv + held * slope) / (uu + held)
    squares = max(vv - 2 * found * uv + found * found * uu, 0.0)
    return _Piece(n, u, v, found, (squares + 2 * noise) / (n + 2), uu + held, squares / n)


@kernel
def _error(piece: _Piece, at: float) -> float:
    """Squared error of a piece's height at a place."""
    square = piece.square
    return square / piece.filled + square * (at - piece.at) ** 2 / piece.held + _MODEL_M**2


@kernel
def _enough(sums: _Floats, edge: int, sign: int, width: int, wanted: int) -> int:
    """How many cells from an edge on hold enough for a straight piece; 0: not within reach."""
    for factor in range(_LENGTHENED):
        reach = width << factor
        far = edge + sign * reach
        if far < 0 or far >= sums.shape[0]:
            return 0
        n = abs(sums[far, _ONES] - sums[edge, _ONES])
        if n >= wanted or (factor == _LENGTHENED - 1 and n >= _FEWEST):
            return reach
    return 0


@kernel
def _foot(sums: _Floats, cell: int, sign: int, noise: float) -> _Piece:
    """The ground before a step, which ends at the cell."""
    edge = cell if sign > 0 else cell + 1
    known = (0.0, _SLOPE_SD, noise)
    far = edge - sign * _enough(sums, edge, -sign, _FOOT_CELLS, _FOOT_POINTS)
    foot = _piece(sums, min(edge, far), max(edge, far), known)
    if foot.own_square <= _BROKEN_M**2 or min(edge, edge - sign * _LEDGE_CELLS) < 0:
        return foot
    far = max(min(edge - sign * _LEDGE_CELLS, sums.shape[0] - 1), 0)
    ledge = _piece(sums, min(edge, far), max(edge, far), known)
    is_ledge = ledge.filled >= _LEDGE_POINTS and ledge.own_square < noise + _MODEL_M**2
    return ledge if is_ledge else foot


@kernel
def _top_cells(sums: _Floats, step: _Step) -> tuple[int, int, float]:
    """First and behind the last cell of the ground behind a step, and the middle of its face."""
    cell, sign, face = step
    edge = cell if sign > 0 else cell + 1
    gap = _GAPS[face] if face >= 0 else -face
    cells = _TOPS[face] if face >= 0 else _SHADOW_TOP_CELLS
    points = _TOP_POINTS if cells > _NARROW_TOP_CELLS else _NARROW_TOP_POINTS
    near = edge + sign * gap
    far = near + sign * _enough(sums, near, sign, cells, points)
    return min(near, far), max(near, far), (edge + sign * gap / 2) * CELL_M


@kernel
def _height(piece: _Piece, at: float) -> float:
    return piece.height + piece.slope * (at - piece.at)


@kernel
def _look_over(sums: _Floats, rises: _Floats, shadows: _Integers) -> None:
    """How much higher the cells to the right of each are than those before it: a quick look.

    0 where too few are filled. ``shadows`` are the empty cells beyond a foot on the far side of
    the vehicle's path, at the cell where the foot ends.
    """
    cells = rises.size
    shadows[:] = 0
    last = cells
    for cell in range(cells):
        rises[cell] = _rise(sums, cell)
        if sums[cell + 1, _ONES] == sums[cell, _ONES]:
            continue
        empty = cell - last - 1
        if _GAPS[2] < empty <= _MOST_SHADOW_CELLS:
            if last + 1 < cells // 2:
                shadows[last + 1] = empty
            if cell - 1 > cells // 2:
                shadows[cell - 1] = empty
        last = cell


@kernel
def _rise(sums: _Floats, cell: int) -> float:
    """How much higher the cells from the third after a place on are than those before it."""
    for factor in range(_LOOKS_LENGTHENED):
        reach = _LOOK_CELLS << factor
        if cell < reach or cell + _GAP_OF_LOOK + reach >= sums.shape[0]:
            break
        m = sums[cell, _ONES] - sums[cell - reach, _ONES]
        n = sums[cell + _GAP_OF_LOOK + reach, _ONES] - sums[cell + _GAP_OF_LOOK, _ONES]
        if min(m, n) >= _FEWEST:
            rise = (sums[cell + _GAP_OF_LOOK + reach, _V] - sums[cell + _GAP_OF_LOOK, _V]) / n
            return float(rise - (sums[cell, _V] - sums[cell - reach, _V]) / m)
    return 0.0


@kernel
def _judge_cells(
    line: _Line, sign: int, limits: StepLimits, noise: float, best: tuple[_Floats, _Integers]
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
        if shadow == 0 and rise < _HINT * limits.least_m:
            continue
        foot = _foot(sums, cell, sign, noise)
        if foot.filled == 0 or abs(foot.slope) > limits.steepest:
            continue
        squares = _error(foot, (cell if sign > 0 else cell + 1) * CELL_M) + _MODEL_M**2
        unit = _NEARLY * math.sqrt(max(foot.own_square - noise, 0.0) + squares)
        for face in range(-1 if shadow > 0 else 0, _GAPS.size):
            form = face if face >= 0 else -shadow
            least = max(max(sure[cell], _LEAST_SURE) * unit, limits.least_m)
            value = _significance(sums, _Step(cell, sign, form), limits, (noise, least), foot)
            if value > sure[cell]:
                sure[cell] = value
                chosen[cell] = form


@kernel
def _significance(
    sums: _Floats, step: _Step, limits: StepLimits, known: tuple[float, float], foot: _Piece
) -> float:
    """Height of a step in its standard deviations; 0 where it is none or lower than a least.

    ``known`` are noise and that least height.
    """
    noise, least = known
    begin, end, at = _top_cells(sums, step)
    n, base = sums[end, _ONES] - sums[begin, _ONES], _height(foot, at)
    if n == 0.0:
        return 0.0
    # Most of rough ground is left here, before anything is fitted: no slope makes it high enough.
    level, away = (sums[end, _V] - sums[begin, _V]) / n, (sums[end, _U] - sums[begin, _U]) / n - at
    if level + limits.steepest * abs(away) < base + least:
        return 0.0
    top = _piece(sums, begin, end, (foot.slope, _TOP_SLOPE_SD, noise))
    high = _height(top, at) - base
    if top.filled == 0 or abs(top.slope) > limits.steepest or not least <= high <= limits.most_m:
        return 0.0
    if step.face < 0:
        away = abs(step.cell * CELL_M - limits.half_m)
        if -step.face * CELL_M > high * away / limits.scanner_m + _SHADOW_MORE_M:
            return 0.0
    misfit = max(foot.own_square - noise, 0.0) + max(top.own_square - noise, 0.0)
    return float(high / math.sqrt(_error(foot, at) + _error(top, at) + misfit))


@kernel
def _is_peak(sure: _Floats, cell: int) -> bool:
    """Whether no cell nearby is surer; of equal ones the first counts."""
    for other in range(max(0, cell - _APART_CELLS), min(sure.size, cell + _APART_CELLS + 1)):
        if sure[other] > sure[cell] or (other < cell and sure[other] == sure[cell]):
            return False
    return True


@kernel
def _describe(line: _Line, step: _Step, limits: StepLimits, noise: float, row: _Floats) -> bool:
    """What is known of a step from the cells."""
    cell, sign, face = step
    foot = _foot(line.sums, cell, sign, noise)
    begin, end, at = _top_cells(line.sums, step)
    top = _piece(line.sums, begin, end, (foot.slope, _TOP_SLOPE_SD, noise))
    if foot.filled == 0 or top.filled == 0:
        return False
    low, high = _height(foot, at), _height(top, at)
    half_face = (_GAPS[face] if face >= 0 else -face) * CELL_M / 2
    row[of.SIGN] = sign
    row[of.FOOT_SLOPE], row[of.TOP_SLOPE] = foot.slope * sign, top.slope * sign
    row[of.LOWER_HEIGHT], row[of.UPPER_HEIGHT] = low, high
    row[of.LOWER_ACROSS] = at - sign * half_face - line.half
    row[of.UPPER_ACROSS] = at + sign * half_face - line.half
    row[of.FOOT_M] = _follow(line, at - sign * half_face, (low, foot.slope), -sign)
    row[of.TOP_M] = _follow(line, at + sign * half_face, (high, top.slope), sign)
    return bool(limits.least_m <= high - low <= limits.most_m)


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
        if sums[at + 1, _ONES] == sums[at, _ONES]:
            continue
        if sums[at + 1, _WALLS] > sums[at, _WALLS]:
            break
        away = (at + 0.5) * CELL_M - edge
        off = level[at] - height - slope * away
        if abs(off) > _OFF_M + _OFF_SHARE * abs(away):
            break
        seen = k
    return seen * CELL_M


def warm_up() -> None:
    """Compile the kernels."""
    line, limits = np.zeros(9), StepLimits(0.01, 0.45, 0.36, 1.5, 1.5)
    steps_kernel(line, line, np.array([0, 9]), limits, np.empty((8, of.STEP_COLUMNS)))
