"""Sensors of the program, and those that a user describes."""

from __future__ import annotations

from pathlib import Path

import pytest

from processing.core.errors import BadFile, MissingInput, OutOfRange
from processing.laboratory.simulate.scanning.sensors import SENSORS, sensor_of
from resources import path_of

_OWN = """
[[mount.mine]]
name = "rear"
source_id = 1
lever_m = [-1.0, 0.2, 0.9]
yaw_deg = 170.0
pitch_deg = -30.0

[[sensor]]
id = "mine"
name = "自社センサー"
kind = "mobile"
turns_per_s = 60.0
pulses = 900
measures_by = "pulse"
most_m = 90.0
noise_m = 0.01
exit_m = 0.01
divergence_rad = 0.002
returns = 2
mount = "mine"
"""


def _file(folder: Path, text: str) -> str:
    path = folder / "センサー.toml"
    path.write_text(text, encoding="utf-8")
    return str(path)


def test_every_mobile_sensor_has_heads_and_no_standing_one_has() -> None:
    assert all(bool(one.heads) == (one.kind == "mobile") for one in SENSORS.values())


def test_an_own_sensor_is_taken_from_its_file(tmp_path: Path) -> None:
    sensor = sensor_of("vq250", "mobile", _file(tmp_path, _OWN))
    assert sensor.pulses == 900
    assert sensor.heads[0].lever_m == (-1.0, 0.2, 0.9)


@pytest.mark.parametrize("language", ["en", "ja"])
def test_the_manuals_example_is_a_sensor(tmp_path: Path, language: str) -> None:
    page = path_of(f"manual/{language}") / "simulate.html"
    _, example = page.read_text(encoding="utf-8").split("<pre><code>")
    sensor = sensor_of("", "mobile", _file(tmp_path, example.split("</code>")[0]))
    assert sensor.name.en == "MMS-3"


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("pulses = 900", "pulses = 0"),
        ("pulses = 900", ""),
        ("pulses = 900", "pulses = 'many'"),
        ('mount = "mine"', 'mount = "other"'),
        ('mount = "mine"', ""),
        ('kind = "mobile"', 'kind = "standing"'),
        ("[[sensor]]", "[[sensor"),
        ('"pulse"', '"sonar"'),
        ("[-1.0, 0.2, 0.9]", "[-1.0, 0.2]"),
        ("[-1.0, 0.2, 0.9]", "[-1.0, 0.2, nan]"),
        ("pulses = 900", "pulses = 900.5"),
        ("pulses = 900", "pulses = 100000000000"),
        ("turns_per_s = 60.0", "turns_per_s = inf"),
        ("most_m = 90.0", "most_m = nan"),
        ("noise_m = 0.01", "noise_m = true"),
        ("exit_m = 0.01", "exit_m = -1.0"),
        ("returns = 2", "returns = 300"),
        ("source_id = 1", "source_id = 70000"),
        ("yaw_deg = 170.0", "yaw_deg = 'left'"),
        ('"rear"', "'../../rear'"),
    ],
)
def test_a_file_that_describes_none_is_told(tmp_path: Path, old: str, new: str) -> None:
    with pytest.raises(BadFile):
        sensor_of("vq250", "mobile", _file(tmp_path, _OWN.replace(old, new)))


def test_a_missing_file_and_an_unknown_name_are_told(tmp_path: Path) -> None:
    with pytest.raises(MissingInput):
        sensor_of("vq250", "mobile", str(tmp_path / "none.toml"))
    with pytest.raises(OutOfRange, match="vq250"):
        sensor_of("sonar", "mobile")
