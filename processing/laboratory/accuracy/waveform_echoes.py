"""Echoes found in waveforms of flights whose truth is known.

``python -m processing.laboratory.accuracy.waveform_echoes [FOLDER...] [--seeds 900-904]``

Flights of all sensors over several landscapes are simulated with seeds that nothing was chosen on;
folders of another flight (``in``, ``truth``, as ``zuka simulate flight`` leaves them) follow.
``--pulse own`` learns the scanner's pulse from the recording in place of the delivered one.
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
from processing.methods.waveforms.decomposition import Digitiser, decompose
from processing.methods.waveforms.pulse_file import read_pulse
from processing.methods.waveforms.system_pulse import noise_of, own_pulse, system_pulse
from processing.scoring.waveforms.echo_scores import EchoScore, TrueEchoes, echo_score
from processing.scoring.waveforms.flight_scores import HALF_LIGHT_M_NS, recorded_echoes

_LENGTH_M = 60.0
_MOST = 6000
"""Packets of each flight, drawn by chance: some thousand echoes of every kind in all."""


class _Packets(NamedTuple):
    """Packets of a flight: their counts, pulse, range of the first sample and digitiser."""

    samples: NDArray[np.float32]
    beam: Integers
    first_m: Floats
    digitiser: Digitiser


def main(arguments: Sequence[str] | None = None) -> int:
    """Print a line for each flight."""
    parser = argparse.ArgumentParser(
        prog="python -m processing.laboratory.accuracy.waveform_echoes"
    )
    parser.add_argument("folders", nargs="*", type=Path)
    parser.add_argument("--seeds", default="900-904")
    parser.add_argument("--pulse", choices=("given", "own"), default="given")
    options = parser.parse_args(arguments)
    heads = ("alone", "apart", "near", "weak", "false", "split", "range_cm", "compact_cm")
    say(f"| flight | {' | '.join(heads)} |")
    say("|---|" + "---|" * len(heads))
    styles, sensors = sorted(FLIGHT_STYLES), sorted(FLIGHT_SENSORS)
    for number, seed in enumerate(seeds_of(options.seeds)):
        style, sensor = styles[number % len(styles)], sensors[number % len(sensors)]
        with tempfile.TemporaryDirectory() as folder:
            request = FlightRequest(seed=seed, length_m=_LENGTH_M, style=style, sensor=sensor)
            simulate_flight(request, Path(folder) / "flight", SilentMonitor())
            score = score_flight(Path(folder) / "flight", options.pulse)
        say(_line(f"{style} {seed}, {sensor}", score))
    for delivered in options.folders:
        say(_line(delivered.name, score_flight(delivered, options.pulse)))
    return 0


def score_flight(folder: Path, pulse: str) -> EchoScore:
    """Decompose packets of a flight and score the echoes."""
    beams = np.load(folder / "truth" / "beams.npz")
    packets = _packets(folder)
    samples = packets.samples
    lengths = np.full(len(samples), samples.shape[1], np.int32)
    noise = noise_of(samples, lengths)
    if pulse == "own":
        shape = own_pulse(samples, lengths, noise, packets.digitiser.top)
    else:
        times_ns, amplitudes = read_pulse(folder / "in" / "system_pulse.csv")
        shape = system_pulse(times_ns / packets.digitiser.interval_ns, amplitudes)
    echoes = decompose(samples, lengths, shape, noise, packets.digitiser)
    found_m = packets.first_m[echoes.row] + echoes.time_ns * HALF_LIGHT_M_NS
    order = np.lexsort((found_m, packets.beam[echoes.row]))
    pulses = packets.beam[echoes.row][order].astype(np.int64)
    return echo_score(_true_echoes(beams, packets), pulses, found_m[order])


def _packets(folder: Path) -> _Packets:
    cloud = laspy.read(folder / "in" / "flight.las")
    truth = np.load(folder / "truth" / "truth.npz")
    (described,) = (one.parsed_record for one in cloud.header.vlrs if one.record_id == 100)
    interval_ns, bits = described.temporal_sample_spacing / 1000.0, described.bits_per_sample
    _, owners = np.unique(truth["packet"], return_index=True)
    if owners.size > _MOST:
        owners = np.sort(np.random.default_rng(0).choice(owners, _MOST, replace=False))
    raw = np.fromfile(folder / "in" / "flight.wdp", np.uint8)
    size = described.number_of_samples * bits // 8
    begin = np.asarray(cloud.wavepacket_offset, np.int64)[owners]
    data = np.ascontiguousarray(raw[begin[:, None] + np.arange(size)])
    samples = data.view("<u1" if bits == 8 else "<u2").astype(np.float32)
    first_m = truth["range_m"][owners] - truth["loc_ps"][owners] / 1000.0 * HALF_LIGHT_M_NS
    digitiser = Digitiser(interval_ns, 2.0**bits - 1)
    return _Packets(samples, truth["beam"][owners].astype(np.int64), first_m, digitiser)


def _true_echoes(beams: np.lib.npyio.NpzFile, packets: _Packets) -> TrueEchoes:
    pulse, range_m = beams["echo_beam"].astype(np.int64), beams["echo_range"]
    span_m = packets.samples.shape[1] * packets.digitiser.interval_ns * HALF_LIGHT_M_NS
    recorded = recorded_echoes(pulse, range_m, packets.beam, packets.first_m, span_m)
    sigma = float(beams["noise_sigma"].ravel()[0])
    return TrueEchoes(pulse, range_m, beams["echo_spread"], beams["echo_energy"] / sigma, recorded)


def _line(name: str, score: EchoScore) -> str:
    values = [
        f"{one:.4f}" if key in _SHARES else f"{one:.2f}" for key, one in score.measures.items()
    ]
    return f"| {name} | {' | '.join(values)} |"


_SHARES = {"alone", "apart", "near", "weak", "false", "split"}


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())
