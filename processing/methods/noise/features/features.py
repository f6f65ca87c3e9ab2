"""What is known about a point that may be noise, in numbers that don't depend on the scanner.

Sizes are taken relative to the spacing that the scanner should have there: the distance between
neighbouring beams at the point's range, or, where no beams are known, between the points around.

Sizes and limits here shape what the trees are told (see :mod:`processing.methods.noise.combined`):
they learned with these values, so that a change asks for new training. They were set by trial, on
simulated scenes; no measurement varied one alone.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor
from processing.methods.noise.beams.beam_kernels import (
    SQUARE,
    SURE,
    PointBeams,
    spacing_kernel,
    surface_kernel,
)
from processing.methods.noise.beams.window_kernels import (
    NEAR_FEATURES,
    WIDE_FEATURES,
    near_beams_kernel,
    wide_beams_kernel,
)
from processing.methods.noise.features.second_pass import FirstEstimate, suspicions_beside
from processing.methods.noise.features.surroundings import CloudNeighbourhood
from processing.methods.noise.neighbours.sharing import share_out

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

_ROWS_AT_ONCE = 64
_POINTS_AT_ONCE = 4_096
"""Rows and points of a share of a core's work: small enough to share evenly."""

_FLAT_BAND_M = 0.1
"""Height about the ground within which surfaces square to the beam are kept: narrow, since arcs of
noise stand square, too."""

_INTENSITY_SAMPLE = 20_000
"""Points whose median intensity stands for a range, and ten times as many for all ranges: the
median is then sure to a hundredth of their spread."""

_RANGE_BINS, _BINS_PER_DOUBLING, _LEAST_RANGE_M = 31, 3, 0.5
"""Bins of ranges for intensities: three for each doubling from 1 m up to 1 km; nearer ones share
the first."""

_LEAST_LENGTH_M = 1e-6
"""Keeps the direction of a beam of no length finite."""


@dataclass(frozen=True)
class Candidates:
    """The points that may be noise.

    Attributes
    ----------
    points : (k,) int64
        Indices into the cloud.
    features : (k, f) float32
    around : CloudNeighbourhood
        Of the whole cloud.
    levels : list of int
        At which parts of the cloud are looked at.
    beams, rows : PointBeams and (k,) int64, or None
        Where beams are known.
    """

    points: _Integers
    features: NDArray[np.float32]
    around: CloudNeighbourhood
    levels: list[int]
    beams: PointBeams | None = None
    rows: _Integers | None = None

    def seen_again(self, odds: _Floats, chosen: _Integers, monitor: Monitor) -> NDArray[np.float32]:
        """(c, g): features of chosen ones, with what was first said of all, (k,) log-odds."""
        judgement = FirstEstimate(self.around, self.points, odds)
        blocks = [self.features[chosen], judgement.features(chosen, self.levels, monitor)]
        if self.beams is not None and self.rows is not None:
            blocks.append(suspicions_beside(self.beams, self.rows, judgement, chosen, monitor))
        return np.concatenate(blocks, axis=1)


@dataclass(frozen=True)
class BeamSearch:
    """Points of a recording that no smooth surface explains, before anything dear is asked.

    Attributes
    ----------
    beams : PointBeams
    is_sure : (n,) bool
    around : CloudNeighbourhood
    points, rows : (k,) int64
        Points that may be noise, and their rows.
    """

    beams: PointBeams
    is_sure: NDArray[np.bool_]
    around: CloudNeighbourhood
    points: _Integers
    rows: _Integers

    def cheap_features(self, monitor: Monitor) -> NDArray[np.float32]:
        """(k, f): what the beams beside each met, what it hangs together with, its height."""
        found = np.empty((self.points.size, NEAR_FEATURES), np.float32)

        def look(start: int, stop: int) -> None:
            part = slice(start, stop)
            near_beams_kernel(
                self.beams, self.is_sure, self.points[part], self.rows[part], found[part]
            )

        share_out(look, self.points.size, _POINTS_AT_ONCE, monitor)
        positions = self.around.place_features(self.points)
        steepness = self._directions(self.points)[:, 2:].astype(np.float32)
        return np.concatenate([found, positions, steepness], axis=1)

    def candidates(
        self,
        cheap: NDArray[np.float32],
        is_doubtful: NDArray[np.bool_],
        intensity: NDArray[np.uint16],
        monitor: Monitor,
    ) -> Candidates:
        """Everything about those of the points that remain doubtful, (k,) bool.

        ``cheap`` (k, f) are the cheap features.
        """
        points, rows = self.points[is_doubtful], self.rows[is_doubtful]
        found = np.empty((points.size, WIDE_FEATURES), np.float32)

        def look(start: int, stop: int) -> None:
            part = slice(start, stop)
            wide_beams_kernel(self.beams, self.is_sure, points[part], rows[part], found[part])

        share_out(look, points.size, _POINTS_AT_ONCE, monitor)
        blocks = [
            self.around.scale_features(points, self._directions(points), monitor),
            self.around.part_features(points, self.around.link),
            cheap[is_doubtful],
            found,
            _light(self.beams.ranges, intensity, self.is_sure, points)[:, None],
        ]
        features = np.concatenate(blocks, axis=1)
        return Candidates(
            points, features, self.around, [self.around.link], beams=self.beams, rows=rows
        )

    def _directions(self, points: _Integers) -> _Floats:
        away = self.beams.xyz[points] - self.beams.origins[points]
        directions: _Floats = away / np.maximum(self.beams.ranges[points], _LEAST_LENGTH_M)[:, None]
        return directions


def search_with_beams(beams: PointBeams, monitor: Monitor) -> BeamSearch:
    """Set aside what a surface explains that goes on to all sides of a beam."""
    count, rows = beams.xyz.shape[0], beams.segments.size
    spacings, goes_on = np.zeros(count), np.zeros(count, np.uint8)

    def space(start: int, stop: int) -> None:
        spacing_kernel(beams, start, stop, spacings)

    def surfaces(start: int, stop: int) -> None:
        surface_kernel(beams, spacings, start, stop, goes_on)

    share_out(space, rows, _ROWS_AT_ONCE, monitor)
    known = spacings > 0
    middle = np.median(spacings[known] / beams.ranges[known]) if known.any() else beams.step_rad
    spacings[~known] = beams.ranges[~known] * max(middle, beams.step_rad)
    share_out(surfaces, rows, _ROWS_AT_ONCE, monitor)
    is_sure = goes_on == SURE
    around = CloudNeighbourhood.of(beams.xyz, spacings, is_sure)
    is_ground = (goes_on == SQUARE) & (np.abs(around.heights) < _FLAT_BAND_M)
    points = np.flatnonzero(~((is_sure | is_ground) & around.is_main))
    rows_of = np.searchsorted(beams.row_starts, points, "right") - 1
    return BeamSearch(beams, is_sure, around, points, rows_of)


def _light(
    ranges: _Floats,
    intensity: NDArray[np.uint16],
    is_sure: NDArray[np.bool_],
    points: _Integers,
) -> NDArray[np.float32]:
    """(k,) log2 of intensity over the median of sure points at about the same range."""
    sure = np.flatnonzero(is_sure)
    sure = sure[:: max(1, sure.size // (10 * _INTENSITY_SAMPLE))]
    bins, values = _range_bins(ranges[sure]), np.log2(intensity[sure].astype(np.float64) + 1)
    medians = np.full(_RANGE_BINS, np.nan)
    for number in np.unique(bins):
        medians[number] = np.median(values[bins == number][:_INTENSITY_SAMPLE])
    known = np.flatnonzero(~np.isnan(medians))
    if not known.size:
        return np.zeros(points.size, np.float32)
    medians = np.interp(np.arange(_RANGE_BINS), known, medians[known])
    mine = np.log2(intensity[points].astype(np.float64) + 1)
    light: NDArray[np.float32] = (mine - medians[_range_bins(ranges[points])]).astype(np.float32)
    return light


def _range_bins(ranges: _Floats) -> _Integers:
    doublings = np.log2(np.maximum(ranges, _LEAST_RANGE_M))
    bins: _Integers = np.clip(doublings * _BINS_PER_DOUBLING, 0, _RANGE_BINS - 1).astype(np.int64)
    return bins
