"""Every method on one body whose volume follows from a formula."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import shapely

from processing.core.arrays import Floats
from processing.core.monitor import SilentMonitor
from processing.methods.earthwork.geometry.volume_scope import VolumeScope
from processing.methods.earthwork.surfaces.sides import EpochGround, GroundBlock, Level
from processing.methods.earthwork.volumes.comparison import compare
from processing.methods.earthwork.volumes.volume_parameters import (
    END_AREA,
    GRID,
    PRISMOIDAL,
    TIN,
    VolumeParameters,
)

BODY_HEADING = "## Methods on a body of known volume"
BODY_ABOUT = (
    "The same command: an embankment 40 m long, 6 m wide on top and 4 m high, all of its sides "
    "falling 1 : 1.5, as 400 points per square metre with noise of 5 mm, against level ground. "
    "Its volume is that of the frustum of a wedge: h · (l·w + h·(l + w)·n + 4/3·h²·n²), with n "
    "the run of its slopes. Sections stand every 5 m, and every 2.5 m for the prismoidal formula."
)
_LONG_M, _WIDE_M, _HIGH_M, _RUN = 40.0, 6.0, 4.0, 1.5
_ORIGIN = np.array([-12_400.0, -36_700.0, 20.0])
_MARGIN_M = 6.0
_PER_M2 = 400
_NOISE_M = 0.005
_SEED = 9
_INTERVAL_M = 5.0
_METHODS = {
    GRID: "grid, 0.2 m",
    TIN: "TIN against TIN",
    END_AREA: "average end area, 5 m",
    PRISMOIDAL: "prismoidal formula, 5 m",
}


def body_volume_m3() -> float:
    """Volume of the embankment, by the formula."""
    base = _HIGH_M * _RUN
    return _HIGH_M * (_LONG_M * _WIDE_M + base * (_LONG_M + _WIDE_M) + 4.0 / 3.0 * base * base)


def body_points() -> Floats:
    """The embankment as a scan: (n, 3) float64, m."""
    chance = np.random.default_rng(_SEED)
    half = np.array([_LONG_M, _WIDE_M]) / 2
    reach = half + _HIGH_M * _RUN + _MARGIN_M
    count = int(4 * reach[0] * reach[1] * _PER_M2)
    xy = chance.uniform(-reach, reach, (count, 2))
    outside = np.maximum(np.abs(xy) - half, 0.0).max(axis=1)
    z = np.maximum(_HIGH_M - outside / _RUN, 0.0) + _NOISE_M * chance.normal(size=count)
    points: Floats = np.column_stack([xy, z]) + _ORIGIN
    return points


def body_rows() -> list[list[str]]:
    """Cut, fill and how far off each method is."""
    points, true = body_points(), body_volume_m3()
    half = np.array([_LONG_M, _WIDE_M]) / 2 + _HIGH_M * _RUN + _MARGIN_M / 2
    low, high = _ORIGIN[:2] - half, _ORIGIN[:2] + half
    boundary = shapely.box(*low, *high)
    line = np.array([[low[0], _ORIGIN[1]], [high[0], _ORIGIN[1]]])

    def blocks() -> Iterator[GroundBlock]:
        yield GroundBlock(points, 0)

    body = EpochGround(
        "body", blocks, points.min(axis=0), points.max(axis=0), stands=np.empty((0, 3))
    )
    rows = [["method", "true (m³)", "cut (m³)", "fill (m³)", "net, off", "stated ± (m³)"]]
    for method, name in _METHODS.items():
        parameters = VolumeParameters(method=method, interval_m=_INTERVAL_M)
        result = compare(
            Level(float(_ORIGIN[2])), body, parameters, SilentMonitor(), VolumeScope(boundary, line)
        )
        volumes = result.volumes
        rows.append(
            [
                name,
                f"{true:,.1f}",
                f"{volumes.cut_m3:,.1f}",
                f"{volumes.fill_m3:,.1f}",
                f"{100 * (volumes.net_m3 / true - 1):+.2f} %",
                f"{volumes.uncertainty_m3:.1f}",
            ]
        )
    return rows
