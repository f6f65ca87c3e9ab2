"""Examples for the trees: features of points that are known to be noise or to be true.

They come of recordings by the simulator, and of true recordings, all of which is kept.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from processing.core.arrays import Flags
from processing.core.monitor import SilentMonitor
from processing.image.images_of_drives import image_of
from processing.laboratory.noise_training.recordings import RecordedScene
from processing.methods.noise.beams.beam_origins import beam_origins
from processing.methods.noise.beams.beams_of_drives import beams_of
from processing.methods.noise.combined import OPEN_IN_SPACE
from processing.methods.noise.features.features import BeamSearch, Candidates, search_with_beams
from processing.methods.noise.features.second_pass import OPEN_ODDS
from processing.methods.noise.features.space_search import SpaceSearch, search_in_space
from processing.methods.noise.trees import Trees, log_odds
from processing.recording.drive import Drive

FeatureVectors = NDArray[np.float32]

_POINTS_PER_RECORDING, _POINTS_KEPT = 5_000, 8_000
_NOISE_OFTEN = 3.0
"""Noise of a simulated recording is so much likelier to be an example, and counts so much less."""

_ON_SURFACE_M = 0.04
"""Noise so near to a true point harms nobody and tells nothing: it is no example."""

_CROWN, _WIRE = 5, 14
_THIN = (_WIRE, _CROWN, 3, 4, 65, 66)
_EASILY_LOST = (_WIRE, _CROWN)
"""Codes: low plants, signs and poles are thin, too."""

_MOST_POINTS = 200_000
_CHUNKS = 4
_FEWEST_ROWS = 50
_KEPT_SHARES = (0.3, 0.1)
_KEPT_PIECES = 4
_FEWEST_POINTS = 100
_LOST_WEIGHT, _THIN_WEIGHT, _TRUE_WEIGHT = 4.0, 2.2, 0.9
_REST_WEIGHT, _MOST_WEIGHT = 0.5, 5.0
_UNKNOWN_LIGHT_SHARE, _SHIFTED_LIGHT_SHARE = 0.4, 0.4


@dataclass(frozen=True)
class Examples:
    """Rows of features with what they are.

    Attributes
    ----------
    rows : (k, f) float32
    is_noise : (k,) bool
    weights : (k,) float64
        How much each counts: doubt is in favour of thin things.
    """

    rows: FeatureVectors
    is_noise: Flags
    weights: NDArray[np.float64]

    def chosen(self, rows: Flags) -> Examples:
        """Some of them."""
        return Examples(self.rows[rows], self.is_noise[rows], self.weights[rows])

    @classmethod
    def joined(cls, parts: Iterable[Examples]) -> Examples:
        """All in one."""
        all_of = list(parts)
        return cls(
            np.vstack([one.rows for one in all_of]),
            np.concatenate([one.is_noise for one in all_of]),
            np.concatenate([one.weights for one in all_of]),
        )


@dataclass(frozen=True)
class LabelledCloud:
    """A cloud whose truth is known.

    Attributes
    ----------
    is_noise : (n,) bool
        Of every point, as the search counts them.
    labels : (n,) uint8
        Codes of what was met.
    search : BeamSearch or None
        Where its beams are known.
    intensity : (n,) uint16
    space : SpaceSearch or None
        Where only places are known.
    seed : int
        Chance is drawn from it, so that every pass sees the same.
    is_clear : (n,) bool or None
        Which points may be examples; None for all.
    points_wanted : int
        Examples, about; of thin things and noise there are more.
    noise_often : float
        How many times as often as others noise is an example. It counts as much less.
    """

    is_noise: Flags
    labels: NDArray[np.uint8]
    seed: int
    search: BeamSearch | None = None
    intensity: NDArray[np.uint16] | None = None
    space: SpaceSearch | None = None
    is_clear: Flags | None = None
    points_wanted: int = _POINTS_PER_RECORDING
    noise_often: float = 1.0

    def alone(self) -> tuple[Examples, Examples]:
        """Examples of points by themselves: what the first look sees of each, and everything.

        The first has no columns in space.
        """
        if self.space is not None:
            points = self.space.points
            none = np.zeros((points.size, 0), np.float32)
            return self._some(none, points), self._some(self._candidates(None).features, points)
        points, cheap = self._search().points, self._search().cheap_features(SilentMonitor())
        chosen, what = self._picked(points)
        rows = self._with_beams(cheap, chosen).features
        return Examples(cheap[chosen], *what), Examples(rows, *what)

    def again(self, first: Trees | None, own: Trees) -> Examples:
        """Examples of points with what ``own`` said of them and of others."""
        candidates, monitor = self._candidates(first), SilentMonitor()
        odds = log_odds(own, candidates.features, monitor)
        is_open = np.flatnonzero(odds > OPEN_ODDS)
        rows = candidates.seen_again(odds, is_open, monitor)
        return self._some(rows, candidates.points[is_open])

    def said(self, own: Trees, again: Trees) -> Examples:
        """Examples in space for a first look: what others, that see everything, call noise.

        All that is called noise, as far as there is no more of it than else in a scene, and some
        of the rest, which counts half, or more where there was much to choose from.
        """
        if self.space is None:
            raise ValueError("beams are known of this cloud")
        candidates, monitor = self._candidates(None), SilentMonitor()
        odds = log_odds(own, candidates.features, monitor)
        is_open = np.flatnonzero(odds > OPEN_IN_SPACE)
        rows = candidates.seen_again(odds, is_open, monitor)
        is_said = np.zeros(odds.size, np.bool_)
        is_said[is_open] = log_odds(again, rows, monitor) > 0
        often = np.array(
            [self.points_wanted / max(1, int(one.sum())) for one in (~is_said, is_said)]
        )
        chosen = np.random.default_rng(self.seed + 1).random(odds.size) < often[is_said.astype(int)]
        of_rest = float(np.clip(1 / often[0], 1.0, _MOST_WEIGHT)) * _REST_WEIGHT
        cheap = self.space.cheap_features(monitor)[chosen]
        return Examples(cheap, is_said[chosen], np.where(is_said[chosen], 1.0, of_rest))

    def _candidates(self, first: Trees | None) -> Candidates:
        if self.space is not None:
            cheap = self.space.cheap_features(SilentMonitor())
            everything = np.ones(self.space.points.size, np.bool_)
            return self.space.candidates(cheap, everything, SilentMonitor())
        if first is None:
            raise ValueError("beams need the trees of the first look")
        cheap = self._search().cheap_features(SilentMonitor())
        return self._with_beams(cheap, log_odds(first, cheap, SilentMonitor()) > 0)

    def _with_beams(self, cheap: FeatureVectors, is_doubtful: Flags) -> Candidates:
        if self.intensity is None:
            raise ValueError("beams come with intensities")
        search, monitor = self._search(), SilentMonitor()
        candidates = search.candidates(cheap, is_doubtful, self.intensity, monitor)
        self._change_light(candidates)
        return candidates

    def _search(self) -> BeamSearch:
        if self.search is None:
            raise ValueError("only places are known of this cloud")
        return self.search

    def _change_light(self, candidates: Candidates) -> None:
        """Make intensity unknown or other than simulated, so that the trees don't lean on it."""
        random, light = np.random.default_rng(self.seed), candidates.features[:, -1]
        way, labels = random.random(), self.labels[candidates.points]
        is_noise = self.is_noise[candidates.points]
        shifted_share = _SHIFTED_LIGHT_SHARE if self.is_noise.any() else 0.0
        if way < _UNKNOWN_LIGHT_SHARE:
            light[:] = random.normal(0, 0.3, light.size)
        elif way < _UNKNOWN_LIGHT_SHARE + shifted_share:
            light += np.where(is_noise, 0.0, random.normal(-0.7, 1.3, 256)[labels])

    def _some(self, rows: FeatureVectors, points: NDArray[np.int64]) -> Examples:
        chosen, what = self._picked(points)
        return Examples(rows[chosen], *what)

    def _picked(self, points: NDArray[np.int64]) -> tuple[Flags, tuple[Flags, NDArray[np.float64]]]:
        """Which are examples, what those are and how much each counts.

        Thin things are taken twice as often as others, and noise as is wanted.
        """
        random = np.random.default_rng(self.seed + 1)
        is_thin, is_noise = np.isin(self.labels[points], _THIN), self.is_noise[points]
        usual = self.points_wanted / max(1, points.size)
        often = np.where(is_thin, 2.0, np.where(is_noise, self.noise_often, 1.0)) * usual
        chosen = random.random(points.size) < often
        if self.is_clear is not None:
            chosen &= self.is_clear[points]
        of_noise = min(1.0, usual) / min(1.0, self.noise_often * usual)
        weights = np.where(is_noise, of_noise, _TRUE_WEIGHT)
        weights[is_thin] = _THIN_WEIGHT
        weights[np.isin(self.labels[points], _EASILY_LOST)] = _LOST_WEIGHT
        return chosen, (is_noise[chosen], weights[chosen])


def recording_with_beams(scene: RecordedScene, seed: int) -> LabelledCloud:
    """A recording by the simulator whose beams are known.

    Raises
    ------
    ValueError
        They aren't.
    """
    if scene.beams is None:
        raise ValueError("no beams are known of this recording")
    return LabelledCloud(
        scene.is_noise,
        scene.labels,
        seed,
        search_with_beams(scene.beams, SilentMonitor()),
        scene.intensity,
        is_clear=_clear_of_surfaces(scene),
        noise_often=_NOISE_OFTEN,
    )


def recording_in_space(scene: RecordedScene, seed: int) -> LabelledCloud:
    """A recording by the simulator of which only places are known."""
    xyz = scene.xyz - scene.xyz.mean(axis=0)
    space = search_in_space(xyz, SilentMonitor())
    return LabelledCloud(
        scene.is_noise[space.order],
        scene.labels[space.order],
        seed,
        space=space,
        is_clear=_clear_of_surfaces(scene)[space.order],
        noise_often=_NOISE_OFTEN,
    )


def _clear_of_surfaces(scene: RecordedScene) -> Flags:
    """(n,) whether a point is true, or noise away from what is."""
    from scipy.spatial import cKDTree

    is_clear, noise = np.ones(scene.labels.size, np.bool_), np.flatnonzero(scene.is_noise)
    if 0 < noise.size < scene.labels.size:
        true = cKDTree(scene.xyz[~scene.is_noise])
        away, _ = true.query(scene.xyz[noise], distance_upper_bound=_ON_SURFACE_M)
        is_clear[noise] = np.isinf(away)
    return is_clear


def sample_with_beams(drive: Drive, seed: int) -> Iterator[LabelledCloud]:
    """A recording all of whose points are taken for true; none without beams."""
    origins = beam_origins(drive)
    if origins is None:
        return
    image = image_of(drive, drive.pixel_kind)
    parts = max(1, min(_CHUNKS, image.rows // _FEWEST_ROWS))
    cuts = np.linspace(0, image.rows, parts + 1).astype(np.int64)
    for number in range(parts):
        most = np.searchsorted(image.row_starts, image.row_starts[cuts[number]] + _MOST_POINTS)
        rows = range(int(cuts[number]), int(min(cuts[number + 1], most)))
        beams, points = beams_of(drive, image, rows, origins)
        intensity = np.asarray(drive.columns["intensity"][points])
        search, kept = search_with_beams(beams, SilentMonitor()), _all_kept(beams.ranges.size)
        yield LabelledCloud(*kept, seed + number, search, intensity, points_wanted=_POINTS_KEPT)


def sample_in_space(drive: Drive, seed: int) -> Iterator[LabelledCloud]:
    """A recording all of whose points are taken for true, as it is, thinned, and in pieces."""
    xyz = drive.xyz(slice(0, min(drive.count, 4 * _MOST_POINTS)))
    random = np.random.default_rng(seed)
    for number, cloud in enumerate(_as_delivered_elsewhere(xyz - xyz.mean(axis=0), random)):
        space = search_in_space(np.ascontiguousarray(cloud), SilentMonitor())
        kept = _all_kept(cloud.shape[0])
        yield LabelledCloud(*kept, seed + number, space=space, points_wanted=_POINTS_KEPT)


def _all_kept(count: int) -> tuple[Flags, NDArray[np.uint8]]:
    """Whether points are noise, and what they are: thin things, which count most."""
    return np.zeros(count, np.bool_), np.full(count, _CROWN, np.uint8)


def _as_delivered_elsewhere(
    xyz: NDArray[np.float64], random: Generator
) -> list[NDArray[np.float64]]:
    """A cloud as it is, thinned twice, and some small pieces of it."""
    clouds = [xyz]
    clouds += [xyz[random.random(xyz.shape[0]) < share] for share in _KEPT_SHARES]
    for _ in range(_KEPT_PIECES):
        away = np.abs(xyz[:, :2] - xyz[random.integers(xyz.shape[0]), :2]).max(axis=1)
        count = min(xyz.shape[0], int(10 ** random.uniform(2, 4)))
        clouds.append(xyz[np.argpartition(away, count - 1)[:count]])
    return [one for one in clouds if one.shape[0] >= _FEWEST_POINTS]
