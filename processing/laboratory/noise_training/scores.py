"""How well noise was told in a scene whose truth is known."""

from __future__ import annotations

import numpy as np

from processing.core.arrays import Flags
from processing.laboratory.noise_training.recordings import RecordedScene
from processing.methods.noise.combined import noise_codes_in_space, noise_codes_with_beams

THIN_CODES = {
    "wire": (14,),
    "pole, trunk": (66,),
    "sign": (65,),
    "low plant": (3, 4),
    "crown": (5,),
}
"""Codes of what is lost most easily, by its name."""

_OTHERS = {"ground": (2,), "road": (11,), "building": (6,), "vehicle": (64,), "curb": (67,)}
_FEWEST = 20


def said_of(scene: RecordedScene) -> Flags:
    """(n,) what the models that the program has call noise."""
    if scene.beams is not None:
        return np.asarray(noise_codes_with_beams(scene.beams, scene.intensity) > 0, np.bool_)
    return np.asarray(noise_codes_in_space(scene.xyz) > 0, np.bool_)


def f_measure(said: Flags, truth: Flags) -> float:
    """2 P R / (P + R) of a claim; 1 where there is nothing to claim and nothing was claimed."""
    both = int(said.sum() + truth.sum())
    return 2 * int((said & truth).sum()) / both if both else 1.0


def score_line(name: str, said: Flags, scene: RecordedScene) -> str:
    """One scene as a line: F of noise, F of kept points, things kept by kind."""
    truth = scene.is_noise
    kept = []
    for kind, codes in {**THIN_CODES, **_OTHERS}.items():
        is_kind = np.isin(scene.labels, codes)
        if is_kind.sum() >= _FEWEST:
            kept.append(f"{kind} {(~said[is_kind]).mean():.3f}")
    return (
        f"{name}: F {f_measure(said, truth):.3f} of {truth.mean():.1%} noise, "
        f"kept F {100 * f_measure(~said, ~truth):.2f} | kept {', '.join(kept)}"
    )
