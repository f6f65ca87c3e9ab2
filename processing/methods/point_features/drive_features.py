"""The chosen features of every point of a drive.

What lies around points is computed a part of space at a time, whenever a neighbour was measured;
scan lines and the trajectory a stretch of the recording at a time. Nothing the size of the drive is
held but the columns, which are files.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Flags, Floats, Integers
from processing.core.monitor import Monitor, PartMonitor
from processing.core.text import Text
from processing.methods.noise.neighbours.sharing import share_out
from processing.methods.noise.tiles_of_space import TiledCloud
from processing.methods.point_features.ball_kernels import (
    DISC,
    SPHERE,
    discs_kernel,
    spheres_kernel,
)
from processing.methods.point_features.best_radius import (
    BEST_FEATURES,
    FARTHEST_M,
    best_neighbours,
)
from processing.methods.point_features.cell_features import CELL_M, cell_features
from processing.methods.point_features.path_features import has_path, path_features
from processing.methods.point_features.point_tree import PointTree, point_tree
from processing.methods.point_features.scan_line_features import has_scan_lines, scan_line_features
from processing.recording.columns.point_features import (
    BEST,
    POINT_FEATURES,
    SCALES_M,
    SPHERE_FEATURES,
)
from processing.recording.drive import Drive

_TILE_M = 4.0
"""Side of a tile of space: about the largest radius."""

_POINTS_AT_ONCE = 256
"""Points of a share of a core's work: up to 50 ms."""

_MEAN_HEIGHT = [name for name, *_ in SPHERE_FEATURES].index("mean_height")

_PATH, _LINE = 0.05, 0.05
"""Shares of the work: of the trajectory, and of scan lines."""

_NO_LINES = Text(
    "scan-line length and curvature need the order of a scanner's lines",
    "スキャンライン長と曲率にはスキャンラインの並びが必要です",
)
_NO_PATH = Text(
    "height over the trajectory and distance from it need a trajectory with the points' times",
    "軌跡相対高さと軌跡相対距離には、走行軌跡と点の時刻が必要です",
)

Columns = Mapping[str, NDArray[np.float32]]


@dataclass(frozen=True)
class _Around:
    """The points of a part of space, those asked for first.

    Attributes
    ----------
    points : (k,) int64
        The numbers of those asked for, in the drive.
    xyz : (n, 3) float64
        m, project CRS: of these, and of those around.
    """

    points: Integers
    xyz: Floats

    @property
    def own(self) -> int:
        return self.points.size

    @property
    def origin(self) -> Floats:
        """The middle, about which sums of squares keep their last digits."""
        middle: Floats = self.xyz.mean(axis=0)
        return middle


def computable_features(drive: Drive, wanted: Sequence[str]) -> tuple[tuple[str, ...], Text]:
    """Those of some features that a drive has what they need for, and what the others lack.

    Parameters
    ----------
    wanted : sequence of str
        Keys of `POINT_FEATURES`.

    Returns
    -------
    tuple of (tuple of str, Text)
        The text is empty where none is left out.
    """
    lacks = {"line": not has_scan_lines(drive), "path": not has_path(drive)}
    left = {POINT_FEATURES[name].group for name in wanted}
    reasons = [why for group, why in (("line", _NO_LINES), ("path", _NO_PATH))
               if lacks[group] and group in left]  # fmt: skip
    kept = tuple(name for name in wanted if not lacks.get(POINT_FEATURES[name].group, False))
    why = Text("; ".join(one.en for one in reasons), "、".join(one.ja for one in reasons))
    return kept, why


def drive_features(
    drive: Drive,
    columns: Columns,
    scratch: Path,
    monitor: Monitor,
    *,
    wanted: NDArray[np.bool_] | None = None,
) -> None:
    """Compute features of every point; those that :func:`computable_features` gives.

    Parameters
    ----------
    columns : mapping of str to (n,) float32
        Get the values by name; points without a coordinate keep what is there.
    scratch : Path
        A folder for files meanwhile; the caller deletes it.
    wanted : (n,) bool, optional
        Other points needn't have features in space; they count as neighbours.

    Raises
    ------
    NoSpace, Cancelled
    """
    groups: dict[str, list[str]] = {}
    for name in columns:
        groups.setdefault(POINT_FEATURES[name].group, []).append(name)
    if "line" in groups:
        both = _pair(drive, columns, ("scan_line_length", "scan_line_curvature"), scratch)
        scan_line_features(drive, both, PartMonitor(monitor, 0.0, _LINE))
    if "path" in groups:
        both = _pair(drive, columns, ("path_height", "path_distance"), scratch)
        path_features(drive, both, PartMonitor(monitor, _LINE, _LINE + _PATH))
    in_space = {group: names for group, names in groups.items() if group not in ("line", "path")}
    if in_space and drive.count:
        rest = PartMonitor(monitor, _LINE + _PATH, 1.0)
        chosen = np.ones(drive.count, np.bool_) if wanted is None else wanted
        _in_space(drive, columns, in_space, (chosen, scratch), rest)


def _pair(
    drive: Drive, columns: Columns, names: tuple[str, str], scratch: Path
) -> tuple[NDArray[np.float32], ...]:
    """Two columns; where one isn't wanted, room that is thrown away."""
    return tuple(
        columns[name]
        if name in columns
        else np.memmap(scratch / f"{name}-spare", np.float32, "w+", shape=(max(1, drive.count),))
        for name in names
    )


def _in_space(
    drive: Drive,
    columns: Columns,
    groups: Mapping[str, Sequence[str]],
    asked_with: tuple[NDArray[np.bool_], Path],
    monitor: Monitor,
) -> None:
    """Features of spheres, discs and cells, a part of space at a time."""
    wanted, scratch = asked_with
    sorting, rest = PartMonitor(monitor, 0.0, _LINE), PartMonitor(monitor, _LINE, 1.0)

    def read(points: Integers | slice) -> Floats:
        drive.columns.give_back()
        return drive.xyz(points)

    cloud = TiledCloud(read, drive.count, scratch / "order", _TILE_M, monitor=sorting)
    done = 0
    for part in cloud.parts(max(map(_reach_m, groups)), wanted=wanted):
        rest.check()
        is_wanted = wanted[part.own]
        points = np.concatenate([part.own[is_wanted], part.own[~is_wanted], part.around])
        xyz = drive.xyz(points)
        finite: Flags = np.asarray(np.isfinite(xyz).all(axis=1))
        first = int(np.count_nonzero(is_wanted))
        asked = points[:first][finite[:first]]
        step = PartMonitor(rest, done / drive.count, (done + part.own.size) / drive.count)
        if asked.size:
            around = _Around(asked, xyz[finite])
            for group, values in _features_of_part(around, groups, step):
                for name in groups[group]:
                    columns[name][asked] = values[:, POINT_FEATURES[name].place]
        done += part.own.size


def _reach_m(group: str) -> float:
    """How far a group's features look."""
    if group == "cell":
        return 2.0 * CELL_M
    scale = group.partition("_")[2]
    return FARTHEST_M if scale == BEST else SCALES_M[scale]


def _features_of_part(
    around: _Around, groups: Mapping[str, Sequence[str]], monitor: Monitor
) -> Iterator[tuple[str, NDArray[np.float32]]]:
    """The values of each group, (k, …) float32, for the points asked for."""
    if "cell" in groups:
        yield "cell", cell_features(around.xyz, around.own)
    origin = around.origin
    local = around.xyz - origin
    for shape, axes in (("sphere", 3), ("disc", 2)):
        scales = [one.partition("_")[2] for one in groups if one.startswith(f"{shape}_")]
        if not scales:
            continue
        tree = point_tree(local, axes)
        for number, scale in enumerate(scales):
            step = PartMonitor(monitor, number / len(scales), (number + 1) / len(scales))
            found = _looked_at(tree, shape, scale, around.own, step)
            if shape == "sphere":
                found[:, _MEAN_HEIGHT] += origin[2]
            yield f"{shape}_{scale}", found


def _looked_at(
    tree: PointTree, shape: str, scale: str, own: int, monitor: Monitor
) -> NDArray[np.float32]:
    """The features of one size."""
    width = DISC if shape == "disc" else BEST_FEATURES if scale == BEST else SPHERE
    found = np.zeros((own, width), np.float32)
    if scale == BEST:
        work = partial(_look_for_best, tree, found)
    else:
        work = partial(_look, tree, (shape, SCALES_M[scale]), found)
    share_out(work, tree.order.size, _POINTS_AT_ONCE, monitor)
    return found


def _look(
    tree: PointTree, ball: tuple[str, float], found: NDArray[np.float32], start: int, stop: int
) -> None:
    shape, radius_m = ball
    look = spheres_kernel if shape == "sphere" else discs_kernel
    look(tree, radius_m, (start, stop), len(found), found)


def _look_for_best(tree: PointTree, found: NDArray[np.float32], start: int, stop: int) -> None:
    best_neighbours(tree, (start, stop), len(found), found)
