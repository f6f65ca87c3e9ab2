"""What the first estimate of the points around says about a point.

Noise comes in arcs, clouds and patches, and true things hang together: once every point has been
judged on its own, the judgement of its neighbours, of the part it belongs to and of the whole
cloud tells more than any further measure of the point itself.

References
----------
Tu and Bai, "Auto-context and its application to high-level vision tasks and 3D brain image
segmentation", 2010, for asking again with the first answer as a feature.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor
from processing.methods.noise.beams.beam_kernels import PointBeams
from processing.methods.noise.beams.window_kernels import SUSPICION_FEATURES, suspicion_kernel
from processing.methods.noise.features.connected import parts_of
from processing.methods.noise.features.surroundings import SCALES, CloudNeighbourhood
from processing.methods.noise.neighbours.sharing import share_out

_Rows = NDArray[np.float32]
_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

OPEN_ODDS = -4.0
"""Log-odds (2 % likely) below which nobody asks again; by trial, it only saves time."""

_MOST_ODDS = 8.0
"""Log-odds to which the first estimate is cut: more than 99.97 % says no more. The second trees
learned with it, as with the two below; by trial."""

_JOINING_SHARE = 0.3
"""Of a cell's points that must be noise, as far as is known, for it to join a suspicious part."""

_LEAST_SHARE = 1e-4
"""Keeps the logarithm of the cloud's share of noise finite: a point in ten thousand."""

_POINTS_AT_ONCE = 4_096
"""Points of a share of a core's work."""


@dataclass(frozen=True)
class FirstEstimate:
    """What the first trees said of a cloud's points.

    Attributes
    ----------
    around : CloudNeighbourhood
    points : (k,) int64
        Those that were judged; all others are held to be true.
    odds : (k,) float64
        Log-odds of being noise.
    """

    around: CloudNeighbourhood
    points: _Integers
    odds: _Floats

    def suspicions(self) -> _Floats:
        """(k,): how likely each of the judged points is noise, 0 to 1."""
        likely: _Floats = 1 / (1 + np.exp(-self.odds))
        return likely

    def features(self, chosen: _Integers, levels: list[int], monitor: Monitor) -> _Rows:
        """(c, …) of the chosen ones of the judged points, (c,) int64.

        The point's own odds, the share of noise in the cloud, around the point at `SCALES` sizes,
        in the parts it belongs to at each of ``levels``, and what the suspicious part looks like
        to which it belongs at the first of them.
        """
        around, points = self.around, self.points[chosen]
        suspicions = self.suspicions()
        blocks = [
            np.clip(self.odds[chosen], -_MOST_ODDS, _MOST_ODDS)[:, None],
            np.full(
                (chosen.size, 1), np.log2(_LEAST_SHARE + suspicions.sum() / around.position.size)
            ),
        ]
        totals = self._totals(suspicions)
        own = around.own_levels(points)
        for scale in range(SCALES):
            at = around.level_at(own, scale)
            means = np.empty((chosen.size, 1), np.float32)
            for level in np.unique(at):
                monitor.check()
                mine = np.flatnonzero(at == level)
                means[mine, 0] = around.means_around(int(level), points[mine], totals[level])
            blocks.append(means)
        for level in levels:
            parts = around.parts_at(level)
            sums = np.bincount(parts.numbers, weights=totals[level], minlength=parts.sizes.size)
            blocks.append((sums / parts.sizes)[parts.numbers[around.cells_of(level, points)], None])
        blocks.append(self._suspicious_parts(points, levels[0], totals[levels[0]]))
        return np.concatenate([one.astype(np.float32) for one in blocks], axis=1)

    def _totals(self, suspicions: _Floats) -> list[_Floats]:
        """The sum of suspicions in every cell, level by level."""
        around = self.around
        cells = around.cells_of(0, self.points)
        least = around.levels[0].codes.size
        totals: list[_Floats] = [np.bincount(cells, suspicions, least).astype(np.float64)]
        for numbers, level in zip(around.numbers[1:], around.levels[1:], strict=True):
            totals.append(np.bincount(numbers, totals[-1], level.codes.size).astype(np.float64))
        return totals

    def _suspicious_parts(self, points: _Integers, level: int, totals: _Floats) -> _Rows:
        """(c, PART_FEATURES) of the part of suspicious cells; zeros in a cell that isn't."""
        cells = self.around.levels[level]
        joins = totals > _JOINING_SHARE * cells.sums[:, 0]
        parts, mine = parts_of(cells, joins), self.around.cells_of(level, points)
        return np.where(joins[mine, None], parts.features[parts.numbers[mine]], np.float32(0))


def suspicions_beside(
    beams: PointBeams,
    rows: _Integers,
    judgement: FirstEstimate,
    chosen: _Integers,
    monitor: Monitor,
) -> _Rows:
    """(c, SUSPICION_FEATURES): how suspicious the pixels beside the chosen points are.

    ``rows`` (k,) are those of the judged points.
    """
    suspicions = np.zeros(beams.ranges.size, np.float32)
    suspicions[judgement.points] = judgement.suspicions()
    points, rows = judgement.points[chosen], rows[chosen]
    found = np.empty((points.size, SUSPICION_FEATURES), np.float32)

    def look(start: int, stop: int) -> None:
        part = slice(start, stop)
        suspicion_kernel(beams, suspicions, points[part], rows[part], found[part])

    share_out(look, points.size, _POINTS_AT_ONCE, monitor)
    return found
