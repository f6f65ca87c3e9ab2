"""Makes the models of the six classes of flights anew and says what they reach.

``python -m processing.laboratory.class_training.flights``

Needs the extra ``train``. Flights of ``--seeds`` over all styles by all scanners, of 1.5 to 18
pulses/m², are learnt from, with their waveforms and once more as points alone; those of
``--check`` are only scored. ``--without`` names a scanner whose flights aren't learnt from.
``--folders`` are flights with truths, as ``zuka simulate flight`` leaves them, that are only
scored. ``--keep`` is a folder that simulated flights stay in. ``--score-only`` leaves the models
as they are.
"""

from __future__ import annotations

import argparse
import itertools
import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.core.scratch_arrays import nameless_array
from processing.laboratory.class_training.examples import LabelledCells, codes_of_cells
from processing.laboratory.class_training.fitting import AveragedSize, ForestSize
from processing.laboratory.class_training.two_forests import (
    FOLDS,
    ForestPlan,
    SampledCells,
    make_averaged_trees,
    make_two_forests,
)
from processing.laboratory.progress_lines import say
from processing.laboratory.seed_ranges import seeds_of
from processing.laboratory.simulate.airborne.flight_scene import FLIGHT_STYLES
from processing.laboratory.simulate.airborne.flight_sensors import FLIGHT_SENSORS
from processing.laboratory.simulate.flights import simulate_flight
from processing.laboratory.simulate.requests import FlightRequest
from processing.methods.classes.aerial_cells import spacing_m
from processing.methods.classes.class_models import (
    BARE_AGAIN,
    BARE_ALONE,
    BARE_AVERAGED,
    WAVE_AGAIN,
    WAVE_ALONE,
    WAVE_AVERAGED,
    flight_models,
)
from processing.methods.classes.drive_classes import shares_of_cells
from processing.methods.classes.flight_classes import FlightReturns
from processing.project.importing.import_request import ImportRequest
from processing.project.importing.importing import import_drives
from processing.recording.columns.source_order import sources_of
from processing.recording.drive import Drive
from processing.scoring.points.confusion_matrix import ConfusionMatrix
from processing.scoring.points.six_classes import SIX, as_six_classes

_PLANS = {
    True: ForestPlan(WAVE_ALONE, ForestSize(30, 24, 0.2), WAVE_AGAIN, ForestSize(25, 24, 0.2)),
    False: ForestPlan(BARE_ALONE, ForestSize(30, 24, 0.2), BARE_AGAIN, ForestSize(25, 24, 0.2)),
}

_AVERAGED = {True: WAVE_AVERAGED, False: BARE_AVERAGED}
_AVERAGED_SIZE = AveragedSize(trees=30, leaves=1500, asked=0.2)

_LEARNT = "7000-7020,7030-7034,7040-7069"
"""Of which the shipped models were made: on flights that weren't learnt from, twice as many gave
more than any other trees did."""

_CELLS = 700
"""Of each class and flight that are learnt from."""

_THINNEST, _DENSEST = 1.5, 18.0
"""Pulses/m²: as surveys of a whole country order them, to those of a corridor."""

_PULSES = 120_000
"""Of a flight: a square is as small as that asks."""

_LEAST_M, _MOST_M = 80.0, 190.0


@dataclass(frozen=True)
class _Cells:
    """A flight's cells and the truth of its points, with waveforms or without."""

    name: str
    cells: LabelledCells
    truth: NDArray[np.uint8]
    is_first: NDArray[np.bool_]


def main(arguments: Sequence[str] | None = None) -> int:
    """Make the models, or only score those that are there."""
    parser = argparse.ArgumentParser(prog="python -m processing.laboratory.class_training.flights")
    parser.add_argument("--seeds", default=_LEARNT, help="flights that are learnt from")
    parser.add_argument("--check", default="7100-7104", help="flights that are only scored")
    parser.add_argument("--without", default="", help="a scanner that isn't learnt from")
    parser.add_argument("--folders", type=Path, nargs="*", default=[])
    parser.add_argument("--keep", type=Path)
    parser.add_argument("--score-only", action="store_true")
    options = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory() as temporary:
        keep = options.keep or Path(temporary)
        if not options.score_only:
            seeds = seeds_of(options.seeds)
            learnt = [one for one in seeds if _order(one).sensor != options.without]
            for with_waveforms in (True, False):
                folders = [flown(one, keep) for one in learnt]
                _make(folders, Path(temporary), with_waveforms=with_waveforms)
            flight_models.cache_clear()
        say(f"| flight | input | {' | '.join(map(str, SIX))} | mean F | first returns, least |")
        say("|---|---|" + "---|" * (len(SIX) + 2))
        checked = [flown(one, keep) for one in seeds_of(options.check)] + options.folders
        for folder in checked:
            for with_waveforms in (True, False):
                for one in _cells_of(folder, with_waveforms=with_waveforms):
                    say(_score_line(one, with_waveforms=with_waveforms))
    return 0


def _order(seed: int) -> FlightRequest:
    rng = np.random.default_rng(seed)
    styles, sensors = list(FLIGHT_STYLES), list(FLIGHT_SENSORS)
    density = float(np.exp(rng.uniform(np.log(_THINNEST), np.log(_DENSEST))))
    return FlightRequest(
        seed=seed,
        style=styles[seed % len(styles)],
        sensor=sensors[(seed // len(styles) + seed) % len(sensors)],
        length_m=float(np.clip((_PULSES / density) ** 0.5, _LEAST_M, _MOST_M)),
        density=density,
    )


def flown(seed: int, keep: Path) -> Path:
    """The folder of a seed's flight within another; it is simulated where it isn't there."""
    order = _order(seed)
    folder = keep / f"{seed}_{order.style}_{order.sensor}"
    if not folder.exists():
        simulate_flight(order, folder, SilentMonitor())
    return folder


def _cells_of(folder: Path, *, with_waveforms: bool) -> Iterator[_Cells]:
    """The cells of a flight, all its strips together."""
    with tempfile.TemporaryDirectory() as temporary:
        request = ImportRequest((folder / "in" / "flight.las",))
        made = import_drives(request, Path(temporary) / "drives", SilentMonitor())
        drives = [Drive(one) for one in made]
        labels = as_six_classes(np.load(folder / "truth" / "truth.npz")["label"])
        truth = np.concatenate([labels[_delivered(one)] for one in drives])
        first = np.concatenate([np.asarray(one.columns["return_number"][:]) for one in drives])
        scratch = Path(temporary) / "scratch"
        scratch.mkdir()
        flight = FlightReturns(drives, scratch, SilentMonitor(), uses_waveforms=with_waveforms)
        for part in flight.parts(spacing_m(drives), SilentMonitor()):
            codes = codes_of_cells(part.cells, truth[part.points])
            of = part.points[: part.own]
            labelled = LabelledCells(part.cells, codes)
            yield _Cells(folder.name, labelled, truth[of], first[of] == 1)


def _delivered(drive: Drive) -> NDArray[np.int64]:
    """(n,) which delivered point each of a drive's is."""
    _, indices = sources_of(drive.columns, drive.info.source_runs, 0, drive.count, sources=1)
    return indices


def _make(folders: Sequence[Path], scratch: Path, *, with_waveforms: bool) -> None:
    rng = np.random.default_rng(0)
    folds: list[list[SampledCells]] = [[] for _ in range(FOLDS)]
    for number, folder in enumerate(folders):
        for one in _cells_of(folder, with_waveforms=with_waveforms):
            cells = _in_file(one.cells, scratch)
            folds[number % FOLDS].append(SampledCells.of(cells, _CELLS, rng))
        say(f"learnt from {folder.name}")
    make_two_forests(folds, _PLANS[with_waveforms])
    make_averaged_trees(itertools.chain(*folds), _AVERAGED[with_waveforms], _AVERAGED_SIZE)


def _in_file(labelled: LabelledCells, scratch: Path) -> LabelledCells:
    """The same cells with their rows on disk: those of all flights are some 5 GB."""
    rows = nameless_array(scratch, np.float32, labelled.cells.rows.shape)
    rows[:] = labelled.cells.rows
    return replace(labelled, cells=replace(labelled.cells, rows=rows))


def _score_line(flight: _Cells, *, with_waveforms: bool) -> str:
    cells = flight.cells.cells
    models = flight_models(with_waveforms=with_waveforms)
    shares = shares_of_cells(cells, models, SilentMonitor())
    found = models.again.codes[shares.argmax(axis=1)][cells.cell_of[: flight.truth.size]]
    known = flight.truth > 0
    matrix = ConfusionMatrix.of(flight.truth[known], found[known])
    first = known & flight.is_first
    recalls = ConfusionMatrix.of(flight.truth[first], found[first])
    met = [code for code in SIX if (flight.truth == code).any()]
    f_of = {code: matrix.against_rest((code,)).f_measure for code in met}
    words = " | ".join(f"{f_of[code]:.3f}" if code in f_of else "–" for code in SIX)
    mean = np.mean(list(f_of.values()))
    least = min(recalls.against_rest((code,)).recall for code in met)
    by = "waveforms" if with_waveforms else "points"
    return f"| {flight.name} | {by} | {words} | {mean:.3f} | {least:.3f} |"


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())
