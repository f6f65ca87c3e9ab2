"""A made-up hectare of earthwork at two dates, with machines that hide the ground."""

from __future__ import annotations

from pathlib import Path

import laspy
import numpy as np
import shapely

from processing.core.arrays import Floats
from processing.core.monitor import SilentMonitor
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.drive import Drive

SIDE_M = 100.0
CORNER = np.array([-12_400.0, -36_700.0, 20.0])
_SCANNERS_M = ((30.0, 30.0), (70.0, 30.0), (30.0, 70.0), (70.0, 70.0))
_NEAREST_M, _FARTHEST_M = 1.0, 75.0
_IN_TURN = 1000
_OF_WHICH_ONE_IS_HERE = 1.9  # the others fall outside of the hectare
_NOISE_M = 0.003
_PULSES_PER_S = 100_000.0
_MACHINES_M = np.array([[20.0, 50.0], [48.0, 22.0], [81.0, 55.0], [52.0, 78.0]])
_MACHINE_M, _MACHINE_TALL_M = 3.0, 2.0
_PIT_M, _PIT_DEEP_M = (40.0, 60.0, 18.0), 2.0
_HEAP_M, _HEAP_TALL_M = (65.0, 40.0, 15.0), 1.5
_GROUND, _OTHER = 2, 1


def ground_height(xy: Floats, *, is_later: bool) -> Floats:
    """Height of the ground above the corner's, m: a slope, and a pit and a heap at a later date.

    Parameters
    ----------
    xy : (n, 2) float64
        m from the corner.
    """
    x, y = xy.T
    heights: Floats = 0.03 * x + 0.4 * np.sin(x / 9.0) * np.cos(y / 11.0)
    if is_later:
        heights += _HEAP_TALL_M * _bowl(xy, _HEAP_M) - _PIT_DEEP_M * _bowl(xy, _PIT_M)
    return heights


def true_volumes() -> tuple[float, float]:
    """Cut and fill within the boundary, m³: the bowls are (1 - r²/R²)² and don't overlap."""
    cut, fill = (
        depth * np.pi * position[2] ** 2 / 3
        for depth, position in ((_PIT_DEEP_M, _PIT_M), (_HEAP_TALL_M, _HEAP_M))
    )
    return cut, fill


def _bowl(xy: Floats, position: tuple[float, float, float]) -> Floats:
    away = np.hypot(xy[:, 0] - position[0], xy[:, 1] - position[1]) / position[2]
    bowl: Floats = np.square(np.maximum(1.0 - np.square(away), 0.0))
    return bowl


def boundary() -> shapely.Polygon:
    """A polygon of 24 corners that goes round the work, m, project CRS."""
    turns = np.linspace(0.0, 2 * np.pi, 24, endpoint=False)
    round_middle = np.column_stack([np.cos(turns), np.sin(turns)]) * 0.48 * SIDE_M
    return shapely.Polygon(round_middle + SIDE_M / 2 + CORNER[:2])


def scanned_drives(folder: Path, points: int, *, is_later: bool) -> tuple[Drive, ...]:
    """An epoch as it is imported: about so many points of four set-ups, with ground classes."""
    random = np.random.default_rng(7 + is_later)
    clouds = []
    for number, position in enumerate(_SCANNERS_M):
        cloud = folder / f"{'after' if is_later else 'before'}-{number}.laz"
        _write_scan(
            cloud, np.array(position), points // len(_SCANNERS_M), random, is_later=is_later
        )
        clouds.append(cloud)
    into = folder / ("later" if is_later else "earlier")
    made = import_drives(ImportRequest(tuple(clouds), ()), into, SilentMonitor())
    return tuple(Drive(one) for one in made)


def _write_scan(
    path: Path, position: Floats, points: int, random: np.random.Generator, *, is_later: bool
) -> None:
    """What a head that turns slowly measures while its mirror turns fast; even in plan."""
    pulses = np.arange(round(points * _OF_WHICH_ONE_IS_HERE))
    steps = (pulses % _IN_TURN + random.uniform(size=pulses.size)) / _IN_TURN
    away = np.sqrt(_NEAREST_M**2 + steps * (_FARTHEST_M**2 - _NEAREST_M**2))
    turn = 2 * np.pi * pulses / pulses.size
    xy = position + np.column_stack([np.cos(turn), np.sin(turn)]) * away[:, None]
    is_here = np.flatnonzero(((xy > 0) & (xy < SIDE_M)).all(axis=1))
    xy = xy[is_here]
    codes = np.full(len(xy), _GROUND, np.uint8)
    heights = ground_height(xy, is_later=is_later) + random.normal(0, _NOISE_M, len(xy))
    for machine in _MACHINES_M:
        is_machine = (np.abs(xy - machine) < _MACHINE_M).all(axis=1)
        heights[is_machine] += _MACHINE_TALL_M
        codes[is_machine] = _OTHER
    header = laspy.LasHeader(point_format=6, version="1.4")
    header.scales, header.offsets = np.full(3, 0.001), CORNER
    las = laspy.LasData(header)
    las.x, las.y, las.z = (np.column_stack([xy, heights]) + CORNER).T
    las.gps_time = is_here / _PULSES_PER_S
    las.classification = codes
    las.write(path)
