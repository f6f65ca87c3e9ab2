"""A full-waveform flight to order: beams with divergence over a landscape, with their truth."""

from __future__ import annotations

import dataclasses
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from processing.core.monitor import Monitor
from processing.core.parameters import fill_parameters
from processing.core.text import Text
from processing.core.whole_folder import write_whole_folder
from processing.laboratory.simulate.airborne.beam_kernels import FootprintHits, cast_beams
from processing.laboratory.simulate.airborne.flight_files import ArrayArchive, Columns, WaveformFile
from processing.laboratory.simulate.airborne.flight_lines import FlightPlan, SentPulses, pulses_of
from processing.laboratory.simulate.airborne.flight_packets import PacketReturns, returns_of
from processing.laboratory.simulate.airborne.flight_scene import FlightScene, flight_scene
from processing.laboratory.simulate.airborne.flight_sensors import (
    PULSE_BEFORE_NS,
    PULSE_FILE_STEP_NS,
    PULSE_STEP_NS,
    FlightSensor,
    flight_sensor_of,
    pulse_table,
)
from processing.laboratory.simulate.airborne.landscapes import Floats
from processing.laboratory.simulate.airborne.waveform_kernels import (
    HALF_LIGHT_M_NS,
    clean_waves,
    record,
    true_echoes,
)
from processing.laboratory.simulate.requests import FlightRequest
from processing.laboratory.simulate.scanning.delivered_files import (
    CRS_NAME,
    DeliveredPoints,
    PointFile,
)
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.simulated import Simulated
from processing.laboratory.simulate.sites.delivery import write_json

_FIRST_S = 370_000_000.0  # adjusted standard GPS time
_HALF_WHITE = 0.5
_INTENSITY_OF_HALF = 30_000.0
"""Delivered for the echo of a flat target of 50 %."""

_FIRST_SAMPLE_NS, FIRST_WAVE_SAMPLES = 12.5, 160
"""Cleaned waveforms of first returns: the return's place in them, and samples of 1 ns."""

_POINT_COLUMNS: Columns = {
    "label": (np.uint8, 0),
    "beam": (np.int32, 0),
    "packet": (np.int32, 0),
    "range_m": (np.float64, 0),
    "loc_ps": (np.float64, 0),
    "rn": (np.uint8, 0),
    "nr": (np.uint8, 0),
}
_BEAM_COLUMNS: Columns = {
    "origin": (np.float64, 3),
    "direction": (np.float64, 3),
    "gps": (np.float64, 0),
    "echo_beam": (np.int32, 0),
    "echo_range": (np.float64, 0),
    "echo_energy": (np.float32, 0),
    "echo_spread": (np.float32, 0),
    "echo_lo": (np.float64, 0),
    "echo_hi": (np.float64, 0),
    "echo_class": (np.uint8, 0),
    "noise_sigma": (np.float64, 0),
}
_FIRST_COLUMNS: Columns = {
    "index": (np.int64, 0),
    "wave": (np.uint16, FIRST_WAVE_SAMPLES),
    "label": (np.uint8, 0),
}


def simulate_flight(
    request: FlightRequest, folder: Path, monitor: Monitor, sensor: FlightSensor | None = None
) -> Simulated:
    """Fly over a landscape, and write the delivery and its truth.

    Parameters
    ----------
    folder : Path
        Holds ``in`` (``flight.las`` with ``flight.wdp``, ``points.laz``, ``system_pulse.csv``) and
        ``truth`` (``truth.npz``, ``beams.npz``, ``first.npz``, ``scene.json``) afterwards; appears
        only when everything is written.
    sensor : FlightSensor, optional
        Flown in place of the one that the request names.

    Raises
    ------
    InUse
        The folder holds files already.
    OutOfRange
        A wish is not within its limits.
    MissingInput, NoSpace, BadFile
        What the operating system says; `Cancelled`.
    """
    request = fill_parameters(FlightRequest, dataclasses.asdict(request))
    sensor = sensor or flight_sensor_of(request.sensor)
    with write_whole_folder(folder) as hidden:
        for part in ("in", "truth"):
            (hidden / part).mkdir()
        monitor.report(0.0, Text("Drawing the landscape.", "地形を作成しています。"))
        scene = flight_scene(request.style, request.seed, request.length_m)
        monitor.check()
        count = _fly(_ordered(request, sensor, scene), scene, hidden, monitor)
    monitor.report(1.0)
    points = (folder / "in" / "flight.las",)
    return Simulated(folder, points, (), (), folder / "truth", CRS_NAME, count)


@dataclass(frozen=True)
class _Order:
    """A flight as it is flown; ``shift`` (3,) m moves the landscape into the reference system."""

    request: FlightRequest
    sensor: FlightSensor
    flight: FlightPlan
    shift: Floats
    scale: float


def _ordered(request: FlightRequest, sensor: FlightSensor, scene: FlightScene) -> _Order:
    flight = FlightPlan(
        request.length_m,
        request.density or sensor.density,
        request.height_m or sensor.height_m,
        float(np.median(scene.surface)),
    )
    place = chance(request.seed, "place").uniform((-30_000, -60_000), (10_000, -20_000))
    shift = np.array([*np.round(place), 40.0])
    # Power falls with the square of the range (the lidar equation of a target that fills the beam).
    scale = sensor.half_counts / _HALF_WHITE * (sensor.height_m / flight.height_m) ** 2
    return _Order(request, sensor, flight, shift, scale)


class _Files:
    """All files of a flight, open."""

    def __init__(self, order: _Order, hidden: Path, stack: ExitStack) -> None:
        offset = np.floor(order.shift / 100) * 100
        into, truth = hidden / "in", hidden / "truth"
        self.waves = stack.enter_context(WaveformFile(into / "flight.las", offset, order.sensor))
        self.points = stack.enter_context(PointFile(into / "points.laz", offset))
        self.truth = stack.enter_context(ArrayArchive(truth / "truth.npz", _POINT_COLUMNS))
        self.beams = stack.enter_context(ArrayArchive(truth / "beams.npz", _BEAM_COLUMNS))
        self.first = stack.enter_context(ArrayArchive(truth / "first.npz", _FIRST_COLUMNS))
        self.of_label = np.zeros(256, np.int64)
        self.pulses = self.packets = self.count = 0


class _Chunk(NamedTuple):
    """Pulses, what they meet, what is told of it, and the packets: (k, samples) counts."""

    pulses: SentPulses
    hits: FootprintHits
    returns: PacketReturns
    packets: np.typing.NDArray[np.float32]


def _fly(order: _Order, scene: FlightScene, hidden: Path, monitor: Monitor) -> int:
    """Send all pulses; gives how many points there are."""
    sensor, flight = order.sensor, order.flight
    random = chance(order.request.seed, "beams", sensor.id)
    expected = flight.density * flight.extent_m**2
    text = Text("Flying over the landscape.", "上空を飛行しています。")
    with ExitStack() as stack:
        files = _Files(order, hidden, stack)
        for pulses in pulses_of(sensor, flight, random):
            monitor.check()
            hits = cast_beams(
                scene,
                pulses.origin,
                pulses.direction,
                0.5e-3 * sensor.divergence_mrad,
                random.uniform(0, 2 * np.pi, len(pulses.origin)),
            )
            records = record(hits, sensor, order.scale, random)
            _write(order, files, _Chunk(pulses, hits, *returns_of(hits, records, sensor)))
            monitor.report(min(0.99, files.pulses / expected), text)
        files.beams.write(noise_sigma=[sensor.noise])
    _write_pulse(hidden / "in" / "system_pulse.csv", sensor)
    _write_scene(hidden / "truth" / "scene.json", order, files)
    return files.count


def _write(order: _Order, files: _Files, chunk: _Chunk) -> None:
    pulses, returns, shift = chunk.pulses, chunk.returns, order.shift
    direction = pulses.direction[returns.beam]
    xyz = pulses.origin[returns.beam] + returns.range_m[:, None] * direction + shift
    time = _FIRST_S + pulses.time_s
    intensity = returns.height * (_INTENSITY_OF_HALF / order.sensor.half_counts)
    points = DeliveredPoints(
        xyz,
        time[returns.beam],
        np.clip(intensity, 0, 65_535).astype(np.uint16),
        returns.number,
        returns.of_pulse,
        int(pulses.line[0]),
    )
    towards = -direction * HALF_LIGHT_M_NS / 1000.0
    ray = (returns.location_ps, towards, pulses.angle_deg[returns.beam])
    files.waves.write(points, returns.packet, ray, chunk.packets)
    files.points.write(points)
    files.truth.write(
        label=returns.label,
        beam=files.pulses + returns.beam,
        packet=files.packets + returns.packet,
        range_m=returns.range_m,
        loc_ps=returns.location_ps,
        rn=returns.number,
        nr=returns.of_pulse,
    )
    echoes = true_echoes(chunk.hits)
    files.beams.write(
        origin=pulses.origin + shift,
        direction=pulses.direction,
        gps=time,
        echo_beam=files.pulses + echoes.beam,
        echo_range=echoes.range_m,
        echo_energy=order.scale * echoes.energy,
        echo_spread=echoes.spread_m,
        echo_lo=echoes.low_m,
        echo_hi=echoes.high_m,
        echo_class=echoes.code,
    )
    first = np.flatnonzero(returns.number == 1)
    starts = returns.range_m[first] - _FIRST_SAMPLE_NS * HALF_LIGHT_M_NS
    waves = clean_waves(
        chunk.hits, returns.beam[first], starts, (order.sensor, order.scale, FIRST_WAVE_SAMPLES)
    )
    files.first.write(index=files.count + first, wave=np.rint(waves), label=returns.label[first])
    files.of_label += np.bincount(returns.label, minlength=256)
    files.pulses += len(pulses.origin)
    files.packets += len(chunk.packets)
    files.count += returns.beam.size


def _write_pulse(path: Path, sensor: FlightSensor) -> None:
    """The response to a flat target, as the maker of the scanner hands it over."""
    step = round(PULSE_FILE_STEP_NS / PULSE_STEP_NS)
    table = pulse_table(sensor)
    times = PULSE_STEP_NS * np.arange(table.size) - PULSE_BEFORE_NS
    first = round(PULSE_BEFORE_NS / PULSE_STEP_NS) % step
    lines = [
        f"{time:.2f},{value:.5f}"
        for time, value in zip(times[first::step], table[first::step], strict=True)
    ]
    path.write_text("\n".join(["time_ns,amplitude", *lines, ""]), encoding="utf-8")


def _write_scene(path: Path, order: _Order, files: _Files) -> None:
    classes = {str(code): int(files.of_label[code]) for code in np.flatnonzero(files.of_label)}
    facts = {
        "scene": "simulated flight",
        **dataclasses.asdict(order.request),
        "height_m": order.flight.height_m,
        "density": order.flight.density,
        "beams": files.pulses,
        "points": files.count,
        "packets": files.packets,
        "classes": classes,
        "pulse": order.sensor.pulse,
    }
    write_json(path, facts)
