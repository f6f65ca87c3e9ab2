"""Which of the points under a brush are painted: all, those without a label, those of a class."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray


class PaintOver(Enum):
    """Points that may be painted."""

    EVERYTHING = "everything"
    UNLABELLED = "unlabelled"
    ONE_CLASS = "one-class"


@dataclass(frozen=True)
class PaintRule:
    """What a stroke does to the points under it.

    Attributes
    ----------
    code : int
        The label they get; 0 takes labels away.
    over : PaintOver
    only : int
        The class that points must have; for `PaintOver.ONE_CLASS`.
    """

    code: int
    over: PaintOver = PaintOver.EVERYTHING
    only: int = 0

    def chosen(self, labels: NDArray[np.uint8], classes: NDArray[np.uint8]) -> NDArray[np.bool_]:
        """(n,) which of points with these labels get another one.

        Parameters
        ----------
        classes : (n,) uint8
            What counts for each: its label, or else the class it was delivered with.
        """
        is_other: NDArray[np.bool_] = labels != self.code
        if self.over is PaintOver.UNLABELLED:
            is_other &= labels == 0
        elif self.over is PaintOver.ONE_CLASS:
            is_other &= classes == self.only
        return is_other
