"""How a template lies in one section: its score, and the points about it to look at."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.methods.templates.fit import FitSettings, FitStart, fit_at
from processing.methods.templates.profile_template import ProfileTemplate
from processing.methods.templates.shape import FittableTemplate
from processing.methods.templates.slab import SectionFrame, SlabReader
from processing.recording.drive import Drive


@dataclass(frozen=True)
class Preview:
    """A template in one section.

    Attributes
    ----------
    start : FitStart
        Where it lies; its score is 0 where there are no points.
    is_mirrored : bool
        Whether it fits only the other way round.
    points : (n, 2) float64
        The section's points in the template's axes as it was drawn, m.
    """

    start: FitStart
    is_mirrored: bool
    points: NDArray[np.float64]


def preview_at(
    drive: Drive, template: ProfileTemplate, frame: SectionFrame, settings: FitSettings
) -> Preview:
    """Look for a template about a position of a section."""
    start = fit_at(drive, template, frame, settings)
    is_mirrored = start.template is not template
    box = FittableTemplate.of(start.template, settings.tolerance_m).box(0.0)
    local = SlabReader(drive, settings.width_m, box).slab(start.frame).local
    cos, sin = np.cos(start.tilt_rad), np.sin(start.tilt_rad)
    across = local[:, 0] * cos + local[:, 1] * sin
    up = local[:, 1] * cos - local[:, 0] * sin
    return Preview(start, is_mirrored, np.column_stack([-across if is_mirrored else across, up]))
