"""What is told of a simulation before it is made; `zuka simulate` is tested to give about that."""

from __future__ import annotations

from dataclasses import replace

import pytest

from processing.laboratory.simulate.forecast import forecast_site, forecast_street
from processing.laboratory.simulate.requests import SiteRequest, StreetRequest

SMALL = StreetRequest(length_m=20.0, pulses=300, turns_per_s=30.0, speed_km_h=30.0, images=False)


def test_points_and_time_follow_from_length_speed_and_pulses() -> None:
    told = forecast_street(SMALL)
    assert told.seconds == pytest.approx(20.0 / (30 / 3.6))
    pulses = told.seconds * 300 * 30 * 2
    assert 0.4 * pulses < told.points < pulses


def test_passes_waits_and_images_take_more() -> None:
    plain = forecast_street(SMALL)
    twice = forecast_street(replace(SMALL, passes=2))
    assert twice.points == pytest.approx(2 * plain.points, abs=1)
    assert forecast_street(replace(SMALL, stops=True)).seconds > plain.seconds
    assert forecast_street(replace(SMALL, images=True)).size > plain.size


def test_a_speed_of_nought_is_the_usual_one_of_the_style() -> None:
    slow, fast = (
        forecast_street(StreetRequest(style=style)).density for style in ("urban", "highway")
    )
    assert slow is not None
    assert fast is not None
    assert fast.survey.speed_m_s > 1.5 * slow.survey.speed_m_s
    assert fast.road[200] < slow.road[200]


def test_a_finer_site_of_more_stations_takes_more_and_has_no_density() -> None:
    coarse, fine = SiteRequest(stations=4, spacing_m=0.04), SiteRequest(stations=8, spacing_m=0.02)
    assert forecast_site(fine).points == pytest.approx(8 * forecast_site(coarse).points, rel=1e-5)
    assert forecast_site(fine).density is None
