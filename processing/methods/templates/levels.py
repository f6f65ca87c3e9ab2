"""At which height a template begins where only its place in plan is known."""

from __future__ import annotations

import math

import numpy as np

from processing.core.errors import Unsuitable
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.methods.templates.fit import FitSettings, fit_at
from processing.methods.templates.profile_template import ProfileTemplate
from processing.methods.templates.slab import SectionFrame, SlabBox, SlabReader
from processing.recording.drive import Drive

_ASIDE_M = 0.3
"""To either side of the start within which points tell levels; by trial, a curb's surroundings."""

_APART_M = 0.25
"""Points whose heights differ by less are of one level: more than a curb's step, less than a
storey. By trial."""

_FEWEST = 5
"""Points of a level, so that strays are none; by trial."""


def levels_near(
    drive: Drive,
    template: ProfileTemplate,
    frame: SectionFrame,
    settings: FitSettings,
    monitor: Monitor,
) -> SectionFrame:
    """The frame at the level at which the template fits best: the road, not a roof above it.

    Raises
    ------
    Unsuitable
        No point is near the start.
    """
    level = SectionFrame(np.array([frame.position[0], frame.position[1], 0.0]), frame.heading_rad)
    reader = SlabReader(drive, settings.width_m, SlabBox(-_ASIDE_M, _ASIDE_M, -math.inf, math.inf))
    heights = np.sort(reader.slab(level).local[:, 1])
    best, most = None, -1.0
    lowest = -math.inf
    for number, height in enumerate(heights[: heights.size - _FEWEST + 1].tolist()):
        is_level = heights[number + _FEWEST - 1] - height <= _APART_M
        if height < lowest or not is_level:
            continue
        lowest = height + _APART_M
        middle = np.array([frame.position[0], frame.position[1], height + _APART_M / 2])
        tried = SectionFrame(middle, frame.heading_rad)
        fit = fit_at(drive, template, tried, settings, monitor)
        if fit.score > most:
            best, most = tried, fit.score
    if best is None:
        raise Unsuitable(
            Text("No measured point is near the start.", "開始位置の近くに計測点がありません。"),
            Text.same(f"{frame.position[0]:.2f}, {frame.position[1]:.2f}"),
            Text(
                "Begin where this drive has points.",
                "この走行データに点がある位置から始めてください。",
            ),
        )
    return best
