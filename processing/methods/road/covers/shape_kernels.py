"""Loops over the cells about a place: the circle or rectangle that parts them best."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel

BAND_M = 0.1
"""Of an edge's inside and outside that are compared: so near to each other that patches of dirt and
water, which change over decimetres, hardly differ."""

CHANNELS = 3
"""Tone, height, share of points below the surface."""

PATCHY = (0.05, 0.0006, 0.03)
"""What the bands on both sides of any edge on a road differ by, where nothing lies: dirt, damp and
wheels' polish change tones by as much over a decimetre; of a texture of 0.3 to 1.5 mm (mean profile
depth, ISO 13473-1) about half is left, m, in the mean of a band."""

_OCTANTS, _FEWEST = 8, 20
_STEEP_M = 0.06
"""How far a road rises within a metre; curbs are higher."""

_OF_MEDIAN = 1.0 / (0.6745 * math.sqrt(2.0))
"""Standard deviation of a value over the median size of the difference of two."""

_LEAST_SEEN = 1.0
"""Weight of the cells of a band in an eighth of an edge."""

_STEPS_M = (0.08, 0.04, 0.02, 0.01)
"""Of the search around the best start; a fifth of what is asked for at the end."""

_TURN_RAD = (0.2, 0.12, 0.06, 0.03)
_ROUNDS = 4
_BOXES, _MOST_STARTS = 2, 24
_LEAST_BEGUN = 16.0
"""Of an edge before it is moved into its place: chance alone makes a mean of 2."""

_SMALLEST_M, _LARGEST_M = 0.06, 0.75
"""Half a cover's side, least and most."""

_MOST_LONG = 2.6
"""Length over width of covers."""

_RATIOS = ((0.88, 0.88), (1.0, 0.75), (1.25, 0.62), (1.7, 0.85), (1.35, 0.9))
"""Half sides of rectangles that are begun with, over the radius of the best circle."""


@kernel
def rows_kernel(cells: Floats, cell_m: float, rows: Integers) -> None:
    """Where the rows of cells begin, and each of their columns: what lies far from an edge is left.

    ``rows``: (2 n, 2 n + 1), for as many cells on both sides of the place, gets the number of the
    first cell in a row at a column or behind it. ``cells`` are in the order of `cells_about`.
    """
    half, begun = len(rows) // 2, 0
    starts = rows.reshape(-1)
    for k in range(len(cells)):
        row = math.floor(cells[k, 0] / cell_m) + half
        place = row * rows.shape[1] + math.floor(cells[k, 1] / cell_m) + half + 1
        starts[begun:place] = k
        begun = place
    starts[begun:] = len(cells)


@kernel
def gain_of(cells: Floats, rows: Integers, noise: Floats, cell_m: float, shape: Floats) -> float:
    """How surely a shape's edge parts something, all around: a sum of squares of t-values.

    In eight sectors of the edge the means of a band inside and one outside are compared. Of each
    channel the mean difference is held against what it would vary by: the noise of cells, and how
    much it differs from sector to sector. What dirt and water part differs from sector to sector.

    ``cells``: (n, 7) place, tone, height, share below, weight of the first two, weight of all.
    ``rows``: of `rows_kernel`. ``noise``: standard deviations of the three. Cells on the edge
    itself count by how far they lie off it.
    """
    sums = np.zeros((_OCTANTS, 2, 7))
    cosine, sine = math.cos(shape[4]), math.sin(shape[4])
    wide_x, wide_y = shape[2] + BAND_M, shape[2] + BAND_M
    if shape[3] > 0.0:
        turned = shape[3] + BAND_M
        wide_y = abs(sine) * wide_x + abs(cosine) * turned
        wide_x = abs(cosine) * wide_x + abs(sine) * turned
    columns = _columns(shape[1], wide_y, cell_m, len(rows))
    first, last = _columns(shape[0], wide_x, cell_m, len(rows))
    for row in range(first, last):
        part = rows[row, columns[0]], rows[row, columns[1]]
        _add_to_octants(cells, part, shape, cell_m, sums)
    return _sure_of(sums, noise)


@kernel
def _columns(middle: float, wide: float, cell_m: float, many: int) -> tuple[int, int]:
    """The first column that reaches to a place less a width, and the first behind it."""
    first = math.floor((middle - wide) / cell_m) + many // 2
    last = math.floor((middle + wide) / cell_m) + many // 2 + 1
    return int(min(max(first, 0), many)), int(min(max(last, 0), many))


@kernel
def _add_to_octants(
    cells: Floats, part: tuple[int, int], shape: Floats, cell_m: float, sums: Floats
) -> None:
    """Add some cells to the sums of the eighths of a shape's edge that they lie by, if any."""
    long = shape[3] > 0.0
    cosine, sine = math.cos(shape[4]), math.sin(shape[4])
    for k in range(part[0], part[1]):
        x, y = cells[k, 0] - shape[0], cells[k, 1] - shape[1]
        if long:
            x, y = x * cosine + y * sine, y * cosine - x * sine
            along, across = abs(x), abs(y)
            depth = min(shape[2] - along, shape[3] - across)
            if depth < 0.0 and shape[2] < along and shape[3] < across:
                continue
            along /= shape[2]
            across /= shape[3]
        else:
            along, across = abs(x), abs(y)
            depth = shape[2] - math.sqrt(x * x + y * y)
        if depth > BAND_M or depth < -BAND_M:
            continue
        octant = (1 if x > 0 else 0) + (2 if y > 0 else 0) + (4 if along > across else 0)
        own = sums[octant, 0 if depth > 0 else 1]
        share = min(abs(depth) / (0.5 * cell_m), 1.0)
        w, v = share * cells[k, 5], share * cells[k, 6]
        own[0] += w
        own[1] += w * cells[k, 2]
        own[2] += w * cells[k, 3]
        own[3] += v
        own[4] += v * cells[k, 4]
        own[5] += w * cells[k, 2] * cells[k, 2]
        own[6] += w * cells[k, 3] * cells[k, 3]


@kernel
def _sure_of(sums: Floats, noise: Floats) -> float:
    """The sum of the squares of three t-values, each 0 where three sectors or more weren't seen."""
    found = 0.0
    for channel in range(CHANNELS):
        weight = 3 if channel == 2 else 0
        value = (1, 2, 4)[channel]
        total, mean, square, rest, mixed = 0.0, 0.0, 0.0, 0.0, 0.0
        for k in range(_OCTANTS):
            one, other = sums[k, 0, weight], sums[k, 1, weight]
            if one < _LEAST_SEEN or other < _LEAST_SEEN:
                continue
            inner, outer = sums[k, 0, value] / one, sums[k, 1, value] / other
            off = inner - outer
            if channel < 2:
                mixed += (sums[k, 0, 5 + channel] / one - inner * inner) / 2
                mixed += (sums[k, 1, 5 + channel] / other - outer * outer) / 2
            total += 1.0
            mean += off
            square += off * off
            rest += 1.0 / one + 1.0 / other
        if total < _OCTANTS - 2:
            continue
        mean /= total
        between = max(square / total - mean * mean, 0.0) * total / (total - 1.0)
        within = noise[channel] ** 2 * rest / total
        # Bands that hold more than one thing, as both sides of a line, are no cover's.
        patchy = PATCHY[channel] ** 2 + max(mixed / total - 2.0 * noise[channel] ** 2, 0.0)
        found += total * mean * mean / (max(between, within) + patchy)
    return found


class LookedAt(NamedTuple):
    """A place that shapes are laid about.

    ``place``: in cells; ``half_m``: half sides of the box that differs there; ``reach_m``: how far
    about it cells count; ``off_m``: off the road's plane, beyond which they don't; ``cell_m``: how
    wide they are.
    """

    place: tuple[float, float]
    half_m: tuple[float, float]
    reach_m: float
    off_m: float
    cell_m: float


@kernel
def fit_kernel(
    layers: NDArray[np.float32],
    looked: LookedAt,
    radii: Floats,
    room: Floats,
    told: tuple[Floats, Floats, Floats],
) -> tuple[int, float, float]:
    """How many cells lie about a place, and the gains of the best circle and rectangle on them.

    Parameters
    ----------
    radii : (r,) float64
        That circles may be begun with.
    room : (n, 9) float64
        Gets the cells, flat and in m about the place.
    told : (noise, plane, shapes)
        (3,) the least standard deviations of cells, raised here; (3,) and (2, 5) get the road's
        plane, and the circle and the rectangle.
    """
    noise, plane, shapes = told
    count = cells_about(layers, looked.place, looked.reach_m / looked.cell_m, room)
    cells = room[:count]
    cells[:, :2] *= looked.cell_m
    if not level_kernel(cells, looked.half_m, looked.off_m, plane):
        return count, 0.0, 0.0
    noise_kernel(cells, noise)
    least = 0.6 * min(looked.half_m[0], looked.half_m[1])
    begun = radii[(least < radii) & (radii < looked.reach_m - 0.05)]
    gain, other = fit_shapes(cells, noise, looked.cell_m, (begun, looked.half_m), shapes)
    return count, gain, other


@kernel
def fit_shapes(
    cells: Floats,
    noise: Floats,
    cell_m: float,
    starts: tuple[Floats, tuple[float, float]],
    shapes: Floats,
) -> tuple[float, float]:
    """The best circle and the best rectangle about a place; their gains, 0 where there is none.

    ``starts``: radii of circles about the middle, and half sides of the box there. ``shapes``:
    (2, 5) gets them.
    """
    radii, box = starts
    rows = _rows_about(cells, cell_m)
    shifted, begun = np.zeros(5), np.zeros((_MOST_STARTS, 5))
    best, other = 0.0, 0.0
    for k in range(len(radii)):
        shifted[2] = radii[k]
        gain = gain_of(cells, rows, noise, cell_m, shifted)
        if gain > best:
            best = gain
            shapes[0] = shifted
    for k in range(rectangles_about(shapes[0], box, begun)):
        gain = gain_of(cells, rows, noise, cell_m, begun[k])
        if gain > other:
            other = gain
            shapes[1] = begun[k]
    if max(best, other) < _LEAST_BEGUN:
        return 0.0, 0.0
    if best > 0.0:
        best = _climb(cells, rows, noise, cell_m, shapes[0], best)
    # What the best circle tells after its climb is worth a second look; the box was looked at.
    for k in range(_BOXES, rectangles_about(shapes[0], box, begun)):
        gain = gain_of(cells, rows, noise, cell_m, begun[k])
        if gain > other:
            other = gain
            shapes[1] = begun[k]
    if other > 0.0:
        other = _climb(cells, rows, noise, cell_m, shapes[1], other)
    return best, other


@kernel
def _rows_about(cells: Floats, cell_m: float) -> Integers:
    """The rows of cells, as wide as they reach."""
    reach = 0.0
    for k in range(len(cells)):
        reach = max(reach, abs(cells[k, 0]), abs(cells[k, 1]))
    half = int(reach / cell_m) + 1
    rows = np.empty((2 * half, 2 * half + 1), np.int64)
    rows_kernel(cells, cell_m, rows)
    return rows


@kernel
def rectangles_about(circle: Floats, box: tuple[float, float], start: Floats) -> int:
    """Rectangles to begin with: a box, and those as large as a circle; how many.

    ``start``: (n, 5) gets them.
    """
    start[:] = 0.0
    start[0, 2], start[0, 3] = box[0], box[1]
    start[1, 2], start[1, 3] = box[0], box[1]
    start[1, 4] = math.pi / 4
    count = _BOXES
    if circle[2] <= 0.0:
        return count
    for one in range(len(_RATIOS)):
        long, wide = _RATIOS[one]
        for turn in range(4 if long > wide else 2):
            start[count, 0], start[count, 1] = circle[0], circle[1]
            start[count, 2] = min(max(circle[2] * long, _SMALLEST_M), _LARGEST_M)
            start[count, 3] = min(max(circle[2] * wide, _SMALLEST_M), _LARGEST_M)
            start[count, 4] = turn * math.pi / 4
            count += 1
    return count


@kernel
def _climb(
    cells: Floats, rows: Integers, noise: Floats, cell_m: float, shape: Floats, gain: float
) -> float:
    """Move a shape's middle and edges by smaller and smaller steps while that gains.

    After as many moves in vain as there are, all about a shape were tried.
    """
    shifted = np.empty(5)
    moves = 6 if shape[3] <= 0.0 else 10
    for level in range(len(_STEPS_M)):
        in_vain = 0
        for number in range(_ROUNDS * moves):
            shifted[:] = shape
            _move(shifted, number % moves, level)
            value = gain_of(cells, rows, noise, cell_m, shifted) if _is_cover(shifted) else 0.0
            in_vain += 1
            if value > gain:
                gain, in_vain = value, 0
                shape[:] = shifted
            if in_vain == moves:
                break
    return gain


@kernel
def _move(shape: Floats, move: int, level: int) -> None:
    """One of the small moves: of a circle's middle and radius, of a rectangle's sides and angle."""
    step = _STEPS_M[level] if move % 2 == 0 else -_STEPS_M[level]
    if shape[3] <= 0.0:
        shape[move // 2] += step
    elif move < 8:
        # One side moves, and the middle by half of that.
        axis, end = (move // 2) % 2, 1.0 if move < 4 else -1.0
        angle = shape[4] + axis * math.pi / 2
        shape[2 + axis] += step / 2
        shape[0] += end * math.cos(angle) * step / 2
        shape[1] += end * math.sin(angle) * step / 2
    else:
        shape[4] += _TURN_RAD[level] if move == 8 else -_TURN_RAD[level]


@kernel
def _is_cover(shape: Floats) -> bool:
    """Whether a shape is as large and as long as covers may be."""
    if not _SMALLEST_M <= shape[2] <= _LARGEST_M:
        return False
    if shape[3] <= 0.0:
        return True
    long, wide = max(shape[2], shape[3]), min(shape[2], shape[3])
    return bool(wide >= _SMALLEST_M and long <= _LARGEST_M and long <= _MOST_LONG * wide)


@kernel
def cells_about(
    layers: NDArray[np.float32], place: tuple[float, float], reach: float, cells: Floats
) -> int:
    """The cells of a window about a place; how many.

    ``place``, ``reach``: in cells. ``cells`` gets places in cells from the place, then what the
    layers hold, and the differences to the next cells' tones and heights; NaN where there is none.
    """
    size = layers.shape[1]
    count = 0
    for i in range(max(0, int(place[0] - reach)), min(size, int(place[0] + reach) + 1)):
        for j in range(max(0, int(place[1] - reach)), min(size, int(place[1] + reach) + 1)):
            x, y = i + 0.5 - place[0], j + 0.5 - place[1]
            if layers[3, i, j] <= 0 or x * x + y * y > reach * reach or count >= len(cells):
                continue
            cells[count, 0], cells[count, 1] = x, y
            cells[count, 2], cells[count, 3] = layers[1, i, j], layers[2, i, j]
            cells[count, 4] = layers[4, i, j]
            cells[count, 5], cells[count, 6] = layers[0, i, j], layers[3, i, j]
            cells[count, 7] = cells[count, 8] = np.nan
            if j > 0 and layers[0, i, j] > 0 and layers[0, i, j - 1] > 0:
                cells[count, 7] = layers[1, i, j] - layers[1, i, j - 1]
                cells[count, 8] = layers[2, i, j] - layers[2, i, j - 1]
            count += 1
    return count


@kernel
def noise_kernel(cells: Floats, noise: Floats) -> None:
    """Raise the least standard deviations of single cells to those of neighbours' differences."""
    for channel in range(2):
        steps = np.empty(len(cells))
        count = 0
        for k in range(len(cells)):
            if not math.isnan(cells[k, 7 + channel]):
                steps[count] = abs(cells[k, 7 + channel])
                count += 1
        if count >= _FEWEST:
            noise[channel] = max(noise[channel], _OF_MEDIAN * _median(steps[:count]))


@kernel
def level_kernel(cells: Floats, half: tuple[float, float], off_m: float, plane: Floats) -> bool:
    """Take off the heights the plane of the road about a box, and leave out what is far off it.

    Three rounds, each without what lies far off the plane before; the first is held against the
    middle height. Cells that are left out, and those without points of the surface, have no weight
    and no tone. False: too few cells tell.
    """
    chosen, off, rest = np.empty(len(cells), np.bool_), np.zeros(len(cells)), np.empty(len(cells))
    middle, spread = 0.0, np.inf
    off[:] = cells[:, 3]
    chosen[:] = cells[:, 5] > 0
    for turn in range(4):
        if turn > 0:
            _choose(cells, off, half, (middle, 3.0 * spread), chosen)
            if chosen.sum() < _FEWEST or not _plane_of(cells, chosen, plane):
                return False
            off[:] = cells[:, 3] - plane[0] - plane[1] * cells[:, 0] - plane[2] * cells[:, 1]
        if turn < 3:
            count = 0
            for k in range(len(cells)):
                rest[count] = off[k]
                count += chosen[k]
            if count < _FEWEST:
                return False
            middle = _median(rest[:count])
            spread = _STEEP_M / 3.0
            if turn > 0:
                rest[:count] = np.abs(rest[:count] - middle)
                spread = max(1.5 * _median(rest[:count]), 0.001)
    for k in range(len(cells)):
        cells[k, 3] = off[k]
        if cells[k, 5] <= 0 or abs(off[k]) > off_m:
            cells[k, 2:4] = 0.0
            cells[k, 6] = 0.0 if cells[k, 5] > 0 else cells[k, 6]
            cells[k, 5] = 0.0
    return True


@kernel
def _median(values: Floats) -> float:
    """The median of values, which are put into another order; a quarter of ``np.median``'s time."""
    half = len(values) // 2
    upper = _put_in_place(values, half)
    return upper if len(values) % 2 else (float(values[:half].max()) + upper) / 2.0


@kernel
def _put_in_place(values: Floats, rank: int) -> float:
    """The value of a rank, moved there with all smaller ones before it.

    Hoare 1961, "Find" (algorithm 65), with the partition of Lomuto, which needs no branch that a
    processor could mispredict: where half of all values are on each side, that is half of the time.
    """
    first, last = 0, len(values) - 1
    while first < last:
        low, middle, high = values[first], values[(first + last) // 2], values[last]
        pivot = max(min(low, middle), min(max(low, middle), high))
        place = first
        for k in range(first, last + 1):
            value = values[k]
            values[k] = values[place]
            values[place] = value
            place += value < pivot
        if rank < place:
            last = place - 1
            continue
        # Nothing or not enough lies below: those alike come next.
        first = place
        for k in range(first, last + 1):
            value = values[k]
            values[k] = values[place]
            values[place] = value
            place += value == pivot
        if rank < place:
            return float(pivot)
        first = place
    return float(values[rank])


@kernel
def _choose(
    cells: Floats,
    off: Floats,
    half: tuple[float, float],
    near: tuple[float, float],
    chosen: NDArray[np.bool_],
) -> None:
    """Which cells lie about a box, with a height off the plane so near to a middle one."""
    for k in range(len(cells)):
        is_about = abs(cells[k, 0]) > half[0] or abs(cells[k, 1]) > half[1]
        chosen[k] = is_about and cells[k, 5] > 0 and abs(off[k] - near[0]) < near[1]


@kernel
def _plane_of(cells: Floats, chosen: NDArray[np.bool_], plane: Floats) -> bool:
    """The plane of heights through some cells: height at the middle, and rise along both axes."""
    s = np.zeros(9)
    for k in range(len(cells)):
        if chosen[k]:
            x, y, h = cells[k, 0], cells[k, 1], cells[k, 3]
            s[0] += 1.0
            s[1] += x
            s[2] += y
            s[3] += x * x
            s[4] += x * y
            s[5] += y * y
            s[6] += h
            s[7] += x * h
            s[8] += y * h
    n = s[0]
    mx, my, mh = s[1] / n, s[2] / n, s[6] / n
    xx, xy, yy = s[3] / n - mx * mx, s[4] / n - mx * my, s[5] / n - my * my
    xh, yh = s[7] / n - mx * mh, s[8] / n - my * mh
    det = xx * yy - xy * xy
    if det <= 0.02 * xx * yy or det <= 0.0:
        return False
    plane[1] = (xh * yy - yh * xy) / det
    plane[2] = (yh * xx - xh * xy) / det
    plane[0] = mh - plane[1] * mx - plane[2] * my
    return True
