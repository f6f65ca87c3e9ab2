"""Noise of streets recorded by pulses, by how far it lies from anything true, as a table.

There next to nothing is noise, and most of it lies within the width of a hand of a true point,
where it harms nobody: what is found is told by distance, and beside it what is lost.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.formats.points.point_codes import read_result
from processing.laboratory.accuracy.filters.filter_methods import our_noise
from processing.laboratory.accuracy.filters.filter_scenes import FilterScene

_FAR_M, _NEAR_M = 0.5, 0.2
"""Distances to the nearest true point at which noise is counted apart."""

_NOISE, _LOW_NOISE = (7, 18), 7
_THIN = {"wire": (14,), "pole, trunk": (66,), "sign": (65,)}
_OTHERS = {"crown": (5,), "low plant": (3, 4), "moving": (64,)}


@dataclass(frozen=True)
class _Head:
    """One scanner's points with their truth, in the file's order."""

    scene: FilterScene
    away_m: NDArray[np.float64]


def street_rows(data: Path) -> Iterator[list[str]]:
    """Rows of cells, the head first: one for each scanner of each street of a folder."""
    head = ["street, scanner", "points", "noise", "> 0.5 m found", "0.2–0.5 m found"]
    head += ["below the ground found", "true points lost"]
    yield [*head, *(f"{name} lost" for name in (*_THIN, *_OTHERS))]
    for folder in sorted(data.glob("street_*")):
        for one in _heads(folder):
            with tempfile.TemporaryDirectory(prefix="zuka-") as made:
                said = our_noise(one.scene, Path(made)) > 0
            yield _row(one, said)


def _heads(folder: Path) -> Iterator[_Head]:
    clouds = sorted(folder.glob("*.laz"))
    labels = [folder / "truth" / f"{cloud.stem}.labels.npy" for cloud in clouds]
    trajectory = folder / "trajectory.csv"
    if not clouds or not trajectory.is_file() or not all(path.is_file() for path in labels):
        return
    from scipy.spatial import cKDTree

    codes = [np.load(path) for path in labels]
    places = [_places(cloud) for cloud in clouds]
    pairs = zip(places, codes, strict=True)
    true = cKDTree(np.concatenate([xyz[~np.isin(own, _NOISE)] for xyz, own in pairs]))
    for cloud, xyz, own in zip(clouds, places, codes, strict=True):
        is_noise = np.isin(own, _NOISE)
        away = np.zeros(own.size)
        away[is_noise], _ = true.query(xyz[is_noise])
        name = f"{folder.name}, {cloud.stem}"
        yield _Head(FilterScene(name, cloud, trajectory, xyz, own, {}), away)


def _places(cloud: Path) -> NDArray[np.float64]:
    blocks = [block.xyz for block in read_result(cloud).blocks() if block.xyz is not None]
    return np.concatenate(blocks)


def _row(one: _Head, said: NDArray[np.bool_]) -> list[str]:
    truth = one.scene.truth
    is_noise = np.isin(truth, _NOISE)
    is_far = is_noise & (one.away_m > _FAR_M)
    is_near = is_noise & (one.away_m > _NEAR_M) & ~is_far
    found = [is_far, is_near, truth == _LOW_NOISE]
    lost = [~is_noise, *(np.isin(truth, codes) for codes in (_THIN | _OTHERS).values())]
    return [
        one.scene.name,
        f"{truth.size:,}",
        f"{is_noise.sum():,}",
        *(f"{said[which].mean():.3f} of {which.sum()}" if which.any() else "–" for which in found),
        *(f"{100 * said[which].mean():.2f} %" if which.any() else "–" for which in lost),
    ]
