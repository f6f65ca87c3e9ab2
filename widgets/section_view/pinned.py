"""PinnedSections: one place held as two windows, across its line and along it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

from widgets.section_view.picture.section_position import SectionPosition


@dataclass(frozen=True)
class PinnedSections:
    """Two sections through one place.

    Attributes
    ----------
    across, along : SectionPosition
    """

    across: SectionPosition
    along: SectionPosition

    @classmethod
    def at(cls, standing: SectionPosition) -> Self:
        """The two sections where one stands."""
        return cls(standing.turned(is_along=False), standing.turned(is_along=True))
