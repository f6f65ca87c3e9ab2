"""What networks say of flights whose truth is known, as rows of tables.

References
----------
Shinohara 2022, sections 3.4 and 3.5: precision, recall and F of each class, plain means; waveforms
or points replaced by zeros or noise; thinned points.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.laboratory.waveform_networks.merging import (
    LearnedMerge,
    merged_any_class,
    merged_published,
)
from processing.laboratory.waveform_networks.patches import (
    FirstReturns,
    Patch,
    covering_patches,
)
from processing.laboratory.waveform_networks.sizes import CLASSES, NetworkSizes
from processing.laboratory.waveform_networks.training import (
    GLOBAL,
    GLOBAL_POINTS,
    LOCAL,
    LOCAL_POINTS,
    WHOLE_PATCH,
    patch_shares,
)

F32 = NDArray[np.float32]

NAMES = ("ground", "vegetation", "building", "wire", "tower", "road")

Change = Callable[[Patch, Generator], Patch]

_NOISE_OF_WAVES = 0.05
"""Of a flight's middle peak; the published amplitude isn't told, as that of points isn't."""

_NOISE_OF_POINTS_M = 0.3


@dataclass(frozen=True, eq=False)
class Answers:
    """What networks say of the first returns of flights.

    Attributes
    ----------
    shares : mapping of str to (n, 6) float32
        Of each kind of network.
    classes : (n,) int64
        The truth.
    """

    shares: Mapping[str, F32]
    classes: Integers


@dataclass(frozen=True)
class ClassRates:
    """Precision, recall and F of six classes; NaN where nothing is there.

    Attributes
    ----------
    precision, recall, f_measure : (6,) float64
    """

    precision: Floats
    recall: Floats
    f_measure: Floats

    @staticmethod
    def of(classes: Integers, found: Integers) -> ClassRates:
        """Of true and found places of classes."""
        counts = np.bincount(classes * CLASSES + found, minlength=CLASSES**2)
        table = counts.reshape(CLASSES, CLASSES)
        hits, true, called = np.diag(table), table.sum(axis=1), table.sum(axis=0)
        with np.errstate(invalid="ignore", divide="ignore"):
            f_measure = np.where(true > 0, 2 * hits / (true + called), np.nan)
            return ClassRates(hits / called, hits / true, f_measure)


def answers(
    networks: Mapping[str, Any],  # torch's: an extra that may be missing
    sizes: NetworkSizes,
    flights: Sequence[FirstReturns],
    change: Change | None = None,
    most: int | None = None,
) -> Answers:
    """What networks say of flights; a point that several patches hold gets the mean.

    Parameters
    ----------
    change : callable, optional
        What is done to each patch before.
    most : int, optional
        Patches of a flight, drawn by chance; None for all.
    """
    rng = np.random.default_rng(0)
    said: dict[str, list[F32]] = {kind: [] for kind in networks}
    classes = []
    for flight in flights:
        sums = {kind: np.zeros((len(flight.xyz), CLASSES), np.float32) for kind in networks}
        seen = np.zeros(len(flight.xyz), np.bool_)
        patches = covering_patches(flight, sizes.points, rng)
        for number in rng.permutation(len(patches))[:most].tolist():
            patch = patches[number]
            shown = patch if change is None else change(patch, rng)
            for kind, network in networks.items():
                own = patch_shares(network, kind, sizes, shown)
                np.add.at(sums[kind], patch.points, own)
            seen[patch.points] = True
        scored = seen & (flight.classes >= 0)
        classes.append(flight.classes[scored])
        for kind, whole in sums.items():
            own = whole[scored]
            said[kind].append(own / own.sum(axis=1, keepdims=True))
    shares = {kind: np.concatenate(parts) for kind, parts in said.items()}
    return Answers(shares, np.concatenate(classes))


def found_by(said: Answers, local: str, of_all: str) -> dict[str, Integers]:
    """Places of classes by each block alone and by the published rules of both."""
    one, other = said.shares[local], said.shares[of_all]
    return {
        "local": one.argmax(axis=1),
        "global": other.argmax(axis=1),
        "local–global": merged_published(one, other)[0],
        "local–global, any class": merged_any_class(one, other)[0],
    }


def block_rows(said: Answers, learned: LearnedMerge) -> list[str]:
    """Tables 3.4 and 3.6: blocks and inputs, with the learned merge."""
    rows = []
    for words, local, of_all in (
        ("points", LOCAL_POINTS, GLOBAL_POINTS),
        ("points and waveforms", LOCAL, GLOBAL),
    ):
        found = found_by(said, local, of_all)
        if local == LOCAL:
            found["local–global, learned"] = learned.merged(said.shares[local], said.shares[of_all])
        for name, places in found.items():
            rows += _three_rows(f"{name} | {words}", ClassRates.of(said.classes, places))
    if WHOLE_PATCH in said.shares:
        whole = said.shares[WHOLE_PATCH].argmax(axis=1)
        words = "whole patch | points and waveforms"
        rows += _three_rows(words, ClassRates.of(said.classes, whole))
    return rows


def share_rows(said: Answers) -> list[str]:
    """Table 3.5: of the points called a class, how many the local block's word decided."""
    rows = []
    for words, local, of_all in (
        ("points", LOCAL_POINTS, GLOBAL_POINTS),
        ("points and waveforms", LOCAL, GLOBAL),
    ):
        for rule, merge in (("published", merged_published), ("any class", merged_any_class)):
            found, is_local = merge(said.shares[local], said.shares[of_all])
            called = np.bincount(found, minlength=CLASSES)
            decided = np.bincount(found[is_local], minlength=CLASSES)
            with np.errstate(invalid="ignore"):
                rows.append(table_row(f"{rule} | {words}", decided / called, with_mean=False))
    return rows


def f_row(words: str, said: Answers) -> str:
    """F of the published rule on points and waveforms."""
    found = merged_published(said.shares[LOCAL], said.shares[GLOBAL])[0]
    return table_row(words, ClassRates.of(said.classes, found).f_measure)


def recall_row(words: str, said: Answers) -> str:
    """Recall of the published rule, as tables 3.7 and 3.8 have it."""
    found = merged_published(said.shares[LOCAL], said.shares[GLOBAL])[0]
    return table_row(words, ClassRates.of(said.classes, found).recall)


def table_row(words: str, values: Floats, *, with_mean: bool = True) -> str:
    """A line of a table: two decimals, the plain mean of those that are known at its end."""
    known = values[np.isfinite(values)]
    told = [f"{one:.2f}" if np.isfinite(one) else "–" for one in values]
    if with_mean:
        told.append(f"{known.mean():.2f}" if known.size else "–")
    return f"| {words} | {' | '.join(told)} |"


def table_head(words: Sequence[str], *, with_mean: bool = True) -> list[str]:
    """The first two lines of a table of six classes."""
    heads = [*words, *NAMES, *(["mean"] if with_mean else [])]
    return [f"| {' | '.join(heads)} |", "|---" * len(heads) + "|"]


def _three_rows(words: str, rates: ClassRates) -> list[str]:
    parts = (("P", rates.precision), ("R", rates.recall), ("F", rates.f_measure))
    return [table_row(f"{words} | {name}", values) for name, values in parts]


def _without_waves(patch: Patch, _: Generator) -> Patch:
    return replace(patch, waves=np.zeros_like(patch.waves))


def _only_noise(patch: Patch, rng: Generator) -> Patch:
    noise = np.abs(rng.normal(0, float(patch.waves.std()), patch.waves.shape))
    return replace(patch, waves=noise.astype(np.float32))


def _noisy_waves(patch: Patch, rng: Generator) -> Patch:
    noise = rng.normal(0, _NOISE_OF_WAVES, patch.waves.shape).astype(np.float32)
    return replace(patch, waves=np.maximum(patch.waves + noise, 0))


def _anywhere(patch: Patch, rng: Generator) -> Patch:
    drawn = rng.uniform(patch.xyz.min(axis=0), patch.xyz.max(axis=0), patch.xyz.shape)
    return replace(patch, xyz=drawn.astype(np.float32))


def _shaken(patch: Patch, rng: Generator) -> Patch:
    moves = rng.normal(0, _NOISE_OF_POINTS_M, patch.xyz.shape).astype(np.float32)
    return replace(patch, xyz=patch.xyz + moves)


CHANGES: Mapping[str, Change] = {
    "real | zeros": _without_waves,
    "real | noise only": _only_noise,
    f"real | real + noise of {_NOISE_OF_WAVES:g} of a peak": _noisy_waves,
    "noise only | real": _anywhere,
    f"real + noise of {_NOISE_OF_POINTS_M:g} m | real": _shaken,
}
"""Points and waveforms of tables 3.7 and 3.8. Points at zero have no neighbourhoods."""
