"""Where the shared cursor goes when a section is stepped along its line."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from processing.image.search.nearest import nearest_point
from processing.recording.drive import Drive
from processing.section.points_in_cut import ground_near
from widgets.section_view.picture.point_search import can_search, position_of
from widgets.section_view.picture.section_position import SectionPosition
from widgets.shared.cursor import PickedPosition

_SAME_M = 0.1


def position_of_step(standing: SectionPosition, drives: Sequence[Drive]) -> PickedPosition:
    """The line's own place, or the measured point that stands for it.

    Below a trajectory it is a point of the ground; on a drawn line one within a decimetre. Drives
    whose tiles aren't there yet are not waited for.
    """
    cut = standing.turned(is_along=False).cut
    own = sorted(drives, key=lambda drive: drive.id != standing.line.drive)
    for drive in own:
        if not can_search(drive):
            continue
        if standing.line.feature:
            point = nearest_point(drive, np.array(cut.middle), _SAME_M)
        else:
            point = ground_near(drive, replace(cut, width_m=min(cut.width_m, 1.0)))
        if point >= 0:
            return position_of(drive, point)
    return PickedPosition(cut.middle)
