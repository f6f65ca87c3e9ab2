"""The plans of a section's neighbours: worked out again from the seed, never by building them."""

from __future__ import annotations

from functools import lru_cache

from processing.laboratory.simulate.street.alignment import MARGIN_M, Alignment
from processing.laboratory.simulate.street.plan import SectionPlan, plans_of
from processing.laboratory.simulate.street.section import StreetSection
from processing.laboratory.simulate.street.styles import Style


def driven_m(alignment: Alignment) -> float:
    """Length of the drive that an alignment was made for, m."""
    return float(alignment.chainages[-1]) - MARGIN_M


def neighbour(section: StreetSection, step: int) -> SectionPlan | None:
    """The plan ``step`` sections further on, None beyond the street's ends."""
    plan = section.plan
    return plans(section.seed, plan.style, driven_m(section.alignment)).get(plan.index + step)


@lru_cache(maxsize=4)
def plans(seed: int, style: Style, length_m: float) -> dict[int, SectionPlan]:
    """All plans of a street by their numbers."""
    return {one.index: one for one in plans_of(seed, style, length_m)}
