"""Scanners on vehicles as they are met: any height, tilt, number of heads, rate and noise.

The sensors of the catalogue are mounted in two ways. A method that is judged by them alone may hold
a fact about those two for one about roads, so scenes for developing and judging draw from what is
built: bonnets, roof racks and masts, heads that look across, ahead or back.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.random import Generator

from processing.core.text import Text
from processing.laboratory.simulate.scanning.sensors import Head, Sensor
from processing.laboratory.simulate.scene.chance import chance

_UP_M = (-0.1, 1.9)
"""Of a head above the trajectory's reference point, which `simulated_passes` puts 1.7 to 2.0 m
above the road: heads of 1.6 to 3.9 m, those of the bonnet of a car and of the mast of a lorry."""

_TURNS_PER_S = (50.0, 250.0)
"""Line scanners of the last twenty years (resources/catalogue/sensors.toml)."""

_POINTS_PER_S = (200e3, 1.0e6)
"""Measured by one head: of the same."""

_PULSES = (900, 5_000)
"""In one revolution: fewer leave 7 mrad between beams, more turn slowly."""

_NOISE_M = (0.001, 0.008)
"""Standard deviation of a range: of the same, and what older ones state."""

_PHASE_SHARE, _ONE_HEAD_SHARE = 0.15, 0.5


def any_sensor(seed: int) -> Sensor:
    """A sensor with its mounting, of a seed."""
    random = chance(seed, "any mounting")
    turns = float(random.uniform(*_TURNS_PER_S))
    rate = float(np.exp(random.uniform(*np.log(_POINTS_PER_S))))
    pulses = int(np.clip(rate / turns, *_PULSES))
    is_phase = bool(random.random() < _PHASE_SHARE)
    up = float(random.uniform(*_UP_M))
    heads = _one_head(random, up) if random.random() < _ONE_HEAD_SHARE else _two_heads(random, up)
    return Sensor(
        id="any",
        name=Text.same(f"any mounting {seed}"),
        kind="mobile",
        turns_per_s=round(turns, 1),
        pulses=pulses,
        measures_by="phase" if is_phase else "pulse",
        most_m=119.0 if is_phase else 180.0,
        noise_m=round(float(np.exp(random.uniform(*np.log(_NOISE_M)))), 4),
        exit_m=round(float(random.uniform(0.002, 0.008)), 4),
        divergence_rad=round(float(random.uniform(0.0003, 0.0008)), 6),
        returns=1 if is_phase else 4,
        heads=heads,
    )


def _one_head(random: Generator, up_m: float) -> tuple[Head, ...]:
    """A head at the back or the front that looks down along the road."""
    lever = round(float(random.uniform(-2.0, 0.5)), 3), round(float(random.normal(0.0, 0.1)), 3)
    yaw = float(random.choice([0.0, 180.0])) + float(random.uniform(-45.0, 45.0))
    pitch = float(random.uniform(10.0, 45.0))
    return (Head("scan", 1, (*lever, round(up_m, 3)), round(yaw, 1), round(pitch, 1)),)


def _two_heads(random: Generator, up_m: float) -> tuple[Head, ...]:
    """Two heads that cross each other's rows, about alike."""
    back, aside = float(random.uniform(-1.5, 0.0)), float(random.uniform(0.2, 0.6))
    yaw, pitch = float(random.uniform(25.0, 65.0)), float(random.uniform(10.0, 35.0))
    heads = []
    for number, (name, side) in enumerate((("left", 1), ("right", -1)), 1):
        off = random.uniform(-5.0, 5.0, 2)
        lever = round(back, 3), round(side * aside, 3), round(up_m, 3)
        angles = round(side * (yaw + float(off[0])), 1), round(pitch + float(off[1]), 1)
        heads.append(Head(name, number, lever, *angles))
    return tuple(heads)


def write_sensor(sensor: Sensor, path: Path) -> None:
    """Write a sensor as an own file for a request (`StreetRequest.own_sensor`)."""
    lines = []
    for head in sensor.heads:
        lines += [
            "[[mount.own]]",
            f'name = "{head.name}"',
            f"source_id = {head.source_id}",
            f"lever_m = {list(head.lever_m)}",
            f"yaw_deg = {head.yaw_deg}",
            f"pitch_deg = {head.pitch_deg}",
            "",
        ]
    lines += ["[[sensor]]", f'name = "{sensor.name.en}"', 'mount = "own"']
    lines += [f'{name} = "{getattr(sensor, name)}"' for name in ("id", "kind", "measures_by")]
    numbers = ("turns_per_s", "pulses", "most_m", "noise_m", "exit_m", "divergence_rad", "returns")
    lines += [f"{name} = {getattr(sensor, name)}" for name in numbers]
    path.write_text("\n".join(lines) + "\n", "utf-8")
