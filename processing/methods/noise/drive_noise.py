"""The noise of a whole drive, by each of the methods, with bounded memory.

Neighbours in space may have been measured minutes apart: the two methods of the study read the
drive by tiles of space. The combined one follows the recording where its beams are known.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from itertools import count
from pathlib import Path
from threading import Lock

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor, PartMonitor
from processing.image.images_of_drives import image_of
from processing.methods.noise.beams.beam_kernels import PointBeams
from processing.methods.noise.beams.beam_origins import beam_origins
from processing.methods.noise.beams.beams_of_drives import along_rows, beams_of
from processing.methods.noise.beams.standing_scans import StandingScan, standing_scan_of
from processing.methods.noise.combined import noise_codes_in_space, noise_codes_with_beams
from processing.methods.noise.features.ground_heights import ground_below
from processing.methods.noise.neighbours.sharing import share_out
from processing.methods.noise.noise_codes import part_noise_by_ground
from processing.methods.noise.row_chunks import POINTS, row_chunks_of
from processing.methods.noise.tiles_of_space import TiledCloud
from processing.methods.noise.whole_clouds import (
    radius_outliers_by_parts,
    statistical_outliers_by_parts,
)
from processing.recording.drive import Drive

_TILE_M = 1.0
"""Side of a tile: wider than the radius of the study (0.5 m), so that a point's neighbours lie in
nine tiles."""

_SORTING, _FINDING = 0.1, 0.9
"""Of the progress bar: when points are in tiles, and when outliers are found."""

_REACH_SPACINGS = 40.0
_LEAST_REACH_M, _MOST_REACH_M = 1.0, 10.0
"""What a part of a cloud sees around it where no beams are known: the widest cells that features
are taken from (16 spacings, with the cells beside them 48), within limits. By trial."""

_POINTS_IN_SPACE = 2_000_000
"""Points of such a part, of which a core takes one at a time: what is usual in a cloud is told by
the part. With half as many, three times as much of a simulated street was called noise."""


_STEEP, _MOST_STEEP, _GROUND_CELL_M, _SAMPLE = 0.1, 0.04, 1.0, 400_000
"""The trees with beams learned on streets: where more than this share of the points on the ground
around a tripod lies on slopes of more than 1 : 10, in cells of a metre, places alone judge, which
learned on banks, too. Of a simulated street 0.3 % does, of scans of a real street 2.4 %, of sites
with banks 6 to 94 %: there the trees with beams take 1 to 4 % of the true ground, which lies in
narrow strips behind crests."""


@dataclass(frozen=True)
class _BeamRows:
    """Rows of beams: where each begins, how far the scanner had come, and the beams of some."""

    starts: NDArray[np.int64]
    along_m: NDArray[np.float64]
    beams_of: Callable[[range], tuple[PointBeams, slice | NDArray[np.int64]]]


@dataclass(frozen=True)
class NoiseSearch:
    """A drive whose noise is looked for.

    Attributes
    ----------
    drive : Drive
    codes : (n,) uint8
        Zero; gets 7 for noise below the ground, 18 for noise elsewhere.
    scratch : Path
        A folder for files meanwhile; the caller deletes it.
    points_at_once : int
        What the methods of the study hold in memory at a time.
    points_per_chunk : int
        The combined method's own; its results near the cuts depend a little on it.
    """

    drive: Drive
    codes: NDArray[np.uint8]
    scratch: Path
    points_at_once: int
    points_per_chunk: int = POINTS

    def by_radius(self, radius_m: float, neighbours: int, monitor: Monitor) -> None:
        """Radius outlier removal."""
        cloud = self._tiled(monitor)
        radius_outliers_by_parts(
            cloud,
            self.codes,
            radius_m,
            neighbours,
            monitor=PartMonitor(monitor, _SORTING, _FINDING),
            points_per_part=self.points_at_once,
        )
        self._tell_low_from_high(cloud, monitor)

    def by_statistics(self, neighbours: int, deviations: float, monitor: Monitor) -> None:
        """Statistical outlier removal."""
        cloud = self._tiled(monitor)
        statistical_outliers_by_parts(
            cloud,
            self.codes,
            neighbours,
            deviations,
            scratch=self.scratch,
            monitor=PartMonitor(monitor, _SORTING, _FINDING),
            points_per_part=self.points_at_once,
        )
        self._tell_low_from_high(cloud, monitor)

    def combined(self, strictness: float, monitor: Monitor) -> None:
        """By everything that is known; see :mod:`processing.methods.noise.combined`."""
        drive = self.drive
        origins = beam_origins(drive)
        if origins is not None:
            image = image_of(drive, drive.pixel_kind)
            along = along_rows(origins, image.row_starts)
            beams_in = partial(beams_of, drive, image, origins=origins)
            self._combined_with_beams(
                _BeamRows(image.row_starts, along, beams_in), strictness, monitor
            )
            return
        scan = standing_scan_of(drive, self.scratch, monitor)
        if scan is None or not _stands_on_level_ground(scan):
            self._combined_in_space(strictness, monitor)
            return
        stood = np.zeros(scan.segments.size)
        self._combined_with_beams(
            _BeamRows(scan.row_starts, stood, scan.beams_of), strictness, monitor
        )

    def _combined_with_beams(self, rows: _BeamRows, strictness: float, monitor: Monitor) -> None:
        drive, starts = self.drive, rows.starts
        chunks = list(row_chunks_of(starts, rows.along_m, self.points_per_chunk))
        reporting, ended = Lock(), count(1)

        def look(number: int, _: int) -> None:
            chunk = chunks[number]
            drive.columns.give_back()
            beams, points = rows.beams_of(chunk.with_overlap)
            intensity = np.asarray(drive.columns["intensity"][points])
            codes = noise_codes_with_beams(beams, intensity, strictness, monitor=monitor)
            first, end = int(starts[chunk.rows.start]), int(starts[chunk.rows.stop])
            skipped = first - int(starts[chunk.with_overlap.start])
            owned = slice(skipped, skipped + end - first)
            into = slice(first, end) if isinstance(points, slice) else points[owned]
            self.codes[into] = codes[owned]
            with reporting:
                monitor.report(next(ended) / len(chunks))

        share_out(look, len(chunks), 1, monitor)

    def _combined_in_space(self, strictness: float, monitor: Monitor) -> None:
        cloud = self._tiled(monitor)
        reach = min(max(_REACH_SPACINGS * cloud.spacing_m, _LEAST_REACH_M), _MOST_REACH_M)
        rest = PartMonitor(monitor, _SORTING, 1.0)
        tiles = list(cloud.tiles_of_parts(reach, _POINTS_IN_SPACE))
        reporting, ended = Lock(), count(1)

        def look(number: int, _: int) -> None:
            part = cloud.part(tiles[number], reach)
            xyz = np.concatenate([cloud.read(part.own), cloud.read(part.around)])
            codes = noise_codes_in_space(xyz, strictness, monitor=rest)
            self.codes[part.own] = codes[: part.own.size]
            with reporting:
                rest.report(next(ended) / len(tiles))

        share_out(look, len(tiles), 1, rest)

    def _tiled(self, monitor: Monitor) -> TiledCloud:
        drive = self.drive

        def read(points: NDArray[np.int64] | slice) -> NDArray[np.float64]:
            drive.columns.give_back()
            return drive.xyz(points)

        sorting = PartMonitor(monitor, 0.0, _SORTING)
        return TiledCloud(read, drive.count, self.scratch / "order", _TILE_M, monitor=sorting)

    def _tell_low_from_high(self, cloud: TiledCloud, monitor: Monitor) -> None:
        monitor.report(_FINDING)
        part_noise_by_ground(
            cloud, self.codes, monitor=monitor, points_per_part=self.points_at_once
        )


def _stands_on_level_ground(scan: StandingScan) -> bool:
    points = np.asarray(scan.order[:: max(1, scan.order.size // _SAMPLE)])
    xyz = scan.drive.xyz(points) - scan.position
    ground = ground_below(xyz, np.ones(points.size, np.bool_), _GROUND_CELL_M)
    on_it = np.abs(ground.heights) < _GROUND_CELL_M / 2
    slopes = ground.slopes.ravel()[ground.cells[on_it]]
    return not slopes.size or float((slopes > _STEEP).mean()) <= _MOST_STEEP
