"""The ground's colour of a plate, by the shares of colours on its face."""

from __future__ import annotations

import numpy as np
import pytest

from processing.map.plate_colours import ground_colour

SEEN = {
    "red": (190, 30, 40), "white": (205, 210, 225), "blue": (30, 80, 160),
    "yellow": (225, 185, 40), "green": (20, 120, 60), "black": (25, 25, 28),
}  # fmt: skip


def face(**percents: int) -> np.ndarray[tuple[int, int], np.dtype[np.uint8]]:
    """A face of so many pixels of each colour, with noise, in the light and in the shade."""
    random = np.random.default_rng(3)
    pixels = np.concatenate([np.tile(SEEN[name], (n, 1)) for name, n in percents.items()])
    return np.clip(pixels + random.normal(0, 6, pixels.shape), 0, 255).astype(np.uint8)


@pytest.mark.parametrize(
    ("percents", "colour"),
    [({"blue": 75, "white": 25}, "blue"), ({"yellow": 80, "black": 20}, "yellow"),
     ({"green": 70, "white": 30}, "green"), ({"white": 85, "black": 15}, "white"),
     ({"red": 85, "white": 15}, "red"), ({"red": 78, "white": 22}, "red"),
     ({"red": 36, "white": 46, "blue": 18}, "white"), ({"red": 52, "blue": 48}, "blue")],
)  # fmt: skip
def test_the_ground_is_told_from_rims_bars_and_symbols(
    percents: dict[str, int], colour: str
) -> None:
    assert ground_colour(face(**percents)) == colour
    assert ground_colour((face(**percents) * 0.4).astype(np.uint8)) == colour


def test_a_few_pixels_tell_nothing() -> None:
    assert ground_colour(face(blue=11)) is None
    assert ground_colour(np.empty((0, 3), np.uint8)) is None
