"""Benchmark of the simulator: a street made, recorded and written, beside bare ray casting."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path

from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.laboratory.bench.case import BenchmarkOptions, Measurement
from processing.laboratory.bench.timing import seconds_of
from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.forecast import forecast_street
from processing.laboratory.simulate.requests import StreetRequest
from processing.laboratory.simulate.scanning.beams import Beams, ScanPattern, beams_of
from processing.laboratory.simulate.scanning.casting import RaycastScene
from processing.laboratory.simulate.scanning.sensors import sensor_of
from processing.laboratory.simulate.scanning.simulated_passes import Driving, pass_of
from processing.laboratory.simulate.scene.mesh import Mesh
from processing.laboratory.simulate.street.styles import style_of
from processing.laboratory.simulate.streets import simulate_street

_POINTS = 5_000_000
_WISHED_PER_S = 0.3e6
_SEED, _SPEED_KM_H = 11, 36.0
_LEAST_M, _LEAST_PULSES = 10.0, 50
_RAYS_AT_ONCE = 100_000


def measure_simulate(options: BenchmarkOptions) -> tuple[Measurement, ...]:
    """Points per second of a whole simulation: building, recording, truth and files.

    Beside it, in the same run, Open3D casts as many rays from the same places at the same
    triangles, all in one tree that is built before.
    """
    order = _street_of(options.limited(_POINTS))
    with tempfile.TemporaryDirectory(prefix="zuka-bench-") as name:
        # Kernels are compiled, libraries loaded.
        simulate_street(_street_of(0), Path(name) / "first", SilentMonitor())
        found = []
        began = time.process_time()
        seconds = seconds_of(
            lambda: found.append(simulate_street(order, Path(name) / "street", SilentMonitor()))
        )
        worked = time.process_time() - began
    points = found[0].count
    casting, rays = _bare_casting(order)
    row = Measurement(
        "simulate",
        Text(
            "Simulation of a street of {length:.0f} m, with truth and files",
            "延長{length:.0f}mの道路の模擬計測（正解データとファイルを含む）",
        ).filled(length=order.length_m),
        points / seconds / 1e6,
        "M points/s",
        _WISHED_PER_S / 1e6,
        is_at_most=False,
        detail=(
            f"{points:,} points in {seconds:.1f} s, {worked:.1f} s of the cores' time; "
            f"Open3D alone casts the {rays:,} rays in {casting:.1f} s"
        ),
        figures={
            "points": points,
            "zuka_s": seconds,
            "zuka_cpu_s": worked,
            "open3d_casting_s": casting,
            "rays": rays,
        },
    )
    return (row,)


def _street_of(points: int) -> StreetRequest:
    """A street in a town that gives about so many points."""
    short = StreetRequest(
        seed=_SEED, length_m=_LEAST_M, speed_km_h=_SPEED_KM_H, pulses=_LEAST_PULSES, images=False
    )
    usual = sensor_of(short.sensor, "mobile").pulses
    least = forecast_street(short).points * usual / _LEAST_PULSES
    length_m = max(_LEAST_M, _LEAST_M * points / least)
    pulses = round(usual * min(1.0, points / least))
    return StreetRequest(
        seed=_SEED,
        length_m=length_m,
        speed_km_h=_SPEED_KM_H,
        pulses=max(_LEAST_PULSES, pulses),
        images=False,
    )


def _bare_casting(order: StreetRequest) -> tuple[float, int]:
    """Seconds for casting all rays of a street at all its triangles, and how many they are."""
    street = Street(order.seed, style_of(order.style), order.length_m)
    mesh = Mesh.joined(street.section(row).mesh for row in range(len(street.plans)))
    scene = RaycastScene(mesh, street.alignment.at(order.length_m / 2, 0.0, 0.0))
    seconds, rays = 0.0, 0
    for beams in _rays(street, order):
        seconds += seconds_of(partial(scene.cast, beams.origins, beams.directions))
        rays += beams.time_s.size
    return seconds, rays


def _rays(street: Street, order: StreetRequest) -> Iterator[Beams]:
    sensor = sensor_of(order.sensor, "mobile")
    driven = pass_of(street, 0, Driving(order.speed_km_h / 3.6, order.stops, order.drift_m))
    scan_pattern = ScanPattern(order.pulses, sensor.turns_per_s, 0.0)
    pulses = int(driven.duration_s * scan_pattern.rate_hz)
    for head in sensor.heads:
        for first in range(0, pulses, _RAYS_AT_ONCE):
            yield beams_of(
                driven, head, scan_pattern, range(first, min(pulses, first + _RAYS_AT_ONCE))
            )
