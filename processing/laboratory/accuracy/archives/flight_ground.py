"""Ground of flights without their waveforms, with them, and with wide echoes left out, as a table.

``python -m processing.laboratory.accuracy.archives.flight_ground [FOLDER…] --markdown
docs/accuracy.md`` makes the page's section; without ``--markdown`` it is written to standard
output. Flights of ``--seeds`` are simulated; folders of other flights follow (``in``, ``truth``,
as ``zuka simulate flight`` leaves them).

References
----------
Doneus and others 2008; Mücke 2010; Lin and Mills 2010: echo widths against low plants.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from processing.core.arrays import Floats
from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.laboratory.accuracy.archives.archive_points import (
    CLASS,
    ArchivePoints,
    ArchiveRequest,
    archive_points,
)
from processing.laboratory.accuracy.archives.chained_classes import drawn_flights
from processing.laboratory.accuracy.filters.filter_tables import markdown_table
from processing.laboratory.accuracy.filters.filters import write_sections
from processing.laboratory.seed_ranges import seeds_of
from processing.methods.ground.ground_columns import GROUND, HEIGHT
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix
from processing.tools.ground import GROUND_TOOL, GroundParameters
from processing.tools.running.run_shares import mark_all

HEADING = "### Ground of flights by their waveforms"

_UNSEEN = "7320-7329"
"""Flights that nothing was chosen by."""

_PULSES = 14_000
_GROUND, _PLANTS = (2, 11), 4
_BESIDE_M = 0.5
"""How far from a plant's return the ground beneath it is asked."""

_WIDTHS = (1.35, 1.2)
"""In widths of the narrowest echoes: past most of the ground on slopes, and past level ground."""


class GroundScore(NamedTuple):
    """How the ground of a flight was found.

    ``points`` of all returns; ``plants_m``: root mean square of its height under low plants, m.
    """

    points: BinaryConfusionMatrix
    plants_m: float


def main(arguments: Sequence[str] | None = None) -> int:
    """Make the table."""
    parser = argparse.ArgumentParser(
        prog="python -m processing.laboratory.accuracy.archives.flight_ground"
    )
    parser.add_argument("folders", type=Path, nargs="*")
    parser.add_argument("--seeds", default=_UNSEEN)
    parser.add_argument("--pulses", type=int, default=_PULSES, help="of a simulated flight")
    parser.add_argument("--markdown", type=Path)
    options = parser.parse_args(arguments)
    ways = ["points alone", "waveforms", *(f"width {one:g}" for one in _WIDTHS)]
    words = ("kappa", "total error", "under plants")
    rows = [["flight", *(f"{way}, {word}" for way in ways for word in words)]]
    figures = []
    for name, folder in drawn_flights(seeds_of(options.seeds), options.pulses, options.folders):
        scores = list(ground_scores(folder))
        found = [
            figure
            for one in scores
            for figure in (one.points.kappa, one.points.total_error, one.plants_m)
        ]
        if folder not in options.folders:
            figures.append(found)
        rows.append([name, *_shown(found)])
    if figures:
        rows.append(["**mean of the simulated**", *_shown(np.nanmean(figures, axis=0).tolist())])
    write_sections(options.markdown, {HEADING: f"{_ABOUT}\n{markdown_table(rows)}"})
    return 0


def ground_scores(flight: Path) -> Iterator[GroundScore]:
    """Without waveforms, with them, and with each of the widths."""
    with np.load(flight / "truth" / "truth.npz") as truth:
        labels = truth["label"].astype(np.uint8)
    beneath = _ground_hits(flight)
    for name, asked in (
        ("points.laz", (GroundParameters(),)),
        ("flight.las", (GroundParameters(), *(GroundParameters(widest_echo=w) for w in _WIDTHS))),
    ):
        with tempfile.TemporaryDirectory(prefix="zuka-") as position:
            scratch = Path(position)
            request = ArchiveRequest(flight / "in" / name, density=0.0, first_only=False)
            archive = archive_points(request, scratch / "archive", labels)
            for number, parameters in enumerate(asked):
                yield _score(archive, parameters, scratch / str(number), beneath)


def _ground_hits(flight: Path) -> Floats:
    """(k, 3) where beams met ground, m."""
    with np.load(flight / "truth" / "beams.npz") as beams:
        is_ground = np.isin(beams["echo_class"], _GROUND)
        beam = beams["echo_beam"][is_ground]
        along = beams["echo_range"][is_ground][:, None] * beams["direction"][beam]
        return np.asarray(beams["origin"][beam] + along, np.float64)


def _score(
    archive: ArchivePoints, parameters: GroundParameters, scratch: Path, beneath: Floats
) -> GroundScore:
    drives = archive.drives
    mark_all(GROUND_TOOL.id, drives, SilentMonitor(), into=scratch, parameters=parameters)
    codes, above = (_column(archive, name) for name in (CLASS, HEIGHT))
    matrix = BinaryConfusionMatrix.of(np.isin(archive.truth, _GROUND), codes == GROUND)
    plants = archive.truth == _PLANTS
    xyz = archive.xyz[plants]
    away, nearest = cKDTree(beneath[:, :2]).query(xyz[:, :2])
    off = (xyz[:, 2] - above[plants] - beneath[nearest, 2])[away < _BESIDE_M]
    off = off[np.isfinite(off)]
    return GroundScore(matrix, float(np.sqrt(np.mean(off**2))) if off.size else np.nan)


def _column(archive: ArchivePoints, name: str) -> NDArray[np.float64]:
    return np.concatenate([np.asarray(one.columns[name], np.float64) for one in archive.drives])


def _shown(figures: Sequence[float]) -> list[str]:
    formats = ("{:.4f}", "{:.4f}", "{:.3f} m")
    return [
        formats[number % 3].format(one) if np.isfinite(one) else "–"
        for number, one in enumerate(figures)
    ]


_ABOUT = """\
`python -m processing.laboratory.accuracy.archives.flight_ground WAVEFORM_SAMPLE --markdown \
docs/accuracy.md` makes this section: ground and roads against all other returns of flights that \
nothing was chosen by, and how far the surface lies from where beams met the ground within 0.5 m \
of returns of low plants, root mean square. *Points alone* are delivered without waveforms; with \
*waveforms* swings of the receiver are left out; *width* sets `widest_echo` as well. The last \
flight is of another simulator. Widths gain nothing over all and aren't asked unless one wants it: \
of what was taken for ground on six flights before, low plants were a hundredth at most, and \
without the wide returns the surface moves elsewhere as well, for better and for worse.
"""


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())
