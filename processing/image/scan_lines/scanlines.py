"""Normalised scanlines: sections square to the vehicle's path at a constant spacing.

They are the iso-lines of the station on the triangle mesh of neighbouring pixels, so their spacing
does not depend on speed, rotation rate or mounting angle (Takahashi 2022, section 6.2).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from processing.core.arrays import Floats, Integers
from processing.core.monitor import Monitor, SilentMonitor, parts_of
from processing.core.worked_ahead import one_ahead
from processing.image.scan_lines.road_height import height_above_road
from processing.image.scan_lines.scanline_arrays import MeshLimits
from processing.image.scan_lines.scanline_mesh import SectionMesh, SectionVertices
from processing.image.scan_lines.scanline_rows import (
    PULSES_AT_ONCE,
    RowPoints,
    ScanRows,
    read_rows,
    scan_rows,
)
from processing.recording.drive import Drive
from processing.recording.passes import REACH_M, Pass, passes_of


@dataclass(frozen=True)
class ScanlineSettings:
    """How scanlines are made.

    Attributes
    ----------
    spacing_m : float
        Between sections along the vehicle's path; they lie at its multiples. The thesis doesn't say
        its own; by trial, no measurement is recorded.
    half_width_m : float
        How far to either side of the path: two lanes and a walk beyond.
    longest_edge_m : float
        Triangles with a longer edge are left out; where the vehicle advances more than two thirds
        of it between two rows, those with an edge longer than one and a half advances. By trial;
        no measurement is recorded.
    lowest_m, highest_m : float
        What lies outside of these heights about the road is left out: ditches below and walls
        beside it are kept, wires and crowns are not. By trial; no measurement is recorded.
    least_advance_m : float
        Rows are left out until the vehicle has gone so far since the last one, a fifth of the
        spacing: rows of a waiting vehicle show the same place again.
    """

    spacing_m: float = 0.10
    half_width_m: float = 15.0
    longest_edge_m: float = 0.5
    lowest_m: float = -1.5
    highest_m: float = 4.0
    least_advance_m: float = 0.02


@dataclass(frozen=True)
class Scanlines:
    """Normalised scanlines of one stretch of a pass.

    Section ``i`` has the vertices ``starts[i] … starts[i + 1] − 1``, from left to right. There is a
    section for every multiple of the spacing along the stretch; some have no vertices.

    Attributes
    ----------
    number : int
        Of the pass in the drive.
    stations_m : (s,) float64
        Along the pass, rising.
    positions : (s, 3) float64
        The path there at the height of the road, m, project CRS.
    rights : (s, 2) float64
        Unit vector in plan to the right of the path.
    starts : (s + 1,) int64
    across_m : (n,) float64
        To the right of the vehicle's path.
    height_m : (n,) float64
        Above ``positions[i, 2]``.
    is_break : (n,) bool
        Nothing was measured between the vertex before and this one; also the first of a section.
    time_s : (n,) float64
        Between those of the measured points on either side, s on the trajectory's clock.
    intensity : (n,) float32
        Likewise, as delivered.
    point : (n,) int64
        The nearer of the two measured points, by its index in the drive.
    """

    number: int
    stations_m: Floats
    positions: Floats
    rights: Floats
    starts: Integers
    across_m: Floats
    height_m: Floats
    is_break: NDArray[np.bool_]
    time_s: Floats
    intensity: NDArray[np.float32]
    point: Integers

    def section_of(self, vertices: Integers) -> Integers:
        """The section of each vertex: (k,) int64."""
        sections: Integers = np.searchsorted(self.starts, vertices, side="right") - 1
        return sections

    def xyz(self, vertices: Integers) -> Floats:
        """Where vertices are: (k, 3) float64, m, project CRS."""
        sections = self.section_of(vertices)
        across, right = self.across_m[vertices], self.rights[sections]
        shift = np.column_stack([across[:, None] * right, self.height_m[vertices]])
        positions: Floats = self.positions[sections] + shift
        return positions


@dataclass(frozen=True)
class _Asked:
    """The sections from one multiple of the spacing to another, and how much is read at once."""

    first: int
    last: int
    pulses_at_once: int = PULSES_AT_ONCE


def scanlines_of(
    drive: Drive,
    settings: ScanlineSettings,
    monitor: Monitor,
    *,
    pulses_at_once: int = PULSES_AT_ONCE,
) -> Iterator[Scanlines]:
    """The normalised scanlines of a drive, pass by pass and stretch by stretch.

    However the recording is cut into stretches, the scanlines are the same to the last bit.

    Parameters
    ----------
    pulses_at_once : int
        What is held in memory at a time, but for the sections that later rows may reach.

    Raises
    ------
    MissingInput
        The drive has no trajectory.
    Cancelled

    Notes
    -----
    1. Rows in which the vehicle has hardly gone on are left out.
    2. Neighbouring pixels of the rows make a mesh: two triangles of four filled pixels, one of
       three, none with a long edge; the last return of each pulse counts, noise doesn't.
    3. A section is where the station of the mesh, computed from the vehicle's path about the time
       of each point, is a multiple of the spacing; triangles that follow each other make it a line.

    References
    ----------
    Takahashi 2022, section 6.2.
    """
    passes = passes_of(drive)
    parts = parts_of(monitor, [vehicle_path.length_m for vehicle_path in passes])
    for vehicle_path, part in zip(passes, parts, strict=True):
        yield from scanlines_of_pass(
            drive, vehicle_path, settings, part, pulses_at_once=pulses_at_once
        )


def scanlines_of_pass(
    drive: Drive,
    vehicle_path: Pass,
    settings: ScanlineSettings,
    monitor: Monitor,
    *,
    pulses_at_once: int = PULSES_AT_ONCE,
) -> Iterator[Scanlines]:
    """The same for one of the drive's passes; sections go on beyond its ends by the half width."""
    spacing, beyond = settings.spacing_m, settings.half_width_m
    first = int(np.ceil(-beyond / spacing))
    last = int(np.floor((vehicle_path.length_m + beyond) / spacing))
    asked = _Asked(first, last, pulses_at_once)
    yield from _sections(drive, vehicle_path, settings, asked, monitor)


def scanline_through(
    drive: Drive, position: ArrayLike, settings: ScanlineSettings, time_s: float | None = None
) -> Scanlines | None:
    """The scanline nearest to a place, the same to the last bit as `scanlines_of` gives.

    Parameters
    ----------
    position : (3,) float64
        m, project CRS.
    time_s : float, optional
        When the place was measured: which of several passes is meant, and where in a bend.

    Returns
    -------
    Scanlines or None
        One section; None where no pass came by within the half width.

    Raises
    ------
    MissingInput
        The drive has no trajectory.
    """
    passed = _nearest_pass(
        passes_of(drive), np.asarray(position, dtype=np.float64), settings, time_s
    )
    if passed is None:
        return None
    vehicle_path, station = passed
    level = round(station / settings.spacing_m)
    for section in _sections(drive, vehicle_path, settings, _Asked(level, level), SilentMonitor()):
        return section
    return None


def scanlines_about(
    drive: Drive, position: ArrayLike, within_m: float, settings: ScanlineSettings
) -> Iterator[Scanlines]:
    """The scanlines about a place, so far before and behind; none as in `scanline_through`."""
    passed = _nearest_pass(passes_of(drive), np.asarray(position, dtype=np.float64), settings, None)
    if passed is None:
        return
    vehicle_path, station = passed
    level, more = round(station / settings.spacing_m), round(within_m / settings.spacing_m)
    asked = _Asked(level - more, level + more)
    yield from _sections(drive, vehicle_path, settings, asked, SilentMonitor())


def _nearest_pass(
    passes: tuple[Pass, ...], position: Floats, settings: ScanlineSettings, time_s: float | None
) -> tuple[Pass, float] | None:
    """The pass that came nearest by a place, and the station of the place."""
    nearest, found = settings.half_width_m, None
    for vehicle_path in passes:
        if time_s is not None and not vehicle_path.times[0] <= time_s <= vehicle_path.times[-1]:
            continue
        times = np.array([vehicle_path.time_nearest(position) if time_s is None else time_s])
        station, across = vehicle_path.stations_of(position[None], times)
        if abs(float(across[0])) <= nearest:
            nearest, found = abs(float(across[0])), (vehicle_path, float(station[0]))
    return found


def _sections(
    drive: Drive,
    vehicle_path: Pass,
    settings: ScanlineSettings,
    asked: _Asked,
    monitor: Monitor,
) -> Iterator[Scanlines]:
    if drive.revolutions is None:
        return
    spacing, first, last = settings.spacing_m, asked.first, asked.last
    rows = scan_rows(drive.revolutions, vehicle_path, settings.least_advance_m)
    rows = rows.between(first * spacing - REACH_M, last * spacing + REACH_M)
    if not len(rows):
        return
    height = height_above_road(drive, vehicle_path)
    band = MeshLimits(
        REACH_M,
        settings.half_width_m,
        settings.lowest_m - height,
        settings.highest_m - height,
        spacing,
        first,
        last,
        settings.longest_edge_m,
    )
    beside = vehicle_path.beside(band.half_width_m, band.lowest_m, band.highest_m)

    def read() -> Iterator[tuple[tuple[int, int], ScanRows, RowPoints]]:
        for start, end in rows.batches(asked.pulses_at_once):
            monitor.check()
            part = rows.part(start, end)
            yield (start, end), part, read_rows(drive, vehicle_path, part, rows.half_width, beside)

    mesh = SectionMesh(rows.width, band)
    for (start, end), part, points in one_ahead(read()):
        monitor.check()
        monitor.report(start / len(rows))
        mesh.add(points, part.stations_m)
        # No later point lies farther behind the vehicle than the reach.
        reached = int(np.floor((part.stations_m[-1] - REACH_M) / spacing)) - 1
        reached = last if end == len(rows) else min(reached, last)
        if reached >= first:
            vertices = mesh.finished(reached)
            sections = np.arange(first, reached + 1)
            yield _scanlines(vehicle_path, height, sections, spacing, vertices)
            first = reached + 1


def _scanlines(
    vehicle_path: Pass,
    height: float,
    sections: Integers,
    spacing: float,
    vertices: SectionVertices,
) -> Scanlines:
    stations = sections.astype(np.float64) * spacing
    positions = vehicle_path.positions_at(stations)
    positions[:, 2] -= height
    own = vertices.levels - sections[0]
    above = vertices.height + vehicle_path.origin[2] - positions[own, 2]
    return Scanlines(
        number=vehicle_path.number,
        stations_m=stations,
        positions=positions,
        rights=vehicle_path.rights_at(stations),
        starts=np.searchsorted(vertices.levels, np.append(sections, sections[-1] + 1)),
        across_m=vertices.across,
        height_m=above,
        is_break=vertices.is_break,
        time_s=vertices.time,
        intensity=vertices.intensity,
        point=vertices.point,
    )
