"""The six classes of flights: ground, vegetation, buildings, wires, towers and roads.

1. The ground is found as :mod:`processing.methods.ground` finds it.
2. Each return is measured in its waveform, against the recording's own pulse and ground.
3. Points are taken together in cells as wide as they lie apart, and two sets of trees say what a
   cell is: one by itself, one with what the first said around. Without waveforms another pair is
   asked, which learnt from points alone.

References
----------
Shinohara 2022, chapter 3: classes, and why waveforms and surroundings are both needed.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.errors import report_as_user_error
from processing.core.monitor import Monitor, PartMonitor
from processing.methods.classes.aerial_classes import Strips
from processing.methods.classes.class_models import flight_models
from processing.methods.classes.drive_classes import FoundClasses, shares_of_cells
from processing.methods.classes.features import REACH, ClassCells
from processing.methods.classes.flight_cells import RETURN_COLUMNS, flight_cells
from processing.methods.classes.ground_strips import RANKS
from processing.methods.ground.drive_ground import adaptive_ground
from processing.methods.ground.drive_points import DrivePoints
from processing.methods.ground.filters.adaptive import GroundAssumptions
from processing.methods.noise.tiles_of_space import TiledCloud
from processing.methods.waveforms.return_measures import (
    RETURN_MEASURES,
    PulseReference,
    pulse_reference,
    raw_measures,
    return_measures,
)
from processing.recording.drive import Drive
from processing.recording.waveforms import waveforms_of

_TILE_M = 4.0
_POINTS_PER_PART = 400_000
"""Points in memory at a time, with those around: some 600 MB with their features."""

_POINTS_AT_ONCE = 1 << 18
_GROUND = 0.25
"""Of the progress: when the ground is known."""

_SAMPLE = 40_000
"""Returns, evenly among all of a drive, that its pulse and the light of its ground are taken from.
"""

_STEPS = 6.0
"""Doublings of the intensity that are told apart."""

_MOST_RETURNS = 7.0


@dataclass(frozen=True)
class FlightPart:
    """Cells of a part of a flight.

    Attributes
    ----------
    points : (n,) int64
        Numbers among all drives' points; the first ``own`` are the part's, the others around it.
    own : int
    cells : ClassCells
    """

    points: Integers
    own: int
    cells: ClassCells


@dataclass(frozen=True)
class _Light:
    """Against what a drive's returns are told.

    ``intensity``: median of its ground; ``pulse``: its own; ``tones``: brightness of some of its
    ground's returns as :class:`FlightReturns` tells it, log2 over the median.
    """

    intensity: float
    pulse: PulseReference | None
    tones: Floats


class FlightReturns:
    """The returns of a flight's drives with their ground and waveforms.

    Parameters
    ----------
    drives : sequence of Drive
        Strips that were flown together.
    scratch : Path
        A folder for files meanwhile; the caller deletes it.
    uses_waveforms : bool
        False: they are left aside.
    """

    def __init__(
        self, drives: Sequence[Drive], scratch: Path, monitor: Monitor, *, uses_waveforms: bool
    ) -> None:
        self._drives, self._scratch = drives, scratch
        folders = [scratch / f"ground {number}" for number in range(len(drives))]
        for folder in folders:
            with report_as_user_error(folder):
                folder.mkdir()
        points = DrivePoints(tuple(drives), _POINTS_AT_ONCE, monitor)
        adaptive_ground(points, GroundAssumptions(), folders, scratch / "surface", monitor)
        self.strips = Strips(drives, folders)
        self._waveforms = [waveforms_of(one) if uses_waveforms else None for one in drives]
        self._lights = [self._light_of(number) for number in range(len(drives))]
        self.has_waveforms = any(one.pulse is not None for one in self._lights)
        tones = np.concatenate([one.tones for one in self._lights])
        self._ranks = np.quantile(tones, np.linspace(0.0, 1.0, RANKS))

    def parts(self, cell_m: float, monitor: Monitor) -> Iterator[FlightPart]:
        """Cells, a part of space at a time; noise is left out."""
        sorting, rest = PartMonitor(monitor, 0.0, 0.1), PartMonitor(monitor, 0.1, 1.0)
        strips, done = self.strips, 0
        cloud = TiledCloud(
            strips.xyz, strips.count, self._scratch / "order", _TILE_M, monitor=sorting
        )
        for part in cloud.parts(REACH * cell_m, _POINTS_PER_PART):
            rest.check()
            rest.report(done / cloud.count)
            numbers = np.concatenate([part.own, part.around])
            xyz = strips.xyz(numbers)
            asked = ~strips.are_noise(numbers) & np.isfinite(xyz).all(axis=1)
            own = int(np.count_nonzero(asked[: part.own.size]))
            if own:
                numbers, xyz = numbers[asked], xyz[asked]
                returns, measures = self._told(numbers)
                points = strips.points(numbers, xyz)
                cells = flight_cells(
                    points, returns, measures, self._ranks, cell_m=cell_m, monitor=rest
                )
                yield FlightPart(numbers, own, cells)
            done += part.own.size

    def _light_of(self, number: int) -> _Light:
        drive, waveforms = self._drives[number], self._waveforms[number]
        local = np.arange(0, drive.count, max(1, drive.count // _SAMPLE))
        xyz = drive.xyz(local)
        known = self.strips.points(local + int(self.strips.starts[number]), xyz)
        bare = known.is_ground & known.is_only
        bare = bare if bare.any() else np.ones_like(bare)
        intensity = np.asarray(drive.columns["intensity"][local], np.float64)[bare]
        light = float(np.median(intensity))
        tones = _doublings(intensity, light)
        if waveforms is None:
            return _Light(light, None, tones)
        raw = raw_measures(waveforms, local)
        pulse = pulse_reference(raw, known.is_only, known.is_ground)
        if pulse is not None:
            tones = return_measures(raw[bare], pulse)[:, 0].astype(np.float64)
        return _Light(light, pulse, tones)

    def _told(self, numbers: Integers) -> tuple[NDArray[np.float32], NDArray[np.float32] | None]:
        """What the returns of points say, and their waveforms."""
        returns = np.zeros((numbers.size, RETURN_COLUMNS), np.float32)
        measures = np.full((numbers.size, RETURN_MEASURES), np.nan, np.float32)
        measures[:] = return_measures(np.full((1, 5), np.nan), PulseReference(1, 1, 1, 1, 1))
        for number, own, local in self.strips.by_drive(numbers):
            drive, light = self._drives[number], self._lights[number]
            columns = drive.columns
            bright = np.asarray(columns["intensity"][local], np.float64)
            returns[own, 0] = _doublings(bright, light.intensity)
            returns[own, 1:] = 1.0
            if columns.has("return_number") and columns.has("number_of_returns"):
                for at, name in ((1, "return_number"), (2, "number_of_returns")):
                    returns[own, at] = np.minimum(columns[name][local], _MOST_RETURNS)
            waveforms = self._waveforms[number]
            if waveforms is not None and light.pulse is not None:
                raw = raw_measures(waveforms, local)
                measures[own] = return_measures(raw, light.pulse)
        return returns, measures if self.has_waveforms else None


def _doublings(intensity: Floats, light: float) -> Floats:
    """log2 of intensities over that of the ground."""
    found: Floats = np.clip(np.log2((intensity + 1) / (light + 1)), -_STEPS, _STEPS)
    return found


def classify_flight(
    drives: Sequence[Drive],
    found: Sequence[FoundClasses],
    scratch: Path,
    monitor: Monitor,
    *,
    cell_m: float,
    uses_waveforms: bool,
) -> bool:
    """Find the class of every point that isn't known to be noise.

    Parameters
    ----------
    found : sequence of FoundClasses
        For each drive, zero; gets classes and how sure they are.
    cell_m : float
        How far apart the points lie, as :func:`~.aerial_cells.spacing_m` tells.

    Returns
    -------
    bool
        Whether waveforms were asked.

    Raises
    ------
    OutOfRange
        Points at fewer than three positions.
    BadFile, MissingInput, NoSpace, Cancelled
    """
    finding, rest = PartMonitor(monitor, 0.0, _GROUND), PartMonitor(monitor, _GROUND, 1.0)
    flight = FlightReturns(drives, scratch, finding, uses_waveforms=uses_waveforms)
    models = flight_models(with_waveforms=flight.has_waveforms)
    for part in flight.parts(cell_m, rest):
        shares = shares_of_cells(part.cells, models, rest)
        best = shares.argmax(axis=1)
        sure = np.take_along_axis(shares, best[:, None], axis=1)[:, 0].astype(np.float32)
        of, own = part.cells.cell_of[: part.own], part.points[: part.own]
        flight.strips.give(own, models.again.codes[best][of], [one.codes for one in found])
        flight.strips.give(own, sure[of], [one.confidence for one in found])
    return flight.has_waveforms
