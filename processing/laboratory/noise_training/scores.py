"""How well noise was told in a scene whose truth is known."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Flags
from processing.laboratory.noise_training.noise_kinds import NOISE_KINDS
from processing.laboratory.noise_training.scenes import TrainingScene
from processing.laboratory.noise_training.streets import KINDS

_FEWEST = 20


def f_measure(said: Flags, truth: Flags) -> float:
    """2 P R / (P + R) of a claim; 1 where there is nothing to claim and nothing was claimed."""
    both = int(said.sum() + truth.sum())
    return 2 * int((said & truth).sum()) / both if both else 1.0


def score_line(name: str, said: Flags, scene: TrainingScene) -> str:
    """One scene as a line: F of noise, F of kept points, noise found and things kept by kind."""
    truth = scene.noise > 0
    found = _shares(NOISE_KINDS, scene.noise, said, first=1)
    kept = _shares(KINDS, scene.kinds, ~said, first=0)
    return (
        f"{name}: F {f_measure(said, truth):.3f} of {truth.mean():.1%} noise, "
        f"kept F {100 * f_measure(~said, ~truth):.2f} | found {found} | kept {kept}"
    )


def _shares(names: Sequence[str], kinds: NDArray[np.int64], said: Flags, *, first: int) -> str:
    parts = []
    for number, name in enumerate(names):
        is_kind = kinds == number
        if number >= first and is_kind.sum() >= _FEWEST:
            parts.append(f"{name} {said[is_kind].mean():.3f}")
    return ", ".join(parts)
