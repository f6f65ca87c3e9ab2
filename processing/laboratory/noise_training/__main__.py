"""Makes the noise models anew and says what they reach.

``python -m processing.laboratory.noise_training``

Needs the extra ``train``. The same seeds and recordings give the same models.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from itertools import chain
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.laboratory.noise_training.examples import (
    Examples,
    LabelledCloud,
    case_in_space,
    case_with_beams,
    recording_with_beams,
    sample_in_space,
    sample_with_beams,
)
from processing.laboratory.noise_training.fitting import TreesSize, fit_trees, shift_to_keep
from processing.laboratory.noise_training.meadows import grow_grass, remove_most_noise
from processing.laboratory.noise_training.recordings import (
    MEADOW,
    MUCH,
    VARIED,
    recorded_scene,
)
from processing.laboratory.noise_training.relief import on_relief
from processing.laboratory.noise_training.scanners import AIRBORNE, MOBILE, STANDING
from processing.laboratory.noise_training.scenes import TrainingScene, scene_of, thin_scene
from processing.laboratory.noise_training.scores import score_line
from processing.laboratory.progress_lines import say
from processing.laboratory.seed_ranges import seeds_of
from processing.methods.noise.combined import (
    FIRST_LOOK,
    FIRST_LOOK_IN_SPACE,
    IN_SPACE,
    MODELS,
    WITH_BEAMS,
    noise_codes_in_space,
    noise_codes_with_beams,
)
from processing.methods.noise.tree_files import read_trees, write_trees
from processing.methods.noise.trees import Trees, log_odds
from processing.recording.drive import Drive
from resources import path_of

_BUDGETS = (150_000, 250_000, 450_000)
_DENSE_BUDGET = 1_500_000
_FEWEST = 100
_FIRST_SHAPE = TreesSize(trees=30, leaves=12, rate=0.25)
_BEAMS_SHAPE = TreesSize(trees=80, leaves=24, rate=0.18)
_SPACE_SHAPE = TreesSize(trees=100, leaves=31, rate=0.15)
_AGAIN_SHAPE = TreesSize(trees=150, leaves=31, rate=0.12)
# Log-odds: with beams noise must be four and a half times as likely as not; in space the second
# trees are careful by themselves.
_DOUBT = {"beams": 1.5, "space": 0.0}
# Log-odds: the others learn from a little more than they will be shown; a third less is left of a
# street so, for one point of noise in two hundred.
_NARROWER = 0.3
# Of what the others in space call noise, the first look may lose one in a thousand.
_SPACE_FIRST_SHAPE = TreesSize(trees=24, leaves=12, rate=0.2)
_SAID_LOST_AT_FIRST = 0.001
_FOLDS = 3
_KEPT_SEED = 100_000
_LOST_AT_FIRST = 0.003
_SCANNERS = {
    "beams": (MOBILE, MOBILE, MOBILE, STANDING),
    "space": (STANDING, STANDING, AIRBORNE, MOBILE),
}
_RECORDED = (MOBILE, MOBILE, MOBILE, STANDING, STANDING, MEADOW)


def main(arguments: Sequence[str] | None = None) -> int:
    """Make the models, or only score those that are there."""
    options = _parser().parse_args(arguments)
    with TemporaryDirectory(prefix="zuka-") as made:
        options.folder = options.folder or Path(made)
        _make_and_score(options)
    return 0


def _make_and_score(options: argparse.Namespace) -> None:
    for what in options.what:
        if not (options.score_only or options.only_first_look):
            _make(what, options)
        if what == "space" and not options.score_only:
            _make_first_look_in_space(options)
        for seed in seeds_of(options.held_out):
            for scene, turn, name in [*_scenes(what, (seed,)), *_on_relief(what, (seed,))]:
                say(score_line(f"{what} {name}", _classify_scene(what, scene, turn), scene))


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m processing.laboratory.noise_training")
    parser.add_argument("--what", nargs="+", choices=("beams", "space"), default=["beams", "space"])
    parser.add_argument("--seeds", default="1-120", help="of the scenes that are learned from")
    parser.add_argument(
        "--relief-seeds", default="121-240", help="of those on relief, where only places are known"
    )
    parser.add_argument(
        "--quiet-seeds",
        default="241-300",
        help="of those on relief with much grass and little noise, which are only asked again",
    )
    parser.add_argument("--dense-seeds", default="301-320", help="likewise, from standing scanners")
    parser.add_argument(
        "--recordings",
        default="",
        help="seeds of the simulator's own that are learned from, too, where beams are known",
    )
    parser.add_argument(
        "--much-recordings",
        default="",
        help="likewise, with the usual kinds of noise many times as often",
    )
    parser.add_argument("--folder", type=Path, help="where recordings are kept; none: nowhere")
    parser.add_argument("--held-out", default="501-512", help="of the scenes that are scored")
    parser.add_argument(
        "--kept-with-beams", nargs="*", type=Path, default=[], help="folders of true recordings"
    )
    parser.add_argument(
        "--kept-in-space", nargs="*", type=Path, default=[], help="folders of true clouds"
    )
    parser.add_argument("--score-only", action="store_true")
    parser.add_argument(
        "--only-first-look",
        action="store_true",
        help="in space, from what the models that are there say; the others stay",
    )
    return parser


def _make(what: str, options: argparse.Namespace) -> None:
    looks: list[list[Examples]] = [[] for _ in range(_FOLDS)]
    folds: list[list[Examples]] = [[] for _ in range(_FOLDS)]
    for fold, name, case in _cases(what, options):
        look, everything = case.alone()
        looks[fold].append(look)
        folds[fold].append(everything)
        say(f"learned from {name}: {case.noise.size} points")
    alone, first = [Examples.joined(one) for one in folds], None
    names, shape = (WITH_BEAMS, _BEAMS_SHAPE) if what == "beams" else (IN_SPACE, _SPACE_SHAPE)
    if what == "beams":
        first, alone = _initial_view([Examples.joined(one) for one in looks], alone)
    others = [fit_trees(_but(alone, fold), shape) for fold in range(_FOLDS)]
    own = fit_trees(Examples.joined(alone), shape)
    _write(names[0], own, alone[0].rows.shape[1])
    asked = [case.again(first, others[fold]) for fold, _, case in _cases(what, options)]
    if what == "space":  # these were not learned from: all the others may judge
        asked += [case.again(None, own) for case in _quiet_cases(options)]
    again = Examples.joined(asked)
    say(f"asked again about {again.is_noise.size} points")
    if first is not None:
        columns = looks[0][0].rows.shape[1]
        _write(FIRST_LOOK, first._replace(base=first.base - _NARROWER), columns)
    last = fit_trees(again, _AGAIN_SHAPE)
    _write(names[1], last._replace(base=last.base - _DOUBT[what]), again.rows.shape[1])


def _make_first_look_in_space(options: argparse.Namespace) -> None:
    """Trees that keep, by what costs little, what the others wouldn't call noise."""
    own, again = (read_trees(path_of(f"{MODELS}/{name}")) for name in IN_SPACE)
    cases = chain((case for _, _, case in _cases("space", options)), _quiet_cases(options))
    joined = Examples.joined(case.said(own, again) for case in cases)
    first = fit_trees(joined, _SPACE_FIRST_SHAPE)
    first = shift_to_keep(first, joined.rows, joined.is_noise, _SAID_LOST_AT_FIRST)
    left = log_odds(first, joined.rows, SilentMonitor()) > 0
    share = np.average(left[~joined.is_noise], weights=joined.weights[~joined.is_noise])
    say(f"{share:.1%} of {left.size} examples that are kept in the end are asked about")
    _write(FIRST_LOOK_IN_SPACE, first, joined.rows.shape[1])


def _initial_view(
    looks: Sequence[Examples], alone: Sequence[Examples]
) -> tuple[Trees, list[Examples]]:
    """The trees of the first look, and what it leaves of the examples."""
    joined = Examples.joined(looks)
    first = fit_trees(joined, _FIRST_SHAPE)
    first = shift_to_keep(first, joined.rows, joined.is_noise, _LOST_AT_FIRST)
    _write(FIRST_LOOK, first, joined.rows.shape[1])
    left = [log_odds(first, look.rows, SilentMonitor()) > 0 for look in looks]
    share = sum(int(one.sum()) for one in left) / joined.is_noise.size
    say(f"{share:.1%} of {joined.is_noise.size} examples are left after the first look")
    return first, [one.chosen(rows) for one, rows in zip(alone, left, strict=True)]


def _but(folds: Sequence[Examples], fold: int) -> Examples:
    return Examples.joined(one for number, one in enumerate(folds) if number != fold)


def _cases(what: str, options: argparse.Namespace) -> Iterator[tuple[int, str, LabelledCloud]]:
    """Scenes and recordings that are learned from, each of a fold; the same at every pass."""
    for seed in seeds_of(options.seeds):
        for scene, turn, name in _scenes(what, (seed,)):
            is_space = what == "space"
            case = case_in_space(scene, seed) if is_space else case_with_beams(scene, turn, seed)
            yield seed // 12 % _FOLDS, name, case
    if what == "beams":
        yield from _recorded_cases(options)
    for seed in seeds_of(options.relief_seeds):
        for scene, _, name in _on_relief(what, (seed,)):
            yield seed // 12 % _FOLDS, name, case_in_space(scene, seed)
    folders = options.kept_in_space if what == "space" else options.kept_with_beams
    for number, folder in enumerate(folders):
        kept = sample_in_space if what == "space" else sample_with_beams
        for case in kept(Drive(folder), _KEPT_SEED + 100 * number):
            yield number % _FOLDS, f"kept {folder.name}", case


def _recorded_cases(options: argparse.Namespace) -> Iterator[tuple[int, str, LabelledCloud]]:
    for seeds, noise in ((options.recordings, VARIED), (options.much_recordings, MUCH)):
        for seed in seeds_of(seeds):
            how = _RECORDED[seed % len(_RECORDED)]
            scene = recorded_scene(how, seed, options.folder, noise)
            if scene.labels.size >= _FEWEST and scene.beams is not None:
                name = f"recording {how} {seed}"
                yield seed // 12 % _FOLDS, name, recording_with_beams(scene, seed)


def _scenes(what: str, seeds: Sequence[int]) -> Iterator[tuple[TrainingScene, float, str]]:
    for seed in seeds:
        scene, turn, how = _scene(what, seed)
        if what == "space":
            scene = thin_scene(scene, seed)
        elif how == STANDING:
            scene = scene.chosen(scene.scans == 0)
        if scene.noise.size >= _FEWEST:
            yield scene, turn, f"{how} {seed}"


def _on_relief(what: str, seeds: Sequence[int]) -> Iterator[tuple[TrainingScene, float, str]]:
    """Scenes as for clouds of which only places are known, lifted by hills and banks."""
    for seed in seeds if what == "space" else ():
        scene, turn, how = _scene(what, seed)
        scene = thin_scene(on_relief(scene, seed), seed)
        if scene.noise.size >= _FEWEST:
            yield scene, turn, f"{how} {seed} on relief"


def _quiet_cases(options: argparse.Namespace) -> Iterator[LabelledCloud]:
    """On relief with much grass and little noise, the last as dense as a tripod's own scans."""
    few = ((seed, _scene("space", seed)[0]) for seed in seeds_of(options.quiet_seeds))
    dense = (
        (seed, scene_of(seed, STANDING, _DENSE_BUDGET)[0]) for seed in seeds_of(options.dense_seeds)
    )
    for seed, scene in chain(few, dense):
        meadow = on_relief(grow_grass(scene, seed), seed)
        meadow = thin_scene(remove_most_noise(meadow, seed), seed)
        if meadow.noise.size >= _FEWEST:
            yield case_in_space(meadow, seed)


def _scene(what: str, seed: int) -> tuple[TrainingScene, float, str]:
    how = _SCANNERS[what][seed % len(_SCANNERS[what])]
    return *scene_of(seed, how, _BUDGETS[seed % len(_BUDGETS)]), how


def _classify_scene(
    what: str, scene: TrainingScene, turn: float
) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    if what == "beams":
        return noise_codes_with_beams(scene.beams(turn), scene.intensity) > 0
    return noise_codes_in_space(scene.xyz) > 0


def _write(name: str, trees: Trees, columns: int) -> None:
    write_trees(trees, path_of(MODELS) / name, columns)


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())
