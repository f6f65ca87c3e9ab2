"""From one file's quantisation to another's.

Files of one drive may differ in scale and offset. Their integers are moved to one quantisation
where that can be done exactly; where it can't, the file becomes a drive of its own.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.recording.columns.quantisation import Quantisation

_INT32 = np.iinfo(np.int32)


@dataclass(frozen=True)
class QuantisationShift:
    """From one quantisation's integers to another's: × factor + shift, exactly."""

    factor: NDArray[np.int64]
    shift: NDArray[np.int64]

    def applied(self, integers: NDArray[np.int32]) -> NDArray[np.int32] | None:
        """The integers on the other lattice; None where they don't fit in 32 bits."""
        if (self.factor == 1).all() and (self.shift == 0).all():
            return integers
        moved = integers.astype(np.int64) * self.factor + self.shift
        if moved.size and (moved.min() < _INT32.min or moved.max() > _INT32.max):
            return None
        return moved.astype(np.int32)


def shift_between(source: Quantisation, target: Quantisation) -> QuantisationShift | None:
    """How to bring integers of one quantisation to another without changing a coordinate.

    Returns
    -------
    Move or None
        None when some coordinate of ``source`` isn't on ``target``.
    """
    factor = np.array(source.scale) / np.array(target.scale)
    shift = (np.array(source.offset) - np.array(target.offset)) / np.array(target.scale)
    # A millionth of the last digit: what float64 leaves of offsets such as 649000.
    is_exact = np.all(np.abs(factor - np.rint(factor)) < 1e-6) and np.all(
        np.abs(shift - np.rint(shift)) < 1e-4
    )
    if not is_exact or np.any(np.rint(factor) < 1):
        return None
    return QuantisationShift(np.rint(factor).astype(np.int64), np.rint(shift).astype(np.int64))
