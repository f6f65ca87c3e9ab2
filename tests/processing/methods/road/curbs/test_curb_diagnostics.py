"""The diagnostic layer of curbs: what the tool says of the steps of one scanline."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from processing.image.scan_lines.scanlines import ScanlineSettings, scanline_through
from processing.methods.road.curbs.steps.curb_diagnostics import curb_diagnostics
from processing.methods.road.curbs.steps.curb_profile import StepSettings
from processing.methods.road.diagnostics import Diagnostic
from processing.methods.road.requested_position import RequestedPosition
from processing.recording.passes import passes_of
from tests.processing.image.scan_lines.test_scanlines import recorded
from tests.street_scene import CURB_AT_M, CURB_HEIGHT_M


def diagnostics_in_the_middle(
    folder: Path, settings: StepSettings
) -> tuple[tuple[Diagnostic, ...], float]:
    """Trials on the scanline in the middle of the street, and where the way is beside its axis."""
    drive, _ = recorded(folder, mount="90", pulses_per_revolution=1500.0, range_noise_m=0.003)
    (vehicle_path,) = passes_of(drive)
    station = vehicle_path.station_at([np.median(np.asarray(drive.columns["time"]))])
    position = vehicle_path.positions_at(station)[0]
    scanlines = scanline_through(drive, position, ScanlineSettings())
    assert scanlines is not None
    return curb_diagnostics(RequestedPosition(drive, position, scanlines), settings), float(
        position[0]
    )


def test_both_curbs_are_taken_and_their_height_is_told(tmp_path: Path) -> None:
    diagnostics, easting = diagnostics_in_the_middle(tmp_path, StepSettings())
    taken = [diagnostic for diagnostic in diagnostics if diagnostic.is_taken]
    apart = taken[-1].xyz[0] - taken[0].xyz[0]
    assert abs(apart - 2 * CURB_AT_M) < 0.1
    assert taken[0].xyz[0] < easting < taken[-1].xyz[0]
    for diagnostic in taken:
        height, length = diagnostic.outcomes[:2]
        assert abs(height.value - CURB_HEIGHT_M) < 0.02
        assert height.limit == StepSettings().least_step_m
        assert length.value > 1.0
        assert all(outcome.is_met for outcome in diagnostic.outcomes)


def test_with_a_greater_least_height_the_same_places_are_told_as_not_taken(tmp_path: Path) -> None:
    diagnostics, _ = diagnostics_in_the_middle(tmp_path, StepSettings(least_step_m=0.25))
    assert diagnostics
    assert not any(diagnostic.is_taken for diagnostic in diagnostics)
    curbs = [t for t in diagnostics if abs(t.outcomes[0].value - CURB_HEIGHT_M) < 0.02]
    assert len(curbs) >= 2
    assert not any(diagnostic.outcomes[0].is_met for diagnostic in curbs)
