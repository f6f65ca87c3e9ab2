"""The table of barriers, on a short expressway with guard rails on both sides."""

from __future__ import annotations

from dataclasses import replace

from processing.laboratory.accuracy.road.road_scenes import simulated_scenes
from processing.laboratory.accuracy.road_map.barriers import TABLE, section_of
from processing.laboratory.simulate.requests import StreetRequest


def _short(number: int, seed: int, length_m: float) -> StreetRequest:
    return replace(
        TABLE.request_of(number, seed, length_m),
        style="highway",
        sensor="vq250",
        pulses=900,
        turns_per_s=60.0,
        speed_km_h=30.0,
    )


def test_barriers_of_an_expressway_are_found_and_told_in_the_table() -> None:
    (row,) = TABLE.rows_of(simulated_scenes([9305], 24.0, _short))
    counts = row.score.counts_of("lines")
    assert counts.hits > 180
    assert counts.f_measure > 0.85
    assert row.score.errors_of("off").rms < 0.06
    text = section_of([row])
    assert f"| {row.street} | {counts.hits / 10:.0f} m" in text
    assert "| all |" in text
