"""Scans of a site from all its stations, column by column, in stretches that fit into memory."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.laboratory.simulate.scanning.beams import Beams
from processing.laboratory.simulate.scanning.casting import RaycastScene
from processing.laboratory.simulate.scanning.return_kernels import intensities
from processing.laboratory.simulate.scanning.returns import (
    HIGH_NOISE,
    LOW_NOISE,
    BeamHits,
    Weather,
    returns_of,
    scanner_numbers,
)
from processing.laboratory.simulate.scanning.sensors import Sensor
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats, Integers
from processing.laboratory.simulate.sites.bodies import OTHER, SiteKind
from processing.laboratory.simulate.sites.ghosts import (
    GhostSources,
    add_ghosts,
    arcs_of,
    ghosts_of,
    machines_among,
)
from processing.laboratory.simulate.sites.heights import HeightGrid
from processing.laboratory.simulate.sites.layout import GROUND, SiteLayout
from processing.laboratory.simulate.sites.movement import DustCloud, MovingThings
from processing.laboratory.simulate.sites.stations import Station

LOWEST_RAD = np.radians(-60.0)
NEAR_GROUND_M = 0.04
"""A mixed point or blade of grass within this of the ground counts as ground."""

_PULSES_AT_ONCE = 60_000
_BETWEEN_STATIONS_S = 420.0
_SPACING_AT_M = 10.0


@dataclass(frozen=True)
class TripodScanPattern:
    """How a scanner on a tripod sends its pulses.

    Attributes
    ----------
    step_rad : float
        Between columns and between rows.
    column_s, pulse_s : float
        From column to column, and from pulse to pulse within one.
    columns : int
        In a full revolution.
    """

    step_rad: float
    column_s: float
    pulse_s: float
    columns: int

    @property
    def scan_s(self) -> float:
        """How long one scan takes."""
        return self.columns * self.column_s


@dataclass(frozen=True)
class SitePoints:
    """Some points as they go into the files.

    Attributes
    ----------
    xyz : (n, 3) float64
        m, the site's frame, with the errors of the registration.
    time_s : (n,) float64
        From the beginning of the recording.
    intensity : (n,) uint16
    number, count, label : (n,) uint8
    kind : (n,) int8
    station : int
        From 1.
    """

    xyz: Floats
    time_s: Floats
    intensity: NDArray[np.uint16]
    number: NDArray[np.uint8]
    count: NDArray[np.uint8]
    label: NDArray[np.uint8]
    kind: NDArray[np.int8]
    station: int


@dataclass(frozen=True)
class SiteSurvey:
    """All that one date's recording needs.

    Attributes
    ----------
    date : str
    scene : RaycastScene
        What stands still.
    kinds : (instances + 1,) int64
        Kind of every instance, of those that move too.
    """

    seed: int
    date: str
    sensor: Sensor
    pattern: TripodScanPattern
    weather: Weather
    stations: list[Station]
    layout: SiteLayout
    scene: RaycastScene
    moving: MovingThings
    dust: list[DustCloud]
    kinds: Integers


def pattern_of(sensor: Sensor, spacing_m: float) -> TripodScanPattern:
    """The pattern of a point spacing 10 m away.

    The mirror turns as fast as it can, or more slowly where the pulses would not suffice.
    """
    columns = int(np.ceil(2 * np.pi / (spacing_m / _SPACING_AT_M)))
    turn_s = max(1.0 / sensor.turns_per_s, columns / sensor.rate_hz)
    return TripodScanPattern(2 * np.pi / columns, turn_s, turn_s / columns, columns)


def record_points(survey: SiteSurvey) -> Iterator[tuple[float, SitePoints]]:
    """Points of all stations in time order, with the share of the work that is done."""
    total = len(survey.stations)
    for number, station in enumerate(survey.stations):
        rows = _rows(survey, station)
        per_stretch = max(1, _PULSES_AT_ONCE // rows.size)
        for first in range(0, survey.pattern.columns, per_stretch):
            last = min(first + per_stretch, survey.pattern.columns)
            share = (number + last / survey.pattern.columns) / total
            yield share, _stretch(survey, number, range(first, last), rows)


def duration_s(pattern: TripodScanPattern, stations: int) -> float:
    """Of a whole recording, with the time for carrying the tripod."""
    return stations * (pattern.scan_s + _BETWEEN_STATIONS_S)


def scans_at(pattern: TripodScanPattern, stations: int) -> list[float]:
    """When the scans begin, s, with time for carrying the tripod between them."""
    return [number * (pattern.scan_s + _BETWEEN_STATIONS_S) for number in range(stations)]


def _rows(survey: SiteSurvey, station: Station) -> Floats:
    """Elevations of the rows, downwards to upwards, as far up as anything stands."""
    vertices = survey.scene.mesh.vertices
    off = vertices - station.position
    away = np.maximum(np.hypot(off[:, 0], off[:, 1]), 0.1)
    highest = float(np.arctan2(off[:, 2], away).max())
    highest = max(highest, np.radians(35.0))  # what moves or drifts by
    count = int(np.floor((min(highest, np.pi / 2) - LOWEST_RAD) / survey.pattern.step_rad)) + 1
    return np.asarray(LOWEST_RAD + np.arange(count) * survey.pattern.step_rad, np.float64)


def tripod_beams(
    pattern: TripodScanPattern,
    station: tuple[Floats, float],
    columns: range,
    rows: Floats,
    before: tuple[int, float],
) -> Beams:
    """Some columns of a scan.

    Parameters
    ----------
    station : ((3,) float64, float)
        Where the scanner stands, m, and where its first column points, rad anticlockwise from east.
    rows : (r,) float64
        Elevations, rad, downwards to upwards.
    before : (int, float)
        Pulses that were sent before this scan, and when it began, s.
    """
    (position, start_rad), (sent, start_s) = station, before
    ids = np.arange(columns.start, columns.stop)
    azimuth = np.repeat(start_rad - ids * pattern.step_rad, rows.size)
    elevation = np.tile(rows, ids.size)
    flat = np.cos(elevation)
    directions = np.column_stack(
        [flat * np.cos(azimuth), flat * np.sin(azimuth), np.sin(elevation)]
    )
    row_s = np.arange(rows.size) * pattern.pulse_s
    time_s = start_s + (ids[:, None] * pattern.column_s + row_s).ravel()
    first = sent + columns.start * rows.size
    return Beams(first, time_s, np.broadcast_to(position, directions.shape), directions)


def _stretch(survey: SiteSurvey, number: int, columns: range, rows: Floats) -> SitePoints:
    pattern, station = survey.pattern, survey.stations[number]
    beams = tripod_beams(
        pattern,
        (station.position, station.start_rad),
        columns,
        rows,
        (number * pattern.columns * rows.size, scans_at(pattern, number + 1)[-1]),
    )
    hits = survey.scene.cast(beams.origins, beams.directions)
    met = BeamHits.of(hits, survey.scene.mesh)
    survey.moving.meet(beams, met)
    random = chance(survey.seed, "scan", survey.date, number, columns.start)
    ghosts = ghosts_of(random, beams, met, (hits, survey.scene), _ghost_sources(survey, number))
    key = int(chance(survey.seed, "key", survey.date, number).integers(1, 1 << 31))
    scanner = scanner_numbers(survey.sensor, survey.pattern.columns, survey.weather)
    returns, _ = returns_of(beams, met, survey.scene, scanner, key)
    is_noise = returns.evidence < 0
    found = np.where(is_noise, int(SiteKind.GHOST), survey.kinds[returns.instance]).astype(np.int8)
    returns, kind = add_ghosts(returns, found, beams, ghosts)
    heights = survey.layout.ground.heights
    near = _is_on(heights, returns.xyz)
    returns, kind = returns.chosen(near), kind[near]
    kind, label = labels_of(returns.xyz, kind, survey.layout)
    intensity = np.empty(kind.size, np.uint16)
    intensities(returns.strength, survey.weather.damping, intensity)
    return SitePoints(
        _registered(returns.xyz, survey.stations[number]),
        returns.time_s,
        intensity,
        returns.number,
        returns.count,
        label,
        kind,
        number + 1,
    )


def _ghost_sources(survey: SiteSurvey, number: int) -> GhostSources:
    is_phase = survey.sensor.measures_by == "phase"
    arcs = arcs_of(chance(survey.seed, "arcs", survey.date, number)) if is_phase else []
    machines = machines_among(survey.layout.things)
    restless = float(np.exp(chance(survey.seed, "restless", survey.date).uniform(-0.7, 2.0)))
    return GhostSources(machines, survey.dust, arcs, survey.weather.wetness, is_phase, restless)


def labels_of(
    xyz: Floats, kind: NDArray[np.int8], layout: SiteLayout
) -> tuple[NDArray[np.int8], NDArray[np.uint8]]:
    """Kinds, blades of grass told from their ground, and class codes: 2, 1, 7 or 18.

    Parameters
    ----------
    xyz : (n, 3) float64
        The site's frame, before the errors of the registration.
    kind : (n,) int8
        Of what was hit.
    """
    heights = layout.ground.heights
    above = xyz[:, 2] - heights.height(xyz[:, 0], xyz[:, 1])
    last_row, last_column = layout.ground.material.shape
    j = np.clip(xyz[:, 1] / heights.res, 0, last_row - 1).astype(np.int64)
    i = np.clip(xyz[:, 0] / heights.res, 0, last_column - 1).astype(np.int64)
    grows = layout.ground.material[j, i] == int(Material.GRASS)
    is_blade = (kind == int(SiteKind.TERRAIN)) & grows & (above > NEAR_GROUND_M)
    kind = np.where(is_blade, int(SiteKind.GRASS), kind).astype(np.int8)
    label = np.full(kind.size, OTHER, np.uint8)
    label[kind == int(SiteKind.TERRAIN)] = GROUND
    is_ghost = kind == int(SiteKind.GHOST)
    label[kind == int(SiteKind.DUST)] = HIGH_NOISE
    label[is_ghost] = HIGH_NOISE
    label[is_ghost & (above < -NEAR_GROUND_M)] = LOW_NOISE
    label[is_ghost & (np.abs(above) <= NEAR_GROUND_M)] = GROUND
    return kind, label


def _is_on(heights: HeightGrid, xyz: Floats) -> NDArray[np.bool_]:
    """Whether points are over the site, so that truth has a height for them."""
    east, north = heights.size_m
    x, y = xyz[:, 0], xyz[:, 1]
    return np.asarray((x >= 0) & (x <= east) & (y >= 0) & (y <= north), np.bool_)


def _registered(xyz: Floats, station: Station) -> Floats:
    """Points as the registration places them: turned a little about the station, and shifted."""
    off = xyz - station.position
    return np.asarray(xyz + np.cross(station.turn, off) + station.shift, np.float64)
