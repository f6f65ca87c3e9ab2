"""Why a dip of a row was taken for the hole of a lid, or not: for people to read."""

from __future__ import annotations

import numpy as np

from processing.core.text import Text
from processing.methods.road.diagnostics import Diagnostic, DiagnosticTest
from processing.methods.road.gutters.notches.gutter_notches import notches_about
from processing.methods.road.gutters.notches.notches import DENT, OPENING, Notches, NotchParameters
from processing.methods.road.requested_position import RequestedPosition

ABOUT_M = 1.0
"""Notches farther from the requested place are none of its business."""

LEAST_STRENGTH = 0.5
"""Shown as what speaks for a hole: likelier than not. The tool itself weighs weaker ones too."""

_WIDEST_M = 0.20
"""Widest hole of a lid, 19 cm (Takahashi 2022, Table 7-2), rounded up."""
_DEPTH = Text("Depth below the surface", "路面からの深さ")
_WIDTH = Text("Width along the row", "走査線方向の幅")
_SHAPE = Text("Jump as in equations 7-2 and 7-3", "式(7-2)・(7-3)の変化")
_STRENGTH = Text("Likelihood of a hole", "穴である確からしさ")


def notch_diagnostics(
    asked: RequestedPosition, parameters: NotchParameters
) -> tuple[Diagnostic, ...]:
    """The notches about a place, along the vehicle's path.

    Raises
    ------
    MissingInput
        The drive has no trajectory.
    """
    position = np.asarray(asked.xyz, dtype=np.float64)
    notches = notches_about(asked.drive, position, parameters)
    away = np.hypot(*(notches.xyz[:, :2] - position[:2]).T)
    near = np.flatnonzero(away <= ABOUT_M)
    near = near[np.argsort(notches.station_m[near], kind="stable")]
    return tuple(_diagnostic_of(notches, int(one), parameters) for one in near)


def _diagnostic_of(notches: Notches, one: int, parameters: NotchParameters) -> Diagnostic:
    depth, width = float(notches.depth_m[one]), float(notches.width_m[one])
    strength = float(notches.strength[one])
    is_jump = bool(notches.pattern[one] & (OPENING | DENT))
    return Diagnostic(
        notches.xyz[one],
        (
            DiagnosticTest(_DEPTH, depth, parameters.down_m, "m", depth >= parameters.down_m),
            DiagnosticTest(_WIDTH, width, _WIDEST_M, "m", width <= _WIDEST_M),
            DiagnosticTest(_SHAPE, float(is_jump), 1.0, "", is_jump),
            DiagnosticTest(_STRENGTH, strength, LEAST_STRENGTH, "", strength >= LEAST_STRENGTH),
        ),
        strength >= LEAST_STRENGTH,
    )
