"""What the tools tell of the places that they look at, by the tool's id: the diagnostic layer.

A maker gets the place somebody points at, with the scanline through it, and tells of all places on
that scanline that its tool looked at, with the parameters that the tool would run with.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from processing.methods.road.curbs.steps.curb_diagnostics import curb_diagnostics
from processing.methods.road.diagnostics import Diagnostic
from processing.methods.road.gutters.notch_diagnostics import notch_diagnostics
from processing.methods.road.requested_position import RequestedPosition
from processing.tools.curbs import CurbParameters, step_settings
from processing.tools.gutters import GutterParameters, notch_parameters

# A tool's parameters are its own dataclass, so nobody here can know their type.
DiagnosticMaker = Callable[[RequestedPosition, Any], tuple[Diagnostic, ...]]


def _curbs(asked: RequestedPosition, parameters: CurbParameters) -> tuple[Diagnostic, ...]:
    return curb_diagnostics(asked, step_settings(parameters))


def _gutters(asked: RequestedPosition, parameters: GutterParameters) -> tuple[Diagnostic, ...]:
    return notch_diagnostics(asked, notch_parameters(parameters))


DIAGNOSTIC_MAKERS: Mapping[str, DiagnosticMaker] = {"curbs": _curbs, "gutters": _gutters}
"""By the id of the tool, in the order of the tools."""
