"""What tools make of a section: its normalised scanline, and the places that they look at there."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.errors import UserError
from processing.image.scanlines import Scanlines, ScanlineSettings, scanline_through
from processing.points.drive import Drive
from processing.road.asked_place import AskedPlace
from processing.road.trials import Trial
from processing.section.cut import Cut
from processing.tools.trial_makers import TRIAL_MAKERS
from widgets.section_view.standing import Standing

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class ShownTrial:
    """A place that a tool looked at.

    Attributes
    ----------
    tool : str
        Id of the tool.
    section : (3,) float64
        Offset, height, distance from the plane, m.
    """

    tool: str
    trial: Trial
    section: Floats


@dataclass(frozen=True, eq=False)
class SectionTrials:
    """The scanline of one drive in a section, and what was looked at on it.

    Attributes
    ----------
    lines : tuple of (k, 3) float64
        Its unbroken parts; offset, height, distance from the plane, m.
    trials : tuple of ShownTrial
    """

    drive: str
    lines: tuple[Floats, ...]
    trials: tuple[ShownTrial, ...]


def trials_at(
    drives: Sequence[Drive], standing: Standing, cut: Cut, parameters: Mapping[str, object]
) -> tuple[SectionTrials, ...]:
    """What is to be shown in a section; of drives that lack turns or a trajectory nothing.

    Parameters
    ----------
    parameters : mapping of str to object
        Of the tools, by their ids, as they would run now.
    """
    place = np.array(cut.middle if standing.through is None else standing.through)
    found = []
    for drive in drives:
        if drive.trajectory is None or drive.turns is None:
            continue
        try:
            scanlines = scanline_through(drive, place, ScanlineSettings())
            if scanlines is not None:
                found.append(_shown(AskedPlace(drive, place, scanlines), cut, parameters))
        except UserError:  # whoever runs the tool is told; here there is just nothing to show
            continue
    return tuple(found)


def _shown(asked: AskedPlace, cut: Cut, parameters: Mapping[str, object]) -> SectionTrials:
    trials = [
        ShownTrial(tool, trial, cut.to_section(trial.xyz.reshape(1, 3))[0])
        for tool, make in TRIAL_MAKERS.items()
        if tool in parameters
        for trial in make(asked, parameters[tool])
    ]
    return SectionTrials(asked.drive.info.name, _lines(asked.scanlines, cut), tuple(trials))


def _lines(scanlines: Scanlines, cut: Cut) -> tuple[Floats, ...]:
    vertices = np.arange(scanlines.across_m.size)
    section = cut.to_section(scanlines.xyz(vertices))
    return tuple(np.split(section, np.flatnonzero(scanlines.is_break)[1:]))
