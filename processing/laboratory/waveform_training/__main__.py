"""Networks that estimate waveforms, made from simulated flights.

``python -m processing.laboratory.waveform_training --folder FOLDER``

Needs the extra ``train``. A flight for each of ``--seeds`` is simulated over landscapes of all
styles in turn, by scanners whose pulse, beam, noise and brightness are drawn; the last of them
(``--validation``) are only scored. ``FOLDER/all.npz`` and ``FOLDER/positions.npz`` are what
``resources/models/waveforms`` holds. Examples of flights stay in the folder and are made once.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from processing.core.output_streams import write_every_character
from processing.laboratory.progress_lines import say
from processing.laboratory.seed_ranges import seeds_of
from processing.laboratory.waveform_training.drawn_flights import examples_of_seed
from processing.laboratory.waveform_training.fitting import FitRequest, fit_network, write_network
from processing.laboratory.waveform_training.flight_examples import FlightExamples
from processing.methods.waveforms.estimation.response_network import (
    ResponseNetwork,
    read_network,
)
from processing.scoring.waveforms.wave_errors import wave_error

_WIDTHS = {"all": 24, "positions": 16}
"""Maps of the layers: positions tell less."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Make the networks, and print their errors on flights that they didn't learn from."""
    options = _parser().parse_args(arguments)
    options.folder.mkdir(parents=True, exist_ok=True)
    for kind in options.networks:
        flights = []
        for seed in seeds_of(options.seeds):
            flights.append(
                examples_of_seed(
                    options.folder, seed, options.length, options.most,
                    knows_intensity=kind == "all",
                )
            )  # fmt: skip
            say(f"{kind}: flight {seed}, {flights[-1].label.size} packets")
        learnt = flights[: max(1, len(flights) - options.validation)]
        request = FitRequest(_WIDTHS[kind], options.epochs)
        path = options.folder / f"{kind}.npz"
        write_network(fit_network(learnt, request, say), path)
        network = read_network(path)
        say(f"| {kind} | plain, counts | network, counts | share |")
        say("|---|---|---|---|")
        for seed, flight in list(zip(seeds_of(options.seeds), flights, strict=True))[len(learnt) :]:
            say(_line(seed, flight, network))
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m processing.laboratory.waveform_training")
    parser.add_argument("--folder", type=Path, required=True, help="where work is kept")
    parser.add_argument("--seeds", default="7000-7042")
    parser.add_argument("--validation", type=int, default=7, help="last flights, only scored")
    parser.add_argument("--length", type=float, default=90.0, help="m, side of each flight")
    parser.add_argument("--most", type=int, default=700, help="first returns of each class")
    parser.add_argument("--epochs", type=float, default=11.0, help="times each example is seen")
    parser.add_argument("--networks", nargs="*", default=list(_WIDTHS), choices=list(_WIDTHS))
    return parser


def _line(seed: int, flight: FlightExamples, network: ResponseNetwork) -> str:
    """Errors of a flight's examples: of the plain estimate and of the network's."""
    channels = flight.channels.astype(np.float32)
    found = network.waves(channels, flight.facts, flight.plain, flight.pulse)
    counts = flight.counts[:, None]
    plain, own = (
        wave_error(waves * counts, flight.true * counts, flight.label).mean
        for waves in (flight.plain, found)
    )
    return f"| {seed} | {plain:.3f} | {own:.3f} | {own / plain:.2f} |"


if __name__ == "__main__":
    write_every_character()
    raise SystemExit(main())
