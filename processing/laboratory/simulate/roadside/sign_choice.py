"""Which plates hang together: regulatory, warning and guide signs with plates below them."""

from __future__ import annotations

from numpy.random import Generator

from processing.laboratory.simulate.roadside.sign_plates import PlateShape, SignPlate
from processing.laboratory.simulate.street.styles import HIGHWAY, Style

# Sides and diameters of the Order on Road Signs (標識令, 別表第二): regulatory plates of 60 cm,
# 40 cm where streets are narrow, 90 cm and 120 cm on expressways; the stop sign's side is 80 cm.
_CIRCLES_M = ((0.6, 0.72), (0.4, 0.16), (0.9, 0.12))
_WIDE_CIRCLES_M = ((0.9, 0.6), (1.2, 0.2), (0.6, 0.2))
_TRIANGLES_M = ((0.8, 0.8), (0.533, 0.15), (1.2, 0.05))
_DIAMONDS_M = ((0.45, 0.55), (0.6, 0.25), (0.9, 0.2))
_SQUARES_M = ((0.6, 0.6), (0.45, 0.15), (0.9, 0.25))
_PENTAGONS_M = ((0.6, 0.75), (0.4, 0.1), (0.9, 0.15))
_SIZES: dict[PlateShape, tuple[tuple[float, float], ...]] = {
    "circle": _CIRCLES_M,
    "triangle": _TRIANGLES_M,
    "diamond": _DIAMONDS_M,
    "square": _SQUARES_M,
    "pentagon": _PENTAGONS_M,
}
_SHARES: dict[PlateShape, float] = {
    "circle": 0.4, "diamond": 0.15, "square": 0.12, "pentagon": 0.1, "rectangle": 0.18,
    "triangle": 0.05,
}  # fmt: skip


def plates_of(random: Generator, style: Style) -> list[SignPlate]:
    """One to four plates for one post, the highest first."""
    names = list(_SHARES)
    shares = list(_SHARES.values())
    count = int(random.choice([1, 2, 3], p=[0.72, 0.22, 0.06]))
    plates: list[SignPlate] = []
    for _ in range(count):
        shape = names[int(random.choice(len(names), p=shares))]
        plates.append(plate_of(random, shape, style))
    if random.random() < 0.38 and plates[-1].shape != "rectangle" and len(plates) < 4:
        plates.append(supplement_of(random, plates[-1]))
    return plates


def plate_of(random: Generator, shape: PlateShape, style: Style) -> SignPlate:
    """A plate of a shape in one of its sizes."""
    if shape == "rectangle":
        wide = float(random.choice([0.4, 0.5, 0.6, 0.9, 1.2]))
        high = wide * float(random.choice([0.4, 0.5, 0.7] if wide > 0.6 else [0.4, 0.5, 0.7, 1.5]))
        return SignPlate("rectangle", wide, high)
    sizes = _WIDE_CIRCLES_M if style is HIGHWAY and shape == "circle" else _SIZES[shape]
    shares = [one[1] for one in sizes]
    return SignPlate(shape, sizes[int(random.choice(len(sizes), p=shares))][0])


def supplement_of(random: Generator, above: SignPlate) -> SignPlate:
    """The small plate below a sign (補助標識)."""
    wide = 0.4 if above.size_m < 0.7 else 0.6
    high = float(random.choice([0.1, 0.15, 0.2, 0.2, 0.3])) * wide / 0.4
    return SignPlate("rectangle", wide, high, is_supplementary=True)
