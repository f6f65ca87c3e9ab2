"""Why the steps of a scanline are taken for curbs or not: for the diagnostic layer.

The tool judges runs, not single steps, so the runs about the place are found as the tool finds
them, and what spoke for and against each is told where it crosses the scanline.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.core.text import Text
from processing.image.scan_lines.scanlines import Scanlines, ScanlineSettings, scanlines_about
from processing.methods.road.curbs.steps.curb_confidence import confidence_of
from processing.methods.road.curbs.steps.curb_filters import (
    LEAST_CHANCE,
    LEAST_LENGTH_M,
    curb_indications_of,
    is_likely,
    remove_unlikely_runs,
    runs_of,
)
from processing.methods.road.curbs.steps.curb_profile import StepSettings, steps_of
from processing.methods.road.curbs.steps.curb_runs import StepRun
from processing.methods.road.curbs.steps.step_columns import (
    LOWER_ACROSS,
    LOWER_HEIGHT,
    UPPER_ACROSS,
    UPPER_HEIGHT,
)
from processing.methods.road.diagnostics import Diagnostic, DiagnosticTest
from processing.methods.road.requested_position import RequestedPosition

Floats = NDArray[np.float64]

ABOUT_M = 12.0
"""Runs are followed so far to either side: with both sides they are longer than what makes a run no
surer (20 m, `curb_confidence`)."""

_BESIDE_M = 0.15
"""A step of the scanline alone that lies nearer to a run is that run's: they are known within some
3 cm, and two edges of one stone lie farther apart."""

_HEIGHT = Text("Height of the step, median of its run", "段差の高さ（連続区間の中央値）")
_HEIGHT_HERE = Text("Height of the step", "段差の高さ")
_LENGTH = Text("Length seen nearby", "付近で確認できた長さ")
_CHANCE = Text("Chance to be a curb", "縁石である確率")
_UPRIGHT = Text("Upright face, no bank of earth", "面が立っている（法面ではない）")
_OF_ROAD = Text(
    "Rises from the road, no ditch or channel",
    "路面から立ち上がる（水路・側溝の壁や路肩の落ち込みではない）",
)
_FRONT = Text("Front of the stone, not its rear", "縁石の前面（背面ではない）")


def curb_diagnostics(asked: RequestedPosition, settings: StepSettings) -> tuple[Diagnostic, ...]:
    """The steps that cross a scanline, from left to right, and what the tool makes of them.

    Parameters
    ----------
    asked : RequestedPosition
    settings : StepSettings
        As the tool would run.
    """
    about = scanlines_about(asked.drive, asked.xyz, ABOUT_M, ScanlineSettings())
    runs = tuple(runs_of(about, 0, settings))
    # Sides of tree pits are taken with another chance: what was measured is the same.
    taken = {id(run.upper): run for run in remove_unlikely_runs(runs, settings)}
    scanlines = asked.scanlines
    found: list[tuple[float, Diagnostic]] = []
    for run in runs:
        across = _crossing(run, scanlines)
        if across is not None:
            position, xyz = across
            is_taken = id(run.upper) in taken
            outcomes = _outcomes(taken.get(id(run.upper), run), settings, is_taken=is_taken)
            found.append((position, Diagnostic(xyz, outcomes, is_taken=is_taken)))
    known = [position for position, _ in found]
    for position, diagnostic in _lone_steps(scanlines, settings):
        if all(abs(position - other) > _BESIDE_M for other in known):
            found.append((position, diagnostic))
    return tuple(diagnostic for _, diagnostic in sorted(found, key=lambda one: one[0]))


def _crossing(run: StepRun, scanlines: Scanlines) -> tuple[float, Floats] | None:
    """Where a run crosses the scanline: across, and the place."""
    middles = (run.lower + run.upper) / 2
    right = scanlines.rights[0]
    from_way = middles[:, :2] - scanlines.positions[0, :2]
    ahead = np.abs(from_way @ np.array([-right[1], right[0]]))
    nearest = int(ahead.argmin())
    if ahead[nearest] > ScanlineSettings().spacing_m:
        return None
    return float(from_way[nearest] @ right), middles[nearest]


def _outcomes(
    run: StepRun, settings: StepSettings, *, is_taken: bool
) -> tuple[DiagnosticTest, ...]:
    least, seen = settings.least_step_m, run.seen_m
    high = float(np.median(run.heights_m[run.is_seen])) if run.is_seen.any() else np.nan
    chance = confidence_of(run)
    outcomes = [
        DiagnosticTest(_HEIGHT, high, least, "m", is_met=high >= least),
        DiagnosticTest(_LENGTH, seen, LEAST_LENGTH_M, "m", is_met=seen >= LEAST_LENGTH_M),
        DiagnosticTest(_CHANCE, chance, LEAST_CHANCE, "", is_met=chance >= LEAST_CHANCE),
    ]
    if run.is_seen.any():
        looks = curb_indications_of(run)
        outcomes += [
            DiagnosticTest(name, np.nan, np.nan, "", is_met=is_met)
            for name, is_met in ((_UPRIGHT, looks.is_upright), (_OF_ROAD, looks.is_of_road))
            if is_taken or not is_met
        ]
    if is_likely(run, settings):
        outcomes.append(DiagnosticTest(_FRONT, np.nan, np.nan, "", is_met=is_taken))
    return tuple(outcomes)


def _lone_steps(scanlines: Scanlines, settings: StepSettings) -> list[tuple[float, Diagnostic]]:
    """Steps of the scanline alone, which belong to no run."""
    table = steps_of(scanlines, settings).table
    diagnostics = []
    for row in table:
        across = float(row[LOWER_ACROSS] + row[UPPER_ACROSS]) / 2
        height = float(row[LOWER_HEIGHT] + row[UPPER_HEIGHT]) / 2
        right, position = scanlines.rights[0], scanlines.positions[0]
        xyz = position + np.array([across * right[0], across * right[1], height])
        rise, least = float(row[UPPER_HEIGHT] - row[LOWER_HEIGHT]), settings.least_step_m
        outcomes = (
            DiagnosticTest(_HEIGHT_HERE, rise, least, "m", is_met=rise >= least),
            DiagnosticTest(_LENGTH, 0.0, LEAST_LENGTH_M, "m", is_met=False),
        )
        diagnostics.append((across, Diagnostic(xyz, outcomes, is_taken=False)))
    return diagnostics
