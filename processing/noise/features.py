"""What is known about a point that may be noise, in numbers that don't depend on the scanner.

Sizes are taken relative to the spacing that the scanner should have there: the distance between
neighbouring beams at the point's range, or, where no beams are known, between the points around.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from processing.monitor import Monitor
from processing.noise.beam_kernels import (
    BEAM_FEATURES,
    SQUARE,
    SURE,
    Beams,
    beam_features_kernel,
    spacing_kernel,
    surface_kernel,
)
from processing.noise.cell_levels import AROUND, CellLevel, around_kernel, cell_levels
from processing.noise.connected import connected_counts
from processing.noise.ground_heights import heights_above_ground
from processing.noise.local_spacing import local_spacings
from processing.noise.morton import NestedCells, nested_cells
from processing.noise.sharing import shared_out

_Floats = NDArray[np.float64]

SCALES = 5
PER_SCALE = 8
LEVELS = 12
SPACE_FEATURES = SCALES * PER_SCALE + 7
_FINEST_M = 0.02
_ROWS_AT_ONCE = 64
_CELLS_AT_ONCE = 4_096
_MAIN_SHARE = 0.1
_GROUND_BAND_M = 0.3
_FLAT_BAND_M = 0.1
_PLANE_POINTS = 24
_PLANE_SHARE = 0.4
_PLANE_THICKNESS = 0.12  # in cells of two spacings


@dataclass(frozen=True)
class Candidates:
    """The points that may be noise.

    Attributes
    ----------
    points : (k,) int64
        Indices into the cloud.
    features : (k, f) float32
    heights : (n,) float64
        m above the local ground, of every point; NaN where none is known.
    """

    points: NDArray[np.int64]
    features: NDArray[np.float32]
    heights: _Floats


def candidates_with_beams(
    beams: Beams, intensity: NDArray[np.uint16], monitor: Monitor
) -> Candidates:
    """Candidates of a recording whose beams are known."""
    count = beams.xyz.shape[0]
    spacings, goes_on = np.zeros(count), np.zeros(count, np.uint8)
    rows = beams.segments.size

    def space(start: int, stop: int) -> None:
        spacing_kernel(beams, start, stop, spacings)

    def surfaces(start: int, stop: int) -> None:
        surface_kernel(beams, spacings, start, stop, goes_on)

    shared_out(space, rows, _ROWS_AT_ONCE, monitor)
    known = spacings > 0
    middle = np.median(spacings[known] / beams.ranges[known]) if known.any() else beams.turn
    spacings[~known] = beams.ranges[~known] * max(middle, beams.turn)
    shared_out(surfaces, rows, _ROWS_AT_ONCE, monitor)
    is_sure = goes_on == SURE
    cloud = _Cloud.of(beams.xyz, spacings, is_sure)
    is_ground = (goes_on == SQUARE) & (np.abs(cloud.heights) < _FLAT_BAND_M)
    points = np.flatnonzero(~((is_sure | is_ground) & cloud.is_main))
    row_of_point = np.repeat(np.arange(rows), np.diff(beams.row_starts))
    found = np.empty((points.size, BEAM_FEATURES))
    rows_of = row_of_point[points]

    def look(start: int, stop: int) -> None:
        part = slice(start, stop)
        beam_features_kernel(beams, is_sure, points[part], rows_of[part], found[part])

    shared_out(look, points.size, _CELLS_AT_ONCE, monitor)
    away = beams.xyz[points] - beams.origins[points]
    ways = away / np.maximum(beams.ranges[points], 1e-6)[:, None]
    space_features = cloud.features(points, ways, monitor)
    light = _light(beams.ranges, intensity, is_sure, points)
    features = np.column_stack([space_features, found, light]).astype(np.float32)
    return Candidates(points, features, cloud.heights)


def candidates_in_space(xyz: _Floats, monitor: Monitor) -> Candidates:
    """Candidates of a cloud of which only places are known.

    Parameters
    ----------
    xyz : (n, 3) float64
        m, finite.
    """
    fine = nested_cells(xyz, float(np.ptp(xyz, axis=0).max(initial=0.0)) / 2**20)
    spacings = np.empty(xyz.shape[0])
    spacings[fine.order] = np.clip(local_spacings(fine), _FINEST_M, None)
    is_sure = _planar_points(xyz, spacings, monitor)
    cloud = _Cloud.of(xyz, spacings, is_sure)
    is_ground = np.abs(cloud.heights) < _GROUND_BAND_M
    points = np.flatnonzero(~(is_sure & cloud.is_main & is_ground))
    features = cloud.features(points, None, monitor).astype(np.float32)
    return Candidates(points, features, cloud.heights)


def _planar_points(xyz: _Floats, spacings: _Floats, monitor: Monitor) -> NDArray[np.bool_]:
    """Points in the middle of a densely measured plane, eight spacings wide."""
    count = xyz.shape[0]
    bare = _Cloud.bare(xyz, spacings, np.zeros(count, np.bool_))
    found = np.zeros(count, np.bool_)
    wanted = np.clip(
        np.rint(np.log2(spacings / bare.cells.cell_m)).astype(np.int64) + 1, 0, LEVELS - 1
    )
    for level in np.unique(wanted):
        chosen = np.flatnonzero(wanted == level)
        around = bare.around(int(level), bare.place[chosen], None, monitor)
        found[chosen] = (
            (around[:, 0] > np.log2(1 + _PLANE_POINTS))
            & (around[:, 3] > _PLANE_SHARE)
            & (around[:, 4] < _PLANE_THICKNESS)
            & (around[:, 5] < 2 * _PLANE_THICKNESS)
        )
    return found


def _light(
    ranges: _Floats,
    intensity: NDArray[np.uint16],
    is_sure: NDArray[np.bool_],
    points: NDArray[np.int64],
) -> _Floats:
    """(k,) log2 of intensity over the median of sure points at about the same range."""
    bins = np.clip(np.log2(np.maximum(ranges, 0.5)) * 3, 0, 30).astype(np.int64)
    values = np.log2(intensity.astype(np.float64) + 1)
    medians = np.full(31, np.nan)
    for number in np.unique(bins[is_sure]):
        medians[number] = np.median(values[is_sure & (bins == number)][:20_000])
    known = np.flatnonzero(~np.isnan(medians))
    if not known.size:
        return np.zeros(points.size)
    medians = np.interp(np.arange(31), known, medians[known])
    light: _Floats = values[points] - medians[bins[points]]
    return light


@dataclass(frozen=True)
class _Cloud:
    cells: NestedCells
    place: NDArray[np.int64]  # of every point along the curve
    spacings: _Floats
    levels: list[CellLevel]
    connected: _Floats
    is_main: NDArray[np.bool_]
    heights: _Floats

    @classmethod
    def bare(cls, xyz: _Floats, spacings: _Floats, is_sure: NDArray[np.bool_]) -> _Cloud:
        """Without what hangs together and without heights."""
        finest = max(_FINEST_M, float(np.percentile(spacings, 2))) / 2
        cells = nested_cells(xyz, finest)
        place = np.empty(cells.order.size, np.int64)
        place[cells.order] = np.arange(cells.order.size)
        levels = cell_levels(cells, is_sure[cells.order], LEVELS)
        none = np.zeros(0)
        return cls(cells, place, spacings, levels, none, none.astype(bool), none)

    @classmethod
    def of(cls, xyz: _Floats, spacings: _Floats, is_sure: NDArray[np.bool_]) -> _Cloud:
        """With everything."""
        bare = cls.bare(xyz, spacings, is_sure)
        link = max(0.4, 3 * float(np.median(spacings)))
        connected = np.column_stack(
            [connected_counts(xyz, is_sure, link), connected_counts(xyz, is_sure, 3 * link)]
        )
        is_main = connected[:, 0] >= _MAIN_SHARE * max(1, int(is_sure.sum()))
        heights = heights_above_ground(xyz, is_sure, max(1.0, 4 * float(np.median(spacings))))
        return replace(bare, connected=connected, is_main=is_main, heights=heights)

    def features(
        self, points: NDArray[np.int64], ways: _Floats | None, monitor: Monitor
    ) -> _Floats:
        """(k, SPACE_FEATURES) features of chosen points; ``ways`` (k, 3) are their beams."""
        found = np.zeros((points.size, SPACE_FEATURES))
        wanted = np.rint(np.log2(self.spacings[points] / self.cells.cell_m)).astype(np.int64)
        place = self.place[points]
        for level in range(LEVELS):
            for scale in range(SCALES):
                chosen = np.flatnonzero(np.clip(wanted + scale, 0, LEVELS - 1) == level)
                if chosen.size:
                    block = slice(scale * PER_SCALE, (scale + 1) * PER_SCALE)
                    found[chosen, block] = self.around(
                        level, place[chosen], None if ways is None else ways[chosen], monitor
                    )
        rest = SCALES * PER_SCALE
        found[:, rest] = np.log2(self.spacings[points])
        found[:, rest + 1 : rest + 3] = np.log2(1 + self.connected[points])
        height = np.nan_to_num(self.heights[points])  # 0 where no ground is known
        found[:, rest + 3] = np.sign(height) * np.log2(1 + np.abs(height) / 0.05)
        if ways is not None:
            found[:, rest + 4] = ways[:, 2]
        return found

    def around(
        self, level: int, place: NDArray[np.int64], ways: _Floats | None, monitor: Monitor
    ) -> _Floats:
        cells = self.levels[level]
        along = np.argsort(place)
        mine_codes = self.cells.codes[place[along]] >> (3 * level)
        is_first = np.r_[True, mine_codes[1:] != mine_codes[:-1]]
        codes = mine_codes[is_first]
        back = np.empty(place.size, np.int64)
        back[along] = np.cumsum(is_first) - 1
        around = np.empty((codes.size, AROUND))

        def add_up(start: int, stop: int) -> None:
            around_kernel(cells, codes[start:stop], around[start:stop])

        shared_out(add_up, codes.size, _CELLS_AT_ONCE, monitor)
        mine = around[back]
        normals = mine[:, 5:8]
        found = np.empty((place.size, PER_SCALE))
        found[:, 0:2] = np.log2(1 + mine[:, 0:2])
        found[:, 2:5] = mine[:, 2:5]
        offsets = (normals * self.cells.local_xyz[place]).sum(axis=1) - mine[:, 8]
        found[:, 5] = np.abs(offsets) / cells.side
        found[:, 6] = np.abs(normals[:, 2])
        found[:, 7] = 0.0 if ways is None else np.abs((normals * ways).sum(axis=1))
        return found
