"""Where a gutter crosses the mouth of a side street (横断側溝)."""

from __future__ import annotations

from processing.laboratory.simulate.street.junction_shape import Mouth
from processing.laboratory.simulate.street.section import StreetSection

_SHARE = 0.25


def transverse_of(section: StreetSection, mouth: Mouth) -> tuple[float, float] | None:
    """From and to which distance beside the road's edge it lies, m; None where there is none."""
    random = section.chance("transverse", mouth.side)
    near = max(one.radius_m for one in mouth.corners) + float(random.uniform(0.1, 0.5))
    wide = float(random.uniform(0.3, 0.5))
    return (near, near + wide) if random.random() < _SHARE else None
