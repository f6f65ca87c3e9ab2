"""Waveforms estimated from points alone, against those of flights whose truth is known.

``python -m processing.laboratory.accuracy.waveform_estimates [FOLDER...] [--seeds 960-962]``

Flights over several landscapes by several scanners are simulated with seeds that nothing was
chosen on; folders of another flight (``in``, ``truth``, as ``zuka simulate flight`` leaves them)
follow. The tool sees ``in/points.laz`` and ``in/system_pulse.csv``.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import laspy
import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.laboratory.progress_lines import say
from processing.laboratory.seed_ranges import seeds_of
from processing.laboratory.simulate.airborne.flight_scene import FLIGHT_STYLES
from processing.laboratory.simulate.airborne.flight_sensors import FLIGHT_SENSORS
from processing.laboratory.simulate.flights import simulate_flight
from processing.laboratory.simulate.requests import FlightRequest
from processing.methods.waveforms.estimation.known_pulse import response_of
from processing.methods.waveforms.estimation.packet_inputs import SystemResponse
from processing.methods.waveforms.estimation.pulse_returns import SAMPLES
from processing.methods.waveforms.pulse_file import read_pulse
from processing.project.importing.import_request import ImportRequest
from processing.project.importing.importing import import_drives
from processing.recording.drive import Drive
from processing.scoring.waveforms.wave_errors import (
    WaveError,
    best_constant,
    constant_error,
    wave_error,
)
from processing.tools.waveform_points import WaveformEstimateParameters, make_waveforms

_LENGTH_M = 60.0
_MOST_OF_A_CLASS = 3_000
"""First returns that are scored: the mean of a class is then known to a hundredth or two."""

_PS_IN_NS = 1000.0
_LOW_PLANTS, _PLANTS = 4, 5
_COLUMNS = ("zero", "constant", "plain", "estimated", "by plain", "positions", "by constant")


class _Truth(NamedTuple):
    """First returns to be scored: their points in the file, waveforms, counts, and classes."""

    points: Integers
    waves: Floats
    label: NDArray[np.uint8]


class _Waves(NamedTuple):
    """Estimates for the first returns of a truth, in one unit: plain ones and the tool's."""

    plain: Floats
    estimated: Floats


def main(arguments: Sequence[str] | None = None) -> int:
    """Print a line for each flight."""
    parser = argparse.ArgumentParser(
        prog="python -m processing.laboratory.accuracy.waveform_estimates"
    )
    parser.add_argument("folders", nargs="*", type=Path)
    parser.add_argument("--seeds", default="960-962")
    options = parser.parse_args(arguments)
    say(f"| flight | {' | '.join(_COLUMNS)} | plain, then estimated, of classes |")
    say("|---|" + "---|" * (len(_COLUMNS) + 1))
    styles, sensors = sorted(FLIGHT_STYLES), sorted(FLIGHT_SENSORS)
    for seed in seeds_of(options.seeds):
        style, sensor = styles[seed % len(styles)], sensors[seed % len(sensors)]
        with tempfile.TemporaryDirectory() as folder:
            request = FlightRequest(seed=seed, length_m=_LENGTH_M, style=style, sensor=sensor)
            simulate_flight(request, Path(folder) / "flight", SilentMonitor())
            say(_line(f"{style} {seed}, {sensor}", Path(folder) / "flight"))
    for delivered in options.folders:
        say(_line(f"sample `{delivered.name}`", delivered))
    return 0


def _line(name: str, flight: Path) -> str:
    truth = _truth(flight)
    zero = constant_error(np.zeros(SAMPLES), truth.waves, truth.label).mean
    typical = best_constant(truth.waves, truth.label)
    constant = constant_error(typical, truth.waves, truth.label).mean
    both = _estimates(flight, truth.points, "all")
    plain, own = (wave_error(waves, truth.waves, truth.label) for waves in both)
    alone = _estimates(flight, truth.points, "positions").estimated
    positions = wave_error(alone, truth.waves, truth.label).mean
    values = (zero, constant, plain.mean, own.mean, own.mean / plain.mean)
    cells = [*values, positions, positions / constant]
    return f"| {name} | {' | '.join(f'{one:.3f}' for one in cells)} | {_classes(plain, own)} |"


def _classes(plain: WaveError, own: WaveError) -> str:
    return ", ".join(
        f"{code}: {plain.of_class[code]:.2f} {own.of_class[code]:.2f}" for code in plain.of_class
    )


def _truth(flight: Path) -> _Truth:
    with np.load(flight / "truth" / "first.npz") as first:
        index, waves, label = first["index"], first["wave"], first["label"].astype(np.uint8)
    label[label == _LOW_PLANTS] = _PLANTS
    random = np.random.default_rng(0)
    parts = [random.permutation(np.flatnonzero(label == one)) for one in np.unique(label)]
    some = np.sort(np.concatenate([part[:_MOST_OF_A_CLASS] for part in parts]))
    return _Truth(index[some].astype(np.int64), waves[some].astype(np.float64), label[some])


def _estimates(flight: Path, points: Integers, inputs: str) -> _Waves:
    """Plain and estimated waveforms at points of ``points.laz``, in intensities."""
    pulse = flight / "in" / "system_pulse.csv"
    asked = WaveformEstimateParameters(pulse=str(pulse), inputs=inputs)
    cloud = laspy.read(flight / "in" / "points.laz")
    keys, plain, estimated = [], [], []
    response = response_of(*read_pulse(pulse))
    with tempfile.TemporaryDirectory() as folder:
        request = ImportRequest((flight / "in" / "points.laz",))
        made = import_drives(request, Path(folder) / "drives", SilentMonitor())
        for part in make_waveforms(tuple(map(Drive, made)), asked, SilentMonitor()):
            if part.packets is None:
                continue
            packet, columns = part.packets.packet, part.columns
            keys.append(np.stack([columns["time"], columns["return_number"]]))
            light = np.asarray(columns["intensity"], np.float64)
            place_ns = np.asarray(part.packets.location_ps, np.float64) / _PS_IN_NS
            first = np.asarray(columns["return_number"]) == 1
            plain.append(_plain(packet, place_ns, light, response)[packet[first]])
            estimated.append(part.packets.samples[packet[first]].astype(np.float32))
    # Points come back line by line in the order of time: pulse and return say which they are.
    asked_order = np.lexsort((np.asarray(cloud.return_number), np.asarray(cloud.gps_time)))
    key = np.concatenate(keys, axis=1)
    row = np.empty(len(asked_order), np.int64)
    row[asked_order] = np.lexsort((key[1], key[0]))
    chosen = (np.cumsum(key[1] == 1) - 1)[row[points]]
    return _Waves(np.concatenate(plain)[chosen], np.concatenate(estimated)[chosen])


def _plain(
    packet: Integers, place_ns: Floats, light: Floats, response: SystemResponse
) -> NDArray[np.float32]:
    """(k, SAMPLES) the pulse at each return, as high as its intensity."""
    waves = np.zeros((int(packet.max()) + 1, SAMPLES), np.float32)
    for some in np.array_split(np.arange(packet.size), max(1, packet.size // 20_000)):
        values = response.at(np.arange(SAMPLES) - place_ns[some, None]) * light[some, None]
        np.add.at(waves, packet[some], values.astype(np.float32))
    return waves


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())
