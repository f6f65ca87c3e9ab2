"""Where a side's walk lies, by chainage."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.street.section import StreetSection
from processing.laboratory.simulate.street.sweep import Sweep


@dataclass(frozen=True)
class WalkLines:
    """Lines along a walk, as distances from the road's centre.

    Attributes
    ----------
    chainages : (n,) float64
        Rising.
    inner, bend, outer : (n,) float64
        Where the walk begins, where ramps to lowered curbs end, and where it ends, m.
    """

    chainages: Floats
    inner: Floats
    bend: Floats
    outer: Floats

    def between(self, chainages: Floats) -> tuple[Floats, Floats]:
        """Beginning and end of the walk at chainages: (n,) float64 each."""
        inner = np.interp(chainages, self.chainages, self.inner)
        return inner, np.interp(chainages, self.chainages, self.outer)


def first_of_walk(sweep: Sweep) -> int | None:
    """The line at which a sweep's walk begins; it has two more. None where there is no walk."""
    walks = [row for row, one in enumerate(sweep.profile.strips) if one.kind == "walk"]
    return walks[0] if walks else None


def walk_lines(section: StreetSection, side: int) -> WalkLines | None:
    """The lines of a side's walk; None where there is none."""
    sweep = section.layout.sides[side].sweep
    first = first_of_walk(sweep)
    if first is None:
        return None
    inner, bend, outer = (side * sweep.offsets[:, first + step] for step in range(3))
    return WalkLines(sweep.chainages[:, 0], inner, bend, outer)
