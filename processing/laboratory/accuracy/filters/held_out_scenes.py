"""Noise of simulated scenes that no model learned from and nobody looked at, as a table.

Seeds 1 to 120 of :mod:`processing.laboratory.noise_training` are learned from, seeds from
501 on were looked at while the method was worked out; these are for the score alone.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from processing.core.arrays import Flags
from processing.laboratory.accuracy.filters.filter_scenes import THIN_KINDS
from processing.laboratory.noise_training.scanners import AIRBORNE, MOBILE, STANDING
from processing.laboratory.noise_training.scenes import TrainingScene, scene_of, thin_scene
from processing.laboratory.noise_training.scores import f_measure
from processing.laboratory.noise_training.streets import KINDS
from processing.methods.noise.combined import noise_codes_in_space, noise_codes_with_beams
from processing.methods.noise.neighbours.radius import radius_outliers
from processing.methods.noise.neighbours.statistical import statistical_outliers

SEEDS = range(901, 913)
_PULSES = 250_000
_FEWEST = 50
_SCANNERS_WITH_BEAMS = (MOBILE, MOBILE, STANDING)
_SCANNERS_IN_SPACE = (STANDING, MOBILE, AIRBORNE)


def unseen_rows(seeds: Sequence[int] = SEEDS, pulses: int = _PULSES) -> Iterator[list[str]]:
    """Rows of cells, the head first: one a scene, then the middle of each kind of knowledge."""
    thin = [KINDS[kind] for kind in THIN_KINDS]
    head = ["known", "scanner, seed", "points", "noise", "kept F", "noise P", "R", "**F**"]
    yield [*head, *(f"{name} kept" for name in thin), "radius F", "statistical F"]
    for knows_beams in (True, False):
        name = "beams" if knows_beams else "places"
        figures = []
        for seed in seeds:
            scanner, scene, said = _make_judged_scene(seed, pulses, knows_beams=knows_beams)
            mine = _figures(scene, said)
            figures.append(mine)
            yield [name, f"{scanner} {seed}", f"{scene.noise.size:,}", *map(_cell, mine)]
        columns = np.array(figures).T
        known = [one[~np.isnan(one)] for one in columns]
        middles = [float(np.median(one)) if one.size else np.nan for one in known]
        yield [name, "**middle**", "", *map(_cell, middles)]


def _make_judged_scene(
    seed: int, pulses: int, *, knows_beams: bool
) -> tuple[str, TrainingScene, Flags]:
    scanners = _SCANNERS_WITH_BEAMS if knows_beams else _SCANNERS_IN_SPACE
    scanner = scanners[seed % len(scanners)]
    scene, turn = scene_of(seed, scanner, pulses)
    if not knows_beams:
        scene = thin_scene(scene, seed)
        return scanner, scene, noise_codes_in_space(scene.xyz) > 0
    scene = scene.chosen(scene.scans == 0)
    return scanner, scene, noise_codes_with_beams(scene.beams(turn), scene.intensity) > 0


def _figures(scene: TrainingScene, said: Flags) -> list[float]:
    is_noise = scene.noise > 0
    found = int((said & is_noise).sum())
    kept = [scene.kinds == kind for kind in THIN_KINDS]
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
