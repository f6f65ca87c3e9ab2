"""Why a plate is a sign or none: outlines laid on the plates about a place, for the diagnostics."""

from __future__ import annotations

import math

import numpy as np

from processing.core.arrays import Floats
from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.image.scan_lines.scanlines import ScanlineSettings, scanlines_about
from processing.methods.road.diagnostics import Diagnostic, DiagnosticTest
from processing.methods.road.objects.sparse_plan import plan_of
from processing.methods.road.requested_position import RequestedPosition
from processing.methods.road.signs.plate_fit import fit_plates
from processing.methods.road.signs.plate_groups import plate_groups
from processing.methods.road.signs.plate_lines import empty_lines, lines_of
from processing.methods.road.signs.plates import Plate, plates_of
from processing.methods.road.signs.road_signs import DriveWays, turn_ways
from processing.methods.road.signs.scan_pieces import pieces_between
from processing.methods.road.signs.sign_confidence import chance_of, facts_of
from processing.methods.road.signs.sign_shapes import looked_for

_ABOUT_M = 2.5
"""Plates so near to the place in plan are looked at."""

_ALONG_M = 4.0
"""Scan lines so far along the path to either side hold them, tilted heads included."""

_TURNS = 3
"""Of the scanner before the first point and behind the last, in which the ends of plates lie."""

_BRIGHT, _SEEN, _EXPLAINED = 0.5, 0.5, 0.6
_OFF, _NOISE_M, _LOWEST_M, _ASKEW_DEG = 2.0, 0.01, 1.6, 10.0
"""What speaks for a sign and against one, as its facts count it (`sign_confidence`)."""

_NAMES = (
    Text("Likelihood of being a sign", "標識である見込み"),
    Text("Points as bright as a sign's face", "標識面のように明るい点の割合"),
    Text("Ends of scan lines off the outline (σ)", "スキャンライン端と輪郭のずれ（σ）"),
    Text("Share of the rim that was seen", "縁のうち計測された割合"),
    Text("Share of the plane that plates explain", "面のうち標識板で説明できる割合"),
    Text("Points off the plane", "面からの点のばらつき"),
    Text("Lower edge above the ground", "下端の地上高"),
    Text("Roll and tilt", "回転と傾き"),
)


def sign_diagnostics(asked: RequestedPosition, least_confidence: float) -> tuple[Diagnostic, ...]:
    """The plates about a place with the outlines that fit them, by one drive alone.

    Raises
    ------
    MissingInput
        The drive has no trajectory.
    """
    span = _points_about(asked)
    if span is None:
        return ()
    drive = asked.drive
    plan = plan_of([(drive.info.lowest, drive.info.highest)])
    place = asked.xyz - plan.origin
    pieces = pieces_between(drive, *span, plan)
    ways = DriveWays([drive])
    found: list[Diagnostic] = []
    for group in plate_groups(pieces, turn_ways([drive], pieces), SilentMonitor()):
        if math.hypot(*(group.middle - place)[:2]) > _ABOUT_M:
            continue
        lines = lines_of(pieces, group)
        empty = empty_lines(pieces, group, lines)
        fit = fit_plates(lines, empty, looked_for(), SilentMonitor())
        for plate in plates_of(pieces, group, lines, fit):
            ground = float(np.median(pieces.ground[plate.pieces]))
            chance = chance_of(facts_of(plate, ground, ways.at(plate.centre + plan.origin)))
            outcomes = _outcomes(plate, ground, chance, least_confidence)
            found.append(
                Diagnostic(
                    plate.centre + plan.origin,
                    outcomes,
                    chance >= least_confidence,
                    plate.outline + plan.origin,
                )
            )
    return tuple(found)


def _points_about(asked: RequestedPosition) -> tuple[int, int] | None:
    """First of the points near a place and one past the last; None where there are none."""
    numbers = []
    for one in scanlines_about(asked.drive, asked.xyz, _ALONG_M, ScanlineSettings()):
        xyz: Floats = one.xyz(np.arange(one.point.size))
        near = np.hypot(*(xyz - asked.xyz)[:, :2].T) <= _ABOUT_M
        numbers.append(one.point[near])
    every = np.concatenate([np.empty(0, np.int64), *numbers])
    every = every[every >= 0]
    if not every.size:
        return None
    revolutions = asked.drive.revolutions
    more = round(_TURNS * (revolutions.pulses_per_revolution if revolutions else 0))
    return max(0, int(every.min()) - more), min(asked.drive.count, int(every.max()) + more)


def _outcomes(
    plate: Plate, ground_m: float, chance: float, least: float
) -> tuple[DiagnosticTest, ...]:
    one = plate.evidence
    off, askew = math.sqrt(one.cost), abs(math.degrees(one.roll_rad))
    askew += abs(math.degrees(math.asin(max(-1.0, min(1.0, one.tilt)))))
    edge = float(plate.outline[:, 2].min()) - ground_m
    tested = (
        (chance, least, "", chance >= least),
        (one.bright, _BRIGHT, "", one.bright >= _BRIGHT),
        (off, _OFF, "", off <= _OFF),
        (one.sectors, _SEEN, "", one.sectors >= _SEEN),
        (one.explained, _EXPLAINED, "", one.explained >= _EXPLAINED),
        (one.noise_m, _NOISE_M, "m", one.noise_m <= _NOISE_M),
        (edge, _LOWEST_M, "m", edge >= _LOWEST_M),
        (askew, _ASKEW_DEG, "°", askew <= _ASKEW_DEG),
    )
    return tuple(DiagnosticTest(name, *test) for name, test in zip(_NAMES, tested, strict=True))
