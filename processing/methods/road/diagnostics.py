"""Diagnostics: the places that a tool looked at and the tests that decided there, for people."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.text import Text


@dataclass(frozen=True)
class DiagnosticTest:
    """One test and what came of it.

    Attributes
    ----------
    name : Text
        What was measured, in surveyors' words: "Height of the step".
    value, limit : float
        Measured, and what it was held against; both in ``unit``. NaN where nothing could be
        measured.
    unit : str
        "m", "°", "" for shares and counts.
    is_met : bool
        Whether the test speaks for the place.
    """

    name: Text
    value: float
    limit: float
    unit: str
    is_met: bool


@dataclass(frozen=True)
class Diagnostic:
    """A place that a tool looked at, and why it was taken or not.

    Attributes
    ----------
    xyz : (3,) float64
        m, project CRS.
    outcomes : tuple of DiagnosticTest
        In the order in which the tool asks.
    is_taken : bool
    outline : (n, 3) float64 or None
        Ring of what was laid on the points there, m, project CRS; its first place isn't repeated.
    points : (n, 3) float64 or None
        The measured points that it rests on, m, project CRS.
    """

    xyz: NDArray[np.float64]
    outcomes: tuple[DiagnosticTest, ...]
    is_taken: bool
    outline: NDArray[np.float64] | None = None
    points: NDArray[np.float64] | None = None
