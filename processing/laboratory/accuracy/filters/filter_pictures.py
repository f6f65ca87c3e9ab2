"""Where a filter errs: plans and sections of a scene with lost and left points in colours."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.formats.pictures.png import write_png
from processing.laboratory.accuracy.filters.filter_scenes import FilterScene
from processing.scoring.points.confusion_matrix import is_one_of

Picture = NDArray[np.uint8]

_PLAN_PX, _SECTION_PX = 1500, 1800
_SECTIONS = 4
_SECTION_WIDTH_M = 1.0
_MARGIN_PX = 8
_KEPT, _REMOVED, _LOST, _LEFT = (
    (150, 150, 150),
    (0, 158, 115),
    (213, 94, 0),
    (86, 180, 233),
)
"""True and kept; rightly removed; true but removed; wrong but kept (Okabe and Ito's colours)."""
_BACKGROUND = (20, 20, 28)


@dataclass(frozen=True)
class _Spot:
    colour: tuple[int, int, int]
    size_px: int
    chosen: NDArray[np.bool_]


def paint_errors(
    scene: FilterScene, codes: NDArray[np.uint8], kept: Collection[int], folder: Path, name: str
) -> tuple[Path, ...]:
    """Paint a plan, and sections where most errors are.

    Parameters
    ----------
    codes : (n,) uint8
        What the filter gave.
    kept : collection of int
        Codes of the points that count as true, in truth and result alike.
    name : str
        Of the filter; files are called by the scene and it.

    Returns
    -------
    tuple of Path
        The plan first; grey: rightly kept, green: rightly removed, red: lost, blue: left.

    Raises
    ------
    NoSpace
    """
    folder.mkdir(parents=True, exist_ok=True)
    is_true, is_kept = is_one_of(scene.truth, kept), is_one_of(codes, kept)
    spots = (
        _Spot(_KEPT, 1, is_true & is_kept),
        _Spot(_REMOVED, 1, ~is_true & ~is_kept),
        _Spot(_LEFT, 2, ~is_true & is_kept),
        _Spot(_LOST, 2, is_true & ~is_kept),
    )
    stem = f"{scene.name}-{name}".replace(",", "").replace(" ", "-")
    paths = [folder / f"{stem}-plan.png"]
    _write(paths[0], _paint_points(scene.xyz[:, :2], spots, _PLAN_PX))
    for number, inside in enumerate(_worst_strips(scene.xyz, is_true != is_kept)):
        paths.append(folder / f"{stem}-section-{number + 1}.png")
        cut = tuple(_Spot(one.colour, one.size_px + 1, one.chosen[inside]) for one in spots)
        _write(paths[-1], _paint_points(scene.xyz[inside][:, [0, 2]], cut, _SECTION_PX))
    return tuple(paths)


def _worst_strips(
    xyz: NDArray[np.float64], is_wrong: NDArray[np.bool_]
) -> Iterator[NDArray[np.bool_]]:
    """Strips along the easting, 1.0 m wide, that hold most errors; the worst first."""
    strip = np.floor((xyz[:, 1] - xyz[:, 1].min()) / _SECTION_WIDTH_M).astype(np.int64)
    errors = np.bincount(strip[is_wrong], minlength=1)
    for number in np.argsort(-errors, kind="stable")[:_SECTIONS].tolist():
        if errors[number]:
            yield strip == number


def _paint_points(
    positions: NDArray[np.float64], spots: tuple[_Spot, ...], longest_px: int
) -> Picture:
    """Places (right, up) in m as dots; heights of a section are drawn as wide as lengths."""
    low, high = _middle_extent(positions)
    px_per_m = (longest_px - 2 * _MARGIN_PX) / max(float((high - low).max()), 1e-6)
    size = np.ceil((high - low) * px_per_m).astype(np.int64) + 2 * _MARGIN_PX
    picture = np.full((int(size[1]), int(size[0]), 3), _BACKGROUND, np.uint8)
    pixels = np.floor((positions - low) * px_per_m).astype(np.int64) + _MARGIN_PX
    inside = np.all((pixels >= 1) & (pixels < size - 1), axis=1)
    columns, rows = pixels[:, 0], size[1] - 1 - pixels[:, 1]
    for spot in spots:
        chosen = np.flatnonzero(spot.chosen & inside)
        for right in range(spot.size_px):
            for down in range(spot.size_px):
                picture[rows[chosen] - down, columns[chosen] + right] = spot.colour
    return picture


def _middle_extent(
    positions: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Without the few points that lie far off, which would shrink everything else."""
    low, high = np.percentile(positions, (0.05, 99.95), axis=0)
    room = 0.05 * (high - low) + 0.2
    return np.maximum(low - room, positions.min(axis=0)), np.minimum(
        high + room, positions.max(axis=0)
    )


def _write(path: Path, picture: Picture) -> None:
    write_png(path, (picture.shape[0], picture.shape[1]), [picture])
