"""What a shaft carries: wires, arms with what hangs on them, plates; and the type that follows.

Types follow from measures that standards and the use of the thing give, not from shares of
examples: a pole with several wires is a utility pole, a head on an arm above the road a lamp, a
signal or a sign by how tall and how thick it is.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.methods.road.poles.leaves import filled_cells
from processing.methods.road.poles.patch_kernels import (
    ASIDE,
    BULGING,
    EAST,
    PATCH_WIDTH,
    SMOOTH,
    STATE,
    UP,
    patches_kernel,
)
from processing.methods.road.poles.shafts import Shaft

_BESIDE_M = 0.04
"""Nearer points are the shaft's own, its bands and bolts."""

ARMS_FROM_M = 3.6
"""Arms, heads and wires are above: what hangs lower must leave room for people and has plates."""

_NEAR_M, _FAR_M = 1.2, 5.0
"""Wires are looked for between: farther out than cross-arms, and as far as points were taken."""

_WIRE_CELL_M, _WIRE_FEWEST = 0.5, 4
"""Cells whose points tell a direction."""

_THIN = 0.08
"""Extent across a wire's cell over that along it: a cable of 3 cm and its noise in half a metre."""

_LEVEL = 0.6
"""Rise over length: service drops fall by half their run, guy wires by more."""

_WIRED_CELLS = 4
"""On each side; of a wire seven in the reach, fewer where few scan lines meet it."""

_ABOVE_TOP_M = 0.4
"""So far above a shaft's top its wires may leave it; higher ones pass over."""

_TURNS, _STRIP_M, _BIN_M = 48, 0.5, 0.25
"""Directions of an arm, half the width about it, and pieces along it: signals are 0.45 m thick."""

_ARM_BELOW_M, _ABOVE_ARM_M = 1.6, 1.3
"""Arms leave a shaft near its top, the lower of two a plate's height below, and may rise beyond."""

_END_BELOW_M, _END_ABOVE_M = 0.8, 0.5
"""About an arm's height, what hangs at its end: lamps and signals, beside a neighbour's crown."""

_HANG_M = 0.3
"""Cells in which an arm hangs together: scan lines cross it every 0.3 m or nearer."""

_MOST_TURNS = 0.4
"""Share of the directions in which something reaches as far: an arm's strip fills a quarter of
them, a crown or a wall more."""

_ONE_WAY = 6
"""Directions that one arm fills as far as points were taken: a strip of a metre 5 m away."""

_LEAST_ARM_M = 0.55
"""Reach of an arm beyond the shaft's surface; steps, bands and boxes of meters are shorter."""

_LAMP_TALL_M, _SIGNAL_TALL_M, _SIGNAL_LONG_M = 0.34, 0.56, 2.0
"""Heights of what hangs on an arm: lamps up to 0.32 m thick; lenses of 25 and 30 cm in housings of
0.35 to 0.45 m (警察庁 信号灯器仕様), three of them 1.3 m long; plates over roads begin at 0.6 m."""

_TALL_M, _TALL_DIAMETER_M = 5.3, 0.105
"""Posts of signs and mirrors are lower and thinner: 60.5 to 101.6 mm (道路標識設置基準), with two
mirrors one above the other 4.5 m high. The slimmest ones, to 89.1 mm, are no lamps' however high
leaves let them seem."""

_WIRED_M, _CONCRETE_TAPER = 6.5, 0.003
"""Utility poles are higher: their lowest wire hangs 5 m over the road. Metres of radius lost in a
metre: half of what poles of concrete lose (JIS A 5373), and more than straight steel pipes."""

_STRAIGHT_TAPER, _SURE = 6e-4, 4.0
"""Metres of radius lost in a metre by what is measured of straight pipes at most, 2 mm of 3 m, and
standard deviations from which a taper isn't chance: two are 5 in 100, and beams that widen upwards
aren't chance either."""

_ROAD_ARM_M = 7.5
"""What hangs higher on an arm is a lamp: signs and signals over roads begin at 5 m (道路標識設置基
準) and are no taller than 2.5 m."""

_THICK_M = 0.5
"""Visors of signals and tilted plates are thinner across the arm."""

_PLATE_LOW_M, _PLATE_REACH_M = 1.0, 1.0
"""Plates on shafts hang above and reach so far."""

_PLATE_FEWEST, _LEAST_PLATE_M = 12, 0.25
"""Points from which a plate is told, and the size of the smallest."""

_CURVED = 0.3
"""Share of its patches, those across its rim or its back included."""

PIECE_M, _PATCHES = 0.4, 6
"""Height of a piece of a shaft, and patches that are looked at in each by each head: the smallest
plates are as high, and a crown above a sign has more points than the sign."""

_HELD_M, _HELD_FROM_M = 0.08, 0.3
"""How far a plate that a shaft holds stands before its surface, with its clamps; and how far from
it patches tell that."""

_LOW_PLATE_M = 1.3
"""Middles of patches below are of no road sign: lower edges of signs hang at 1.8 m, on narrow roads
somewhat lower (道路標識設置基準 2-2); timetables, cloths of banners and boards hang lower."""

_HEAD_M = 0.25
"""So near to its end, and above, a tall post holds a lamp's head; plates reach lower."""

_ONE_MIRROR_DEG = 15.0
"""Between patches of one mirror in plan: 0.25 m from the middle of one of 2.2 m radius it is 7
degrees; two mirrors on one post look into two streets."""

_BREAST_M = 1.2
"""Height above the foot at which diameters are told."""

_CANE_M, _SIGN_POST_M = 0.035, 0.095
"""Diameters of the thickest canes of banners; and beyond that of the posts of most signs
(89.1 mm): what thicker posts of 101.6 mm and more carry are signs if they shine, else boards of
shops."""

_BOARD, _BOARD_M = 0.5, 0.6
"""Share of the patches beside a post that are smooth where most are, and width, of a board that it
holds above people: a shop's, if it doesn't shine. Arms are pipes there, and what hangs at their
ends is farther out."""

_SHORT_M = 1.35
"""Bollards and delineators are lower: 0.65 to 0.85 m (車止め), up to 1.2 m (視線誘導標設置基準)."""

_THIN_POST_M, _REFLECTOR_POST_M, _REFLECTOR_HIGH_M = 0.07, 0.1, 0.87
"""Diameter between posts of delineators, 34 to 60.5 mm, and of bollards, 60.5 mm and more (JIS G
3444), and the least height of a delineator whose reflector is turned away: its middle hangs 90 cm
above the road (視線誘導標設置基準), bollards are lower. Up to the second diameter a reflector tells
delineators, of 89.1 mm and of rubber (80 mm), from bollards, whose bands shine too (114.3 mm and
more)."""

_THINNEST_BOLLARD_M = 0.05
"""No bollard is thinner: 60.5 mm, less what a scanner is off."""

_GOES_ON = 0.5
"""Share of the metre over the top that something fills, beyond which a plate or a cloth hides what
goes on there: bollards and delineators end free."""

_UTILITY_M, _UTILITY_HIGH_M = 0.2, 7.5
"""Diameter 1.2 m above the ground and height of a utility pole whose wires weren't seen: poles of
concrete are 14 to 22 cm thick at the top and a 75th more each metre below (JIS A 5373)."""


_CONCRETE_M = 0.27
"""Diameter 1.2 m above the ground beyond that of steel pipes along roads (267.4 mm, JIS G 3444):
what tapers besides is of concrete, whatever hides its upper part."""


class ShaftNeighbourhood(NamedTuple):
    """Points about a shaft, m about its foot.

    ``local``: (n, 3) those that are nearer to no other shaft; ``heads``: (n,) which head measured
    each; ``beyond``: (m, 3) those above people that are nearer to another, as ends of arms may be.
    """

    local: Floats
    heads: Integers
    beyond: Floats


@dataclass(frozen=True)
class Carried:
    """What a shaft carries; lengths in m.

    Attributes
    ----------
    wires : int
        Half metres of thin lines that leave it.
    arm_m : float
        Reach of its longest arm beyond its surface; 0: none.
    arm_height_m : float
        Of what hangs at its end, above the foot.
    long_m, tall_m, thick_m : float
        Of what hangs there: along the arm, upwards, across.
    plate_points : int
        Below `ARMS_FROM_M`, beside the shaft.
    plate_m : float
        The wider of the plate's extents.
    curved : float
        Share of its patches that bulge as mirrors do.
    smooth : float
        Share of the patches beside it that are smooth surfaces, plates and no twigs, where it is
        the largest along the shaft.
    plate_low_m : float
        Height of the lowest patch of a surface that it holds; infinite without one.
    mirror_deg : float
        Where its mirror looks, clockwise from north, 0 to 360; of several that to which most of
        their patches belong. NaN where no patch bulges.
    """

    wires: int = 0
    arm_m: float = 0.0
    arm_height_m: float = 0.0
    long_m: float = 0.0
    tall_m: float = 0.0
    thick_m: float = 0.0
    plate_points: int = 0
    plate_m: float = 0.0
    curved: float = 0.0
    smooth: float = 0.0
    plate_low_m: float = math.inf
    mirror_deg: float = math.nan


def carried_of(about: ShaftNeighbourhood, shaft: Shaft) -> Carried:
    """Measure what a shaft carries."""
    local, away = _upright(about.local, shaft)
    up = local[:, 2]
    is_high = (up > ARMS_FROM_M) & (away > _BESIDE_M)
    high = local[is_high]
    hung = high[:, 2] < shaft.top_m + _ABOVE_TOP_M
    wires = _wires(high[hung], away[is_high][hung])
    arm = _arm(high, _upright(about.beyond, shaft)[0], shaft)
    is_low = (up > _PLATE_LOW_M) & (up < max(ARMS_FROM_M, min(shaft.top_m, 5.0)) + 0.8)
    is_low &= (away > _BESIDE_M) & (away < _PLATE_REACH_M)
    points, wide, curved, smooth, low, facing = _plate(local[is_low], about.heads[is_low], shaft)
    return Carried(wires, *arm, points, wide, curved, smooth, low, facing)


def _upright(points: Floats, shaft: Shaft) -> tuple[Floats, Floats]:
    """Points about the axis as if it stood upright, and how far they are from the surface."""
    up = points[:, 2]
    plan = points[:, :2] - up[:, None] * shaft.lean
    radii = shaft.radius_m - shaft.taper * np.clip(up, 0, shaft.top_m)
    return np.column_stack([plan, up]), np.hypot(plan[:, 0], plan[:, 1]) - radii


def _wires(points: Floats, away: Floats) -> int:
    """Cells that hold a thin level line away from the shaft, on the side that has fewer of them."""
    far = points[(away > _NEAR_M) & (away < _FAR_M)]
    if len(far) < _WIRE_FEWEST:
        return 0
    _, member = filled_cells(np.floor(far / _WIRE_CELL_M).astype(np.int64))
    number = np.bincount(member).astype(np.float64)
    middle = np.column_stack([np.bincount(member, axis) / number for axis in far.T])
    off = far - middle[member]
    spread = np.empty((number.size, 3, 3))
    for i in range(3):
        for j in range(3):
            spread[:, i, j] = np.bincount(member, off[:, i] * off[:, j]) / number
    extents, axes = np.linalg.eigh(spread)
    is_line = (number >= _WIRE_FEWEST) & (extents[:, 1] < _THIN**2 * extents[:, 2])
    is_line &= extents[:, 2] > (_WIRE_CELL_M / 8) ** 2
    along = axes[:, :, 2]
    is_line &= np.abs(along[:, 2]) < _LEVEL * np.hypot(along[:, 0], along[:, 1])
    # Wires of a line leave towards two sides, arms towards one.
    main = _main_axis(middle[is_line, :2]) if np.count_nonzero(is_line) > 1 else np.ones(2)
    sides = middle[is_line, :2] @ main > 0
    return int(min(np.count_nonzero(sides), np.count_nonzero(~sides)))


def _arm(points: Floats, beyond: Floats, shaft: Shaft) -> tuple[float, float, float, float, float]:
    """Reach, height, length, height and thickness of the farthest thing on an arm."""
    none = (0.0, 0.0, 0.0, 0.0, 0.0)
    from_top = points[:, 2] - shaft.top_m
    points = points[(from_top > -_ARM_BELOW_M) & (from_top < _ABOVE_ARM_M)]
    points = points[_hang_on(points, shaft)]
    if len(points) < _WIRE_FEWEST:
        return none
    turns = np.asarray(np.arange(_TURNS) * (2 * np.pi / _TURNS), np.float64)
    along, across = _strip(points, turns, shaft)
    bins = np.floor(along / _BIN_M).astype(np.int64)
    count = int(_FAR_M / _BIN_M)
    inside = (np.abs(across) < _STRIP_M) & (bins >= 0) & (bins < count)
    filled = np.zeros((_TURNS, count), np.bool_)
    which, turn = np.nonzero(inside)
    filled[turn, bins[which, turn]] = True
    reach = np.array([_reach(one) for one in filled])
    most = int(reach.max())
    ties = np.flatnonzero(reach >= max(most - 1, 1))
    wide = np.count_nonzero(reach > 0.6 * most)
    if most * _BIN_M < _LEAST_ARM_M or wide > _MOST_TURNS * _TURNS:
        return none
    # What leads out of sight to one side of a straight pipe is an arm, of others and to more wires.
    is_long = shaft.taper < _CONCRETE_TAPER and ties.size <= _ONE_WAY
    if most == count and not (is_long and np.ptp(ties - ties[0]) in (ties.size - 1, _TURNS - 1)):
        return none
    # Of directions that reach as far, the one along whose middle the points lie.
    off = [float(np.abs(across[inside[:, one], one]).mean()) for one in ties]
    best = int(ties[int(np.argmin(off))])
    strip = np.column_stack([along[:, best], across[:, best], points[:, 2]])[inside[:, best]]
    return (
        _end_of(_led_on(strip, int(reach[best]), _strip_of(beyond, float(turns[best]), shaft)))
        or none
    )


def _strip(points: Floats, turns: Floats, shaft: Shaft) -> tuple[Floats, Floats]:
    """(n, t) each: how far points lie along directions beyond the shaft, and across."""
    along = points[:, :2] @ np.array([np.cos(turns), np.sin(turns)])
    across = points[:, :2] @ np.array([-np.sin(turns), np.cos(turns)])
    return along - shaft.radius_at(shaft.top_m), across


def _strip_of(beyond: Floats, turn: float, shaft: Shaft) -> Floats:
    """(m, 3) along, across and up of those of the points that lie along a direction."""
    along, across = _strip(beyond, np.array([turn]), shaft)
    strip = np.column_stack([along, across, beyond[:, 2]])
    return strip[(np.abs(strip[:, 1]) < _STRIP_M) & (strip[:, 0] > 0)]


def _led_on(strip: Floats, reach: int, beyond: Floats) -> tuple[Floats, int]:
    """An arm's strip with what leads on from it at its height beyond a neighbour's border.

    Arms over the road end beside trees and other poles; what these don't hold is the arm's.
    """
    level = float(np.median(strip[strip[:, 0] > (reach - 2) * _BIN_M, 2])) if len(strip) else 0.0
    up = beyond[:, 2] - level
    led = np.concatenate([strip, beyond[(up > -_END_BELOW_M) & (up < _END_ABOVE_M)]])
    bins = np.floor(led[:, 0] / _BIN_M).astype(np.int64)
    count = int(_FAR_M / _BIN_M)
    filled = np.zeros(count, np.bool_)
    filled[bins[bins < count]] = True
    farther = _reach(filled)
    return (led, farther) if reach < farther < count else (strip, reach)


def _end_of(arm: tuple[Floats, int]) -> tuple[float, float, float, float, float] | None:
    """Reach of an arm, and height, length, height and thickness of what hangs at its end."""
    strip, reach = arm
    long_m = float(reach * _BIN_M)
    end = strip[(strip[:, 0] <= long_m) & (strip[:, 0] > max(0.3, long_m - 1.4))]
    if len(end) < _WIRE_FEWEST:
        return None
    along, sides, heights = end.T
    return (
        long_m,
        float(np.median(heights)),
        float(np.ptp(along)),
        _tallest(along, heights),
        float(np.quantile(sides, 0.95) - np.quantile(sides, 0.05)),
    )


def _hang_on(points: Floats, shaft: Shaft) -> NDArray[np.bool_]:
    """(n,) points that hang together with the shaft: wires pass by, crowns stand beside."""
    from scipy import ndimage

    if not len(points):
        return np.zeros(0, np.bool_)
    cells = np.floor(points / _HANG_M).astype(np.int64)
    cells -= cells.min(axis=0)
    grid = np.zeros(cells.max(axis=0) + 1, np.bool_)
    where = tuple(cells.T)
    grid[where] = True
    parts, _ = ndimage.label(grid, np.ones((3, 3, 3)))
    part = parts[where]
    away = np.hypot(points[:, 0], points[:, 1]) - shaft.radius_at(shaft.top_m)
    touches = (away < _HANG_M) & (points[:, 2] < shaft.top_m + _HANG_M)
    return np.isin(part, np.unique(part[touches]))


def _reach(filled: NDArray[np.bool_]) -> int:
    """How many pieces from the shaft on are filled, gaps of two included."""
    last = -1
    for piece in np.flatnonzero(filled).tolist():
        if piece - last > 3:
            break
        last = piece
    return last + 1


def _tallest(along: Floats, heights: Floats) -> float:
    """Height of what hangs on an arm: the middle one of its three tallest pieces of 20 cm."""
    pieces = np.floor(along / 0.2).astype(np.int64)
    spans = [
        float(np.ptp(heights[pieces == piece]))
        for piece in np.unique(pieces)
        if np.count_nonzero(pieces == piece) > 1
    ]
    return float(np.median(np.sort(spans)[-3:])) if spans else 0.0


def _plate(
    points: Floats, heads: Integers, shaft: Shaft
) -> tuple[int, float, float, float, float, float]:
    """Points, width, shares of curved and of smooth patches of what hangs on a shaft.

    Also the height of the lowest surface that it holds, and where it bulges to.
    """
    if len(points) < _PLATE_FEWEST:
        return len(points), 0.0, 0.0, 0.0, math.inf, math.nan
    high = points[:, 2]
    width = max(
        float(np.quantile(high, 0.95) - np.quantile(high, 0.05)),
        float(np.ptp(np.quantile(points[:, :2] @ _main_axis(points[:, :2]), [0.05, 0.95]))),
    )
    pieces = (high / PIECE_M).astype(np.int64) * (heads.max() + 1) + heads
    order = np.argsort(pieces, kind="stable")
    groups = [
        members
        for members in np.split(order, np.flatnonzero(np.diff(pieces[order])) + 1)
        if len(members) >= _PLATE_FEWEST
    ]
    if not groups:
        return len(points), width, 0.0, 0.0, math.inf, math.nan
    middles = np.concatenate(
        [one[np.linspace(0, len(one) - 1, _PATCHES).astype(np.int64)] for one in groups]
    )
    told = np.empty((middles.size, PATCH_WIDTH))
    patches_kernel(points, heads, middles, np.zeros(2), told)
    is_smooth, is_curved = told[:, STATE] >= SMOOTH, told[:, STATE] == BULGING
    curved = float(is_curved.sum() / max(is_smooth.sum(), 1))
    smooth = float(is_smooth.reshape(-1, _PATCHES).mean(axis=1).max())
    radii = shaft.radius_m - shaft.taper * high[middles]
    is_held = is_smooth & (told[:, ASIDE] < radii + _HELD_M)
    is_held &= np.hypot(*points[middles, :2].T) < radii + _HELD_FROM_M
    low = float(high[middles[is_held]].min(initial=math.inf))
    return len(points), width, curved, smooth, low, _facing_deg(told[is_curved, EAST : UP + 1])


def _facing_deg(looks: Floats) -> float:
    """Bearing in which most of some unit vectors look: the mean of the largest group."""
    if not len(looks):
        return math.nan
    plan = looks[:, :2].copy()
    plan /= np.maximum(np.hypot(plan[:, 0], plan[:, 1]), 1e-9)[:, None]
    alike = plan @ plan.T > math.cos(math.radians(_ONE_MIRROR_DEG))
    east, north = plan[alike[int(alike.sum(axis=1).argmax())]].sum(axis=0).tolist()
    return math.degrees(math.atan2(east, north)) % 360.0


def _main_axis(plan: Floats) -> Floats:
    _, axes = np.linalg.eigh(np.cov(plan.T))
    return np.asarray(axes[:, 1])


def is_short(shaft: Shaft) -> bool:
    """Whether a shaft is as low as bollards and delineators are."""
    return shaft.top_m < _SHORT_M


def type_of(shaft: Shaft, carried: Carried, *, over: float, is_reflecting: bool) -> str:
    """The contract's name of a pole's type.

    Parameters
    ----------
    over : float
        Share of the metre above its top that something fills near its axis.
    is_reflecting : bool
        Whether it has a reflector or a face that shines.
    """
    diameter, high = 2 * shaft.radius_at(min(_BREAST_M, shaft.top_m / 2)), shaft.top_m
    if is_short(shaft) and over <= _GOES_ON:
        if is_reflecting:
            return "delineator" if diameter < _REFLECTOR_POST_M else "bollard"
        is_high = high > _REFLECTOR_HIGH_M and diameter < _THIN_POST_M
        return "delineator" if is_high or diameter < _THINNEST_BOLLARD_M else "bollard"
    has_plate = carried.plate_points >= _PLATE_FEWEST and carried.plate_m > _LEAST_PLATE_M
    plate = "mirror_pole" if carried.curved > _CURVED else "sign_pole"
    is_board = diameter > _SIGN_POST_M and not is_reflecting
    if diameter < _CANE_M or carried.plate_low_m < _LOW_PLATE_M or is_board:
        plate = "other" if plate == "sign_pole" or diameter < _CANE_M else plate
    # Posts that grow thinner upwards are made for lamps, those of signs are straight pipes.
    is_conical = high > ARMS_FROM_M and _is_conical(shaft)
    is_slim = diameter < (_TALL_DIAMETER_M if high < _TALL_M else _SIGN_POST_M)
    if is_slim and has_plate and not is_conical and _holds_plate(shaft, carried):
        return plate
    if _is_for_wires(shaft, carried, diameter):
        return "utility_pole"
    if is_board and has_plate and not is_conical and high < _WIRED_M and _is_high_board(carried):
        return "other"
    if high > ARMS_FROM_M and carried.arm_m >= _LEAST_ARM_M:
        return _of_arm(carried)
    if high > _TALL_M or is_conical:
        return "street_light" if diameter < _UTILITY_M else "utility_pole"
    return plate if has_plate else "other"


def _is_conical(shaft: Shaft) -> bool:
    """Whether a shaft grows thinner upwards beyond what chance and beams make of a pipe."""
    return shaft.taper > max(_STRAIGHT_TAPER, _SURE * shaft.taper_deviation)


def _holds_plate(shaft: Shaft, carried: Carried) -> bool:
    """Whether what hangs on a tall post is fastened below its end, as no lamp's head is."""
    return shaft.top_m < ARMS_FROM_M or carried.plate_low_m < shaft.top_m - _HEAD_M


def _is_for_wires(shaft: Shaft, carried: Carried, diameter_m: float) -> bool:
    """Whether several wires leave it on both sides, or it is of concrete."""
    high = shaft.top_m
    if high > _WIRED_M and carried.wires >= _WIRED_CELLS:
        return True
    is_thick = diameter_m > _CONCRETE_M and high > ARMS_FROM_M
    is_tall = diameter_m > _UTILITY_M and high > _UTILITY_HIGH_M
    return (is_thick or is_tall) and shaft.taper > _CONCRETE_TAPER


def _is_high_board(carried: Carried) -> bool:
    """Whether what a post holds is wide and smooth and hangs above people."""
    is_wide = carried.smooth >= _BOARD and carried.plate_m > _BOARD_M
    return is_wide and ARMS_FROM_M < carried.plate_low_m < math.inf


def _of_arm(carried: Carried) -> str:
    if carried.arm_m >= _FAR_M:
        return "arm_pole"  # no lamp's arm is as long
    if carried.tall_m < _LAMP_TALL_M or carried.arm_height_m > _ROAD_ARM_M:
        return "street_light"
    if carried.thick_m > _THICK_M:
        return "street_light"  # a crown about it
    is_signal = carried.tall_m < _SIGNAL_TALL_M and carried.long_m < _SIGNAL_LONG_M
    return "signal_pole" if is_signal else "arm_pole"
