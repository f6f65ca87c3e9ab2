"""Scanners of any mounting: what a seed gives is a sensor that the simulator takes."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from processing.laboratory.simulate.scanning.any_mounting import any_sensor, write_sensor
from processing.laboratory.simulate.scanning.sensors import sensor_of


@pytest.mark.parametrize("seed", range(12))
def test_a_seed_gives_a_sensor_that_is_read_as_it_was_written(seed: int, tmp_path: Path) -> None:
    sensor, path = any_sensor(seed), tmp_path / "sensor.toml"

    write_sensor(sensor, path)

    read = sensor_of("", "mobile", str(path))
    assert replace(read, name=sensor.name) == sensor


def test_seeds_differ_in_all_that_a_method_might_take_for_granted() -> None:
    sensors = [any_sensor(seed) for seed in range(40)]
    heights = [one.heads[0].lever_m[2] for one in sensors]

    assert max(heights) - min(heights) > 1.5
    assert {len(one.heads) for one in sensors} == {1, 2}
    assert min(one.turns_per_s for one in sensors) < 80 < 200 < max(o.turns_per_s for o in sensors)
    assert {one.measures_by for one in sensors} == {"pulse", "phase"}
