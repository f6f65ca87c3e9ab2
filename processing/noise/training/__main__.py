"""``python -m processing.noise.training``: makes the models anew and says what they reach.

Needs the extra ``train``. The same seeds and recordings give the same models.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from processing.monitor import SilentMonitor
from processing.noise.combined import (
    FIRST_LOOK,
    IN_SPACE,
    MODELS,
    WITH_BEAMS,
    noise_codes_in_space,
    noise_codes_with_beams,
)
from processing.noise.training.examples import (
    Examples,
    beam_examples,
    kept_examples,
    space_examples,
)
from processing.noise.training.fitting import Shape, fitted, shifted_to_keep
from processing.noise.training.scanners import AIRBORNE, MOBILE, STANDING
from processing.noise.training.scenes import Scene, scene_of, thinned
from processing.noise.training.scores import score_line
from processing.noise.tree_files import write_trees
from processing.noise.trees import Trees, log_odds
from processing.points.drive import Drive
from resources import path_of

_BUDGETS = (120_000, 250_000, 400_000)
_FEWEST = 400
_FIRST_SHAPE = Shape(trees=30, leaves=12, rate=0.25)
_BEAMS_SHAPE = Shape(trees=100, leaves=24, rate=0.15)
_SPACE_SHAPE = Shape(trees=110, leaves=24, rate=0.15)
_LOST_AT_FIRST = 0.003
_SCANNERS = {
    "beams": (MOBILE, MOBILE, MOBILE, STANDING),
    "space": (STANDING, STANDING, AIRBORNE, MOBILE),
}


def main(arguments: Sequence[str] | None = None) -> int:
    """Make the models, or only score those that are there."""
    wish = _parser().parse_args(arguments)
    for what in wish.what:
        if not wish.score_only:
            {"beams": _make_with_beams, "space": _make_in_space}[what](wish)
        for seed in _seeds(wish.held_out):
            for scene, turn, name in _scenes(what, (seed,)):
                _say(score_line(f"{what} {name}", _said(what, scene, turn), scene))
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m processing.noise.training")
    parser.add_argument("--what", nargs="+", choices=("beams", "space"), default=["beams", "space"])
    parser.add_argument("--seeds", default="1-36", help="of the scenes that are learned from")
    parser.add_argument("--held-out", default="501-512", help="of the scenes that are scored")
    parser.add_argument(
        "--kept-with-beams", nargs="*", type=Path, default=[], help="folders of true recordings"
    )
    parser.add_argument(
        "--kept-in-space", nargs="*", type=Path, default=[], help="folders of true clouds"
    )
    parser.add_argument("--score-only", action="store_true")
    return parser


def _make_with_beams(wish: argparse.Namespace) -> None:
    random = np.random.default_rng(1)
    examples = []
    for scene, turn, name in _scenes("beams", _seeds(wish.seeds)):
        examples.append(beam_examples(scene, turn, random))
        _say(f"learned from {name}: {scene.noise.size} points")
    examples += _kept(wish.kept_with_beams, random, in_space=False)
    joined = Examples.joined(examples)
    first = fitted(joined.cheap, joined.is_noise, joined.weights, _FIRST_SHAPE)
    first = shifted_to_keep(first, joined.cheap, joined.is_noise, _LOST_AT_FIRST)
    left = log_odds(first, joined.cheap, SilentMonitor()) > 0
    _say(f"{left.mean():.1%} of {left.size} examples are left after the first look")
    _write(FIRST_LOOK, first, joined.cheap.shape[1])
    trees = fitted(joined.whole[left], joined.is_noise[left], joined.weights[left], _BEAMS_SHAPE)
    _write(WITH_BEAMS, trees, joined.whole.shape[1])


def _make_in_space(wish: argparse.Namespace) -> None:
    random = np.random.default_rng(2)
    examples = []
    for scene, _, name in _scenes("space", _seeds(wish.seeds)):
        examples.append(space_examples(scene, random))
        _say(f"learned from {name}: {scene.noise.size} points")
    examples += _kept(wish.kept_in_space, random, in_space=True)
    joined = Examples.joined(examples)
    trees = fitted(joined.whole, joined.is_noise, joined.weights, _SPACE_SHAPE)
    _write(IN_SPACE, trees, joined.whole.shape[1])


def _scenes(what: str, seeds: Sequence[int]) -> Iterator[tuple[Scene, float, str]]:
    for seed in seeds:
        how = _SCANNERS[what][seed % len(_SCANNERS[what])]
        scene, turn = scene_of(seed, how, _BUDGETS[seed % len(_BUDGETS)])
        if what == "space":
            scene = thinned(scene, seed)
        elif how == STANDING:
            scene = scene.chosen(scene.scans == 0)
        if scene.noise.size >= _FEWEST:
            yield scene, turn, f"{how} {seed}"


def _kept(
    folders: Sequence[Path], random: np.random.Generator, *, in_space: bool
) -> list[Examples]:
    found = []
    for folder in folders:
        examples = kept_examples(Drive(folder), random, in_space=in_space)
        if examples is not None:
            found.append(examples)
            _say(f"kept {folder.name}: {examples.is_noise.size} examples")
    return found


def _said(what: str, scene: Scene, turn: float) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    if what == "beams":
        return noise_codes_with_beams(scene.beams(turn), scene.intensity) > 0
    return noise_codes_in_space(scene.xyz) > 0


def _seeds(text: str) -> range:
    first, _, last = text.partition("-")
    return range(int(first), int(last or first) + 1)


def _write(name: str, trees: Trees, columns: int) -> None:
    write_trees(trees, path_of(MODELS) / name, columns)


def _say(text: str) -> None:
    sys.stdout.write(f"{text}\n")
    sys.stdout.flush()


if __name__ == "__main__":
    sys.exit(main())
