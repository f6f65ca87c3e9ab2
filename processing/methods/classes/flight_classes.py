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
from processing.methods.classes.aerial_cells import last_and_only, spacing_m
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
from processing.methods.waveforms.pulse_ringing import ringing_returns
from processing.methods.waveforms.return_measures import (
    RETURN_MEASURES,
    PulseReference,
    neutral_measures,
    pulse_reference,
    raw_measures,
    return_measures,
)
from processing.recording.drive import Drive
from processing.recording.waveforms import Waveforms, waveforms_of

_TILE_M = 4.0
_POINTS_PER_PART = 400_000
"""Points in memory at a time, with those around: some 600 MB with their features."""

_POINTS_AT_ONCE = 1 << 18
_GROUND = 0.25
"""Of the progress: when the ground is known."""

_LEAST_CELL_M = 0.1
"""Finer than any flight's points lie apart, and what a cloud gets that is too small to tell."""

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
class FlightLight:
    """Against what a drive's returns are told.

    Attributes
    ----------
    intensity : float
        Median of its ground.
    pulse : PulseReference or None
        Its own; None without waveforms.
    tones : (k,) float64
        Brightness of some of its ground's returns, log2 over the median.
    """

    intensity: float
    pulse: PulseReference | None
    tones: Floats

    @classmethod
    def of(
        cls, drive: Drive, points: Integers, bare: NDArray[np.bool_], waveforms: Waveforms | None
    ) -> FlightLight:
        """The light of a drive.

        Parameters
        ----------
        points : (k,) int64
            Some of the drive's, as :func:`sampled_points` gives them.
        bare : (k,) bool
            Which of them are on the ground and their pulse's only one; all are taken where none is.
        """
        _, is_only = last_and_only(drive, points)
        known = bare & is_only
        known = known if known.any() else np.ones_like(known)
        intensity = np.asarray(drive.columns["intensity"][points], np.float64)[known]
        light = float(np.median(intensity))
        tones = _doublings(intensity, light)
        if waveforms is None:
            return cls(light, None, tones)
        raw = raw_measures(waveforms, points)
        pulse = pulse_reference(raw, is_only, bare)
        if pulse is not None:
            tones = return_measures(raw[known], pulse)[:, 0].astype(np.float64)
        return cls(light, pulse, tones)

    def told(
        self, drive: Drive, points: Integers, waveforms: Waveforms | None
    ) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
        """What the returns of points say, (n, RETURN_COLUMNS), and their waveforms.

        The latter, (n, RETURN_MEASURES), are those of bare ground where there is none.
        """
        columns = drive.columns
        returns = np.ones((points.size, RETURN_COLUMNS), np.float32)
        returns[:, 0] = _doublings(np.asarray(columns["intensity"][points], float), self.intensity)
        if columns.has("return_number") and columns.has("number_of_returns"):
            for at, name in ((1, "return_number"), (2, "number_of_returns")):
                returns[:, at] = np.minimum(columns[name][points], _MOST_RETURNS)
        if waveforms is None or self.pulse is None:
            return returns, neutral_measures(points.size)
        return returns, return_measures(raw_measures(waveforms, points), self.pulse)


def flight_cell_m(drives: Sequence[Drive]) -> float:
    """Width of the cells that points of strips which were flown together are taken together in."""
    return max(_LEAST_CELL_M, spacing_m(drives))


def sampled_points(drive: Drive) -> Integers:
    """(k,) int64: returns evenly among all, that its pulse and its light are taken from."""
    return np.arange(0, drive.count, max(1, drive.count // _SAMPLE))


def ranks_of(lights: Sequence[FlightLight]) -> Floats:
    """(RANKS,) brightness of a flight's ground, rising, in even steps of its order."""
    tones = np.concatenate([one.tones for one in lights])
    ranks: Floats = np.quantile(tones, np.linspace(0.0, 1.0, RANKS))
    return ranks


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
        swings = [ringing_returns(one, monitor) if uses_waveforms else None for one in drives]
        points = DrivePoints(tuple(drives), _POINTS_AT_ONCE, monitor, swings)
        adaptive_ground(points, GroundAssumptions(), folders, scratch / "surface", monitor)
        self.strips = Strips(drives, folders)
        self._waveforms = [waveforms_of(one) if uses_waveforms else None for one in drives]
        self._lights = [self._light_of(number) for number in range(len(drives))]
        self.has_waveforms = any(one.pulse is not None for one in self._lights)
        self._ranks = ranks_of(self._lights)

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

    def _light_of(self, number: int) -> FlightLight:
        drive = self._drives[number]
        local = sampled_points(drive)
        known = self.strips.points(local + int(self.strips.starts[number]), drive.xyz(local))
        return FlightLight.of(drive, local, known.is_ground, self._waveforms[number])

    def _told(self, numbers: Integers) -> tuple[NDArray[np.float32], NDArray[np.float32] | None]:
        """What the returns of points say, and their waveforms."""
        returns = np.empty((numbers.size, RETURN_COLUMNS), np.float32)
        measures = np.empty((numbers.size, RETURN_MEASURES), np.float32)
        for number, own, local in self.strips.by_drive(numbers):
            told = self._lights[number].told(self._drives[number], local, self._waveforms[number])
            returns[own], measures[own] = told
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
        How far apart the points lie, as :func:`flight_cell_m` tells.

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
