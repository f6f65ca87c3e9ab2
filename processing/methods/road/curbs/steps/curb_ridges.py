"""Edging stones seen from the road: between a planting strip, or a tree pit, and the walk behind.

Their far edge is the one that maps want, and of it scanners see no more than where the top ends
and how long its shadow is. Where the top begins is seen well: ridges are followed along the
vehicle's path by that, and its straightness tells stone from plants.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from processing.image.scan_lines.scanlines import Scanlines
from processing.methods.road.curbs.steps.curb_chains import chains_of
from processing.methods.road.curbs.steps.curb_profile import (
    HIGHEST_SCANNER_M,
    LEAST_SCANNER_M,
    PassSteps,
    StepSettings,
    join_steps,
)
from processing.methods.road.curbs.steps.curb_runs import StepRun, run_of, spread_of
from processing.methods.road.curbs.steps.ridge_kernels import RidgeLimits, ridges_kernel
from processing.methods.road.curbs.steps.step_columns import (
    LOWER_ACROSS,
    STEP_COLUMNS,
    UPPER_ACROSS,
    VERTEX,
)

Floats = NDArray[np.float64]

_HIGHEST_M = 0.18
"""Blocks for edging are 12 to 15 cm high (JIS A 5371): what stands out by more is a wall."""

_ABOVE_ROAD_M = 0.5
"""How far an edge may lie above the road: a curb and an edging stone on the walk behind it."""

_ASIDE_M = 0.5
"""How far a scanner may be beside the vehicle's path: shadows look shorter by it."""

_ROOM = 4
"""Ridges of a scanline for which there is room at first; where there are more the table is made
anew."""


@dataclass(frozen=True)
class PassRidges:
    """The ridges of all scanlines of one pass.

    Attributes
    ----------
    steps : PassSteps
        Their far edges, as steps down.
    fronts : (n,) float64
        Where their tops begin, m across.
    """

    steps: PassSteps
    fronts: Floats


def ridges_of(scanlines: Scanlines, settings: StepSettings) -> PassRidges:
    """The ridges of the scanlines of one stretch."""
    limits = RidgeLimits(
        settings.least_step_m,
        min(_HIGHEST_M, settings.most_step_m),
        math.tan(math.radians(90.0 - settings.ground_deg)),
        LEAST_SCANNER_M - _ABOVE_ROAD_M,
        HIGHEST_SCANNER_M + _ASIDE_M,
    )
    lines = (scanlines.across_m, scanlines.height_m, scanlines.starts)
    room = _ROOM * scanlines.starts.size
    while True:
        found = (np.empty((room, STEP_COLUMNS)), np.empty(room))
        count = ridges_kernel(*lines, limits, found)
        if count <= room:
            break
        room = count
    table, fronts = found[0][:count].copy(), found[1][:count].copy()
    times = scanlines.time_s[table[:, VERTEX].astype(np.int64)]
    steps = PassSteps(scanlines.stations_m, scanlines.positions, scanlines.rights, table, times)
    return PassRidges(steps, fronts)


def ridge_runs(
    parts: Sequence[PassRidges], steps: PassSteps, number: int, settings: StepSettings
) -> Iterator[StepRun]:
    """Runs along the far edges of ridges of one pass.

    Parameters
    ----------
    parts : sequence of PassRidges
        Of its stretches, in order.
    steps : PassSteps
        All steps of the pass.
    number : int
        Which of the drives given it is.
    """
    ridges = join_steps([part.steps for part in parts])
    begun = ridges.table.copy()
    begun[:, [LOWER_ACROSS, UPPER_ACROSS]] = np.concatenate([part.fronts for part in parts])[
        :, None
    ]
    fronts = replace(ridges, table=begun)
    for chain in chains_of(fronts, settings):
        run = run_of(ridges, chain, number, among=steps)
        # They stand on a walk that a curb has raised: that speaks against plinths only.
        yield replace(
            run,
            spread_m=spread_of(fronts, chain),
            above_path_m=run.above_path_m * 0.0,
            risen_m=run.risen_m * 0.0,
            is_edging=True,
        )
