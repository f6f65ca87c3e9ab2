"""What a request would give, told before it is fulfilled: points, room on the disk, density."""

from __future__ import annotations

import math
from dataclasses import dataclass

from processing.laboratory.simulate.airborne.flight_lines import FlightPlan, flight_seconds
from processing.laboratory.simulate.airborne.flight_sensors import flight_sensor_of
from processing.laboratory.simulate.requests import FlightRequest, SiteRequest, StreetRequest
from processing.laboratory.simulate.scanning.density import DensityMap, density_map, survey_of
from processing.laboratory.simulate.scanning.sensors import sensor_of
from processing.laboratory.simulate.sites.recording import duration_s, pattern_of
from processing.laboratory.simulate.sites.stations import count_for
from processing.laboratory.simulate.street.styles import Style, style_of

_KM_H = 3.6
_SECONDS_OF_WAITS = 8.0
# Recordings of made streets and of the sample: the rest goes to the sky or comes back too weak.
_RETURNS_PER_PULSE = 0.6  # of a street
_SITE_RETURNS_PER_PULSE = 0.3
_BYTES_PER_POINT = 9.0  # of LAZ, labels and what else is told of each
_BYTES_PER_IMAGE, _IMAGE_EVERY_M = 80_000, 10.0
_CAMERAS = 2  # one to three, by the seed
_SPACING_AT_M = 10.0
_HIGHEST_DEG, _LOWEST_DEG = 90.0, -60.0
_EPOCHS = 2
_RETURNS_PER_BEAM = 1.2  # of landscapes with trees
_BYTES_PER_RETURN = 59 + 5 + 110  # LAS point format 9, LAZ, and the truth of points and beams


@dataclass(frozen=True)
class Forecast:
    """About what a simulation gives.

    Attributes
    ----------
    points : int
    size : int
        Bytes of all files.
    seconds : float
        How long the recording would take outdoors.
    density : DensityMap or None
        Beside a vehicle; None for scans from tripods.
    """

    points: int
    size: int
    seconds: float
    density: DensityMap | None = None


def usual_speed_km_h(style: Style) -> float:
    """In the middle of what is driven on such a street."""
    return sum(style.speed_m_s) / 2 * _KM_H


def forecast_street(request: StreetRequest) -> Forecast:
    """About what a street would give.

    Raises
    ------
    OutOfRange
        There is no such sensor or style.
    """
    sensor = sensor_of(request.sensor, "mobile", request.own_sensor)
    speed = request.speed_km_h or usual_speed_km_h(style_of(request.style))
    survey = survey_of(sensor, speed, pulses=request.pulses, turns_per_s=request.turns_per_s)
    seconds = request.passes * (
        request.length_m * _KM_H / speed + request.stops * _SECONDS_OF_WAITS
    )
    rate = survey.pulses * survey.turns_per_s * len(survey.heads)
    points = round(seconds * rate * _RETURNS_PER_PULSE)
    images = (
        request.images * request.passes * _CAMERAS * math.ceil(request.length_m / _IMAGE_EVERY_M)
    )
    size = round(points * _BYTES_PER_POINT) + images * _BYTES_PER_IMAGE
    return Forecast(points, size, seconds, density_map(survey))


def forecast_site(request: SiteRequest) -> Forecast:
    """About what a site would give.

    Raises
    ------
    OutOfRange
        There is no such sensor.
    """
    sensor = sensor_of(request.sensor, "standing", request.own_sensor)
    step_deg = math.degrees(request.spacing_m / _SPACING_AT_M)
    pulses = (360.0 / step_deg) * ((_HIGHEST_DEG - _LOWEST_DEG) / step_deg)
    stations = _EPOCHS * count_for(request.length_m, request.stations)
    points = round(stations * pulses * _SITE_RETURNS_PER_PULSE)
    seconds = duration_s(pattern_of(sensor, request.spacing_m), stations)
    return Forecast(points, round(points * _BYTES_PER_POINT), seconds)


def forecast_flight(request: FlightRequest) -> Forecast:
    """About what a flight would give.

    Raises
    ------
    OutOfRange
        There is no such sensor.
    """
    sensor = flight_sensor_of(request.sensor)
    density, height_m = request.density or sensor.density, request.height_m or sensor.height_m
    pulses = request.length_m**2 * density
    points = round(pulses * _RETURNS_PER_BEAM)
    size = round(points * _BYTES_PER_RETURN + pulses * sensor.samples * sensor.bits / 8)
    flight = FlightPlan(request.length_m, density, height_m, 0.0)
    return Forecast(points, size, flight_seconds(sensor, flight))
