"""People on foot and on two wheels: walking, with umbrella, pram, dog; bicycles, motorcycles.

Statures are those of Japanese children and adults, 1.1 to 1.85 m (文部科学省 学校保健統計,
厚生労働省 国民健康・栄養調査); bicycles stay within 1.9 × 0.6 m (道路交通法施行規則 9条の2の2).
"""

from __future__ import annotations

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import tube
from processing.laboratory.simulate.traffic.bodies import (
    TrafficBody,
    TrafficPart,
    ball,
    block,
    rod,
    scale_shape,
    shift_shape,
)

_WHEEL_SIDES = 16


def person(random: Generator, *, is_walking: bool = True) -> TrafficBody:
    """A person, sometimes with an umbrella, a pram, a dog, a bag or a child."""
    tall = float(np.clip(random.normal(1.64, 0.1), 1.1, 1.85))
    stride = float(random.uniform(0.12, 0.3)) if is_walking else 0.0
    parts = _figure(random, tall, stride)
    length, width, height = max(2 * stride + 0.3, 0.4), 0.55, tall
    extra = float(random.random())
    if extra < 0.14:
        radius = float(random.uniform(0.45, 0.6))
        parts += _umbrella(random, tall, radius)
        length, width, height = max(length, 2 * radius), 2 * radius, tall + 0.25
    elif extra < 0.22:
        parts += _pram(stride)
        length = 2.4
    elif extra < 0.3:
        parts += _dog(random)
        length, width = 2.6, 0.9
    elif extra < 0.4:
        child = _figure(random, float(random.uniform(0.95, 1.25)), stride * 0.6)
        parts = [(shift_shape(shape, (0, 0.24, 0)), m) for shape, m in parts]
        parts += [(shift_shape(shape, (0.05, -0.24, 0)), m) for shape, m in child]
        width = 0.95
    elif extra < 0.6:
        where = (-0.02, 0.3, tall * 0.42)
        parts.append((block(where, (0.32, 0.1, float(random.uniform(0.2, 0.4)))), Material.CLOTH))
        width = 0.75
    return TrafficBody("person", tuple(parts), length, width, height)


def bicycle(random: Generator, *, is_ridden: bool = True) -> TrafficBody:
    """A bicycle, ridden or on its stand."""
    radius = float(random.choice([0.255, 0.33, 0.35]))
    base = float(random.uniform(0.98, 1.12)) * radius / 0.33
    metal = Material.PAINTED_METAL if random.random() < 0.6 else Material.STEEL
    rear, front = -base / 2, base / 2
    saddle, bar = float(random.uniform(0.78, 0.95)), float(random.uniform(0.92, 1.08))
    parts: list[TrafficPart] = [*_thin_wheel(rear, radius), *_thin_wheel(front, radius)]
    crank, neck = (-0.05, 0.0, 0.28), (front - 0.2, 0.0, bar - 0.16)
    seat = (-0.22, 0.0, saddle)
    tubes = (
        [(rear, 0, radius), crank, neck], [crank, seat], [(rear, 0, radius), seat],
        [neck, (front, 0, radius)], [neck, (front - 0.24, 0, bar)],
    )  # fmt: skip
    parts += [(rod(path, 0.016, 6), metal) for path in tubes]
    parts.append((rod([(front - 0.24, -0.28, bar), (front - 0.24, 0.28, bar)], 0.013), metal))
    parts.append((block((seat[0] - 0.02, 0, saddle + 0.03), (0.26, 0.15, 0.06)), Material.RUBBER))
    if random.random() < 0.55:
        where = (front + 0.02, 0, bar - 0.1)
        parts.append((block(where, (0.28, 0.36, 0.24)), Material.GRATING))
    parts.append((block((rear - radius - 0.01, 0, 0.55), (0.02, 0.06, 0.06)), Material.SIGN_FACE))
    height = bar
    if is_ridden:
        parts += _rider(random, seat, (front - 0.24, bar), 0.2)
        height = saddle + 0.95
    return TrafficBody("bicycle", tuple(parts), base + 2 * radius + 0.05, 0.58, height)


def motorcycle(random: Generator, *, is_ridden: bool = True) -> TrafficBody:
    """A scooter or motorcycle."""
    radius = float(random.uniform(0.2, 0.31))
    base = float(random.uniform(1.15, 1.45))
    rear, front = -base / 2, base / 2
    paint = (Material.CAR_PAINT, Material.PAINTED_METAL, Material.RUBBER)[int(random.integers(3))]
    parts: list[TrafficPart] = []
    for x in (rear, front):
        across = np.array([[x, -0.06, radius], [x, 0.06, radius]])
        parts.append((tube(across, np.full(2, radius), _WHEEL_SIDES), Material.RUBBER))
    parts.append((ball((-0.15, 0, 0.52), (0.55, 0.17, 0.2)), paint))
    parts.append((ball((front - 0.2, 0, 0.72), (0.16, 0.19, 0.28)), paint))
    parts.append((block((-0.05, 0, 0.34), (0.5, 0.26, 0.26)), Material.STEEL))
    parts.append((rod([(front, 0, radius), (front - 0.28, 0, 1.0)], 0.035), Material.STEEL))
    parts.append(
        (rod([(front - 0.28, -0.34, 1.0), (front - 0.28, 0.34, 1.0)], 0.02), Material.STEEL)
    )
    parts.append((block((-0.3, 0, 0.76), (0.62, 0.26, 0.1)), Material.RUBBER))
    parts.append((block((rear - 0.26, 0, 0.58), (0.01, 0.2, 0.12)), Material.SIGN_FACE))
    if random.random() < 0.3:
        parts.append((block((rear - 0.05, 0, 0.98), (0.4, 0.4, 0.34)), Material.PLASTIC))
    height = 1.1
    if is_ridden:
        parts += _rider(random, (-0.28, 0.0, 0.78), (front - 0.28, 1.0), 0.24)
        height = 1.75
    return TrafficBody("motorcycle", tuple(parts), base + 2 * radius + 0.1, 0.74, height)


def _figure(random: Generator, tall: float, stride: float) -> list[TrafficPart]:
    """Legs, trunk, arms and head, in proportion to the stature."""
    stout = float(random.uniform(0.85, 1.25))
    hip, shoulder, neck = 0.5 * tall, 0.81 * tall, 0.86 * tall
    parts: list[TrafficPart] = []
    for side in (-1, 1):
        y, foot = side * 0.055 * tall, side * stride
        leg = np.array([[foot, y, 0.03], [foot * 0.35, y, 0.27 * tall], [0, y * 0.9, hip]])
        radii = np.array([0.028, 0.034, 0.048]) * tall * stout
        parts.append((tube(leg, radii, 7), Material.CLOTH))
        parts.append((block((foot + 0.04, y, 0.035), (0.25, 0.09, 0.07)), Material.RUBBER))
        swing = -foot * 0.8
        arm = [[0, side * 0.115 * tall, shoulder], [swing * 0.3, side * 0.135 * tall, 0.63 * tall]]
        arm.append([swing + 0.03, side * 0.14 * tall, 0.47 * tall])
        radii = np.array([0.03, 0.026, 0.02]) * tall * stout
        parts.append((tube(np.array(arm), radii, 6), Material.CLOTH))
    levels = np.array([hip - 0.03, 0.62 * tall, 0.74 * tall, shoulder, neck])
    trunk = tube(
        np.column_stack([np.zeros(5), np.zeros(5), levels]),
        np.array([0.098, 0.092, 0.108, 0.1, 0.03]) * tall * stout,
        9,
    )
    parts.append((scale_shape(trunk, (0.68, 1.05, 1.0)), Material.CLOTH))
    head = (0.02, 0.0, 0.932 * tall)
    parts.append((ball(head, (0.058 * tall, 0.048 * tall, 0.07 * tall)), Material.WOOD))
    hair = (-0.005, 0.0, 0.962 * tall)
    parts.append((ball(hair, (0.06 * tall, 0.053 * tall, 0.052 * tall)), Material.RUBBER))
    return parts


def _umbrella(random: Generator, tall: float, radius: float) -> list[TrafficPart]:
    lean = float(random.uniform(-0.05, 0.15))
    rise = np.array([0.0, 0.06, 0.13, 0.2, 0.23])
    at = np.column_stack([0.08 + lean * rise, np.zeros(5), tall - 0.02 + rise])
    radii = radius * np.array([1.0, 0.88, 0.6, 0.25, 0.01])
    stick = [(0.2, 0.12, 0.6 * tall), (0.08, 0.0, tall + 0.2)]
    material = Material.CLOTH if random.random() < 0.6 else Material.PLASTIC
    return [(tube(at, radii, 8, is_closed=False), material), (rod(stick, 0.008, 4), Material.STEEL)]


def _pram(stride: float) -> list[TrafficPart]:
    ahead = 0.75 + stride * 0.2
    parts: list[TrafficPart] = [
        (ball((ahead, 0, 0.62), (0.4, 0.23, 0.24)), Material.CLOTH),
        (
            rod([(0.3, -0.2, 1.0), (ahead, -0.2, 0.5), (ahead + 0.3, -0.2, 0.1)], 0.014),
            Material.STEEL,
        ),
        (rod([(0.3, 0.2, 1.0), (ahead, 0.2, 0.5), (ahead + 0.3, 0.2, 0.1)], 0.014), Material.STEEL),
        (rod([(0.3, -0.2, 1.0), (0.3, 0.2, 1.0)], 0.014), Material.RUBBER),
    ]
    for x in (ahead - 0.28, ahead + 0.3):
        for y in (-0.22, 0.22):
            across = np.array([[x, y - 0.02, 0.1], [x, y + 0.02, 0.1]])
            parts.append((tube(across, np.full(2, 0.1), 10), Material.RUBBER))
            parts.append((rod([(x, y, 0.1), (ahead, y, 0.5)], 0.012, 4), Material.STEEL))
    return parts


def _dog(random: Generator) -> list[TrafficPart]:
    high = float(random.uniform(0.25, 0.6))
    x, y, long = 0.9, -0.3, high * 1.1
    coat = Material.CLOTH if random.random() < 0.5 else Material.WOOD
    parts: list[TrafficPart] = [
        (ball((x, y, high * 0.8), (long / 2, high * 0.2, high * 0.23)), coat),
        (ball((x + long * 0.6, y, high * 1.08), (high * 0.24, high * 0.14, high * 0.16)), coat),
        (rod([(x + long * 0.5, y, high), (0.1, -0.22, 0.85)], 0.006, 4), Material.CABLE),
    ]
    for dx in (-0.36, 0.36):
        for dy in (-0.11, 0.11):
            foot = (x + dx * long, y + dy * high)
            leg = [(*foot, 0.0), (*foot, high * 0.75)]
            parts.append((rod(leg, high * 0.06, 5), coat))
    return parts


def _thin_wheel(x: float, radius: float) -> list[TrafficPart]:
    """A tyre, with a hub and spokes thin enough to look through."""
    angles = np.linspace(0, 2 * np.pi, _WHEEL_SIDES + 1)
    rim = np.column_stack(
        [
            x + (radius - 0.018) * np.cos(angles),
            np.zeros(angles.size),
            radius + (radius - 0.018) * np.sin(angles),
        ]
    )
    parts: list[TrafficPart] = [
        (tube(rim, np.full(angles.size, 0.018), 5, is_closed=False), Material.RUBBER)
    ]
    for angle in angles[:-1:4]:
        direction = np.array([np.cos(angle), 0.0, np.sin(angle)]) * (radius - 0.02)
        middle = np.array([x, 0.0, radius])
        parts.append((rod([middle, middle + direction], 0.004, 3), Material.STEEL))
    parts.append((rod([(x, -0.05, radius), (x, 0.05, radius)], 0.02), Material.STEEL))
    return parts


def _rider(
    random: Generator, seat: tuple[float, float, float], bar: tuple[float, float], apart: float
) -> list[TrafficPart]:
    """Who sits on a saddle and holds the bar."""
    tall = float(np.clip(random.normal(1.64, 0.09), 1.3, 1.82))
    x, _, z = seat
    chest = (x + 0.16, 0.0, z + 0.3 * tall)
    parts: list[TrafficPart] = []
    for side in (-1, 1):
        y = side * apart / 2
        foot = (float(random.uniform(-0.15, 0.1)), y, 0.18 + 0.08 * (1 + side * 0.9))
        knee = ((x + foot[0]) / 2 + 0.24, y, (z + foot[2]) / 2 + 0.1)
        leg = np.array([(x, y * 0.8, z + 0.08), knee, foot])
        parts.append((tube(leg, np.array([0.075, 0.058, 0.045]), 7), Material.CLOTH))
        parts.append(
            (block((foot[0] + 0.05, y, foot[2] - 0.03), (0.25, 0.09, 0.08)), Material.RUBBER)
        )
        arm = np.array(
            [(chest[0], side * 0.18, chest[2] - 0.03), (bar[0] - 0.2, side * 0.26, bar[1] + 0.06),
             (bar[0], side * 0.24, bar[1] + 0.03)]
        )  # fmt: skip
        parts.append((tube(arm, np.array([0.05, 0.042, 0.034]), 6), Material.CLOTH))
    spine = np.linspace([x, 0.0, z + 0.04], chest, 4)
    trunk = tube(spine, np.array([0.15, 0.14, 0.16, 0.09]), 9)
    parts.append((trunk, Material.CLOTH))
    head = (chest[0] + 0.04, 0.0, chest[2] + 0.15)
    parts.append((ball(head, (0.115, 0.1, 0.13)), Material.WOOD))
    hat = Material.PLASTIC if random.random() < 0.3 else Material.RUBBER
    parts.append((ball((head[0] - 0.01, 0.0, head[2] + 0.05), (0.12, 0.105, 0.1)), hat))
    return parts
