"""Six classes of flights from points, from estimated and from real waveforms, side by side.

``python -m processing.laboratory.accuracy.archives.chained_classes [FOLDER…] --markdown
docs/accuracy.md`` makes the page's section; without ``--markdown`` it is written to standard
output. Flights of ``--seeds`` are simulated, of styles, scanners and densities as those that the
models learnt from; folders of other flights follow (``in``, ``truth``, as ``zuka simulate flight``
leaves them).

References
----------
Shinohara 2022, table 5.1.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.laboratory.accuracy.archives.archive_points import (
    ArchivePoints,
    ArchiveRequest,
    archive_points,
)
from processing.laboratory.accuracy.archives.physical_waveforms import (
    LowestSurface,
    physical_waveforms,
)
from processing.laboratory.accuracy.archives.three_inputs import (
    ALONE,
    ESTIMATED,
    REAL,
    codes_by_points,
    codes_by_waveforms,
    codes_through,
)
from processing.laboratory.accuracy.filters.filter_tables import markdown_table
from processing.laboratory.accuracy.filters.filters import write_sections
from processing.laboratory.seed_ranges import seeds_of
from processing.laboratory.simulate.airborne.flight_scene import FLIGHT_STYLES
from processing.laboratory.simulate.airborne.flight_sensors import FLIGHT_SENSORS
from processing.laboratory.simulate.flights import simulate_flight
from processing.laboratory.simulate.requests import FlightRequest
from processing.methods.classes.aerial_cells import spacing_m
from processing.methods.waveforms.estimation.known_pulse import response_of
from processing.methods.waveforms.pulse_file import read_pulse
from processing.scoring.points.confusion_matrix import ConfusionMatrix
from processing.scoring.points.six_classes import SIX, as_six_classes
from processing.tools.waveform_points import WaveformEstimateParameters, make_waveforms

HEADING = "### Classes of flights through estimated waveforms"
PHYSICAL = "physical waveforms"
INPUTS = (ALONE, PHYSICAL, ESTIMATED, REAL)
_NAMES = ("ground", "vegetation", "building", "wire", "tower", "road")
_UNSEEN = "7300-7304"
"""Flights that nothing was chosen by."""

_THINNEST, _DENSEST = 1.5, 18.0
_PULSES = 10_000
"""Of a flight, so that the table takes minutes; one of those that were learnt from has more."""

_LEARNT_PULSES = 120_000
_LEAST_M, _MOST_M = 80.0, 190.0
_SMALLEST_M = 40.0
"""Of any flight that is simulated."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Make the table."""
    parser = argparse.ArgumentParser(
        prog="python -m processing.laboratory.accuracy.archives.chained_classes"
    )
    parser.add_argument("folders", type=Path, nargs="*")
    parser.add_argument("--seeds", default=_UNSEEN)
    parser.add_argument("--pulses", type=int, default=_PULSES, help="of a simulated flight")
    parser.add_argument("--markdown", type=Path)
    options = parser.parse_args(arguments)
    rows = [["flight", "from", *_NAMES, "mean F", "first returns, least recall"]]
    sums: dict[str, list[float]] = {}
    for name, folder in drawn_flights(seeds_of(options.seeds), options.pulses, options.folders):
        for given, matrix, first in scores_of(folder):
            rows.append([name, given, *_cells(matrix, first)])
            if folder not in options.folders:
                sums.setdefault(given, []).append(matrix.mean_f)
    rows += [
        ["**mean**", one, *[""] * 6, f"{np.mean(all_f):.3f}", ""] for one, all_f in sums.items()
    ]
    write_sections(options.markdown, {HEADING: f"{_ABOUT}\n{markdown_table(rows)}"})
    return 0


def flight_order(seed: int, pulses: int = _PULSES) -> FlightRequest:
    """The flight of a seed: any style, scanner and density, a square of about so many pulses."""
    random = np.random.default_rng(seed)
    styles, sensors = list(FLIGHT_STYLES), list(FLIGHT_SENSORS)
    density = float(np.exp(random.uniform(np.log(_THINNEST), np.log(_DENSEST))))
    least_m = max(_SMALLEST_M, _LEAST_M * (pulses / _LEARNT_PULSES) ** 0.5)
    return FlightRequest(
        seed=seed,
        style=styles[seed % len(styles)],
        sensor=sensors[(seed // len(styles) + seed) % len(sensors)],
        length_m=float(np.clip((pulses / density) ** 0.5, least_m, _MOST_M)),
        density=density,
    )


def drawn_flights(
    seeds: Iterable[int], pulses: int, folders: Sequence[Path]
) -> Iterator[tuple[str, Path]]:
    """Flights by name, simulated for the time of their turn, then those of folders."""
    for seed in seeds:
        order = flight_order(seed, pulses)
        with tempfile.TemporaryDirectory(prefix="zuka-") as position:
            folder = Path(position) / "flight"
            simulate_flight(order, folder, SilentMonitor())
            yield f"{seed} {order.style} {order.sensor}, {order.density:.1f}/m²", folder
    for folder in folders:
        yield f"sample `{folder.name}`", folder


def scores_of(flight: Path) -> Iterator[tuple[str, ConfusionMatrix, ConfusionMatrix]]:
    """By each input, how the returns of a flight are classified: all, and the first of pulses."""
    with np.load(flight / "truth" / "truth.npz") as truth:
        labels = as_six_classes(truth["label"])
    request = ArchiveRequest(flight / "in" / "flight.las", density=0.0, first_only=False)
    pulse = flight / "in" / "system_pulse.csv"
    with tempfile.TemporaryDirectory(prefix="zuka-") as position:
        scratch = Path(position)
        archive = archive_points(request, scratch / "archive", labels)
        first = np.concatenate(
            [np.asarray(one.columns["return_number"]) == 1 for one in archive.drives]
        )
        for given, codes in _codes(archive, scratch / "work", pulse):
            known = archive.truth > 0
            yield (
                given,
                ConfusionMatrix.of(archive.truth[known], codes[known]),
                ConfusionMatrix.of(archive.truth[known & first], codes[known & first]),
            )


def _codes(
    archive: ArchivePoints, scratch: Path, pulse: Path
) -> Iterator[tuple[str, NDArray[np.uint8]]]:
    drives = archive.drives
    yield ALONE, codes_by_points(archive, scratch / "alone")
    asked = WaveformEstimateParameters(pulse=str(pulse))
    # The peer's points, rays and packets are those of the estimate, which takes longest.
    made = list(make_waveforms(drives, asked, SilentMonitor()))
    surface = LowestSurface(archive.xyz, spacing_m(drives))
    beams = physical_waveforms(made, surface, response_of(*read_pulse(pulse)))
    yield PHYSICAL, codes_through(archive, scratch / "physical", beams)
    yield ESTIMATED, codes_through(archive, scratch / "estimated", made)
    yield REAL, codes_by_waveforms(drives, scratch / "real")


def _cells(matrix: ConfusionMatrix, first: ConfusionMatrix) -> list[str]:
    met = [code for code in SIX if matrix.pairs((code,), matrix.codes)]
    shown = [f"{matrix.mean_f_of((code,)):.3f}" if code in met else "–" for code in SIX]
    least = min(first.against_rest((code,)).recall for code in met)
    return [*shown, f"{matrix.mean_f:.3f}", f"{least:.3f}"]


_ABOUT = """\
`python -m processing.laboratory.accuracy.archives.chained_classes WAVEFORM_SAMPLE --markdown \
docs/accuracy.md` makes this section: all returns of flights that nothing was chosen by, \
classified from points alone, through waveforms that `waveform-estimate` made of them and the \
delivered pulse, and with the recorded ones, F of each class. The physical waveforms are the \
thesis' peer, a beam of 0.3 m from above on the lowest points of cells, classified by the same \
model. The last flight is of another simulator.
"""


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())
