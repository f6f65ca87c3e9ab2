"""Hills, cuts and banks under a recorded scene, for clouds of which only places are known.

Streets are level, sites and hillsides are not. Everything of a scene is lifted by the relief under
it; what the relief hides from the scanner is left out.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.random import Generator

from processing.core.arrays import Floats
from processing.laboratory.noise_training.recordings import RecordedScene

_STREAM = 5
_MOST_BANKS, _BANK_HEIGHTS_M, _BANK_SLOPES = 5, (0.5, 6.0), (0.3, 1.2)
_MOST_TILT = 0.3
_WAVES, _CLODS = 4, 8
_WAVE_LENGTHS_M, _CLOD_LENGTHS_M = (4.0, 30.0), (0.4, 2.0)
_WAVE_STEEPNESS, _MOST_CLOD_M = 0.03, 0.03
_ALONG = np.linspace(0.05, 0.85, 17)  # of the beam: what hides a point stands well before it
_HIDES_M = 0.1


@dataclass(frozen=True)
class Relief:
    """Heights over a plane.

    Attributes
    ----------
    banks : (b, 5) float64
        Direction as x and y, where the bank begins in it, m, its width, m, and its height, m.
    waves : (w, 4) float64
        Radians per m along x and y, phase, height, m.
    """

    banks: Floats
    waves: Floats

    def heights(self, xy: Floats) -> Floats:
        """(n,) m at places (n, 2) m."""
        found = np.zeros(xy.shape[0])
        for x, y, start, width, high in self.banks:
            found += high * np.clip((xy[:, 0] * x + xy[:, 1] * y - start) / width, 0.0, 1.0)
        for x, y, phase, high in self.waves:
            found += high * np.sin(xy[:, 0] * x + xy[:, 1] * y + phase)
        return found


def relief_of(random: Generator, length_m: float) -> Relief:
    """A hillside with some banks, as long as they are high or longer, and rough ground."""
    banks = []
    for _ in range(int(random.integers(1, _MOST_BANKS + 1))):
        way, high = random.uniform(0, 2 * np.pi), random.uniform(*_BANK_HEIGHTS_M)
        width = high / random.uniform(*_BANK_SLOPES)
        start = random.uniform(-0.5, 0.5) * length_m
        banks.append([np.cos(way), np.sin(way), start, width, high * random.choice([-1, 1])])
    way, far = random.uniform(0, 2 * np.pi), 4 * length_m
    tilt = random.uniform(0, _MOST_TILT)
    banks.append([np.cos(way), np.sin(way), -far, 2 * far, 2 * far * tilt])
    waves = []
    for count, lengths, clod_m in (
        (_WAVES, _WAVE_LENGTHS_M, None),
        (_CLODS, _CLOD_LENGTHS_M, random.uniform(0, _MOST_CLOD_M)),
    ):
        for _ in range(count):
            way, wave_m = random.uniform(0, 2 * np.pi), random.uniform(*lengths)
            high = random.uniform(0, _WAVE_STEEPNESS) * wave_m if clod_m is None else clod_m
            per_m = 2 * np.pi / wave_m
            waves.append(
                [per_m * np.cos(way), per_m * np.sin(way), random.uniform(0, 2 * np.pi), high]
            )
    return Relief(np.array(banks), np.array(waves))


def on_relief(scene: RecordedScene, seed: int) -> RecordedScene:
    """The places of a scene on a relief of its own; its beams are no longer known.

    Raises
    ------
    ValueError
        No beams are known: what relief hides can't be told.
    """
    if scene.beams is None:
        raise ValueError("no beams are known of this recording")
    random = np.random.default_rng(seed * 7 + _STREAM)
    along = np.percentile(scene.xyz[:, :2], [1, 99], axis=0)
    relief = relief_of(random, float(np.ptp(along, axis=0).max()))
    xyz, origins = (_lifted(one, relief) for one in (scene.beams.xyz, scene.beams.origins))
    is_hidden = np.zeros(xyz.shape[0], np.bool_)
    for share in _ALONG:
        beam = origins + share * (xyz - origins)
        is_hidden |= beam[:, 2] < relief.heights(beam[:, :2]) - _HIDES_M
    return replace(scene, xyz=xyz, beams=None).chosen(~is_hidden)


def _lifted(xyz: Floats, relief: Relief) -> Floats:
    return np.column_stack([xyz[:, :2], xyz[:, 2] + relief.heights(xyz[:, :2])])
