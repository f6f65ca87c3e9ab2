"""Benchmarks of earthwork: a volume over a hectare, two networks of triangles, a changed view."""

from __future__ import annotations

import math
import statistics
import tempfile
from pathlib import Path

import numpy as np
from contourpy import contour_generator

from processing.core.arrays import Floats
from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.laboratory.bench import volume_site
from processing.laboratory.bench.case import BenchmarkOptions, Measurement
from processing.laboratory.bench.cases.road_run import StageWatch
from processing.laboratory.bench.timing import alternating, median_seconds, seconds_of
from processing.methods.earthwork.geometry.triangle_surface import TriangleSurface
from processing.methods.earthwork.geometry.volume_scope import VolumeScope
from processing.methods.earthwork.maps.contours import ContourOptions, contour_lines
from processing.methods.earthwork.maps.heat_map import change_colours
from processing.methods.earthwork.surfaces.epoch_ground import ground_of_drives
from processing.methods.earthwork.volumes.comparison import compare
from processing.methods.earthwork.volumes.tin_volume import volume_between
from processing.methods.earthwork.volumes.volume_parameters import VolumeParameters
from processing.methods.earthwork.volumes.volume_result import VolumeResult
from processing.methods.ground.drive_points import DrivePoints
from processing.methods.ground.filters.cells import CellGrid
from processing.methods.ground.ground_columns import GROUND
from processing.recording.drive import Drive

_POINTS = 5_000_000
_GRID_M, _MOST_S = 0.1, 3.0
_TRIANGLES, _MOST_TIN_S = 200_000, 5.0
_CELLS, _MOST_VIEW_S = 1_000_000, 1.0
_INTERVAL_M = 0.1
_REPEATS = 3


def measure_volume(options: BenchmarkOptions) -> tuple[Measurement, ...]:
    """A volume of two epochs, from opened drives to its result, with the time of each stage.

    Beside it numpy sums the same ground points into the same cells and subtracts their means:
    what the least of volumes costs, without holes, registration or uncertainty.
    """
    points = options.limited(_POINTS)
    with tempfile.TemporaryDirectory(prefix="zuka-bench-") as name:
        before, after = (
            volume_site.scanned_drives(Path(name), points, is_later=is_later)
            for is_later in (False, True)
        )
        _volume(before, after, StageWatch())
        watches = []
        for _ in range(options.repeats(_REPEATS)):
            watch = StageWatch()
            result = _volume(before, after, watch)
            watch.close()
            watches.append(watch)
        floor_s = _plain_seconds(before, after)
    watch = sorted(watches, key=lambda one: sum(one.seconds.values()))[len(watches) // 2]
    seconds = sum(watch.seconds.values())
    stages = ", ".join(f"{stage} {spent:.2f} s" for stage, spent in watch.seconds.items())
    true_cut, true_fill = volume_site.true_volumes()
    volumes = result.volumes
    count = sum(drive.count for drive in (*before, *after))
    return (
        Measurement(
            "volume",
            Text(
                "Volume of two epochs over a hectare at a mesh of 0.1 m, {count} points",
                "1ヘクタールの2時期の土量（格子0.1m、{count}点）",
            ).filled(count=f"{count:,}"),
            seconds,
            "s",
            _MOST_S,
            is_at_most=True,
            detail=(
                f"{stages}; numpy alone sums the ground points in memory in {floor_s:.2f} s; "
                f"cut {volumes.cut_m3:.1f} of {true_cut:.1f} m³, "
                f"fill {volumes.fill_m3:.1f} of {true_fill:.1f} m³"
            ),
            figures={"points": count, "zuka_s": seconds, "numpy_s": floor_s} | dict(watch.seconds),
        ),
    )


def _volume(before: tuple[Drive, ...], after: tuple[Drive, ...], watch: StageWatch) -> VolumeResult:
    sides = [ground_of_drives(drives, SilentMonitor()) for drives in (before, after)]
    options = VolumeParameters(grid_m=_GRID_M)
    return compare(sides[0], sides[1], options, watch, VolumeScope(volume_site.boundary()))


def _plain_seconds(before: tuple[Drive, ...], after: tuple[Drive, ...]) -> float:
    epochs = [_ground_in_memory(drives) for drives in (before, after)]
    across = math.ceil(volume_site.SIDE_M / _GRID_M)

    def change() -> float:
        means = []
        for xyz in epochs:
            cells = (xyz[:, :2] / _GRID_M).astype(np.int64)
            numbers = cells[:, 1] * across + cells[:, 0]
            counts = np.bincount(numbers, minlength=across**2)
            sums = np.bincount(numbers, xyz[:, 2], across**2)
            means.append(np.divide(sums, counts, out=np.full(across**2, np.nan), where=counts > 0))
        return float(np.nansum(means[1] - means[0])) * _GRID_M**2

    return median_seconds(change, _REPEATS)


def _ground_in_memory(drives: tuple[Drive, ...]) -> Floats:
    points = DrivePoints(drives, _POINTS, SilentMonitor())
    found = [points.xyz(chunk)[points.codes(chunk) == GROUND] for chunk in points.chunks]
    xyz: Floats = np.concatenate(found) - volume_site.CORNER
    # A coordinate is rounded to millimetres: it may lie on the very edge.
    return xyz[((xyz[:, :2] >= 0) & (xyz[:, :2] < volume_site.SIDE_M)).all(axis=1)]


def measure_volume_tin(options: BenchmarkOptions) -> tuple[Measurement, ...]:
    """Two networks of triangles that share no corner, exactly; beside it Open3D casts rays.

    Rays upright through the middles of cells of 0.1 m at both networks give a volume too, though
    no exact one; building its trees is counted, as building ours is.
    """
    wanted = options.limited(_TRIANGLES)
    before, after = (
        _network(wanted, seed=seed, is_later=is_later) for seed, is_later in ((1, False), (2, True))
    )
    volumes = []
    ours, rays = alternating(
        [
            lambda: volumes.append(volume_between(before, after, SilentMonitor())),
            lambda: _cast_volume(before, after),
        ],
        options.repeats(_REPEATS),
    )
    found, count = volumes[0], len(before.corners)
    return (
        Measurement(
            "volume-tin",
            Text(
                "Exact volume between two networks of {count} triangles each",
                "三角形{count}枚どうしのTIN対TIN（厳密解）",
            ).filled(count=f"{count:,}"),
            ours,
            "s",
            _MOST_TIN_S,
            is_at_most=True,
            detail=(
                f"cut {found.cut_m3:.2f} m³, fill {found.fill_m3:.2f} m³; Open3D casts rays every "
                f"0.1 m at both in {rays:.2f} s, {rays / ours:.2f} times as long"
            ),
            figures={"triangles": count, "zuka_s": ours, "open3d_s": rays},
        ),
    )


def _network(triangles: int, *, seed: int, is_later: bool) -> TriangleSurface:
    """So many triangles, two to a square, whose corners are moved by chance."""
    side = max(2, math.ceil(math.sqrt(triangles / 2)))
    random = np.random.default_rng(seed)
    at = np.linspace(0.0, volume_site.SIDE_M, side + 1)
    xy = np.stack(np.meshgrid(at, at), axis=-1)
    # What stays within a quarter of a square can't fold.
    step = volume_site.SIDE_M / side
    xy[1:-1, 1:-1] += random.uniform(-0.2, 0.2, (side - 1, side - 1, 2)) * step
    xy = xy.reshape(-1, 2)
    xyz = np.column_stack([xy, volume_site.ground_height(xy, is_later=is_later)])
    first = (np.arange(side)[:, None] * (side + 1) + np.arange(side)).ravel()
    lower = np.column_stack([first, first + 1, first + side + 2])
    upper = np.column_stack([first, first + side + 2, first + side + 1])
    return TriangleSurface(xyz + volume_site.CORNER, np.concatenate([lower, upper]))


def _cast_volume(before: TriangleSurface, after: TriangleSurface) -> float:
    import open3d

    middles = np.arange(_GRID_M / 2, volume_site.SIDE_M, _GRID_M)
    rays = np.zeros((middles.size**2, 6), np.float32)
    rays[:, 0], rays[:, 1] = np.tile(middles, middles.size), np.repeat(middles, middles.size)
    rays[:, 2], rays[:, 5] = volume_site.SIDE_M, -1.0
    heights, tensor = [], open3d.core.Tensor.from_numpy
    for surface in (before, after):
        scene = open3d.t.geometry.RaycastingScene()
        local = (surface.xyz - volume_site.CORNER).astype(np.float32)
        corners = surface.corners.astype(np.uint32)
        scene.add_triangles(tensor(local), tensor(corners))
        heights.append(-scene.cast_rays(tensor(rays))["t_hit"].numpy())
    change = heights[1] - heights[0]
    return float(change[np.isfinite(change)].sum()) * _GRID_M**2


def measure_volume_view(options: BenchmarkOptions) -> tuple[Measurement, ...]:
    """Colours for another limit and contours of another interval, on one map of change.

    Beside it contourpy alone finds the lines of the same levels.
    """
    side = max(10, round(math.sqrt(options.limited(_CELLS))))
    size_m = volume_site.SIDE_M / side
    middles = (np.arange(side) + 0.5) * size_m
    xy = np.column_stack([np.tile(middles, side), np.repeat(middles, side)])
    noise = np.random.default_rng(3).normal(0, 0.003, (side, side))
    later, earlier = (
        volume_site.ground_height(xy, is_later=is_later).reshape(side, side)
        for is_later in (True, False)
    )
    grid = CellGrid(volume_site.CORNER, size_m, side, side)
    ground = (later + noise).astype(np.float32)
    change = ground - earlier.astype(np.float32)
    levels = np.arange(math.ceil(ground.min() / _INTERVAL_M), ground.max() / _INTERVAL_M)
    lines = ContourOptions(_INTERVAL_M, simplify_m=size_m / 4, shortest_m=1.0)

    def plain() -> None:
        generator = contour_generator(middles, middles, ground)
        for level in levels:
            generator.lines(level * _INTERVAL_M)

    colours = [
        seconds_of(lambda: change_colours(change, 0.5))
        for _ in range(options.repeats(_REPEATS) + 1)
    ]
    ours, bare = alternating(
        [lambda: contour_lines(grid, ground, lines, SilentMonitor()), plain],
        options.repeats(_REPEATS),
    )
    colours_s = statistics.median(colours[1:])
    return (
        Measurement(
            "volume-view",
            Text(
                "Another limit of colours and interval of contours on a map of {count} cells",
                "{count}格子の図の色の範囲と等高線間隔の変更",
            ).filled(count=f"{side * side:,}"),
            colours_s + ours,
            "s",
            _MOST_VIEW_S,
            is_at_most=True,
            detail=(
                f"colours {colours_s:.3f} s, contours at {len(levels)} levels {ours:.2f} s; "
                f"contourpy alone {bare:.2f} s"
            ),
            figures={
                "cells": side * side,
                "colours_s": colours_s,
                "contours_s": ours,
                "contourpy_s": bare,
            },
        ),
    )
