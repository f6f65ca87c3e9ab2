"""Measures everything that docs/accuracy.md tells of methods, one table after another.

``python -m processing.laboratory.accuracy DATA_FOLDER --markdown docs/accuracy.md``

``DATA_FOLDER`` holds recordings whose truth is known, as folders ``street_…`` and ``earthwork…``
with LAZ files and ``truth/``, and in it, at any depth, the labelled real recordings that single
tables name. ``--pictures FOLDER`` paints what is left of errors. ``--only NAME…`` makes some tables
alone. Each runs in a process of its own: one that fails is named at the end and stops no other. All
of them take some hours.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from processing.core.output_streams import write_every_character

Inputs = Literal["none", "data", "streets", "drives", "sites", "trees", "flights"]


@dataclass(frozen=True)
class AccuracyTable:
    """A command that makes one or more sections of the page.

    Attributes
    ----------
    module : str
        Below ``processing.laboratory``.
    inputs : str
        What it is told of the data: nothing; the whole folder; streets behind ``--samples``;
        streets as they are; sites of earthwork; streets, and trees scanned by themselves; flights
        with waveforms.
    takes_page : bool
        Whether it writes into the page itself; the others are printed.
    paints : bool
        Whether it takes ``--pictures``.
    """

    module: str
    inputs: Inputs = "none"
    takes_page: bool = True
    paints: bool = False


TABLES = {
    "cameras": AccuracyTable("accuracy.camera_accuracy", "drives", takes_page=False),
    "templates": AccuracyTable("accuracy.template_accuracy", "drives", takes_page=False),
    "traces": AccuracyTable("accuracy.trace_accuracy", "drives", takes_page=False),
    "simulated": AccuracyTable("accuracy.simulated_streets"),
    "filters": AccuracyTable("accuracy.filters.filters", "data", paints=True),
    "removal": AccuracyTable("accuracy.filters.removal_study"),
    "street-ground": AccuracyTable("accuracy.filters.street_ground", "data"),
    "real-classes": AccuracyTable("accuracy.real_street_classes", "data"),
    "real-things": AccuracyTable("accuracy.real_street_things", "data"),
    "aerial-classes": AccuracyTable("accuracy.aerial_classes", "data"),
    "landscapes": AccuracyTable("accuracy.filters.landscape_ground"),
    "volumes": AccuracyTable("accuracy.site_volumes", "sites"),
    "edges": AccuracyTable("accuracy.road.road_edges", paints=True),
    "curbs": AccuracyTable("accuracy.road.curb_streets", "streets"),
    "gutters": AccuracyTable("accuracy.road.gutter_mountings", "streets"),
    "speeds": AccuracyTable("accuracy.road.speeds_and_scanners"),
    "surface-first": AccuracyTable("accuracy.road.road_surface_first"),
    "trees": AccuracyTable("accuracy.road.trees", "trees"),
    "signs": AccuracyTable("accuracy.road.signs", "streets"),
    "poles": AccuracyTable("accuracy.road.poles", "streets"),
    "ledgers": AccuracyTable("accuracy.ledgers", "streets"),
    "waveform-echoes": AccuracyTable("accuracy.waveform_echoes", "flights", takes_page=False),
    "waveform-estimates": AccuracyTable("accuracy.waveform_estimates", "flights", takes_page=False),
    "chained-classes": AccuracyTable("accuracy.archives.chained_classes", "flights"),
    "flight-ground": AccuracyTable("accuracy.archives.flight_ground", "flights"),
    "labels": AccuracyTable("accuracy.labels_against_tools", "streets"),
}
"""By name, in the order in which they are made."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Make the tables; 1 where one of them failed."""
    parser = argparse.ArgumentParser(prog="python -m processing.laboratory.accuracy")
    parser.add_argument("data", type=Path)
    parser.add_argument("--markdown", type=Path)
    parser.add_argument("--pictures", type=Path)
    parser.add_argument("--only", choices=list(TABLES), nargs="+", default=list(TABLES))
    options = parser.parse_args(arguments)
    failed = []
    for name in options.only:
        command = command_of(TABLES[name], options.data, options.markdown, options.pictures)
        begun = time.monotonic()
        status = subprocess.run(command, check=False).returncode  # noqa: S603 - our own modules
        minutes = (time.monotonic() - begun) / 60
        sys.stderr.write(f"{name}: {'made' if status == 0 else 'failed'}, {minutes:.1f} min\n")
        if status != 0:
            failed.append(name)
    if failed:
        sys.stderr.write(f"Not made: {', '.join(failed)}\n")
    return 1 if failed else 0


def command_of(
    table: AccuracyTable, data: Path, page: Path | None, pictures: Path | None
) -> list[str]:
    """The words of a table's own command."""
    words = [sys.executable, "-m", f"processing.laboratory.{table.module}"]
    words += _inputs(table.inputs, data)
    if page is not None and table.takes_page:
        words += ["--markdown", str(page)]
    if pictures is not None and table.paints:
        words += ["--pictures", str(pictures / table.module.rpartition(".")[2])]
    return words


def _inputs(inputs: Inputs, data: Path) -> Iterator[str]:
    streets = [str(one) for one in known_recordings(data, "street_")]
    if inputs == "data":
        yield str(data)
    elif inputs == "drives":
        yield from streets
    elif inputs == "flights":
        yield from (str(one.parents[1]) for one in sorted(data.glob("**/truth/beams.npz")))
    elif inputs == "sites":
        yield from ("--samples", *map(str, known_recordings(data, "earthwork")))
    elif inputs in ("streets", "trees"):
        yield from ("--samples", *streets)
    if inputs == "trees":
        yield from ("--real", *(str(one) for one in sorted(data.glob("**/trees/*.la[sz]"))))


def known_recordings(data: Path, begins: str) -> list[Path]:
    """Folders of a kind with LAZ files and a truth, in the order of their names."""
    found = sorted(data.glob(f"{begins}*"))
    return [one for one in found if (one / "truth").is_dir()]


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())
