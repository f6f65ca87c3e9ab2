"""A template fitted along the street, step by step, in both directions from where it was drawn.

Where a constant says “by trial”, it was set on the left head of a simulated town street; no
measurement varied it alone. Scores of all values together are in docs/accuracy.md.
"""

from __future__ import annotations

import copy
import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import Unsuitable
from processing.core.monitor import Monitor, SilentMonitor
from processing.core.text import Text
from processing.methods.templates.fit_kernels import GRADE, HEIGHT, OFFSET, POSE, TILT, TURN
from processing.methods.templates.line_directions import LineDirection, RoadDirection
from processing.methods.templates.pose_fit import (
    TILTS_RAD,
    PoseFit,
    PosePrior,
    refine_pose,
    search_pose,
)
from processing.methods.templates.profile_template import ProfileTemplate
from processing.methods.templates.shape import FittableTemplate
from processing.methods.templates.slab import STRETCH_M, SectionFrame, SlabReader
from processing.recording.drive import Drive

_Floats = NDArray[np.float64]

_SPREAD = np.array([0.02, 0.01, math.radians(2.0), 0.035, 0.02])
"""How far the next pose lies from the one expected: standard deviations at half a metre, in the
order of a pose (m, m, rad, m per m, m per m). By trial."""

_SPREAD_STEP_M = 0.5
"""The step for which they hold; offsets and heights grow with longer ones."""

_FIRST_REACH_M = (0.30, 0.20)
"""Offset and height about a click within which the shape is looked for: how far clicks miss. By
trial."""

_LOST_REACH_M, _LOST_PER_M, _MOST_LOST_M = (0.05, 0.04), (0.02, 0.015), (0.24, 0.16)
"""The same where the shape wasn't seen: at first, more for each metre (m per m), and at most. By
trial, the trajectory leads the line on so far off."""

_FIRST_TURNS = np.radians([0.0, -8.0, 8.0])
"""Directions tried about the one given, which is mostly the vehicle's and not the curb's."""

_FIRST_LOOKS = 2
"""Times that a start is refined from where it was found; by trial."""

_MIRROR_GAIN = 0.1
"""By which a mirrored template has to score more: symmetrical ones stay as drawn. By trial."""

_CLEARLY = 0.01
"""By which a turned start has to score more; by trial."""

_LONG_LOST_M = 1.0
"""Where the shape wasn't seen for so long, the next section must show it, too; by trial."""

_MOST_STEPS = 200_000
"""Of a walk in one direction, 100 km: a line that finds no end."""

_NEAR_START_M, _BACK_STEPS = 10.0, 1.5
"""A line is back where it began after so many metres at least, and within so many steps."""

_KEPT_TILT = 0.5
"""Of the tilt before, in what is expected next; the rest is the fitted one's. By trial."""


@dataclass(frozen=True)
class FitSettings:
    """How a template is followed.

    Attributes
    ----------
    step_m : float
        From one section to the next: half a metre follows curves of any road.
    width_m : float
        Thickness of a section: of a scanner that turns 100 times a second, at 60 km/h, four
        revolutions.
    tolerance_m : float
        0: the template's own.
    least_score : float
        Below it a section doesn't show the template; by trial.
    longest_gap_m : float
        A line goes on over this without its shape: a parked car.
    search_m : float
        So far beyond its end the shape is looked for again, as another line: over an entrance or
        a mouth of a street. With 25 m it led into a side street, where it made 42 m of a wrong
        line.
    stretch_m : float
        Length of street that is read at a time; what is found doesn't depend on it.
    """

    step_m: float = 0.5
    width_m: float = 0.75
    tolerance_m: float = 0.0
    least_score: float = 0.7
    longest_gap_m: float = 5.0
    search_m: float = 15.0
    stretch_m: float = STRETCH_M


@dataclass(frozen=True)
class TemplatePath:
    """Where a template lies along the street, in the order of the direction it was drawn in.

    Attributes
    ----------
    template : ProfileTemplate
        As it was fitted, mirrored where it lies on the other side.
    positions : (n, 3) float64
        The anchor, m, project CRS.
    headings_rad, tilts_rad, scores : (n,) float64
        Where a score is below the least one, the position is only where the line would go on.
    """

    template: ProfileTemplate
    positions: _Floats
    headings_rad: _Floats
    tilts_rad: _Floats
    scores: _Floats


@dataclass(frozen=True)
class _Step:
    frame: SectionFrame
    fit: PoseFit

    @property
    def position(self) -> _Floats:
        return self.frame.in_space(float(self.fit.pose[OFFSET]), float(self.fit.pose[HEIGHT]))

    @property
    def heading_rad(self) -> float:
        return self.frame.heading_rad - math.atan(float(self.fit.pose[TURN]))


@dataclass(frozen=True)
class FitStart:
    """Where a template lies in one section.

    Attributes
    ----------
    template : ProfileTemplate
        Mirrored where it fits only so.
    frame : SectionFrame
        On the anchor, looking along the line.
    tilt_rad, score : float
    """

    template: ProfileTemplate
    frame: SectionFrame
    tilt_rad: float
    score: float


def fit_at(
    drive: Drive,
    template: ProfileTemplate,
    frame: SectionFrame,
    settings: FitSettings,
    monitor: Monitor | None = None,
) -> FitStart:
    """The template where it was drawn: as it is, or mirrored if it fits only so.

    Raises
    ------
    Cancelled
    """
    monitor = monitor or SilentMonitor()
    as_drawn = _start_of(drive, template, frame, settings, monitor)
    if as_drawn.score > 1.0 - _MIRROR_GAIN:
        return as_drawn
    mirrored = _start_of(drive, template.mirrored(), frame, settings, monitor)
    return mirrored if mirrored.score > as_drawn.score + _MIRROR_GAIN else as_drawn


def fit_along(
    drive: Drive,
    template: ProfileTemplate,
    frame: SectionFrame,
    settings: FitSettings,
    monitor: Monitor,
) -> TemplatePath:
    """Follow a template from where it was drawn, in both directions.

    1. At the start the best position within 30 cm is looked for.
    2. Each step expects the pose of the one before, going on in the direction of the last ones,
       and moves it to where the points lie nearest to the shape.
    3. Where the score falls below the least one, the line goes on beside the trajectory while the
       shape is looked for around it.
    4. It ends where it wasn't seen for as long as it may be searched for, or where it comes back
       to its start.

    Raises
    ------
    Unsuitable
        The template isn't where it is to begin.
    Cancelled
    """
    start = fit_at(drive, template, frame, settings, monitor)
    if start.score < settings.least_score:
        raise _not_here(template, start.score)
    shape = FittableTemplate.of(start.template, settings.tolerance_m)
    found = []
    for number, direction in enumerate((-1, 1)):
        walker = _Walker(drive, shape, settings, direction)
        found.append(walker.walk(start.frame, start.tilt_rad, monitor))
        monitor.report((number + 1) / 2)
    behind, ahead = found
    begin = _Step(
        start.frame, PoseFit(np.array([0.0, 0.0, start.tilt_rad, 0.0, 0.0]), start.score, 1.0)
    )
    steps = [*behind[::-1], begin, *ahead]
    return TemplatePath(
        start.template,
        np.array([step.position for step in steps]),
        np.array([step.heading_rad for step in steps]),
        np.array([step.fit.pose[TILT] for step in steps]),
        np.array([step.fit.score for step in steps]),
    )


def _start_of(
    drive: Drive,
    template: ProfileTemplate,
    frame: SectionFrame,
    settings: FitSettings,
    monitor: Monitor,
) -> FitStart:
    """The best position about a frame, turned by up to eight degrees and looked at twice more."""
    shape = FittableTemplate.of(template, settings.tolerance_m)
    reader = SlabReader(drive, settings.width_m, shape.box(max(_FIRST_REACH_M)))
    best: FitStart | None = None
    for turn in _FIRST_TURNS.tolist():
        monitor.check()
        at = replace(frame, heading_rad=frame.heading_rad + turn)
        unknown = PosePrior(np.zeros(POSE), _SPREAD)
        slab = reader.slab(at)
        fit = search_pose(shape, slab, unknown, _FIRST_REACH_M, TILTS_RAD, monitor=monitor)
        for _ in range(_FIRST_LOOKS):
            monitor.check()
            step = _Step(at, fit)
            at = SectionFrame(step.position, step.heading_rad)
            pose = np.array([0.0, 0.0, fit.pose[TILT], 0.0, fit.pose[GRADE]])
            fit = refine_pose(shape, reader.slab(at), PosePrior(pose, _SPREAD))
        step = _Step(at, fit)
        on_line = SectionFrame(step.position, step.heading_rad)
        found = FitStart(template, on_line, float(fit.pose[TILT]), fit.score)
        best = found if best is None or found.score > best.score + _CLEARLY else best
    return best or FitStart(template, frame, 0.0, 0.0)


class _Walker:
    """One direction of a walk."""

    def __init__(
        self, drive: Drive, shape: FittableTemplate, settings: FitSettings, direction: int
    ) -> None:
        self._shape = shape
        self._settings = settings
        self._direction = direction
        box = shape.box(max(_MOST_LOST_M))
        self._reader = SlabReader(drive, settings.width_m, box, settings.stretch_m)
        self._road = RoadDirection(drive.trajectory)
        scale = max(1.0, settings.step_m / _SPREAD_STEP_M)
        self._spread = _SPREAD * np.array([scale, scale, 1.0, 1.0, 1.0])

    def walk(self, start: SectionFrame, tilt: float, monitor: Monitor) -> list[_Step]:
        direction = LineDirection(start, self._direction)
        steps: list[_Step] = []
        lost_m, settings = 0.0, self._settings
        patience = max(settings.longest_gap_m, settings.search_m)
        while len(steps) < _MOST_STEPS and lost_m <= patience:
            monitor.check()
            frame = direction.next_frame(settings.step_m, self._road, is_seen=lost_m == 0.0)
            fit = self._fit(frame, tilt, direction.grade, lost_m, monitor=monitor)
            step = _Step(frame, fit)
            fits = step.fit.score >= settings.least_score
            if fits and lost_m >= _LONG_LOST_M and not self._goes_on(direction, step):
                # What looks like the shape in one section alone is something else.
                fits, step = False, _Step(frame, replace(step.fit, score=0.0))
            steps.append(step)
            if not fits:
                lost_m += settings.step_m
                direction.go_on(frame)
                continue
            lost_m = 0.0
            tilt = _KEPT_TILT * tilt + (1.0 - _KEPT_TILT) * float(step.fit.pose[TILT])
            direction.take(step.position, step.heading_rad)
            if self._is_back(step.position, start.position, len(steps)):
                break
        return steps

    def _fit(
        self, frame: SectionFrame, tilt: float, grade: float, lost_m: float, *, monitor: Monitor
    ) -> PoseFit:
        pose = np.array([0.0, 0.0, tilt, 0.0, grade])
        expected = PosePrior(pose, self._spread)
        slab = self._reader.slab(frame, self._direction)
        fit = refine_pose(self._shape, slab, expected)
        if fit.score >= self._settings.least_score:
            return fit
        reach = tuple(
            min(most, near + more * lost_m)
            for near, more, most in zip(_LOST_REACH_M, _LOST_PER_M, _MOST_LOST_M, strict=True)
        )
        again = search_pose(self._shape, slab, expected, (reach[0], reach[1]), monitor=monitor)
        if again.score >= self._settings.least_score:
            return again
        return PoseFit(pose, max(fit.score, again.score), fit.seen)

    def _goes_on(self, direction: LineDirection, step: _Step) -> bool:
        """Whether the next section shows the shape too."""
        ahead = copy.copy(direction)
        ahead.take(step.position, step.heading_rad)
        frame = ahead.next_frame(self._settings.step_m, self._road, is_seen=True)
        pose = np.array([0.0, 0.0, step.fit.pose[TILT], 0.0, ahead.grade])
        slab = self._reader.slab(frame, self._direction)
        fit = refine_pose(self._shape, slab, PosePrior(pose, self._spread))
        return fit.score >= self._settings.least_score

    def _is_back(self, position: _Floats, start: _Floats, steps: int) -> bool:
        """Whether the line has come round to where it began."""
        step_m = self._settings.step_m
        return steps * step_m > _NEAR_START_M and math.dist(position, start) < _BACK_STEPS * step_m


def _not_here(template: ProfileTemplate, score: float) -> Unsuitable:
    return Unsuitable(
        Text(
            "The template “{name}” doesn't fit where it is to begin (score {score:.2f}).",
            "テンプレート「{name}」は開始位置の断面に合いません（スコア{score:.2f}）。",
        ).filled(name=template.name, score=score),
        Text("the start", "開始位置"),
        Text(
            "Start where the shape is seen, draw more of its bends, or raise the tolerance.",
            "形状が計測されている位置から始めるか、折れ点を含めて描き直すか、"
            "許容差を大きくしてください。",
        ),
    )
