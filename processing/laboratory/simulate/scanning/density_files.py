"""A density map as a picture with its scale, or as a table."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from processing.core.safe_write import write_safely
from processing.formats.format import Content
from processing.formats.pictures.png import write_png
from processing.formats.registry import FORMATS
from processing.image.attributes.colour_maps import UNKNOWN_COLOUR, height_ramp
from processing.laboratory.simulate.scanning.density import DensityMap

Picture = NDArray[np.uint8]

LEAST, MOST = 10**0.5, 10**4.5
"""Points/m² at the ends of the colours: a tree in a far garden, the road under a slow vehicle."""
DECADES = (10, 100, 1_000, 10_000)
"""What is written beside the scale."""

_PIXELS = 3  # of a cell
_STRIP_M = 10.0
_LEFT, _RIGHT, _TOP, _BETWEEN, _BELOW = 70, 150, 44, 56, 52
_BLACK = (0, 0, 0)
_STEP_M = 5


def density_colours(densities: ArrayLike) -> Picture:
    """Colours of densities, evenly by their logarithm.

    Parameters
    ----------
    densities : (...) array_like
        Points/m²; NaN where there is none.

    Returns
    -------
    (..., 3) uint8
    """
    values = np.asarray(densities, np.float64)
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.log(values / LEAST) / np.log(MOST / LEAST)
        positions = np.clip(np.nan_to_num(share * 255, nan=0.0), 0, 255).astype(np.uint8)
    found: Picture = height_ramp()[positions].copy()
    found[~np.isfinite(values)] = UNKNOWN_COLOUR
    return found


def write_density(path: Path, found: DensityMap, title: str) -> None:
    """Write a density map as ``.png`` or ``.csv``, by the name's ending.

    Parameters
    ----------
    title : str
        Stands above the picture: sensor and speed, in ASCII.

    Raises
    ------
    OutOfRange
        The name ends in something else.
    NoSpace
    """
    if Content.TABLE in FORMATS.format_to_write(path, Content.PICTURE, Content.TABLE).writes:
        _write_table(path, found)
        return
    picture = density_picture(found, title)
    write_png(path, (picture.shape[0], picture.shape[1]), [picture])


def density_picture(found: DensityMap, title: str) -> Picture:
    """Walls above, the road below, the scale on the right: (rows, columns, 3) uint8."""
    wall = _enlarged(density_colours(found.wall[::-1]))
    strip = round(_STRIP_M / (found.up_m[1] - found.up_m[0]))
    road = _enlarged(density_colours(np.tile(found.road, (strip, 1))))
    # Left of the vehicle is left in the picture.
    wall, road = wall[:, ::-1], road[:, ::-1]
    rows = _TOP + wall.shape[0] + _BETWEEN + road.shape[0] + _BELOW
    whole = np.full((rows, _LEFT + wall.shape[1] + _RIGHT, 3), 255, np.uint8)
    under = _TOP + wall.shape[0] + _BETWEEN
    whole[_TOP : _TOP + wall.shape[0], _LEFT : _LEFT + wall.shape[1]] = wall
    whole[under : under + road.shape[0], _LEFT : _LEFT + road.shape[1]] = road
    _write(whole, title, (_LEFT, 28))
    per_m = _PIXELS / (found.up_m[1] - found.up_m[0])
    _mark_across(whole, _TOP + wall.shape[0], per_m, "walls along the road, m to the left")
    _mark_across(whole, under + road.shape[0], per_m, "road, m to the left")
    for top in (_TOP, under):
        _mark_up(whole, top, per_m)
    _paint_scale(whole, wall.shape[1] + _LEFT + 24, rows)
    return whole


def _enlarged(cells: Picture) -> Picture:
    return cells.repeat(_PIXELS, axis=0).repeat(_PIXELS, axis=1)


def _mark_across(whole: Picture, below: int, per_m: float, what: str) -> None:
    half_m = round((whole.shape[1] - _LEFT - _RIGHT) / per_m / 2)
    for metres in range(-half_m, half_m + 1, _STEP_M):
        column = _LEFT + round((half_m - metres) * per_m)
        whole[below : below + 5, min(column, whole.shape[1] - _RIGHT - 1)] = _BLACK
        _write(whole, f"{metres:g}", (column - 10, below + 20))
    _write(whole, what, (_LEFT + 10, below + 40))


def _mark_up(whole: Picture, top: int, per_m: float) -> None:
    for metres in range(0, int(_STRIP_M) + 1, _STEP_M):
        row = top + round((_STRIP_M - metres) * per_m)
        whole[row, _LEFT - 5 : _LEFT] = _BLACK
        _write(whole, f"{metres} m", (12, row + 5))


def _paint_scale(whole: Picture, left: int, rows: int) -> None:
    top, bottom = _TOP + 24, rows - _BELOW
    steps = np.geomspace(MOST, LEAST, bottom - top)
    whole[top:bottom, left : left + 18] = density_colours(steps)[:, None]
    _write(whole, "points/m2", (left, _TOP + 12))
    for decade in DECADES:
        share = np.log(MOST / decade) / np.log(MOST / LEAST)
        row = top + round(share * (bottom - top))
        whole[row, left + 18 : left + 24] = _BLACK
        _write(whole, f"{decade:,}", (left + 28, row + 5))


def _write(whole: Picture, words: str, position: tuple[int, int]) -> None:
    import cv2

    cv2.putText(whole, words, position, cv2.FONT_HERSHEY_SIMPLEX, 0.45, _BLACK, 1, cv2.LINE_AA)


def _write_table(path: Path, found: DensityMap) -> None:
    heights = np.arange(1, round(found.up_m[-1]) + 1)
    rows = np.searchsorted(found.up_m, heights) - 1
    head = ["across_m", "road_points_per_m2", "between_points_m", "between_lines_m"]
    head += [f"wall_{height}_m_points_per_m2" for height in heights]
    lines = np.full(found.across_m.size, found.survey.between_revolutions_m)
    columns = [found.across_m, found.road, found.spacing_m, lines, *found.wall[rows]]
    with write_safely(path) as temporary, temporary.open("w", encoding="utf-8") as file:
        file.write(",".join(head) + "\n")
        for values in zip(*columns, strict=True):
            file.write(",".join("" if np.isnan(one) else f"{one:.5g}" for one in values) + "\n")
