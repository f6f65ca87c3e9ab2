"""Steps of the ground on normalised scanlines: where level ground meets a low, steep rise.

Every step of a scanline is looked at, not only the first beside the vehicle's path, and steps down
as well as up: islands, medians and edgings have two.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from processing.image.scan_lines.scanlines import Scanlines
from processing.methods.road.curbs.steps.step_columns import SECTION, STEP_COLUMNS, VERTEX
from processing.methods.road.curbs.steps.step_edge_kernels import EdgeLimits, edges_kernel
from processing.methods.road.curbs.steps.step_kernels import StepLimits, steps_kernel

Floats = NDArray[np.float64]

_WEAK_SHARE = 0.5
"""A run may go on over steps of half the least height: one of 2 cm is measured at 1 to 3 cm."""

LEAST_SCANNER_M, HIGHEST_SCANNER_M = 1.5, 3.0
"""How high scanners are above the road, on a small car and on a lorry (2.6 m in Takahashi 2022,
Table 6-1); it tells how long shadows may be, and where they begin."""

_LEAST_FACE = 0.25
"""Rise per metre of the flattest face, 14°: ramp stones before driveways. By trial."""

_MARGIN_M = 0.1
"""Beyond the outermost vertex, so that it falls into a cell."""

_ROOM = 64
"""Steps of a scanline for which there is room at first: fields have thirty; what isn't filled takes
no memory, and where there are more the table is made anew."""


@dataclass(frozen=True)
class StepSettings:
    """What counts as the step of a curb on a scanline, and what joins such steps to a run.

    Attributes
    ----------
    least_step_m, most_step_m : float
        Least and greatest height; Takahashi 2022, Table 6-1: 3 cm and 45 cm.
    least_dropped_m : float
        Least height where a run goes on: the step of a dropped curb, which is 2 cm at crossings,
        less what measuring it costs.
    face_deg, ground_deg : float
        Greatest angle of a face, and least angle of ground, to the vertical; Table 6-1: 30° and
        70°.
    join_m : float
        How far apart what belongs together may be; Table 6-1: 2.5 m.
    """

    least_step_m: float = 0.03
    most_step_m: float = 0.45
    least_dropped_m: float = 0.015
    face_deg: float = 30.0
    ground_deg: float = 70.0
    join_m: float = 2.5


@dataclass(frozen=True)
class PassSteps:
    """The steps of all scanlines of one pass.

    Attributes
    ----------
    stations_m, positions, rights
        Of the scanlines, as in `Scanlines`.
    table : (n, STEP_COLUMNS) float64
        See `step_kernels`; in the order of the scanlines.
    times_s : (n,) float64
        When each step was measured.
    """

    stations_m: Floats
    positions: Floats
    rights: Floats
    table: Floats
    times_s: Floats

    @cached_property
    def sections(self) -> NDArray[np.int64]:
        """(n,) scanline of each step."""
        return self.table[:, SECTION].astype(np.int64)


def steps_of(scanlines: Scanlines, settings: StepSettings) -> PassSteps:
    """The steps of the scanlines of one stretch, weak ones too."""
    half_m = float(np.abs(scanlines.across_m).max(initial=1.0)) + _MARGIN_M
    lines = (scanlines.across_m, scanlines.height_m, scanlines.starts)
    table = steps_on_lines(lines, half_m, settings, is_square=True)
    times = scanlines.time_s[table[:, VERTEX].astype(np.int64)]
    return PassSteps(scanlines.stations_m, scanlines.positions, scanlines.rights, table, times)


def steps_on_lines(
    lines: tuple[Floats, Floats, NDArray[np.int64]],
    half_m: float,
    settings: StepSettings,
    *,
    is_square: bool,
) -> Floats:
    """The steps of any lines over the ground, as a table (see `step_columns`).

    Parameters
    ----------
    lines : tuple
        Places along the lines, rising, and heights, (n,) m; where the lines begin, (s + 1,).
    half_m : float
        No place is farther from 0.
    is_square : bool
        Whether the lines are square to the vehicle's path, which crosses them at 0: then far faces
        are in shadow.
    """
    limits = StepLimits(
        _WEAK_SHARE * settings.least_dropped_m,
        settings.most_step_m,
        math.tan(math.radians(90.0 - settings.ground_deg)),
        half_m,
        LEAST_SCANNER_M if is_square else math.inf,
    )
    along, height, starts = lines
    table = np.empty((_ROOM * starts.size, STEP_COLUMNS))
    while True:
        count = steps_kernel(along, height, starts, limits, table)
        if count <= table.shape[0]:
            break
        table = np.empty((count, STEP_COLUMNS))
    table = table[:count]
    highest = HIGHEST_SCANNER_M if is_square else 0.0
    edges = EdgeLimits(limits.least_m, limits.most_m, _LEAST_FACE, highest)
    return table[: edges_kernel(along, height, starts, edges, table)].copy()


def join_steps(parts: Sequence[PassSteps]) -> PassSteps:
    """Steps of the stretches of one pass as of one; scanlines are counted on."""
    firsts = np.cumsum([0, *(part.stations_m.size for part in parts)])
    tables = []
    for part, first in zip(parts, firsts, strict=False):
        table = part.table.copy()
        table[:, SECTION] += first
        tables.append(table)
    return PassSteps(
        np.concatenate([part.stations_m for part in parts]),
        np.vstack([part.positions for part in parts]),
        np.vstack([part.rights for part in parts]),
        np.vstack(tables),
        np.concatenate([part.times_s for part in parts]),
    )
