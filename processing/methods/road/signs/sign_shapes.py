"""The plates that road signs are made of: shapes and standard sizes, as data."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache, lru_cache

import numpy as np

from processing.core.arrays import Floats
from processing.core.kernels import kernel

CIRCLE, TRIANGLE, SQUARE, DIAMOND, PENTAGON, RECTANGLE = (
    "circle",
    "triangle",
    "square",
    "diamond",
    "pentagon",
    "rectangle",
)

STANDARD_M: dict[str, tuple[float, ...]] = {
    CIRCLE: (0.4, 0.6, 0.9, 1.2),
    TRIANGLE: (0.533, 0.6, 0.8, 1.2, 1.6),
    SQUARE: (0.4, 0.45, 0.6, 0.9, 1.2, 1.35, 1.8),
    DIAMOND: (0.45, 0.6, 0.9, 1.2),
    PENTAGON: (0.4, 0.6, 0.9, 1.2),
}
"""Diameters and sides: those of Takahashi 2022, Table 8-1 (2/3, 1, 1.5 and 2 times the usual size),
and of the Order on Road Signs (標識令, 別表第二) where that has more: warning signs (diamonds) and
small squares of 45 cm, stop signs of 60 cm."""

_OTHER_DISCS_M = (0.45, 0.5, 0.8, 1.0)
"""Diameters of discs that are no signs: of bus stops (45 and 50 cm) and of mirrors (道路反射鏡
設置指針: 80 and 100 cm; those of 60 cm are as large as signs). Without them such a disc would be
laid into the next best outline of a sign."""

_USUAL_M: dict[str, tuple[float, ...]] = {
    CIRCLE: (0.6,),
    TRIANGLE: (0.8,),
    SQUARE: (0.6, 0.9),
    DIAMOND: (0.45, 0.6),
    PENTAGON: (0.6,),
}
"""Sizes of scale 1 (標識令, 別表第二; Table 8-1)."""

_WALL_SHARES = (2 / 3, 1 / 3)
"""Height of a pentagon's upright sides over that of the whole, which is as high as it is wide.
Table 8-1 gives a third of it (A×B×C = 60×20×60) without the figure that says of what: plates have
been met whose roof is a third of their height and such whose sides are."""

_CORNER_SHARE = 0.05
"""Radius of a rounded corner over the shorter side: 3 cm of 60 cm (標識令, 別表第二, figures)."""

_KEPT = 1_000
"""Outlines in memory: standard ones, and of rectangles those that were looked at last."""

_ARC = 3
"""Corners that stand for a rounded one."""


@dataclass(frozen=True)
class SignShape:
    """A plate's outline.

    Attributes
    ----------
    shape : str
        As the contract names them; a triangle stands on its tip.
    size_m : float
        Diameter or side; of a pentagon its base, of a rectangle its width.
    high_m : float
        Of the whole.
    wall_share : float
        Of a pentagon, the height of its upright sides over that of the whole; of others 0.
    """

    shape: str
    size_m: float
    high_m: float
    wall_share: float = 0.0

    @property
    def wide_m(self) -> float:
        """Of the whole."""
        return self.size_m * np.sqrt(2) if self.shape == DIAMOND else self.size_m

    @property
    def is_usual(self) -> bool:
        """Whether it has the size that is usual on ordinary roads."""
        return self.size_m in _USUAL_M[self.shape]

    @property
    def is_other_disc(self) -> bool:
        """Whether it is a disc of a size that signs don't have."""
        return self.shape == CIRCLE and self.size_m in _OTHER_DISCS_M


def shape_of(shape: str, size_m: float) -> SignShape:
    """A plate of one size; rectangles have two and are made directly."""
    high = {TRIANGLE: np.sqrt(3) / 2, DIAMOND: np.sqrt(2)}.get(shape, 1.0) * size_m
    return SignShape(shape, size_m, float(high), _WALL_SHARES[0] if shape == PENTAGON else 0.0)


@cache
def standard_shapes() -> tuple[SignShape, ...]:
    """All plates but rectangles."""
    return tuple(
        SignShape(one.shape, one.size_m, one.high_m, share)
        for name, sizes in STANDARD_M.items()
        for one in (shape_of(name, size) for size in sizes)
        for share in (_WALL_SHARES if name == PENTAGON else (0.0,))
    )


@cache
def looked_for() -> tuple[SignShape, ...]:
    """All plates but rectangles, and the discs that would be mistaken for them."""
    return (*standard_shapes(), *(shape_of(CIRCLE, size) for size in _OTHER_DISCS_M))


@lru_cache(maxsize=_KEPT)
def sharp_outline_of(shape: SignShape) -> Floats:
    """(n, 2) corners, m: right and up about the middle of the outline's box, anticlockwise.

    Of a circle one row, its radius.
    """
    half, tall = shape.wide_m / 2, shape.high_m / 2
    if shape.shape == CIRCLE:
        corners = [[half, 0.0]]
    elif shape.shape == TRIANGLE:
        corners = [[0.0, -tall], [half, tall], [-half, tall]]
    elif shape.shape == DIAMOND:
        corners = [[0.0, -tall], [half, 0.0], [0.0, tall], [-half, 0.0]]
    elif shape.shape == PENTAGON:
        eaves = -tall + shape.high_m * shape.wall_share
        corners = [[-half, -tall], [half, -tall], [half, eaves], [0.0, tall], [-half, eaves]]
    else:
        corners = [[-half, -tall], [half, -tall], [half, tall], [-half, tall]]
    return np.array(corners)


@lru_cache(maxsize=_KEPT)
def outline_of(shape: SignShape) -> Floats:
    """The same with rounded corners."""
    corners = sharp_outline_of(shape)
    if len(corners) == 1:
        return corners
    return rounded_corners(corners, _CORNER_SHARE * min(shape.size_m, shape.high_m), _ARC)


@lru_cache(maxsize=_KEPT)
def centroid_of(shape: SignShape) -> Floats:
    """(2,) middle of the area, right and up of the middle of the outline's box."""
    corners = outline_of(shape)
    if len(corners) == 1:
        return np.zeros(2)
    ahead = np.roll(corners, -1, axis=0)
    cross = corners[:, 0] * ahead[:, 1] - ahead[:, 0] * corners[:, 1]
    return np.asarray(((corners + ahead) * cross[:, None]).sum(axis=0) / (3 * cross.sum()))


def rounded_corners(corners: Floats, radius: float, count: int) -> Floats:
    """The outline of a polygon whose corners are arcs of so many points: (k * count, 2)."""
    places = np.empty((len(corners) * count, 2))
    arcs_kernel(corners, radius, count, places)
    return places


@kernel
def arcs_kernel(corners: Floats, radius: float, count: int, places: Floats) -> None:
    """Write the arcs of all corners, one after the other."""
    for k in range(len(corners)):
        one, before, ahead = corners[k], corners[k - 1], corners[(k + 1) % len(corners)]
        long_back = math.hypot(before[0] - one[0], before[1] - one[1])
        long_on = math.hypot(ahead[0] - one[0], ahead[1] - one[1])
        back = ((before[0] - one[0]) / long_back, (before[1] - one[1]) / long_back)
        on = ((ahead[0] - one[0]) / long_on, (ahead[1] - one[1]) / long_on)
        half = math.acos(min(max(back[0] * on[0] + back[1] * on[1], -1.0), 1.0)) / 2
        middle = (back[0] + on[0], back[1] + on[1])
        away = radius / math.sin(half) / math.hypot(middle[0], middle[1])
        centre = (one[0] + middle[0] * away, one[1] + middle[1] * away)
        along = radius / math.tan(half)
        start = (one[0] + back[0] * along - centre[0], one[1] + back[1] * along - centre[1])
        end = (one[0] + on[0] * along - centre[0], one[1] + on[1] * along - centre[1])
        turn = math.atan2(
            start[0] * end[1] - start[1] * end[0], start[0] * end[0] + start[1] * end[1]
        )
        first = math.atan2(start[1], start[0])
        for number in range(count):
            angle = first + turn * number / max(count - 1, 1)
            places[k * count + number, 0] = centre[0] + radius * math.cos(angle)
            places[k * count + number, 1] = centre[1] + radius * math.sin(angle)
