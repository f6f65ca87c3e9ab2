"""Examples for the trees: features of points that are known to be noise or to be true."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from processing.monitor import SilentMonitor
from processing.noise.beam_kernels import Beams
from processing.noise.beam_origins import beam_origins
from processing.noise.beams_of_drives import beams_of
from processing.noise.features import candidates_in_space, search_with_beams
from processing.noise.training.scenes import Scene
from processing.noise.training.streets import FAR, GRASS, POST, RAIL, TREE, WIRE
from processing.points.drive import Drive

Rows = NDArray[np.float32]

_POINTS_PER_SCENE = 5_000
_POINTS_OF_A_DRIVE = 400_000
_THIN = (WIRE, POST, RAIL, GRASS, TREE, FAR)
_THIN_WEIGHT, _THIN_WEIGHT_IN_SPACE, _TRUE_WEIGHT = 2.2, 4.0, 0.9
_UNKNOWN_LIGHT_SHARE, _SHIFTED_LIGHT_SHARE = 0.4, 0.4


@dataclass(frozen=True)
class Examples:
    """Rows of features with what they are.

    Attributes
    ----------
    cheap : (k, f) float32
        What is asked first, where beams are known; no columns in space.
    whole : (k, g) float32
        Everything.
    is_noise : (k,) bool
    weights : (k,) float64
        How much each counts: doubt is in favour of thin things.
    """

    cheap: Rows
    whole: Rows
    is_noise: NDArray[np.bool_]
    weights: NDArray[np.float64]

    @classmethod
    def joined(cls, parts: Iterable[Examples]) -> Examples:
        """All in one."""
        all_of = list(parts)
        return cls(
            np.vstack([one.cheap for one in all_of]),
            np.vstack([one.whole for one in all_of]),
            np.concatenate([one.is_noise for one in all_of]),
            np.concatenate([one.weights for one in all_of]),
        )


def beam_examples(scene: Scene, turn: float, random: Generator) -> Examples:
    """Examples of a scene whose beams are known."""
    cheap, whole, points = _asked(scene.beams(turn), scene.intensity)
    chosen = _chosen(scene.kinds[points], random)
    whole = whole[chosen]
    points = points[chosen]
    _change_light(whole, scene.kinds[points], random)
    return _weighed(cheap[chosen], whole, scene, points, _THIN_WEIGHT)


def space_examples(scene: Scene, random: Generator) -> Examples:
    """Examples of a scene of which only places are known."""
    candidates = candidates_in_space(scene.xyz - scene.xyz.mean(axis=0), SilentMonitor())
    chosen = _chosen(scene.kinds[candidates.points], random)
    whole, points = candidates.features[chosen], candidates.points[chosen]
    cheap = np.zeros((points.size, 0), np.float32)
    return _weighed(cheap, whole, scene, points, _THIN_WEIGHT_IN_SPACE)


def kept_examples(drive: Drive, random: Generator, *, in_space: bool) -> Examples | None:
    """Examples of a recording all of whose points are taken for true; None without beams."""
    if in_space:
        points = slice(0, min(drive.count, 2 * _POINTS_OF_A_DRIVE))
        xyz = drive.xyz(points)
        whole = candidates_in_space(xyz - xyz.mean(axis=0), SilentMonitor()).features
        cheap = np.zeros((whole.shape[0], 0), np.float32)
    else:
        origins = beam_origins(drive)
        if origins is None:
            return None
        image = drive.image(drive.pixel_kind)
        rows = int(np.searchsorted(image.row_starts, _POINTS_OF_A_DRIVE))
        beams, points = beams_of(drive, image, range(max(4, min(rows, image.rows))), origins)
        intensity = np.asarray(drive.columns["intensity"][points])
        cheap, whole, _ = _asked(beams, intensity)
        whole[:, -1] = np.where(random.random(whole.shape[0]) < 0.5, whole[:, -1], 0)
    chosen = random.random(whole.shape[0]) < _POINTS_PER_SCENE / max(1, whole.shape[0])
    count = int(chosen.sum())
    return Examples(
        cheap[chosen],
        whole[chosen],
        np.zeros(count, np.bool_),
        np.full(count, _THIN_WEIGHT),
    )


def _asked(beams: Beams, intensity: NDArray[np.uint16]) -> tuple[Rows, Rows, NDArray[np.int64]]:
    monitor = SilentMonitor()
    search = search_with_beams(beams, monitor)
    everything = np.ones(search.points.size, np.bool_)
    whole = search.candidates(everything, intensity, monitor).features
    return search.cheap_features(monitor), whole, search.points


def _chosen(kinds: NDArray[np.int64], random: Generator) -> NDArray[np.bool_]:
    """Thin things twice as often as others."""
    often = np.where(np.isin(kinds, _THIN), 2.0, 1.0)
    chosen: NDArray[np.bool_] = random.random(kinds.size) < often * _POINTS_PER_SCENE / max(
        1, kinds.size
    )
    return chosen


def _change_light(whole: Rows, kinds: NDArray[np.int64], random: Generator) -> None:
    """Make intensity unknown or other than simulated, so that the trees don't lean on it."""
    way = random.random()
    if way < _UNKNOWN_LIGHT_SHARE:
        whole[:, -1] = random.normal(0, 0.3, whole.shape[0])
    elif way < _UNKNOWN_LIGHT_SHARE + _SHIFTED_LIGHT_SHARE:
        shifts = random.normal(-0.7, 1.3, 12)
        whole[:, -1] += np.where(kinds < 0, 0.0, shifts[kinds])


def _weighed(
    cheap: Rows, whole: Rows, scene: Scene, points: NDArray[np.int64], thin_weight: float
) -> Examples:
    kinds, is_noise = scene.kinds[points], scene.noise[points] > 0
    weights = np.where(is_noise, 1.0, _TRUE_WEIGHT)
    weights[np.isin(kinds, _THIN)] = thin_weight
    return Examples(cheap, whole, is_noise, weights)
