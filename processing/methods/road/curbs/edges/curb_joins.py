"""What several heads and drives measured of one curb, as one: offsets removed, then weighed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.methods.road.curbs.edges.curb_join_kernels import join_kernel
from processing.methods.road.curbs.edges.edge_measures import (
    ERROR_ACROSS,
    ERROR_HIGH,
    ERROR_LOW,
    FACE_POINTS,
    HIGH_OFF,
    LEAN,
    LOW_OFF,
    LOWER_ABOVE,
    LOWER_ACROSS,
    UPPER_ABOVE,
    UPPER_ACROSS,
)

_Floats = NDArray[np.float64]

_MOST_ASIDE_M = 0.25
"""A rough line is off by less: runs of several passes are one within that (`approximate_lines`)."""

_LOWEST_STEP_M = -0.02
"""Where a curb is lowered to the ground noise may turn its step over by so much. By trial: no
measurement is recorded."""

_LEAST_WEIGHT = 1e-9
"""Guard of a division where no points lie on a face."""


@dataclass(frozen=True)
class JointEdges:
    """Edges of one curb at the stations of its approximate line, by all that measured it.

    Attributes
    ----------
    lower_across, upper_across, lower_above, upper_above : (m,) float64
        In the approximate line's frame, m; NaN where nothing was measured.
    lean : (m,) float64
        Of the face, m across per m of height; NaN where no points lie on it.
    across_error, lower_error, upper_error : (m,) float64
        m; infinite where nothing was measured.
    face_points : (m,) float64
        Weight of all points on the face.
    low_off, high_off : (m,) float64
        How far points lie off carriageway and top, by the drive that shows them best, m RMS;
        infinite where nothing was measured.
    """

    lower_across: _Floats
    upper_across: _Floats
    lower_above: _Floats
    upper_above: _Floats
    lean: _Floats
    across_error: _Floats
    lower_error: _Floats
    upper_error: _Floats
    face_points: _Floats
    low_off: _Floats
    high_off: _Floats

    @property
    def steps_m(self) -> _Floats:
        """(m,) heights of the step."""
        return self.upper_above - self.lower_above


def join_edges(measures: Sequence[_Floats], most_step_m: float) -> JointEdges:
    """One result of what each drive measured.

    Parameters
    ----------
    measures : sequence of (m, MEASURES) float64
    most_step_m : float
        What is higher is no curb.
    """
    stack = np.array(measures)
    step = stack[:, :, UPPER_ABOVE] - stack[:, :, LOWER_ABOVE]
    with np.errstate(invalid="ignore"):
        is_good = (
            np.isfinite(stack[:, :, ERROR_ACROSS])
            & (np.abs(stack[:, :, LOWER_ACROSS]) <= _MOST_ASIDE_M)
            & (step > _LOWEST_STEP_M)
            & (step <= most_step_m)
        )
    across = np.where(is_good, stack[:, :, ERROR_ACROSS], np.inf)
    low = np.where(is_good, stack[:, :, ERROR_LOW], np.inf)
    high = np.where(is_good, stack[:, :, ERROR_HIGH], np.inf)
    lower, _ = _join(stack[:, :, LOWER_ACROSS], across)
    upper, across_error = _join(stack[:, :, UPPER_ACROSS], across)
    below, lower_error = _join(stack[:, :, LOWER_ABOVE], low)
    # The step keeps its own offset: that of the height is the same for both edges.
    steps, upper_error = _join(step, high)
    faces = np.where(is_good & np.isfinite(stack[:, :, LEAN]), stack[:, :, FACE_POINTS], 0.0)
    weight = faces.sum(axis=0)
    lean = np.where(faces > 0, stack[:, :, LEAN], 0.0) * faces
    return JointEdges(
        lower,
        upper,
        below,
        below + steps,
        np.where(weight > 0, lean.sum(axis=0) / np.maximum(weight, _LEAST_WEIGHT), np.nan),
        across_error,
        lower_error,
        upper_error,
        weight,
        _least(stack[:, :, LOW_OFF], is_good),
        _least(stack[:, :, HIGH_OFF], is_good),
    )


def _least(values: _Floats, is_good: NDArray[np.bool_]) -> _Floats:
    """(m,) least of the drives (d, m) that show something."""
    known = is_good & np.isfinite(values)
    return np.asarray(np.where(known, values, np.inf).min(axis=0))


def _join(values: _Floats, errors: _Floats) -> tuple[_Floats, _Floats]:
    """Weighted mean of drives (d, m) after their offsets are removed, and its error."""
    mean, error = np.empty(values.shape[1]), np.empty(values.shape[1])
    join_kernel(np.ascontiguousarray(values), errors, mean, error)
    return mean, error
