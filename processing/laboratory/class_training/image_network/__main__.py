"""The thesis' image network beside its forests: M, M&A, M&A&I, and the choice for each class.

``python -m processing.laboratory.class_training.image_network --folder FOLDER --samples FOLDER…``

Needs the extra ``train``. Networks learn from streets of ``--seeds`` and ``--mounted``, from the
street ``--street`` alone, and from it after the others (pre-training); of the first kind one learns
with empty pixels left as they are, and one with the colours of camera images, which its forests are
given too. Forests learn from the points of the same streets with the network's intermediate
features; the streets of ``--validation`` choose features (importance, Boruta) and the kind of
forest for each class; those of ``--check`` and ``--samples`` are scored. All are the middle of the
first head's recording. What takes long stays in ``--folder`` and is made once: rasters, samples,
colours, networks.

References
----------
Takahashi 2022, sections 4.5 to 4.7.
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Integers
from processing.core.output_streams import write_every_character
from processing.laboratory.class_training.forests import (
    LEAST_IMPORTANCE,
    boruta,
    fitted_forest,
    importance_of,
)
from processing.laboratory.class_training.image_network.comparison import (
    Described,
    Forests,
    best_kinds,
    chosen_shares,
    f_of_classes,
    mean_f_of,
    score_of,
)
from processing.laboratory.class_training.image_network.kept_streets import (
    LEARNT_OF_A_CLASS,
    SCORED_OF_A_CLASS,
    KeptStreet,
    StreetFolder,
)
from processing.laboratory.class_training.image_network.network_training import (
    ChannelScale,
    intermediate_features,
    read_network,
    train_network,
    write_network,
)
from processing.laboratory.class_training.image_network.street_rasters import StreetRaster
from processing.laboratory.class_training.point_samples import ABSOLUTE, MMS, NAMES, PointSample
from processing.laboratory.progress_lines import say
from processing.laboratory.seed_ranges import seeds_of
from processing.scoring.points.point_scores import PointScore

_M, _MA, _MAI, _CHOICE = "M", "M&A", "M&A&I", "chosen"
_KINDS = (_M, _MA, _MAI)

_FOR_IMPORTANCE = 12_000
"""Points of the streets of validation that importance is taken of."""


@dataclass(frozen=True)
class Streets:
    """What is learnt from, chosen by, and scored."""

    alone: KeptStreet
    many: Sequence[KeptStreet]
    validation: Sequence[KeptStreet]
    scored: Sequence[KeptStreet]


@dataclass(frozen=True)
class Recipe:
    """How a network is made.

    Attributes
    ----------
    name : str
    learns_from_many : bool
        Else from one street alone.
    start : str
        The name of the network that it goes on from; empty: it knows nothing.
    fills_holes : bool
    sees_colours : bool
        Whether network and forests are given the colours of camera images.
    """

    name: str
    learns_from_many: bool
    start: str = ""
    fills_holes: bool = True
    sees_colours: bool = False

    @property
    def points(self) -> tuple[bool, bool]:
        """The same where forests without the network's features are the same."""
        return self.learns_from_many, self.sees_colours


_RECIPES = (
    Recipe("many streets", learns_from_many=True),
    Recipe("many streets, holes left", learns_from_many=True, fills_holes=False),
    Recipe("many streets, with colours", learns_from_many=True, sees_colours=True),
    Recipe("one street", learns_from_many=False),
    Recipe("one street, pre-trained", learns_from_many=False, start="many streets"),
)


def main(arguments: Sequence[str] | None = None) -> int:
    """Make what isn't there, and print the tables."""
    options = _parser().parse_args(arguments)
    options.folder.mkdir(parents=True, exist_ok=True)
    streets = _streets(options)
    columns = _columns(PointSample.joined([one.sample for one in streets.validation]))
    known: dict[tuple[bool, bool], Forests] = {}
    for recipe in _RECIPES:
        if recipe.name in options.networks:
            say(f"\nnetwork: {recipe.name}")
            network, scale = _network(recipe, streets, options)
            comparison = _Comparison(recipe, streets, columns, network, scale)
            before = known.get(recipe.points)
            known[recipe.points] = comparison.say(before).without(_MAI)
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m processing.laboratory.class_training.image_network"
    )
    names = [one.name for one in _RECIPES]
    parser.add_argument("--folder", type=Path, required=True, help="where work is kept")
    parser.add_argument("--street", type=int, default=3000, help="seed of the one street")
    parser.add_argument("--seeds", default="3003-3004", help="of more streets")
    parser.add_argument("--mounted", default="3040-3044", help="of those by heads of any mounting")
    parser.add_argument("--validation", default="3006")
    parser.add_argument("--check", default="3100", help="streets that are only scored")
    parser.add_argument("--samples", type=Path, nargs="*", default=[])
    parser.add_argument("--length", type=float, default=40.0, help="m of each simulated street")
    parser.add_argument("--steps", type=int, default=360, help="batches of four crops")
    parser.add_argument("--networks", nargs="*", default=names, choices=names)
    return parser


def _streets(options: argparse.Namespace) -> Streets:
    asks_colours = any(one.sees_colours for one in _RECIPES if one.name in options.networks)
    kept = StreetFolder(options.folder, options.length, asks_colours)
    (alone,) = kept.simulated([options.street], LEARNT_OF_A_CLASS)
    others = kept.simulated(seeds_of(options.seeds), LEARNT_OF_A_CLASS)
    others += kept.simulated(seeds_of(options.mounted), LEARNT_OF_A_CLASS, is_mounted=True)
    valid = kept.simulated(seeds_of(options.validation), SCORED_OF_A_CLASS)
    scored = kept.simulated(seeds_of(options.check), SCORED_OF_A_CLASS)
    scored += kept.delivered(options.samples, SCORED_OF_A_CLASS)
    return Streets(alone, [alone, *others], valid, scored)


def _learnt(recipe: Recipe, streets: Streets) -> Sequence[KeptStreet]:
    return streets.many if recipe.learns_from_many else [streets.alone]


def _raster(recipe: Recipe, street: KeptStreet) -> StreetRaster:
    return street.coloured_raster if recipe.sees_colours else street.raster


# torch is an extra: what it gives has no types where it is missing.
def _network(
    recipe: Recipe, streets: Streets, options: argparse.Namespace
) -> tuple[Any, ChannelScale]:
    """The network of a recipe, made if the folder lacks it; a third of the steps go on from one."""
    path = options.folder / f"{recipe.name.replace(',', '').replace(' ', '_')}.pt"
    if path.exists():
        return read_network(path)
    rasters = [_raster(recipe, one) for one in _learnt(recipe, streets)]
    if recipe.fills_holes:
        rasters = [one.without_holes(by_labels=True) for one in rasters]
    start, scale, steps = None, ChannelScale.of(rasters), options.steps
    if recipe.start:
        (before,) = (one for one in _RECIPES if one.name == recipe.start)
        start, scale = _network(before, streets, options)
        steps //= 3
    images = [scale.image_of(one) for one in rasters]
    network = train_network(images, steps, say, start)
    write_network(network, scale, path)
    return network, scale


@dataclass(frozen=True)
class _Comparison:
    """Forests on M, M&A and M&A&I by one network, and the choice between them."""

    recipe: Recipe
    streets: Streets
    columns: Mapping[str, Sequence[int]]
    network: Any  # torch's, see above
    scale: ChannelScale

    def say(self, known: Forests | None) -> Forests:
        """Print the table of the streets; forests that are known aren't grown again."""
        valid = [(one, self._seen(one)) for one in self.streets.validation]
        rows = np.concatenate([seen for _, seen in valid])
        codes = np.concatenate([one.sample.codes for one, _ in valid])
        kept = boruta(rows, codes, np.random.default_rng(0))
        say(f"Boruta keeps {kept.size} of {rows.shape[1]} intermediate features")
        learnt = [
            self._described(one, self._seen(one), kept)
            for one in _learnt(self.recipe, self.streets)
        ]
        forests = Forests.of(learnt, known)
        asked = _as_one([self._described(one, seen, kept) for one, seen in valid])
        shares = forests.shares(asked)
        scores = {kind: score_of(asked.sample, forests.codes, shares[kind]) for kind in _KINDS}
        chosen = best_kinds(scores, forests.codes.tolist(), _KINDS)
        words = zip(forests.codes.tolist(), chosen, strict=True)
        say("chosen: " + ", ".join(f"{code} {kind}" for code, kind in words))
        numbers = [str(one) for one in forests.codes]
        say(f"| street | features | mean F | {' | '.join(numbers)} |")
        say("|---" * (len(numbers) + 3) + "|")
        for street in self.streets.scored:
            shares = forests.shares(self._described(street, self._seen(street), kept))
            shares[_CHOICE] = chosen_shares(shares, chosen)
            for kind, own in shares.items():
                score = score_of(street.sample, forests.codes, own)
                say(_line(street.name, kind, score, numbers))
        return forests

    def _seen(self, street: KeptStreet) -> NDArray[np.float32]:
        """(k, 256) the network's intermediate features at the street's points."""
        raster = _raster(self.recipe, street)
        if self.recipe.fills_holes:
            raster = raster.without_holes(by_labels=False)
        pixels = raster.pixels_of(street.sample.points)
        return intermediate_features(self.network, self.scale.image_of(raster), *pixels)

    def _described(
        self, street: KeptStreet, seen: NDArray[np.float32], kept: Integers
    ) -> Described:
        rows = {kind: street.sample.values(self.columns[kind]) for kind in _KINDS}
        if self.recipe.sees_colours:
            rows = {kind: np.hstack([own, street.colours]) for kind, own in rows.items()}
        rows[_MAI] = np.hstack([rows[_MAI], seen[:, kept]])
        return Described(street.sample, rows)


def _as_one(parts: Sequence[Described]) -> Described:
    return Described(
        PointSample.joined([one.sample for one in parts]),
        {kind: np.concatenate([one.rows[kind] for one in parts]) for kind in _KINDS},
    )


def _columns(valid: PointSample) -> dict[str, list[int]]:
    """M, M&A and the part of it that counts (1.5 %), without heights above the sea.

    Intensities are those over a recording's median.
    """
    both = [at for at, name in enumerate(NAMES) if name not in (*ABSOLUTE, "intensity")]
    rows, rng = valid.values(both), np.random.default_rng(0)
    kept = boruta(rows, valid.codes, rng)
    say(f"Boruta keeps {kept.size} of {len(both)} inputs")
    few = rng.permutation(valid.codes.size)[:_FOR_IMPORTANCE]
    importance = importance_of(fitted_forest(rows[few], valid.codes[few]))
    some = [at for at, share in zip(both, importance, strict=True) if share >= LEAST_IMPORTANCE]
    say(f"M&A of 1.5 % and more: {', '.join(NAMES[at] for at in some)}")
    return {_M: [at for at in both if NAMES[at] not in MMS], _MA: both, _MAI: some}


def _line(street: str, kind: str, score: PointScore, codes: Sequence[str]) -> str:
    f_of = f_of_classes(score)
    words = " | ".join(f"{f_of[int(one)]:.2f}" if int(one) in f_of else "–" for one in codes)
    return f"| {street} | {kind} | {mean_f_of(score):.3f} | {words} |"


if __name__ == "__main__":
    write_every_character()
    raise SystemExit(main())
