"""Makes the noise models anew and says what they reach.

``python -m processing.laboratory.noise_training``

Needs the extra ``train``. The same seeds and recordings give the same models.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.laboratory.noise_training.examples import (
    Examples,
    LabelledCloud,
    recording_in_space,
    recording_with_beams,
    sample_in_space,
    sample_with_beams,
)
from processing.laboratory.noise_training.fitting import (
    TreesSize,
    fit_trees,
    mean_of_trees,
    shift_to_keep,
)
from processing.laboratory.noise_training.recordings import (
    AIRBORNE,
    CLEAR,
    MEADOW,
    MOBILE,
    MUCH,
    SCANS,
    SITE,
    STANDING,
    VARIED,
    RecordedScene,
    quietened,
    recorded_scene,
    thin_scene,
)
from processing.laboratory.noise_training.relief import on_relief
from processing.laboratory.noise_training.scores import said_of, score_line
from processing.laboratory.progress_lines import say
from processing.laboratory.seed_ranges import seeds_of
from processing.methods.noise.combined import (
    FIRST_LOOK,
    FIRST_LOOK_IN_SPACE,
    IN_SPACE,
    MODELS,
    WITH_BEAMS,
)
from processing.methods.noise.tree_files import read_trees, write_trees
from processing.methods.noise.trees import Trees, log_odds
from processing.recording.drive import Drive
from resources import path_of

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
_RECORDED = (MOBILE, MOBILE, MOBILE, STANDING, STANDING, MEADOW)
_CLOUDS = (SCANS, SITE, SITE, AIRBORNE)
_LIFTED_SHARE, _RELIEF_STREAM = 0.5, 9
"""Of recordings in space: streets are level, sites and hillsides are not."""


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
        for name, scene in _held_out(what, options):
            say(score_line(f"{what} {name}", said_of(scene), scene))


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m processing.laboratory.noise_training")
    parser.add_argument("--what", nargs="+", choices=("beams", "space"), default=["beams", "space"])
    parser.add_argument(
        "--recordings",
        default="1-96,157-190",
        help="seeds of the recordings with all kinds of noise that are learned from",
    )
    parser.add_argument(
        "--much-recordings",
        default="121-156",
        help="likewise, with the usual kinds of noise many times as often, where beams are known",
    )
    parser.add_argument(
        "--clouds", default="301-420", help="likewise, of clouds of which only places are known"
    )
    parser.add_argument(
        "--quiet-recordings",
        default="157-204",
        help="of those recordings that in space lose most of their noise, and are only asked again",
    )
    parser.add_argument("--folder", type=Path, help="where recordings are kept; none: nowhere")
    parser.add_argument("--held-out", default="501-506", help="of recordings that are scored")
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


@dataclass(frozen=True)
class _Learned:
    """What recordings with one kind of panes taught.

    Attributes
    ----------
    first : Trees or None
        Of the first look, where beams are known.
    alone, again : Trees
        Of every point by itself, and together with what was said of those around.
    columns : tuple of int
        How many features each has.
    """

    first: Trees | None
    alone: Trees
    again: Trees
    columns: tuple[int, int, int]


def _make(what: str, options: argparse.Namespace) -> None:
    """Models that are the mean of what both kinds of panes taught; the first look is of one.

    It sees nearly every point, so that twice as many trees would cost most there.
    """
    learned = [_learn(what, noise, options) for noise in (VARIED, CLEAR)]
    first, columns = learned[0].first, learned[0].columns
    if first is not None:
        _write(FIRST_LOOK, first, columns[0])
    alone, again = WITH_BEAMS if what == "beams" else IN_SPACE
    _write(alone, mean_of_trees([one.alone for one in learned]), columns[1])
    _write(again, mean_of_trees([one.again for one in learned]), columns[2])


def _learn(what: str, noise: str, options: argparse.Namespace) -> _Learned:
    looks: list[list[Examples]] = [[] for _ in range(_FOLDS)]
    folds: list[list[Examples]] = [[] for _ in range(_FOLDS)]
    for fold, name, case in _cases(what, noise, options):
        look, everything = case.alone()
        looks[fold].append(look)
        folds[fold].append(everything)
        say(f"learned from {name}: {case.is_noise.size} points")
    alone, first = [Examples.joined(one) for one in folds], None
    shape = _BEAMS_SHAPE if what == "beams" else _SPACE_SHAPE
    if what == "beams":
        first, alone = _initial_view([Examples.joined(one) for one in looks], alone)
    others = [fit_trees(_but(alone, fold), shape) for fold in range(_FOLDS)]
    own = fit_trees(Examples.joined(alone), shape)
    asked = [case.again(first, others[fold]) for fold, _, case in _cases(what, noise, options)]
    if what == "space":  # these were not learned from: all the others may judge
        asked += [case.again(None, own) for case in _quiet_cases(noise, options)]
    again = Examples.joined(asked)
    say(f"asked again about {again.is_noise.size} points")
    last = fit_trees(again, _AGAIN_SHAPE)
    return _Learned(
        None if first is None else first._replace(base=first.base - _NARROWER),
        own,
        last._replace(base=last.base - _DOUBT[what]),
        (looks[0][0].rows.shape[1], alone[0].rows.shape[1], again.rows.shape[1]),
    )


def _make_first_look_in_space(options: argparse.Namespace) -> None:
    """Trees that keep, by what costs little, what the others wouldn't call noise."""
    own, again = (read_trees(path_of(f"{MODELS}/{name}")) for name in IN_SPACE)
    cases = chain(
        (case for _, _, case in _cases("space", VARIED, options)), _quiet_cases(VARIED, options)
    )
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
    left = [log_odds(first, look.rows, SilentMonitor()) > 0 for look in looks]
    share = sum(int(one.sum()) for one in left) / joined.is_noise.size
    say(f"{share:.1%} of {joined.is_noise.size} examples are left after the first look")
    return first, [one.chosen(rows) for one, rows in zip(alone, left, strict=True)]


def _but(folds: Sequence[Examples], fold: int) -> Examples:
    return Examples.joined(one for number, one in enumerate(folds) if number != fold)


def _cases(
    what: str, noise: str, options: argparse.Namespace
) -> Iterator[tuple[int, str, LabelledCloud]]:
    """Recordings that are learned from, each of a fold; the same at every pass."""
    cases = _cases_with_beams if what == "beams" else _cases_in_space
    yield from cases(noise, options)
    folders = options.kept_in_space if what == "space" else options.kept_with_beams
    for number, folder in enumerate(folders):
        kept = sample_in_space if what == "space" else sample_with_beams
        for case in kept(Drive(folder), _KEPT_SEED + 100 * number):
            yield number % _FOLDS, f"kept {folder.name}", case


def _cases_with_beams(
    noise: str, options: argparse.Namespace
) -> Iterator[tuple[int, str, LabelledCloud]]:
    for seeds, one in ((options.recordings, noise), (options.much_recordings, MUCH)):
        for seed in seeds_of(seeds):
            how, scene = _recording(seed, one, options.folder)
            if scene.labels.size >= _FEWEST and scene.beams is not None:
                name = f"recording {how} {seed}"
                yield seed // 12 % _FOLDS, name, recording_with_beams(scene, seed)


def _cases_in_space(
    noise: str, options: argparse.Namespace
) -> Iterator[tuple[int, str, LabelledCloud]]:
    quiet = set(seeds_of(options.quiet_recordings))
    for seed in seeds_of(options.recordings):
        if seed not in quiet:
            how, scene = _recording(seed, noise, options.folder)
            scene = _in_places(scene, seed)
            if scene.labels.size >= _FEWEST:
                yield (
                    seed // 12 % _FOLDS,
                    f"recording {how} {seed}",
                    recording_in_space(scene, seed),
                )
    for seed in seeds_of(options.clouds):
        how = _CLOUDS[seed % len(_CLOUDS)]
        scene = thin_scene(recorded_scene(how, seed, options.folder, noise), seed)
        if scene.labels.size >= _FEWEST:
            yield seed // 12 % _FOLDS, f"cloud {how} {seed}", recording_in_space(scene, seed)


def _quiet_cases(noise: str, options: argparse.Namespace) -> Iterator[LabelledCloud]:
    """Recordings with next to no noise: a doubt that many points share is no proof."""
    for seed in seeds_of(options.quiet_recordings):
        scene = _in_places(quietened(_recording(seed, noise, options.folder)[1], seed), seed)
        if scene.labels.size >= _FEWEST:
            yield recording_in_space(scene, seed)


def _recording(seed: int, noise: str, folder: Path) -> tuple[str, RecordedScene]:
    how = _RECORDED[seed % len(_RECORDED)]
    return how, recorded_scene(how, seed, folder, noise)


def _in_places(scene: RecordedScene, seed: int) -> RecordedScene:
    """Places of a recording as a cloud is delivered, some on a relief."""
    is_lifted = np.random.default_rng(seed * 7 + _RELIEF_STREAM).random() < _LIFTED_SHARE
    if is_lifted and scene.beams is not None:
        scene = on_relief(scene, seed)
    return thin_scene(scene, seed)


def _held_out(what: str, options: argparse.Namespace) -> Iterator[tuple[str, RecordedScene]]:
    for seed in seeds_of(options.held_out):
        how, scene = _recording(seed, VARIED, options.folder)
        if what == "space":
            yield f"{how} {seed}", _in_places(scene, seed)
        elif scene.beams is not None:
            yield f"{how} {seed}", scene


def _write(name: str, trees: Trees, columns: int) -> None:
    write_trees(trees, path_of(MODELS) / name, columns)


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())
