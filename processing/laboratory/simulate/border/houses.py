"""Houses, shops, blocks of flats, halls: buildings of a lot, no two alike."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.border.parts import (
    BELOW_M,
    BorderPart,
    BoxPart,
    block,
    gable_roof,
    hip_roof,
    merge_parts,
    shed_roof,
    side_windows,
    slab,
    windows,
)
from processing.laboratory.simulate.scene.materials import Material

_WALLS = (Material.PLASTER, Material.PLASTER, Material.BRICK, Material.OLD_CONCRETE, Material.WOOD)
_STOREY_M = (2.7, 3.1)


@dataclass(frozen=True)
class Plot:
    """Where a building may stand: x from and to along the street, y from its front line, m."""

    wide_m: float
    deep_m: float

    @property
    def half_m(self) -> float:
        """Half of its width; x runs from −half to half."""
        return self.wide_m / 2


Building = Callable[[Generator, Plot], list[BorderPart]]


def house(random: Generator, plot: Plot) -> list[BorderPart]:
    """A house of one or two storeys with a pitched roof, often a wing, a porch and a balcony."""
    wide = min(plot.wide_m - 1.6, float(random.uniform(6.0, 12.0)))
    deep = min(plot.deep_m - 2.0, float(random.uniform(5.5, 10.0)))
    storeys = 1 if random.random() < 0.25 else 2
    storey = float(random.uniform(*_STOREY_M))
    x = float(random.uniform(-plot.half_m + 0.8, plot.half_m - 0.8 - wide))
    y = float(random.uniform(0.8, max(0.9, plot.deep_m - deep - 0.5)))
    body = BoxPart((x, x + wide), (y, y + deep), (-BELOW_M, storeys * storey))
    wall = _WALLS[int(random.integers(len(_WALLS)))]
    parts: list[BorderPart] = [(body.shape(), wall), *_roof(random, body, wall)]
    parts += _fronts(random, body, storeys, storey)
    if storeys == 2 and random.random() < 0.5:
        parts += _balcony(random, body, storey)
    if random.random() < 0.45 and body.y[0] > 2.0:
        jut = min(body.y[0] - 0.8, float(random.uniform(1.0, 3.0)))
        span = wide * float(random.uniform(0.3, 0.55))
        wing = BoxPart((x, x + span), (body.y[0] - jut, body.y[0] + 0.3), (-BELOW_M, storey))
        parts += [(wing.shape(), wall), *_roof(random, wing, wall)]
        parts += _fronts(random, wing, 1, storey)
    parts += _porch(random, body)
    if random.random() < 0.7:
        at = float(random.uniform(body.x[0] + 0.3, body.x[1] - 1.2))
        unit = block((at, at + 0.8), (body.y[0] - 0.4, body.y[0] - 0.1), (0.0, 0.6))
        parts.append((unit, Material.PAINTED_METAL))
    return parts


def _roof(random: Generator, body: BoxPart, wall: Material) -> list[BorderPart]:
    eaves, thick = float(random.uniform(0.2, 0.7)), float(random.uniform(0.12, 0.25))
    pitch = float(random.uniform(0.25, 0.6))
    kind = random.random()
    if kind < 0.45:
        slopes, gables = gable_roof(body, eaves, pitch, thick)
        return [(slopes, Material.ROOF), (gables, wall)]
    if kind < 0.75:
        return [(hip_roof(body, eaves, pitch, thick), Material.ROOF)]
    if kind < 0.88:
        slope, walls = shed_roof(body, eaves, pitch / 2, thick)
        return [(slope, Material.ROOF), (walls, wall)]
    return _parapet(body, float(random.uniform(0.2, 0.9)), wall)


def _parapet(body: BoxPart, high_m: float, wall: Material) -> list[BorderPart]:
    """A flat roof's rim."""
    (x0, x1), (y0, y1), (_, z) = body.x, body.y, body.z
    rims = [
        block((x0, x1), (y0, y0 + 0.15), (z, z + high_m)),
        block((x0, x1), (y1 - 0.15, y1), (z, z + high_m)),
        block((x0, x0 + 0.15), (y0, y1), (z, z + high_m)),
        block((x1 - 0.15, x1), (y0, y1), (z, z + high_m)),
    ]
    return [(merge_parts(rims), wall)]


def _fronts(random: Generator, body: BoxPart, storeys: int, storey_m: float) -> list[BorderPart]:
    """Windows towards the street and on both sides."""
    parts: list[BorderPart] = []
    for floor in range(storeys):
        count = max(1, int(body.wide_m / random.uniform(1.8, 3.5)))
        size = float(random.uniform(0.6, 1.7)), float(random.uniform(0.5, 1.4))
        spacing = body.wide_m / count
        if size[0] > spacing - 0.3:
            continue
        xs = body.x[0] + (np.arange(count) + 0.5) * spacing
        sill = floor * storey_m + storey_m - 0.5 - size[1]
        is_there = random.random(count) < 0.8
        parts += windows(np.column_stack([xs, np.full(count, sill)])[is_there], size, body.y[0])
        if random.random() < 0.6 and body.deep_m > 3.0:
            at = np.array([[float(np.mean(body.y)), sill]])
            parts += side_windows(at, size, body.x[0])
    return parts


def _balcony(random: Generator, body: BoxPart, storey_m: float) -> list[BorderPart]:
    wide = body.wide_m * float(random.uniform(0.3, 0.9))
    x = float(random.uniform(body.x[0], body.x[1] - wide))
    out = min(float(random.uniform(0.7, 1.4)), body.y[0] - 0.2)
    if out < 0.5:
        return []
    face = body.y[0]
    floor = block((x, x + wide), (face - out, face), (storey_m - 0.15, storey_m))
    rails = [
        block((x, x + wide), (face - out, face - out + 0.08), (storey_m, storey_m + 1.1)),
        block((x, x + 0.08), (face - out, face), (storey_m, storey_m + 1.1)),
        block((x + wide - 0.08, x + wide), (face - out, face), (storey_m, storey_m + 1.1)),
    ]
    return [(merge_parts([floor, *rails]), Material.PLASTER)]


def _porch(random: Generator, body: BoxPart) -> list[BorderPart]:
    """A door with one to three steps up to it and often a small roof."""
    x = float(random.uniform(body.x[0] + 0.6, body.x[1] - 1.5))
    y, parts = body.y[0], []
    steps = int(random.integers(1, 4))
    deep = min(0.3, (y - 0.3) / steps)
    rise = float(random.uniform(0.12, 0.2))
    treads = [
        block((x - 0.2, x + 1.2), (y - deep * (steps - n), y), (-BELOW_M, rise * (n + 1)))
        for n in range(steps)
    ]
    parts.append((merge_parts(treads), Material.CONCRETE))
    base = rise * steps
    parts.append((block((x, x + 0.95), (y - 0.05, y), (base, base + 2.1)), Material.WOOD))
    if random.random() < 0.6:
        out = min(1.2, y - 0.2)
        roof = block((x - 0.4, x + 1.4), (y - out, y), (base + 2.3, base + 2.42))
        parts.append((roof, Material.ROOF))
    return parts


def shop(random: Generator, plot: Plot) -> list[BorderPart]:
    """A shop with a glass front, an awning and a board above it, one to four storeys."""
    wide = plot.wide_m - float(random.uniform(0.2, 1.0))
    deep = min(plot.deep_m - 1.0, float(random.uniform(7.0, 14.0)))
    storeys, storey = int(random.integers(1, 5)), float(random.uniform(2.9, 3.6))
    y = float(random.uniform(0.1, 1.2)) if random.random() < 0.8 else plot.deep_m - deep
    body = BoxPart((-wide / 2, wide / 2), (y, y + deep), (-BELOW_M, storeys * storey))
    wall = _WALLS[int(random.integers(len(_WALLS)))]
    parts: list[BorderPart] = [
        (body.shape(), wall),
        *_parapet(body, float(random.uniform(0.2, 1.2)), wall),
    ]
    high, panes = storey - float(random.uniform(0.5, 0.9)), max(2, int(wide / 1.5))
    size = (wide - 0.8) / panes - 0.15, high - 0.1
    xs = (np.arange(panes) + 0.5) * (wide - 0.8) / panes - (wide - 0.8) / 2
    parts += windows(np.column_stack([xs, np.full(panes, 0.12)]), size, y)
    board = float(random.uniform(0.1, 0.3))
    parts.append(
        (
            block(
                (-wide / 2 + 0.2, wide / 2 - 0.2), (max(y - board, 0.0), y), (high + 0.1, storey)
            ),
            Material.PAINTED_METAL,
        )
    )
    out = min(float(random.uniform(0.6, 1.5)), y + 0.25)
    if random.random() < 0.6:
        edge = np.array(
            [
                [-wide / 2 + 0.3, y, high + 0.1],
                [wide / 2 - 0.3, y, high + 0.1],
                [wide / 2 - 0.3, y - out, high - 0.35],
                [-wide / 2 + 0.3, y - out, high - 0.35],
            ]
        )
        parts.append((slab(edge, 0.04), Material.CLOTH))
    upper = BoxPart(body.x, body.y, (0.0, body.z[1]))
    for floor in range(1, storeys):
        count = max(1, int(wide / random.uniform(1.8, 3.0)))
        xs = upper.x[0] + (np.arange(count) + 0.5) * wide / count
        at = np.column_stack([xs, np.full(count, floor * storey + 0.9)])
        parts += windows(at, (min(1.5, wide / count - 0.4), 1.3), y)
    return parts


def flats(random: Generator, plot: Plot) -> list[BorderPart]:
    """A block of flats of three to eleven storeys with balconies along its front."""
    wide = plot.wide_m - float(random.uniform(0.8, 2.0))
    deep = min(plot.deep_m - 3.0, float(random.uniform(8.0, 13.0)))
    storeys, storey = int(random.triangular(3, 4, 13)), float(random.uniform(2.8, 3.1))
    y = float(random.uniform(1.8, max(1.9, plot.deep_m - deep)))
    body = BoxPart((-wide / 2, wide / 2), (y, y + deep), (-BELOW_M, storeys * storey))
    wall = _WALLS[int(random.integers(4))]
    parts: list[BorderPart] = [(body.shape(), wall), *_parapet(body, 0.6, wall)]
    out, homes = float(random.uniform(1.1, 1.6)), max(2, int(wide / random.uniform(4.0, 6.5)))
    edges = np.linspace(-wide / 2 + 0.3, wide / 2 - 0.3, homes + 1)
    is_glass = random.random() < 0.25
    slabs, rails = [], []
    for floor in range(1, storeys):
        z = floor * storey
        across = (float(edges[0]), float(edges[-1]))
        slabs.append(block(across, (y - out, y), (z - 0.18, z)))
        rails.append(block(across, (y - out, y - out + 0.1), (z, z + 1.1)))
        slabs += [block((x - 0.06, x + 0.06), (y - out, y), (z, z + storey - 0.2)) for x in edges]
    parts.append((merge_parts(slabs), wall))
    parts.append((merge_parts(rails), Material.GLASS if is_glass else Material.PLASTER))
    for floor in range(storeys):
        middles = (edges[:-1] + edges[1:]) / 2
        at = np.column_stack([middles, np.full(homes, floor * storey + 0.15)])
        parts += windows(at, (float(edges[1] - edges[0]) * 0.6, 1.9), y)
    left = -wide / 2 + 0.5
    shaft = float(random.uniform(left, max(left, wide / 2 - 3.0)))
    top = storeys * storey
    parts.append((block((shaft, shaft + 2.5), (y + 2, y + 5), (top, top + 2.6)), wall))
    return parts


def second_row(random: Generator, plot: Plot) -> list[BorderPart]:
    """A plain building behind the plot, as it is seen through the gaps of the first row."""
    y = plot.deep_m + float(random.uniform(2.5, 8.0))
    body = BoxPart(
        (-plot.half_m + 0.5, plot.half_m - 0.5),
        (y, y + float(random.uniform(6.0, 11.0))),
        (-2 * BELOW_M, float(random.choice([3.0, 5.8, 5.8, 8.7, 14.0]))),
    )
    wall = _WALLS[int(random.integers(len(_WALLS)))]
    return [(body.shape(), wall), *_roof(random, body, wall)]


def hall(random: Generator, plot: Plot) -> list[BorderPart]:
    """A workshop, store or barn: a low pitch over a long body, a wide gate."""
    wide = plot.wide_m - float(random.uniform(1.0, 4.0))
    deep = min(plot.deep_m - 1.0, float(random.uniform(8.0, 20.0)))
    high = float(random.uniform(3.2, 7.5))
    y = float(random.uniform(1.0, max(1.1, plot.deep_m - deep)))
    body = BoxPart((-wide / 2, wide / 2), (y, y + deep), (-BELOW_M, high))
    wall = Material.PAINTED_METAL if random.random() < 0.7 else Material.OLD_CONCRETE
    slopes, gables = gable_roof(body, 0.3, float(random.uniform(0.1, 0.3)), 0.1)
    gate = min(wide - 1.0, float(random.uniform(3.0, 5.0)))
    x = float(random.uniform(-wide / 2 + 0.4, wide / 2 - 0.4 - gate))
    door = block((x, x + gate), (y - 0.08, y), (0.0, min(high - 0.3, 3.5)))
    return [
        (body.shape(), wall),
        (slopes, Material.ROOF),
        (gables, wall),
        (door, Material.STEEL),
    ]


def greenhouse(random: Generator, plot: Plot) -> list[BorderPart]:
    """One to four tunnels of plastic sheets beside each other (ビニールハウス)."""
    span, high = float(random.uniform(4.5, 6.5)), float(random.uniform(2.4, 3.3))
    count = max(1, min(int(plot.wide_m / (span + 0.6)), int(random.integers(1, 5))))
    deep = min(plot.deep_m - 1.0, float(random.uniform(10.0, 25.0)))
    angles = np.linspace(0, np.pi, 13)
    rise = np.maximum(np.sin(angles), 0.0) ** 0.8 * high
    parts: list[BorderPart] = []
    for number in range(count):
        middle = (number - (count - 1) / 2) * (span + 0.6)
        arch = np.column_stack([np.cos(angles) * span / 2 + middle, rise])
        for y in (1.0, 1.0 + deep):
            end = np.column_stack([arch[:, 0], np.full(13, y), arch[:, 1] - 0.2])
            rest = np.arange(1, 12)
            fan = np.column_stack([np.zeros_like(rest), rest, rest + 1])
            parts.append(((end, fan), Material.PAINTED_METAL))
        rows = np.stack(
            [
                np.column_stack([arch[:, 0], np.full(13, y), arch[:, 1] - 0.2])
                for y in (1.0, 1.0 + deep)
            ]
        )
        first = np.arange(12)
        skin = np.concatenate(
            [
                np.column_stack([first, first + 1, first + 13]),
                np.column_stack([first + 1, first + 14, first + 13]),
            ]
        )
        parts.append(((rows.reshape(-1, 3), skin), Material.PAINTED_METAL))
    return parts
