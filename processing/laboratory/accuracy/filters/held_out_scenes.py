"""Noise of simulated recordings that no model learned from, as a table.

Streets from vehicles and tripods, sites and flights of the simulator, as they are delivered, of
other seeds than those that the models learned from (:mod:`processing.laboratory.noise_training`).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from processing.core.arrays import Flags
from processing.laboratory.noise_training.recordings import (
    AIRBORNE,
    MOBILE,
    SITE,
    STANDING,
    RecordedScene,
    recorded_scene,
    thin_scene,
)
from processing.laboratory.noise_training.scores import THIN_CODES, f_measure, said_of
from processing.methods.noise.neighbours.radius import radius_outliers
from processing.methods.noise.neighbours.statistical import statistical_outliers

SEEDS = range(901, 913)
_FEWEST = 50
_BEAMS, _PLACES = "beams", "places"
_SCANNERS = {_BEAMS: (MOBILE, MOBILE, STANDING), _PLACES: (STANDING, SITE, AIRBORNE, MOBILE)}


def unseen_rows(seeds: Sequence[int] = SEEDS, folder: Path | None = None) -> Iterator[list[str]]:
    """Rows of cells, the head first: one a scene, then the middle of each kind of knowledge.

    Parameters
    ----------
    folder : Path or None
        Where recordings are kept; None for nowhere.
    """
    head = ["known", "scanner, seed", "points", "noise", "kept F", "noise P", "R", "**F**"]
    yield [*head, *(f"{name} kept" for name in THIN_CODES), "radius F", "statistical F"]
    with TemporaryDirectory(prefix="zuka-") as made:
        for known in (_BEAMS, _PLACES):
            figures = []
            for which, scene in _scenes(known, seeds, folder or Path(made)):
                mine = _figures(scene, said_of(scene))
                figures.append(mine)
                yield [known, which, f"{scene.labels.size:,}", *map(_cell, mine)]
            columns = np.array(figures).T
            told = [one[~np.isnan(one)] for one in columns]
            middles = [float(np.median(one)) if one.size else np.nan for one in told]
            yield [known, "**middle**", "", *map(_cell, middles)]


def _scenes(known: str, seeds: Sequence[int], folder: Path) -> Iterator[tuple[str, RecordedScene]]:
    for seed in seeds:
        how = _SCANNERS[known][seed % len(_SCANNERS[known])]
        scene = recorded_scene(how, seed, folder)
        if known == _PLACES:
            scene = thin_scene(scene, seed)
        if known == _PLACES or scene.beams is not None:
            yield f"{how} {seed}", scene


def _figures(scene: RecordedScene, said: Flags) -> list[float]:
    is_noise = scene.is_noise
    found = int((said & is_noise).sum())
    kept = [np.isin(scene.labels, codes) for codes in THIN_CODES.values()]
    peers = [
        radius_outliers(scene.xyz, 0.5, 113),
        statistical_outliers(scene.xyz, 113, 1.5),
    ]
    return [
        float(is_noise.mean()),
        f_measure(~said, ~is_noise),
        found / max(1, int(said.sum())),
        found / max(1, int(is_noise.sum())),
        f_measure(said, is_noise),
        *(float((~said[one]).mean()) if one.sum() >= _FEWEST else np.nan for one in kept),
        *(f_measure(one, is_noise) for one in peers),
    ]


def _cell(share: float) -> str:
    return "–" if np.isnan(share) else f"{share:.3f}"
