"""What a shaft carries: wires, arms with what hangs on them, plates; and the type that follows.

Types follow from measures that standards and the use of the thing give, not from shares of
examples: a pole with several wires is a utility pole, a head on an arm above the road a lamp, a
signal or a sign by how tall and how thick it is.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.methods.road.poles.shafts import Shaft

_BESIDE_M = 0.04
"""Nearer points are the shaft's own, its bands and bolts."""

_HIGH_M = 3.6
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

_HANG_M = 0.3
"""Cells in which an arm hangs together: scan lines cross it every 0.3 m or nearer."""

_MOST_TURNS = 0.4
"""Share of the directions in which something reaches as far: an arm's strip fills a quarter of
them, a crown or a wall more."""

_LEAST_ARM_M = 0.55
"""Reach of an arm beyond the shaft's surface; steps, bands and boxes of meters are shorter."""

_LAMP_TALL_M, _SIGNAL_TALL_M, _SIGNAL_LONG_M = 0.34, 0.56, 2.0
"""Heights of what hangs on an arm: lamps up to 0.32 m thick; lenses of 25 and 30 cm in housings of
0.35 to 0.45 m (警察庁 信号灯器仕様), three of them 1.3 m long; plates over roads begin at 0.6 m."""

_TALL_M, _TALL_DIAMETER_M = 5.3, 0.105
"""Posts of signs and mirrors are lower and thinner: 60.5 to 101.6 mm (道路標識設置基準), with two
mirrors one above the other 4.5 m high."""

_WIRED_M, _CONCRETE_TAPER = 6.5, 0.003
"""Utility poles are higher: their lowest wire hangs 5 m over the road. Metres of radius lost in a
metre: half of what poles of concrete lose (JIS A 5373), and more than straight steel pipes."""

_THICK_M = 0.5
"""Visors of signals and tilted plates are thinner across the arm."""

_PLATE_LOW_M, _PLATE_REACH_M = 1.0, 1.0
"""Plates on shafts hang above and reach so far."""

_PLATE_FEWEST, _LEAST_PLATE_M = 12, 0.25
"""Points from which a plate is told, and the size of the smallest."""

_CURVED = 0.3
"""Share of its patches, those across its rim or its back included."""

_PATCH_M = 0.35
"""Radius of patches whose bulge is told: the smallest mirror has 0.3 m."""

_PIECE_M, _PATCHES = 0.4, 6
"""Height of a piece of a shaft, and patches that are looked at in each: the smallest plates are as
high, and a crown above a sign has more points than the sign."""

_PATCH_WIDE_M, _SMOOTH_M = 0.06, 0.01
"""Standard deviation of a patch's points along its shorter side, and off its surface: lines, edges
and two plates in one patch tell nothing."""

_LEAST_RADIUS_M, _MOST_RADIUS_M = 0.8, 6.0
"""Radii of curvature of road mirrors: 1.5 to 3.6 m (道路反射鏡設置指針), those of
yards less, and the error of it."""

_ONE_MIRROR_DEG = 15.0
"""Between patches of one mirror in plan: 0.25 m from the middle of one of 2.2 m radius it is 7
degrees; two mirrors on one post look into two streets."""

_SHORT_M = 1.35
"""Bollards and delineators are lower: 0.65 to 0.85 m (車止め), up to 1.2 m (視線誘導標設置基準)."""

_THIN_POST_M, _REFLECTOR_POST_M = 0.07, 0.1
"""Diameter between posts of delineators, 34 to 60.5 mm, and of bollards, 76.3 mm and more
(JIS G 3444). Up to the second one a reflector tells delineators, of 89.1 mm and of rubber (80 mm),
from bollards, whose bands shine too (114.3 mm and more)."""

_UTILITY_M, _UTILITY_HIGH_M = 0.2, 7.5
"""Diameter 1.2 m above the ground and height of a utility pole whose wires weren't seen: poles of
concrete are 14 to 22 cm thick at the top and a 75th more each metre below (JIS A 5373)."""


_CONCRETE_M = 0.27
"""Diameter 1.2 m above the ground beyond that of steel pipes along roads (267.4 mm, JIS G 3444):
what tapers besides is of concrete, whatever hides its upper part."""


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
        Below `_HIGH_M`, beside the shaft.
    plate_m : float
        The wider of the plate's extents.
    curved : float
        Share of its patches that bulge as mirrors do.
    smooth : float
        Share of the patches beside it that are smooth surfaces, plates and no twigs, where it is
        the largest along the shaft.
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
    mirror_deg: float = math.nan


def carried_of(points: Floats, shaft: Shaft) -> Carried:
    """Measure what a shaft carries.

    Parameters
    ----------
    points : (n, 3) float64
        m about its foot; those that are nearer to no other shaft.
    """
    up = points[:, 2]
    plan = points[:, :2] - up[:, None] * shaft.lean
    away = (
        np.hypot(plan[:, 0], plan[:, 1])
        - shaft.radius_m
        + shaft.taper * np.clip(up, 0, shaft.top_m)
    )
    local = np.column_stack([plan, up])
    is_high = (up > _HIGH_M) & (away > _BESIDE_M)
    high = local[is_high]
    hung = high[:, 2] < shaft.top_m + _ABOVE_TOP_M
    wires = _wires(high[hung], away[is_high][hung])
    arm = _arm(high, shaft)
    is_low = (up > _PLATE_LOW_M) & (up < max(_HIGH_M, min(shaft.top_m, 5.0)) + 0.8)
    is_low &= (away > _BESIDE_M) & (away < _PLATE_REACH_M)
    plate = _plate(local[is_low])
    return Carried(wires, *arm, *plate)


def _wires(points: Floats, away: Floats) -> int:
    """Cells that hold a thin level line away from the shaft, on the side that has fewer of them."""
    far = points[(away > _NEAR_M) & (away < _FAR_M)]
    if len(far) < _WIRE_FEWEST:
        return 0
    _, member = np.unique(
        np.floor(far / _WIRE_CELL_M).astype(np.int64), axis=0, return_inverse=True
    )
    member = member.reshape(-1)
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


def _arm(points: Floats, shaft: Shaft) -> tuple[float, float, float, float, float]:
    """Reach, height, length, height and thickness of the farthest thing on an arm."""
    none = (0.0, 0.0, 0.0, 0.0, 0.0)
    from_top = points[:, 2] - shaft.top_m
    points = points[(from_top > -_ARM_BELOW_M) & (from_top < _ABOVE_ARM_M)]
    points = points[_hang_on(points, shaft)]
    if len(points) < _WIRE_FEWEST:
        return none
    turns = np.arange(_TURNS) * (2 * np.pi / _TURNS)
    along = points[:, :2] @ np.array([np.cos(turns), np.sin(turns)])
    along -= shaft.radius_at(shaft.top_m)
    across = points[:, :2] @ np.array([-np.sin(turns), np.cos(turns)])
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
    if most * _BIN_M < _LEAST_ARM_M or most == count or wide > _MOST_TURNS * _TURNS:
        return none
    # Of directions that reach as far, the one along whose middle the points lie.
    off = [float(np.abs(across[inside[:, one], one]).mean()) for one in ties]
    best = int(ties[int(np.argmin(off))])
    long_m = float(reach[best] * _BIN_M)
    end = inside[:, best] & (along[:, best] <= long_m) & (along[:, best] > max(0.3, long_m - 1.4))
    if np.count_nonzero(end) < _WIRE_FEWEST:
        return none
    heights, sides = points[end, 2], across[end, best]
    return (
        long_m,
        float(np.median(heights)),
        float(np.ptp(along[end, best])),
        _tallest(along[end, best], heights),
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


def _plate(points: Floats) -> tuple[int, float, float, float, float]:
    """Points, width, shares of curved and of smooth patches of what hangs on a shaft; its face."""
    if len(points) < _PLATE_FEWEST:
        return len(points), 0.0, 0.0, 0.0, math.nan
    high = points[:, 2]
    width = max(
        float(np.quantile(high, 0.95) - np.quantile(high, 0.05)),
        float(np.ptp(np.quantile(points[:, :2] @ _main_axis(points[:, :2]), [0.05, 0.95]))),
    )
    from scipy.spatial import cKDTree

    tree = cKDTree(points)
    pieces = (high / _PIECE_M).astype(np.int64)
    order = np.argsort(pieces, kind="stable")
    told: list[Floats] = []
    smooth = 0.0
    for members in np.split(order, np.flatnonzero(np.diff(pieces[order])) + 1):
        if len(members) < _PLATE_FEWEST:
            continue
        shapes = [
            _bulge_of(points[near] - points[number])
            for number in members[np.linspace(0, len(members) - 1, _PATCHES).astype(np.int64)]
            if len(near := tree.query_ball_point(points[number], _PATCH_M)) >= _PLATE_FEWEST
        ]
        of_piece = [one for one in shapes if one is not None]
        told += of_piece
        smooth = max(smooth, len(of_piece) / _PATCHES)
    looks = [one for one in told if one.any()]
    curved = len(looks) / len(told) if told else 0.0
    return len(points), width, curved, smooth, _facing_deg(looks)


def _facing_deg(looks: Sequence[Floats]) -> float:
    """Bearing in which most of some unit vectors look: the mean of the largest group."""
    if not looks:
        return math.nan
    plan = np.array(looks)[:, :2]
    plan /= np.maximum(np.hypot(plan[:, 0], plan[:, 1]), 1e-9)[:, None]
    alike = plan @ plan.T > math.cos(math.radians(_ONE_MIRROR_DEG))
    east, north = plan[alike[int(alike.sum(axis=1).argmax())]].sum(axis=0).tolist()
    return math.degrees(math.atan2(east, north)) % 360.0


def _main_axis(plan: Floats) -> Floats:
    _, axes = np.linalg.eigh(np.cov(plan.T))
    return np.asarray(axes[:, 1])


def _bulge_of(patch: Floats) -> Floats | None:
    """Where a patch looks that is a piece of a sphere as mirrors are: (3,) a unit vector.

    0 if it doesn't bulge so, None of what is no smooth surface, or bulges more, as trunks and
    people do. A mirror's dish bulges as its glass does, so that it looks the same way from behind.
    """
    middle = patch - patch.mean(axis=0)
    extents, axes = np.linalg.eigh(middle.T @ middle / len(patch))
    if extents[1] < _PATCH_WIDE_M**2:
        return None
    local = middle @ axes
    u, v, n = local[:, 2], local[:, 1], local[:, 0]
    design = np.column_stack([np.ones(len(n)), u, v, u**2 + v**2])
    cofactors = np.linalg.inv(design.T @ design + 1e-9 * np.eye(4))
    found = cofactors @ design.T @ n
    scatter = float(np.sqrt(((n - design @ found) ** 2).sum() / max(len(n) - 4, 1)))
    if scatter > _SMOOTH_M:
        return None
    bulge = abs(float(found[3]))
    is_sure = bulge > 4 * scatter * float(np.sqrt(cofactors[3, 3]))
    if is_sure and 2 * bulge >= 1 / _LEAST_RADIUS_M:
        return None
    if not is_sure or not 1 / _MOST_RADIUS_M < 2 * bulge < 1 / _LEAST_RADIUS_M:
        return np.zeros(3)
    # At the patch's own middle: its normal where it is a piece of a sphere.
    normal = axes @ np.array([1.0, -found[2], -found[1]])
    return np.asarray(-np.sign(found[3]) * normal / np.linalg.norm(normal))


def is_short(shaft: Shaft) -> bool:
    """Whether a shaft is as low as bollards and delineators are."""
    return shaft.top_m < _SHORT_M


def type_of(shaft: Shaft, carried: Carried, *, is_reflecting: bool) -> str:
    """The contract's name of a pole's type.

    Parameters
    ----------
    is_reflecting : bool
        Whether it has a reflector, which is asked of low ones only.
    """
    diameter, high = 2 * shaft.radius_at(min(1.2, shaft.top_m / 2)), shaft.top_m
    if is_short(shaft):
        thickest = _REFLECTOR_POST_M if is_reflecting else _THIN_POST_M
        return "delineator" if diameter < thickest else "bollard"
    has_plate = carried.plate_points >= _PLATE_FEWEST and carried.plate_m > _LEAST_PLATE_M
    plate = "mirror_pole" if carried.curved > _CURVED else "sign_pole"
    is_straight = high < _HIGH_M or shaft.taper < _CONCRETE_TAPER / 2
    if high < _TALL_M and diameter < _TALL_DIAMETER_M and has_plate and is_straight:
        return plate
    if high > _WIRED_M and carried.wires >= _WIRED_CELLS:
        return "utility_pole"
    if diameter > _CONCRETE_M and high > _HIGH_M and shaft.taper > _CONCRETE_TAPER:
        return "utility_pole"
    if diameter > _UTILITY_M and high > _UTILITY_HIGH_M and shaft.taper > _CONCRETE_TAPER:
        return "utility_pole"
    if high > _HIGH_M and carried.arm_m >= _LEAST_ARM_M:
        return _of_arm(carried)
    if high > _TALL_M:
        return "street_light" if diameter < _UTILITY_M else "utility_pole"
    return plate if has_plate else "other"


def _of_arm(carried: Carried) -> str:
    if carried.tall_m < _LAMP_TALL_M:
        return "street_light"
    if carried.thick_m > _THICK_M:
        return "street_light"  # a crown about it
    is_signal = carried.tall_m < _SIGNAL_TALL_M and carried.long_m < _SIGNAL_LONG_M
    return "signal_pole" if is_signal else "arm_pole"
