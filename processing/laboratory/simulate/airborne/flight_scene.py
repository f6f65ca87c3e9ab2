"""A landscape as beams of a flight meet it: surfaces with reflectances, crowns and rods."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter, maximum_filter

from processing.core.text import Text
from processing.laboratory.simulate.airborne.flight_things import (
    Things,
    plants,
    power_line_rods,
)
from processing.laboratory.simulate.airborne.landscapes import (
    BUILDING,
    CELL_M,
    VEHICLE,
    Floats,
    Landscape,
    landscape_of,
)
from processing.laboratory.simulate.airborne.power_lines import HIGH, LOW, LineStyle
from processing.laboratory.simulate.scene.chance import chance

GROUND, ROAD = 2, 11
COARSE_CELLS = 8
"""Cells to a side of the squares whose highest surface is known, so that beams skip the air."""

_SHOULDER_M = 3.0
"""Over which a road's level goes over into the land's."""

_ROAD_CLEAR_M = 1.5
"""No stem stands nearer to a road's edge."""

_GRASS, _SOIL, _GRAVEL = (0.35, 0.6), (0.15, 0.35), (0.25, 0.4)
_ASPHALT, _CONCRETE = (0.08, 0.22), (0.28, 0.45)
_PAVED = ((_ASPHALT, 0.8), (_CONCRETE, 0.1), (_GRAVEL, 0.1))
"""What a road is made of, and how often."""

_PATCH_M = (3.0, 12.0)
"""Sizes of patches of soil or gravel in the land, from one landscape to another."""

_FIELD_M = (20.0, 60.0)
"""Sides of fields, each of one tone with straight edges as roads have."""

_WITH_FIELDS, _IS_FIELD = 0.5, 0.5
"""Share of landscapes with fields, and of their land that fields take."""
_PAINT = 0.6
_ROOF = (0.1, 0.6)
"""Reflectances in the near infrared: roofing has any, so that no echo alone tells a roof."""


class FlightStyle(NamedTuple):
    """What a landscape to be flown over holds.

    ``terrain``: key of the landscapes; ``roads``: least and most; ``crowns``: share of the plan;
    ``high_lines``, ``low_lines``: of towers and of poles.
    """

    name: Text
    terrain: str
    roads: tuple[int, int]
    crowns: tuple[float, float]
    high_lines: int
    low_lines: int


FLIGHT_STYLES: Mapping[str, FlightStyle] = {
    "village": FlightStyle(Text("Village", "集落"), "village", (2, 3), (0.08, 0.2), 1, 1),
    "town": FlightStyle(Text("Town", "市街地"), "town", (2, 4), (0.05, 0.12), 1, 1),
    "forest": FlightStyle(Text("Forest", "森林"), "quarry", (1, 2), (0.4, 0.7), 1, 0),
    "hillside": FlightStyle(Text("Hillside", "斜面地"), "hillside", (1, 2), (0.15, 0.35), 1, 1),
    "river": FlightStyle(Text("River", "河川"), "river", (1, 2), (0.1, 0.3), 1, 1),
    "lines": FlightStyle(
        Text("Power lines", "送電線"), "embankment", (1, 2), (0.05, 0.2), 2, 1
    ),
}  # fmt: skip
"""What can be flown over, by name."""


class FlightScene(NamedTuple):
    """What beams meet, in the landscape's frame: origin at the south-west corner, m.

    ``surface`` (rows, columns) float32, m; ``code`` uint8 and ``reflectance`` float32 of its
    cells of ``CELL_M``; ``coarse`` float32, the highest surface of each square of
    ``COARSE_CELLS`` and of those around it; ``things`` and, for each square of the same size,
    those that stand over it: ``thing_starts`` (squares + 1,) int64 into ``thing_numbers`` int64,
    rods first, crowns counted on behind them. ``top_m``: nothing is higher.
    """

    surface: NDArray[np.float32]
    code: NDArray[np.uint8]
    reflectance: NDArray[np.float32]
    coarse: NDArray[np.float32]
    things: Things
    thing_starts: NDArray[np.int64]
    thing_numbers: NDArray[np.int64]
    top_m: float


def flight_scene(style: str, seed: int, extent_m: float) -> FlightScene:
    """A square scene of one of :data:`FLIGHT_STYLES`.

    Parameters
    ----------
    extent_m : float
        Side of the square.
    """
    drawn = FLIGHT_STYLES[style]
    random = chance(seed, "flight", style)
    land = landscape_of(drawn.terrain, seed, extent_m)
    count = int(random.integers(*drawn.roads, endpoint=True))
    distance, which = _add_roads(land, random, count)
    road = distance < 0
    free = ~np.isfinite(land.solid) & ~land.water & (distance > _ROAD_CLEAR_M)
    parts = []
    for count, style_of_line in ((drawn.high_lines, HIGH), (drawn.low_lines, LOW)):
        parts += [_line(land, random, free, style_of_line) for _ in range(count)]
    parts.append(plants(land, random, free, random.uniform(*drawn.crowns)))
    things = Things.joined(parts)
    surface = np.where(np.isfinite(land.solid), land.solid, land.ground).astype(np.float32)
    code = np.where(road, ROAD, GROUND).astype(np.uint8)
    code[np.isfinite(land.solid)] = land.solid_code[np.isfinite(land.solid)]
    reflectance = _reflectances(land, random, code, which)
    high = [float(surface.max())]
    high += [float(one.max()) for one in (things.rods[:, [2, 5]], things.crowns[:, 3]) if one.size]
    starts, numbers = _over_squares(things, surface.shape)
    return FlightScene(
        surface, code, reflectance, _coarse(surface), things, starts, numbers, max(high) + 1.0
    )


def _line(land: Landscape, random: Generator, free: NDArray[np.bool_], style: LineStyle) -> Things:
    """A line with one carrier where there is room for it, well within the landscape."""
    rows, columns = np.nonzero(free)
    extent_m = land.ground.shape[0] * CELL_M
    inner = (np.minimum(rows, columns) > 0.2 * free.shape[0]) & (
        np.maximum(rows, columns) < 0.8 * free.shape[0]
    )
    if not inner.any():
        through = np.full(2, extent_m / 2)
    else:
        place = random.choice(np.flatnonzero(inner))
        through = CELL_M * (np.array([columns[place], rows[place]]) + 0.5)
    return power_line_rods(land.ground, random, style, through)[0]


def _add_roads(land: Landscape, random: Generator, count: int) -> tuple[Floats, NDArray[np.int64]]:
    """Level roads into the land; gives the distance from the nearest one's edge, m, and which."""
    rows, columns = land.ground.shape
    centres = CELL_M * (np.arange(rows) + 0.5)
    north, east = np.meshgrid(centres, CELL_M * (np.arange(columns) + 0.5), indexing="ij")
    extent_m = rows * CELL_M
    nearest = np.full(land.ground.shape, np.inf)
    which = np.zeros(land.ground.shape, np.int64)
    for number in range(count):
        turn, wide = random.uniform(0, np.pi), random.uniform(3.5, 9.0)
        middle = random.uniform(0.25, 0.75, 2) * extent_m
        off = (east - middle[0]) * np.cos(turn) + (north - middle[1]) * np.sin(turn)
        along = (north - middle[1]) * np.cos(turn) - (east - middle[0]) * np.sin(turn)
        bend, wave = random.uniform(0, 10.0), random.uniform(80.0, 300.0)
        off = off + bend * np.sin(2 * np.pi * along / wave + random.uniform(0, 6.3))
        edge = np.abs(off) - wide / 2
        which[edge < nearest] = number
        nearest = np.minimum(nearest, edge)
    level = gaussian_filter(land.ground, _SHOULDER_M / CELL_M)
    near = np.clip(1.0 - nearest / _SHOULDER_M, 0.0, 1.0)
    land.ground += near * (level - land.ground)
    on_road = nearest < 0
    land.water[on_road] = False
    land.solid[on_road & (land.solid_code == BUILDING)] = np.nan
    _park(land, random, on_road)
    return nearest, which


def _park(land: Landscape, random: Generator, on_road: NDArray[np.bool_]) -> None:
    """A few vehicles stand on the roads."""
    rows, columns = np.nonzero(on_road)
    long, wide = round(4.5 / CELL_M), round(1.8 / CELL_M)
    for place in random.integers(0, max(1, rows.size), int(rows.size * CELL_M**2 / 400.0)):
        row, column = rows[place], columns[place]
        part = np.s_[row : row + wide, column : column + long]
        if random.random() < 0.5:
            part = np.s_[row : row + long, column : column + wide]
        land.add_solid(part, land.ground[part] + random.uniform(1.3, 1.9), VEHICLE)


def _reflectances(
    land: Landscape, random: Generator, code: NDArray[np.uint8], which: NDArray[np.int64]
) -> NDArray[np.float32]:
    """Of each cell: land, roads and roofs each of a tone of their own, grain within."""
    shape = code.shape
    value = np.where(code == ROAD, _paved(random, which), _land_tones(random, shape))
    painted = (code == ROAD) & (random.random(shape) < _PAINTED)
    value = np.where(painted, _PAINT, value)
    solid = np.isfinite(land.solid)
    # Roofs of the same height, and so most of one house, are of the same material.
    roof = np.floor(land.solid[solid] / 3.0).astype(np.int64)
    value[solid] = random.uniform(*_ROOF, 4096)[roof % 4096]
    value = value * np.exp(random.normal(0, 0.08, shape))
    value[land.water] = _WATER
    return np.asarray(value, np.float32)


def _paved(random: Generator, which: NDArray[np.int64]) -> Floats:
    """The tone of the nearest road, each of which is of one material."""
    shares = [share for _, share in _PAVED]
    made = random.choice(len(_PAVED), int(which.max()) + 1, p=shares)
    tones: Floats = np.array([random.uniform(*_PAVED[one][0]) for one in made])[which]
    return tones


def _land_tones(random: Generator, shape: tuple[int, ...]) -> Floats:
    """Grass with patches of soil and gravel, or one of these with patches; often fields in it."""
    patches = gaussian_filter(random.normal(0, 1, shape), random.uniform(*_PATCH_M) / CELL_M)
    patches /= patches.std() + 1e-9
    kinds = [random.uniform(*one) for one in (_SOIL, _GRAVEL, _GRASS)]
    if random.random() < _BARE_LAND:
        random.shuffle(kinds)
    value: Floats = np.choose(np.digitize(patches, [-1.0, -0.6]), kinds)
    if random.random() >= _WITH_FIELDS:
        return value
    turn, side = random.uniform(0, np.pi), random.uniform(*_FIELD_M, 2)
    north, east = CELL_M * np.indices(shape)
    along = (east * np.cos(turn) + north * np.sin(turn)) // side[0]
    across = (north * np.cos(turn) - east * np.sin(turn)) // side[1]
    field = (along * 31 + across * 17).astype(np.int64) % _FIELDS
    tones = np.array([random.uniform(*(_GRASS, _SOIL)[one % 2]) for one in range(_FIELDS)])
    return np.where((random.random(_FIELDS) < _IS_FIELD)[field], tones[field], value)


_FIELDS = 256
"""Tones of fields before they repeat."""

_BARE_LAND = 0.2
"""Share of landscapes whose land is mostly of soil or gravel."""

_PAINTED = 0.01
"""Share of a road's cells that bear paint."""

_WATER = 0.004
"""Water gives hardly any light back where it is not looked at straight."""


_BEAM_M = 0.6
"""More than half of any beam: its edge meets things that its axis passes."""


def _coarse(surface: NDArray[np.float32]) -> NDArray[np.float32]:
    side = COARSE_CELLS
    rows, columns = (-(-one // side) for one in surface.shape)
    padded = np.full((rows * side, columns * side), -np.inf, np.float32)
    padded[: surface.shape[0], : surface.shape[1]] = surface
    highest = padded.reshape(rows, side, columns, side).max(axis=(1, 3))
    return np.asarray(maximum_filter(highest, 3), np.float32)


def _over_squares(
    things: Things, shape: tuple[int, ...]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Which things stand over each square, by their outlines in plan."""
    side = COARSE_CELLS * CELL_M
    rows, columns = (-(-one // COARSE_CELLS) for one in shape)
    ends = things.rods[:, [0, 1, 3, 4]].reshape(-1, 2, 2)
    thick = things.rods[:, 6:7] + _BEAM_M
    low = np.concatenate([ends.min(axis=1) - thick, things.crowns[:, :2] - things.crowns[:, 4:5]])
    high = np.concatenate([ends.max(axis=1) + thick, things.crowns[:, :2] + things.crowns[:, 4:5]])
    first = np.clip((low / side).astype(np.int64), 0, [columns - 1, rows - 1])
    last = np.clip((high / side).astype(np.int64), 0, [columns - 1, rows - 1])
    squares, numbers = [], []
    for number, (here, there) in enumerate(zip(first, last, strict=True)):
        east, north = np.meshgrid(
            np.arange(here[0], there[0] + 1), np.arange(here[1], there[1] + 1)
        )
        squares.append((north * columns + east).ravel())
        numbers.append(np.full(east.size, number))
    square = np.concatenate(squares) if squares else np.empty(0, np.int64)
    order = np.argsort(square, kind="stable")
    starts = np.searchsorted(square[order], np.arange(rows * columns + 1))
    standing = np.concatenate(numbers) if numbers else np.empty(0, np.int64)
    return starts.astype(np.int64), standing[order].astype(np.int64)
