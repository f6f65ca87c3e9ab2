"""Noise by everything a recording tells: beams, neighbours in the image, density, connection.

1. Points from which a surface goes on to all sides, and that hang together with most of the
   recording, are kept at once.
2. A few trees look at what costs little: what the beams beside a point met or, where none are
   known, how the nearest points lie, what it hangs together with, its height. They keep what next
   to nothing speaks against.
3. Every other point is described by numbers relative to the spacing that the scanner should have
   there (:mod:`processing.methods.noise.features.features`), and more trees weigh them.
4. What they say of the points around is asked together with the numbers once more
   (:mod:`processing.methods.noise.features.second_pass`): noise seldom comes alone, and true things
   hang together. Where beams are known, what they say is corrected by how much noise they see.
5. Where beams are known, a point without company is noise, too
   (:mod:`processing.methods.noise.beams.lone_points`), however little noise there is around.

All trees learned from recordings of the program's simulator with every kind of noise side by side,
and from real recordings as examples of what must be kept
(:mod:`processing.laboratory.noise_training`).
"""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor, SilentMonitor
from processing.methods.noise.beams.beam_kernels import PointBeams
from processing.methods.noise.beams.lone_points import lone_points
from processing.methods.noise.features.features import Candidates, search_with_beams
from processing.methods.noise.features.second_pass import OPEN_ODDS
from processing.methods.noise.features.space_search import search_in_space
from processing.methods.noise.neighbours.far_points import heights_of_far, is_far
from processing.methods.noise.noise_codes import HIGH_NOISE, codes_by_height
from processing.methods.noise.tree_files import read_trees
from processing.methods.noise.trees import Trees, log_odds
from resources import path_of

MODELS = "models/noise"
FIRST_LOOK, FIRST_LOOK_IN_SPACE = "first_look.onnx", "first_look_in_space.onnx"
WITH_BEAMS = "with_beams.onnx", "with_beams_again.onnx"
IN_SPACE = "in_space.onnx", "in_space_again.onnx"

OPEN_IN_SPACE = -1.0
"""Log-odds (27 % likely) from which the second look is asked where no beams are known: it may
confirm what the first held possible, and not find noise where it saw none, since it learned from
more, and grass and clods lie side by side, too. By trial."""

_FEWEST = 20
"""Points of a recording below which no row shows a surface; by trial."""

_FEWEST_IN_SPACE = 1_000
"""Points of a cloud below which they don't tell what is usual around them; by trial."""

_FEWEST_FOR_SHARE = 1_000
"""Points in doubt from which their share of noise is sure to some hundredths."""

_MOST_LIKELIER = 1.5
"""Log-odds; by recordings that nothing learned from (913 to 948): 2 finds a little more and loses
a third more of wires and poles, a fifth more of signs."""

_LEAST_STRICTNESS = 1e-6
"""Keeps the odds of a strictness of 0 or 1 finite."""


def noise_codes_with_beams(
    beams: PointBeams,
    intensity: NDArray[np.uint16],
    strictness: float = 0.5,
    *,
    monitor: Monitor | None = None,
) -> NDArray[np.uint8]:
    """Noise of a recording, or of a chunk of its rows, whose beams are known.

    Parameters
    ----------
    beams : PointBeams
    intensity : (n,) uint16
        Any scale; all the same where there is none.
    strictness : float
        0 to 1: the higher, the more is called noise. 0.5 calls noise what is likelier to be so.

    Returns
    -------
    (n,) uint8
        0 kept, 7 noise below the ground, 18 noise elsewhere.
    """
    monitor = monitor or SilentMonitor()
    codes = np.zeros(beams.xyz.shape[0], np.uint8)
    far = is_far(beams.xyz)
    if far.any():
        codes[far] = codes_by_height(heights_of_far(beams.xyz[far], beams.xyz[~far]))
        beams, intensity = _without(beams, far), intensity[~far]
    if beams.xyz.shape[0] >= _FEWEST:
        search = search_with_beams(beams, monitor)
        cheap = search.cheap_features(monitor)
        is_doubtful = log_odds(_trees(FIRST_LOOK), cheap, monitor) > 0
        candidates = search.candidates(cheap, is_doubtful, intensity, monitor)
        found = _codes(candidates, WITH_BEAMS, strictness, monitor)
        is_lone = lone_points(
            beams, search.around.spacings, search.points, search.rows, strictness, monitor=monitor
        )
        alone = search.points[is_lone]
        found[alone] = codes_by_height(search.around.heights[alone])
        codes[~far] = found
    return codes


def noise_codes_in_space(
    xyz: NDArray[np.float64], strictness: float = 0.5, *, monitor: Monitor | None = None
) -> NDArray[np.uint8]:
    """Noise of a cloud of which only positions are known.

    Parameters
    ----------
    xyz : (n, 3) float64
        m. Points that aren't finite are noise, as spikes are; of fewer than 1,000 others none.

    Returns
    -------
    (n,) uint8
        As :func:`noise_codes_with_beams`.
    """
    monitor = monitor or SilentMonitor()
    codes = np.full(xyz.shape[0], HIGH_NOISE, np.uint8)
    finite = np.flatnonzero(np.isfinite(xyz).all(axis=1))
    codes[finite] = 0
    far = is_far(xyz[finite])
    if far.any():
        spikes, others = finite[far], finite[~far]
        codes[spikes] = codes_by_height(heights_of_far(xyz[spikes], xyz[others]))
        finite = others
    if finite.size < _FEWEST_IN_SPACE or not np.ptp(xyz[finite], axis=0).any():
        return codes
    search = search_in_space(xyz[finite], monitor)
    cheap = search.cheap_features(monitor)
    is_doubtful = log_odds(_trees(FIRST_LOOK_IN_SPACE), cheap, monitor) > 0
    candidates = search.candidates(cheap, is_doubtful, monitor)
    found = _codes(candidates, IN_SPACE, strictness, monitor, OPEN_IN_SPACE)
    codes[finite[search.order]] = found
    return codes


def _codes(
    candidates: Candidates,
    models: tuple[str, str],
    strictness: float,
    monitor: Monitor,
    open_odds: float = OPEN_ODDS,
) -> NDArray[np.uint8]:
    """(n,) codes of all points that the candidates were taken from."""
    odds = log_odds(_trees(models[0]), candidates.features, monitor)
    is_open = np.flatnonzero(odds > open_odds)
    again = candidates.seen_again(odds, is_open, monitor)
    share = min(max(strictness, _LEAST_STRICTNESS), 1 - _LEAST_STRICTNESS)
    trees = _trees(models[1])
    asked_again = log_odds(trees, again, monitor)
    if candidates.beams is not None:
        asked_again += _likelier_by(asked_again, trees.base)
    is_noise = asked_again > np.log((1 - share) / share)
    noise, heights = candidates.points[is_open[is_noise]], candidates.around.heights
    codes = np.zeros(heights.size, np.uint8)
    codes[noise] = codes_by_height(heights[noise])
    return codes


def _likelier_by(odds: NDArray[np.float64], usual: float) -> float:
    """How much likelier noise is than where the trees learned, as log-odds.

    Notes
    -----
    One step of the estimate by Saerens and others (2002, Neural Computation 14, eq. 4): the share
    of noise that the trees tell, against the share among their examples (``usual``, log-odds).
    Further steps end at no noise at all where there is little: the trees aren't that sure. On
    streets by pulses the share is .005 to .08, and three of four true points are kept that the
    trees lost before. Where noise is frequent, odds rise by ``_MOST_LIKELIER`` at most.
    """
    if odds.size < _FEWEST_FOR_SHARE:
        return 0.0
    share = float(np.mean(1.0 / (1.0 + np.exp(-odds))))
    return min(float(np.log(share / (1.0 - share))) - usual, _MOST_LIKELIER)


def _without(beams: PointBeams, left_out: NDArray[np.bool_]) -> PointBeams:
    kept = ~left_out
    before = np.concatenate([[0], np.cumsum(kept)])
    return beams._replace(
        xyz=beams.xyz[kept],
        origins=beams.origins[kept],
        ranges=beams.ranges[kept],
        columns=beams.columns[kept],
        row_starts=before[beams.row_starts],
    )


@cache
def _trees(name: str) -> Trees:
    return read_trees(path_of(f"{MODELS}/{name}"))
