"""Limits of as-built control, by work type and face: a table that an office may replace."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import name_with_type
from processing.core.text import Text

_TOLERANCE_M = 1e-7
"""A limit of 50 mm is met by 50 mm: sums of many values end a little beside it."""

_WHOLE_PERCENT = 100.0
_MM = 1000


class FaceKind(Enum):
    """Kinds of faces, told apart by the slope of the design."""

    FLAT = "flat"
    SLOPE = "slope"


@dataclass(frozen=True)
class AllowedRange:
    """Deviations that a limit allows, both ends included.

    Attributes
    ----------
    low_m, high_m : float
        m, at or below zero and at or above it; one of them may be infinite.
    """

    low_m: float
    high_m: float

    def holds(self, value_m: float) -> bool:
        """Whether a deviation is allowed; one that is none is not."""
        return self.low_m - _TOLERANCE_M <= value_m <= self.high_m + _TOLERANCE_M

    def beyond(self, values_m: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Which deviations are not allowed: (n,) bool."""
        is_low: NDArray[np.bool_] = values_m < self.low_m - _TOLERANCE_M
        return is_low | (values_m > self.high_m + _TOLERANCE_M)

    def part(self, percent: float) -> AllowedRange:
        """A limit that is so many percent of this one."""
        return AllowedRange(
            self.low_m * percent / _WHOLE_PERCENT, self.high_m * percent / _WHOLE_PERCENT
        )

    @property
    def is_one_sided(self) -> bool:
        """Whether one of the two sides has no limit."""
        return not (math.isfinite(self.low_m) and math.isfinite(self.high_m))

    def percent(self, values_m: NDArray[np.float64]) -> NDArray[np.float64]:
        """Deviation ÷ limit of its side, %: (n,) float64.

        Where one side has no limit, the other's stands in, so that a map shows both.
        """
        low = self.low_m if math.isfinite(self.low_m) else -self.high_m
        high = self.high_m if math.isfinite(self.high_m) else -self.low_m
        share: NDArray[np.float64] = _WHOLE_PERCENT * np.where(
            values_m < 0.0, values_m / -low, values_m / high
        )
        # As :meth:`holds` has it: what is allowed is not shown as beyond.
        is_met = (np.abs(share) > _WHOLE_PERCENT) & ~self.beyond(values_m)
        is_limited = np.isfinite(np.where(values_m < 0.0, self.low_m, self.high_m))
        return np.where(is_met & is_limited, np.sign(share) * _WHOLE_PERCENT, share)

    def words(self) -> Text:
        """As a form has it: ±50 mm."""
        low, high = round(_MM * abs(self.low_m), 3), round(_MM * self.high_m, 3)
        if math.isinf(high):
            return Text(f"−{low:g} mm or more", f"−{low:g} mm 以上")
        if math.isinf(low):
            return Text(f"+{high:g} mm or less", f"+{high:g} mm 以下")
        return Text.same(f"±{low:g} mm" if low == high else f"−{low:g} … +{high:g} mm")


@dataclass(frozen=True)
class FaceLimits:
    """What one face of a work type has to keep.

    Attributes
    ----------
    mean, single : AllowedRange
        Of the mean of all deviations, and of each.
    """

    face: FaceKind
    name: Text
    mean: AllowedRange
    single: AllowedRange


@dataclass(frozen=True)
class WorkType:
    """A work type (工種) with the limits of its faces, at most one for each kind."""

    id: str
    name: Text
    faces: tuple[FaceLimits, ...]


@dataclass(frozen=True)
class AsBuiltLimits:
    """A table of limits.

    Attributes
    ----------
    standard, edition : Text
        Where the numbers come from, and its date.
    rejected_share : float
        Largest share of values beyond the limit of one value, 0 to 1.
    margin_m : float
        Points this near to a shoulder or a toe, seen from above, are left out.
    density_per_m2 : float
        Smallest number of values on a square metre of plan.
    """

    standard: Text
    edition: Text
    rejected_share: float
    margin_m: float
    density_per_m2: float
    work_types: tuple[WorkType, ...]

    def __getitem__(self, work_type: str) -> WorkType:
        """The work type of an id.

        Raises
        ------
        OutOfRange
            The table has none; tells those that it has.
        """
        return name_with_type(
            {one.id: one for one in self.work_types},
            work_type,
            Text("The table of limits has no such work type.", "規格値表にその工種がありません。"),
        )
