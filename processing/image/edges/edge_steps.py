"""Low steps between two gentle surfaces: dropped curbs, platforms, sunken slabs.

A step of 2 cm is hardly more than what straight pieces of a profile differ by chance, so it is
looked for as what it is: two surfaces, each straight across, whose ends are offset by a short face.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

import numpy as np

from processing.core.arrays import Floats
from processing.image.edges.step_kernels import (
    ACROSS_M,
    BASE,
    FLAT,
    GRADE,
    HEADING,
    JUMP,
    LEFT,
    POSITION,
    RIGHT,
    STEP,
    TWIST,
    UNKNOWNS,
    WIDTH,
    step_kernel,
)

_WANTED, _MOST = 80, 300
"""Points that are enough for a step, over whose length they are taken; more make it slower, not
better. By trial; no measurement of the single values is recorded."""

_SHORTEST_M, LONGEST_M = 0.20, 0.50
"""Half the length of edge that is looked at: as short as has enough points, since the ramps at the
ends of a dropped curb are 70 cm long."""

LONGER_M = 0.7
"""Half the length, m, on the far side of a street, where that is too short: one ramp. By trial."""


class StepGround(Enum):
    """What lies about a place that isn't a step."""

    FLAT = "flat"
    OTHER = "other"


@dataclass(frozen=True)
class EdgeStep:
    """A low step.

    Attributes
    ----------
    lower, upper : (3,) float64
        Where the lower surface ends and the upper one begins, beside the place that was asked
        for, m.
    heading_rad : float
        Direction of the step, the upper surface on its left.
    grades : tuple of float
        Rise per metre along the lower and the upper edge.
    slopes_rad : tuple of float
        Directions across, to the left, of the lower surface, the face and the upper surface.
    """

    lower: Floats
    upper: Floats
    heading_rad: float
    grades: tuple[float, float]
    slopes_rad: tuple[float, float, float]

    @property
    def height_m(self) -> float:
        """Of the face."""
        return float(self.upper[2] - self.lower[2])

    @property
    def edges(self) -> tuple[tuple[Floats, Floats], tuple[Floats, Floats]]:
        """Places and unit vectors of the lower and the upper edge."""
        lower, upper = (
            np.array([math.cos(self.heading_rad), math.sin(self.heading_rad), grade])
            / math.hypot(1.0, grade)
            for grade in self.grades
        )
        return (self.lower, lower), (self.upper, upper)


def step_at(xyz: Floats, center: Floats) -> EdgeStep | StepGround:
    """The low step within 18 cm of a place, in any direction.

    Parameters
    ----------
    xyz : (n, 3) float64
        m.
    """
    local = xyz - center
    needed = _length_needed(local)
    if needed > LONGEST_M:
        found = _step_along(local, center, LONGER_M)
        if found is not StepGround.OTHER:
            return found
    return _step_along(local, center, max(_SHORTEST_M, min(LONGEST_M, needed)))


def reach_needed(xyz: Floats, center: Floats) -> float:
    """How far around a place points are looked at, m."""
    needed = _length_needed(xyz - center)
    return math.hypot(ACROSS_M, LONGER_M if needed > LONGEST_M else LONGEST_M)


def _length_needed(local: Floats) -> float:
    """Half the length that has enough points."""
    near = int(((local**2).sum(axis=1) <= LONGEST_M**2).sum())
    return _WANTED / max(1.0, 4 * ACROSS_M * near / (math.pi * LONGEST_M**2))


def _step_along(local: Floats, center: Floats, along: float) -> EdgeStep | StepGround:
    local = local[(local**2).sum(axis=1) <= along**2 + ACROSS_M**2]
    local = np.ascontiguousarray(local[:: 1 + local.shape[0] // _MOST])
    found = np.zeros(UNKNOWNS)
    kind = step_kernel(local, along, found)
    if kind != STEP:
        return StepGround.FLAT if kind == FLAT else StepGround.OTHER
    return _step(found, center)


def _step(found: Floats, center: Floats) -> EdgeStep:
    cos, sin = math.cos(found[HEADING]), math.sin(found[HEADING])
    far = found[POSITION] + found[WIDTH]
    lower = np.array([-found[POSITION] * sin, found[POSITION] * cos, found[BASE]])
    upper = np.array([-far * sin, far * cos, found[BASE] + found[JUMP]])
    return EdgeStep(
        center + lower,
        center + upper,
        float(found[HEADING]),
        (float(found[GRADE]), float(found[GRADE] + found[TWIST])),
        (
            math.atan(found[LEFT]),
            math.atan2(found[JUMP], found[WIDTH]),
            math.atan(found[RIGHT]),
        ),
    )


def warm_up() -> None:
    """Compile the kernels."""
    across = np.linspace(-0.4, 0.4, 60)
    up = np.where(across > 0, 0.03, 0.0)
    step_at(np.column_stack([np.tile([0.0, 0.2, 0.4], 20), across, up]), np.zeros(3))
