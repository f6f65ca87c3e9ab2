"""Cars, vans, lorries and buses of many sizes.

Outlines are drawn from the side (bonnet, windscreen, roof, rear) and lofted; the underside is
arched over the wheels, so beams pass beneath and into the arches. Kei vehicles stay within
3.4 × 1.48 × 2.0 m, small ones within 4.7 × 1.7 × 2.0 m, all within 12 × 2.5 × 3.8 m (道路運送車両の
保安基準 2条, 道路運送車両法施行規則 別表第一).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats, TriangleShape, plate
from processing.laboratory.simulate.traffic.bodies import (
    TrafficBody,
    TrafficPart,
    block,
    loft_body,
    wheel,
)

_PLATE_M = (0.33, 0.165)  # 中板; lorries and buses have the large one
_LARGE_PLATE_M = (0.44, 0.22)
_RING = 12
_SIDE_WINDOWS, _SCREENS = (3, 7), (4, 5, 6)  # places in the ring after which glass may follow

PAINTS = (
    Material.CAR_PAINT,
    Material.CAR_PAINT,
    Material.PAINTED_METAL,
    Material.ROOF,
    Material.RUBBER,
)
"""What bodies are painted with: bright, white, dark, black for the laser as well."""


@dataclass(frozen=True)
class _Outline:
    """A car from the side; x from the rear bumper, m; shares are of the length.

    Attributes
    ----------
    bonnet, screen, rear, tail : float
        Shares from the rear at which the windscreen begins and the roof's front end lies, where
        the roof's rear end lies, and where the rear window ends.
    """

    length: float
    width: float
    height: float
    belt: float
    clearance: float
    bonnet_z: float
    bonnet: float
    screen: float
    rear: float
    tail: float
    tail_z: float
    wheel: float
    front_axle: float
    rear_axle: float
    is_closed: bool = False


def kei_car(random: Generator) -> TrafficBody:
    """A kei car or kei wagon."""
    length, width = float(random.uniform(3.28, 3.395)), float(random.uniform(1.46, 1.475))
    height = float(random.uniform(1.48, 1.9))
    wheels = float(random.uniform(0.265, 0.285))
    outline = _Outline(
        length, width, height, belt=float(random.uniform(0.88, 0.98)),
        clearance=float(random.uniform(0.15, 0.19)), bonnet_z=float(random.uniform(0.86, 0.95)),
        bonnet=float(random.uniform(0.8, 0.86)), screen=float(random.uniform(0.63, 0.7)),
        rear=float(random.uniform(0.04, 0.08)), tail=0.01, tail_z=0.85, wheel=wheels,
        front_axle=0.86, rear_axle=0.14,
    )  # fmt: skip
    return _car("car", outline, random)


def saloon(random: Generator) -> TrafficBody:
    """A saloon, hatchback or sport utility vehicle."""
    length, width = float(random.uniform(3.9, 4.95)), float(random.uniform(1.66, 1.88))
    height = float(random.uniform(1.42, 1.72))
    is_stepped = random.random() < 0.45
    outline = _Outline(
        length, width, height, belt=height * float(random.uniform(0.58, 0.64)),
        clearance=float(random.uniform(0.13, 0.21)),
        bonnet_z=height * float(random.uniform(0.54, 0.6)),
        bonnet=float(random.uniform(0.7, 0.75)), screen=float(random.uniform(0.54, 0.6)),
        rear=float(random.uniform(0.26, 0.32) if is_stepped else random.uniform(0.09, 0.16)),
        tail=0.12 if is_stepped else 0.015, tail_z=height * float(random.uniform(0.6, 0.66)),
        wheel=float(random.uniform(0.3, 0.36)),
        front_axle=0.81, rear_axle=float(random.uniform(0.18, 0.22)),
    )  # fmt: skip
    return _car("car", outline, random)


def van(random: Generator) -> TrafficBody:
    """A van or minibus-like wagon; some without windows behind the driver."""
    length, width = float(random.uniform(3.39, 5.3)), float(random.uniform(1.475, 1.88))
    width = 1.475 if length < 3.6 else width
    height = float(random.uniform(1.85, 2.25 if length > 4.5 else 1.98))
    outline = _Outline(
        length, width, height, belt=height * float(random.uniform(0.5, 0.55)),
        clearance=float(random.uniform(0.15, 0.2)),
        bonnet_z=height * float(random.uniform(0.5, 0.55)),
        bonnet=float(random.uniform(0.9, 0.96)), screen=float(random.uniform(0.78, 0.84)),
        rear=0.03, tail=0.008, tail_z=height * 0.55,
        wheel=float(random.uniform(0.28, 0.33)),
        front_axle=0.83, rear_axle=float(random.uniform(0.16, 0.2)),
        is_closed=bool(random.random() < 0.35),
    )  # fmt: skip
    return _car("van", outline, random)


def small_truck(random: Generator) -> TrafficBody:
    """A light lorry with an open bed or a box, kei ones among them."""
    is_kei = random.random() < 0.4
    length = 3.395 if is_kei else float(random.uniform(4.6, 6.3))
    width = 1.475 if is_kei else float(random.uniform(1.69, 2.0))
    cab = float(random.uniform(1.25, 1.4) if is_kei else random.uniform(1.5, 1.7))
    height = float(random.uniform(1.76, 1.8) if is_kei else random.uniform(1.95, 2.2))
    return _lorry(random, (length, width, height), cab, has_box=bool(random.random() < 0.4))


def truck(random: Generator) -> TrafficBody:
    """A lorry of medium or full size."""
    length = float(random.uniform(7.5, 11.99))
    size = (length, float(random.uniform(2.2, 2.49)), float(random.uniform(2.5, 2.95)))
    cab = float(random.uniform(1.8, 2.35))
    return _lorry(random, size, cab, has_box=bool(random.random() < 0.65))


def bus(random: Generator) -> TrafficBody:
    """A city bus or coach."""
    length, width = float(random.uniform(6.9, 11.9)), float(random.uniform(2.28, 2.49))
    height, floor = float(random.uniform(2.85, 3.4)), float(random.uniform(0.28, 0.4))
    radius = float(random.uniform(0.44, 0.5))
    paint = PAINTS[int(random.integers(3))]
    axles = (length * 0.29 - length / 2, length / 2 - float(random.uniform(2.2, 2.7)))
    stations = _stations([-length / 2, -length / 2 + 0.08, length / 2 - 0.15, length / 2])
    stations = _stations([*stations, *_arch_stations(axles, radius), *_windows(length)])
    ends = np.clip(np.minimum(stations + length / 2, length / 2 - stations) / 0.15, 0, 1)
    rings = _ring(
        stations,
        low=_under(stations, axles, radius, floor),
        belt=np.full(stations.size, 1.15),
        top=height - 0.12 * (1 - ends),
        half=np.column_stack([np.full(stations.size, width / 2), np.full(stations.size, width / 2)])
        * (0.97 + 0.03 * ends[:, None]),
    )
    shape = loft_body(rings)
    material = np.full(len(shape[1]), paint, np.uint8)
    middle = (stations[1:] + stations[:-1]) / 2
    glass = (np.abs(middle) < length / 2 - 0.2) & (np.diff(stations) > 0.3)
    _paint(material, glass, _SIDE_WINDOWS)
    parts: list[TrafficPart] = [(shape, material)]
    screen = length / 2 + 0.004
    parts.append((_upright((screen, 0, 1.95), (width * 0.84, 1.5)), Material.GLASS))
    parts.append((_upright((-screen, 0, 2.2), (width * 0.7, 0.8)), Material.GLASS))
    for at in axles:
        parts += _axle(at, width, radius, 0.28)
    parts += _ends(length, width, 0.75, _LARGE_PLATE_M)
    parts += _mirrors(length / 2 + 0.1, width / 2 + 0.05, height * 0.78, 0.16)
    return TrafficBody("bus", tuple(parts), length, width, height)


def _car(kind: str, o: _Outline, random: Generator) -> TrafficBody:
    """A car of an outline."""
    back = -o.length / 2
    axles = (back + o.rear_axle * o.length, back + o.front_axle * o.length)
    posts = [back + share * o.length for share in (o.tail, o.rear, o.screen, o.bonnet)]
    pillar = (posts[1] + posts[2]) / 2
    ends = [back, back + 0.06, back + 0.2, -back - 0.25, -back - 0.08, -back]
    stations = _stations(
        [*ends, *posts, pillar - 0.06, pillar + 0.06, *_arch_stations(axles, o.wheel)]
    )
    roof = np.interp(
        stations,
        [back, *posts, -back - 0.12, -back],
        [o.tail_z - 0.1, o.tail_z, o.height - 0.03, o.height, o.bonnet_z, o.bonnet_z - 0.13, 0.62],
    )
    belt = np.minimum(np.interp(stations, [back, 0, -back], [o.belt + 0.03, o.belt, o.belt]), roof)
    inset = np.interp(stations, [back, back + 0.35, -back - 0.6, -back], [0.9, 1.0, 1.0, 0.82])
    half = o.width / 2 * inset
    lean = np.clip((roof - belt) / (o.height - o.belt), 0, 1)
    low = np.interp(stations, [back, back + 0.3, -back - 0.4, -back], [0.16, 0.0, 0.0, 0.05])
    low = _under(stations, axles, o.wheel, o.clearance + low)
    rings = _ring(
        stations, low=low, belt=np.maximum(belt, low + 0.08), top=np.maximum(roof, low + 0.1),
        half=np.column_stack([half, half * (1 - 0.17 * lean - 0.03)]),
    )  # fmt: skip
    shape = loft_body(rings)
    paint = PAINTS[int(random.integers(len(PAINTS)))]
    material = np.full(len(shape[1]), paint, np.uint8)
    middle = (stations[1:] + stations[:-1]) / 2
    side = (middle > posts[1]) & (middle < posts[2] + 0.3 * (posts[3] - posts[2]))
    side &= np.abs(middle - pillar) > 0.06
    if o.is_closed:
        side &= middle > pillar
    _paint(material, side, _SIDE_WINDOWS)
    screens = ((middle > posts[2]) & (middle < posts[3])) | (
        (middle > posts[0]) & (middle < posts[1])
    )
    _paint(material, screens, _SCREENS)
    _paint(material, np.ones(middle.size, np.bool_), (_RING - 1,), Material.RUBBER)
    parts: list[TrafficPart] = [(shape, material)]
    for at in axles:
        parts += _axle(at, o.width, o.wheel, float(random.uniform(0.16, 0.22)))
    parts += _ends(o.length - 0.04, o.width, o.belt - 0.2, _PLATE_M)
    parts += _mirrors(posts[3] - 0.25, o.width / 2, o.belt + 0.07, 0.09)
    return TrafficBody(kind, tuple(parts), o.length, o.width, o.height)


def _lorry(
    random: Generator, size: tuple[float, float, float], cab: float, *, has_box: bool
) -> TrafficBody:
    """A cab, a frame and a bed or box on wheels."""
    length, width, height = size
    radius = float(np.interp(length, [3.4, 6, 12], [0.27, 0.36, 0.5]))
    front, back = length / 2, -length / 2
    axles = [front - cab * 0.62, back + length * 0.22]
    if length > 9:
        axles.append(axles[1] + 2.3 * radius)
    floor = float(np.interp(length, [3.4, 6, 12], [0.62, 0.8, 1.05]))
    paint = PAINTS[int(random.integers(len(PAINTS)))]
    parts = _cab((front, width, height), cab, (axles[0], radius), paint)
    bed = front - cab - 0.08
    middle, long = (back + bed) / 2, bed - back
    parts.append((block((middle, 0, floor - 0.12), (long, width * 0.42, 0.2)), Material.STEEL))
    top = height
    if has_box:
        top = float(random.uniform(height, min(3.78, height * 1.35)))
        where = (middle, 0, (floor + top) / 2)
        parts.append((block(where, (long, width, top - floor)), Material.PAINTED_METAL))
    else:
        parts += _bed(random, (back, bed), width, floor)
    for at in axles:
        parts += _axle(at, width, radius, 0.3 if length > 7 else 0.2)
    parts += _ends(length, width, floor - 0.15, _LARGE_PLATE_M if length > 7 else _PLATE_M)
    parts += _mirrors(front - 0.1, width / 2 + 0.08, height * 0.75, 0.13)
    return TrafficBody("truck", tuple(parts), length, width, top)


def _cab(
    size: tuple[float, float, float], cab: float, axle: tuple[float, float], paint: Material
) -> list[TrafficPart]:
    front, width, height = size
    at, radius = axle
    stations = _stations(
        [front - cab, front - 0.35, front - 0.1, front, *_arch_stations((at,), radius)]
    )
    stations = stations[stations >= front - cab]
    belt = height * 0.55
    roof = np.interp(stations, [front - 0.35, front - 0.1, front], [height, belt + 0.1, belt - 0.1])
    half = np.full(stations.size, width / 2 - 0.01)
    low = _under(stations, (at,), radius, height * 0.17)
    rings = _ring(
        stations, low=low, belt=np.minimum(belt, roof), top=roof,
        half=np.column_stack([half, half * 0.94]),
    )  # fmt: skip
    shape = loft_body(rings)
    material = np.full(len(shape[1]), paint, np.uint8)
    middle = (stations[1:] + stations[:-1]) / 2
    _paint(material, (middle > front - cab * 0.75) & (middle < front - 0.1), _SIDE_WINDOWS)
    _paint(material, middle > front - 0.35, _SCREENS)
    return [(shape, material)]


def _bed(
    random: Generator, reach: tuple[float, float], width: float, floor: float
) -> list[TrafficPart]:
    """A bed with its boards, and maybe a load."""
    back, front = reach
    high = float(random.uniform(0.28, 0.5))
    middle, long = (back + front) / 2, front - back
    parts: list[TrafficPart] = [
        (block((middle, 0, floor - 0.01), (long, width, 0.05)), Material.STEEL),
        (block((front - 0.03, 0, floor + high), (0.05, width, 2 * high)), Material.STEEL),
    ]
    boards = [(back + 0.02, 0.0, 0.04, width)]
    boards += [(middle, side * (width / 2 - 0.02), long, 0.04) for side in (-1, 1)]
    for x, y, deep, wide in boards:
        where = (x, y, floor + high / 2)
        parts.append((block(where, (deep, wide, high)), Material.PAINTED_METAL))
    if random.random() < 0.5:
        tall = float(random.uniform(0.2, 1.1))
        size = (long * float(random.uniform(0.3, 0.85)), width * 0.8, tall)
        load = (Material.WOOD, Material.STEEL, Material.PLASTIC, Material.CLOTH)
        where = (middle, 0.0, floor + tall / 2)
        parts.append((block(where, size), load[int(random.integers(len(load)))]))
    return parts


def _ring(stations: Floats, *, low: Floats, belt: Floats, top: Floats, half: Floats) -> Floats:
    """Rings about a body: (stations, 12, 3); from the right underside up and over to the left.

    Parameters
    ----------
    half : (n, 2) float64
        Half the width at the belt and at the roof.
    """
    wide, roof = half[:, 0], half[:, 1]
    sill = low + 0.05
    bulge = low + 0.55 * (belt - low)
    edge = np.maximum(top - 0.06 * (top - belt) - 0.02, belt)
    right = [
        (-wide * 0.86, low),
        (-wide * 0.97, sill),
        (-wide, bulge),
        (-wide * 0.985, belt),
        (-roof, edge),
        (-roof * 0.84, np.maximum(top, edge)),
    ]
    left = [(-y, z) for y, z in right[::-1]]
    sides = [np.column_stack([stations, y, z]) for y, z in (*right, *left)]
    return np.stack(sides, axis=1)


def _paint(
    material: NDArray[np.uint8],
    stations: NDArray[np.bool_],
    positions: tuple[int, ...],
    paint: Material = Material.GLASS,
) -> None:
    """Give the squares after some stations and places of the rings another material."""
    rows = np.flatnonzero(stations)
    for position in positions:
        first = (rows * _RING + position) * 2
        material[first] = paint
        material[first + 1] = paint


def _under(
    stations: Floats, axles: tuple[float, ...], radius: float, clearance: float | Floats
) -> Floats:
    """Height of the underside: arched over the wheels."""
    low = np.broadcast_to(np.asarray(clearance, np.float64), stations.shape).copy()
    reach = radius + 0.06
    for axle in axles:
        rise = np.sqrt(np.maximum(reach**2 - (stations - axle) ** 2, 0.0))
        low = np.maximum(low, np.where(rise > 0, radius + rise, 0.0) * (rise > radius * 0.3))
    return low


def _arch_stations(axles: tuple[float, ...], radius: float) -> list[float]:
    reach = radius + 0.06
    steps = np.array([-1.0, -0.95, -0.8, -0.5, 0, 0.5, 0.8, 0.95, 1.0]) * reach
    return [axle + step for axle in axles for step in steps.tolist()]


def _windows(length: float) -> list[float]:
    at = np.arange(-length / 2 + 0.4, length / 2 - 0.3, 1.4)
    return [*at.tolist(), *(at + 0.12).tolist()]


def _stations(positions: list[float]) -> Floats:
    return np.unique(np.round(np.array(positions), 4))


def _axle(at: float, width: float, radius: float, wide: float) -> list[TrafficPart]:
    aside = width / 2 - wide / 2 - 0.01
    return [*wheel((at, -aside), radius, wide), *wheel((at, aside), radius, wide)]


def _upright(middle: tuple[float, float, float], size: tuple[float, float]) -> TriangleShape:
    """A pane square to the way, about its middle."""
    x, y, z = middle
    wide, high = size[0] / 2, size[1] / 2
    corners = [(x, y - wide, z - high), (x, y + wide, z - high)]
    corners += [(x, y + wide, z + high), (x, y - wide, z + high)]
    return plate(np.array(corners))


def _ends(
    length: float, width: float, lamp_z: float, size: tuple[float, float]
) -> list[TrafficPart]:
    """Lamps and number plates of both ends."""
    parts: list[TrafficPart] = []
    for end, lamp in ((1, Material.MIRROR), (-1, Material.PLASTIC)):
        x = end * (length / 2 + 0.005)
        where = (x + end * 0.035, 0.0, max(0.35, lamp_z - 0.25))
        parts.append((block(where, (0.012, *size)), Material.SIGN_FACE))
        for side in (-1, 1):
            where = (x - 0.07 * end, side * width * 0.36, lamp_z)
            parts.append((block(where, (0.2, width * 0.16, 0.13)), lamp))
    return parts


def _mirrors(x: float, y: float, z: float, half: float) -> list[TrafficPart]:
    parts: list[TrafficPart] = []
    for side in (-1, 1):
        where = (x, side * (y + 0.06), z)
        parts.append((block(where, (0.08, 0.18, 2 * half)), Material.RUBBER))
    return parts
