"""What the tools tell of the places that they look at, by the tool's id: the diagnostic layer.

A maker gets the place somebody points at, with the scanline through it, and tells of all places on
that scanline that its tool looked at, with the parameters that the tool would run with.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from processing.road.asked_place import AskedPlace
from processing.road.curbs.curb_trials import curb_trials
from processing.road.gutters.notch_trials import notch_trials
from processing.road.trials import Trial
from processing.tools.curbs import CurbParameters, step_settings
from processing.tools.gutters import GutterParameters, notch_parameters

# A tool's parameters are its own dataclass, so nobody here can know their type.
TrialMaker = Callable[[AskedPlace, Any], tuple[Trial, ...]]


def _curbs(asked: AskedPlace, parameters: CurbParameters) -> tuple[Trial, ...]:
    return curb_trials(asked, step_settings(parameters))


def _gutters(asked: AskedPlace, parameters: GutterParameters) -> tuple[Trial, ...]:
    return notch_trials(asked, notch_parameters(parameters))


TRIAL_MAKERS: Mapping[str, TrialMaker] = {"curbs": _curbs, "gutters": _gutters}
"""By the id of the tool, in the order of the tools."""
