"""Ledgers of trees, signs and poles as they are handed in, opened again and held against the truth.

``python -m processing.laboratory.accuracy.ledgers --samples FOLDER… --markdown docs/accuracy.md``
runs the tools on streets, puts what they find on a map, writes the ledgers as CSV, reads them as a
spreadsheet would, and compares row by row what the clerk would copy from them.
"""

from __future__ import annotations

import argparse
import csv
import math
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from itertools import chain
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from processing.core.output_streams import write_every_character
from processing.formats.ledgers.ledger_columns import TableStyle
from processing.formats.ledgers.ledger_csv import write_ledger
from processing.formats.vectors.mapped_shapes import read_mapped
from processing.laboratory.accuracy.filters.filter_tables import markdown_table
from processing.laboratory.accuracy.filters.filters import write_sections
from processing.laboratory.accuracy.road.road_scenes import (
    RoadScene,
    given_scenes,
    results_of,
    simulated_scenes,
)
from processing.laboratory.accuracy.road.signs import is_asked
from processing.map.catalogue_file import read_catalogue
from processing.map.feature import Feature
from processing.project.results.found_features import found_features
from processing.recording.drive import Drive
from processing.scoring.features import poles, signs, trees
from processing.scoring.features.mapped_features import MappedFeature, MappedFile
from processing.scoring.features.object_matches import (
    ObjectMatches,
    is_in_span,
    match_objects,
    shows_enough,
)
from processing.tools.listed.registry import TOOLS
from resources import path_of

SEEDS = (792, 793)
"""Own streets: one that is driven once, one twice."""

LENGTH_M = 60.0
_CRS = "EPSG:6677"
_HEADING = "## Ledgers of trees, signs and poles"
_ABOUT = """`python -m processing.laboratory.accuracy.ledgers --samples FOLDER… --markdown \
docs/accuracy.md`: what the tools find becomes features of the map, its ledgers are written as \
CSV and opened again; rows and true things are paired by the coordinates in the rows. What the \
points don't show is neither asked for nor held against a row. Numbers are the root mean square \
of what rows say less what is true, and the largest such difference; words are counted.
"""


@dataclass(frozen=True)
class Ledger:
    """A ledger and what is true of its rows.

    Attributes
    ----------
    tool : str
    kinds : tuple of str
        Whose ledgers are put together.
    within_m : float
        Between a row's place and the true one, in plan; of signs in space.
    columns : mapping of str to str
        The true facts that columns are held against.
    """

    tool: str
    kinds: tuple[str, ...]
    within_m: float
    columns: Mapping[str, str]


LEDGERS = (
    Ledger(
        "trees",
        ("street_tree",),
        trees.WITHIN_M,
        {"girth_m": "girth_m", "height_m": "height_m", "crown_m": "crown_m",
         "stems": "stems"},
    ),
    Ledger(
        "signs",
        ("sign",),
        signs.WITHIN_M,
        {"shape": "shape", "size_m": "size_m", "height_m": "height_m", "facing_deg": "facing_deg"},
    ),
    Ledger(
        "poles",
        ("pole", "mirror"),
        poles.WITHIN_M,
        {"type": "type", "height_m": "height_m", "diameter_m": "diameter_m"},
    ),
)  # fmt: skip

Row = Mapping[str, str]


@dataclass(frozen=True)
class CheckedLedger:
    """A ledger that was opened, and its rows beside what is true.

    Attributes
    ----------
    street : str
    ledger : Ledger
    matches : ObjectMatches
    rows : tuple of Row
        As the file has them; `MappedFeature.number` says which.
    """

    street: str
    ledger: Ledger
    matches: ObjectMatches
    rows: tuple[Row, ...]

    def cells(self) -> list[str]:
        """Of the table."""
        counts = self.matches.counts
        found = f"{counts.hits}, {counts.false_alarms}, {counts.misses}"
        told = [self._column(*one) for one in self.ledger.columns.items()]
        return [self.street, self.ledger.tool, f"{len(self.rows)}", found, "; ".join(told)]

    def pairs_of(self, column: str) -> list[tuple[str, object]]:
        """What rows say in a column, beside the truth, where both say something."""
        fact = self.ledger.columns[column]
        pairs = [
            (self.rows[one.result.number].get(column, ""), self._true(one.truth, fact))
            for one in self.matches.partners
        ]
        return [one for one in pairs if one[0] and one[1] is not None]

    def _true(self, thing: MappedFeature, fact: str) -> object:
        if (self.ledger.tool, fact) == ("poles", "type"):
            return poles.known_type(thing)
        return thing.facts.get(fact)

    def _column(self, column: str, fact: str) -> str:
        pairs = self.pairs_of(column)
        if not pairs:
            return f"{column} –"
        if isinstance(pairs[0][1], str):
            right = sum(cell == true for cell, true in pairs)
            return f"{column} {right} of {len(pairs)}"
        off = np.array([float(cell) - float(str(true)) for cell, true in pairs])
        if fact.endswith("_deg"):
            off = (off + 180.0) % 360.0 - 180.0
        return f"{column} {math.sqrt(float((off**2).mean())):.3f}, {np.abs(off).max():.3f}"


def written_rows(ledger: Ledger, drives: Sequence[Drive], folder: Path) -> tuple[Row, ...]:
    """The rows of a ledger: found, put on a map, written as CSV, and read again."""
    tool, now = TOOLS[ledger.tool], datetime.now(UTC)
    catalogue = read_catalogue(path_of("catalogue/level500.toml"))
    on_map: list[Feature] = []
    for result in results_of(ledger.tool, drives):
        names = [drive.id for drive in drives]
        found = found_features(result, tool, tool.parameters(), names, started=now, finished=now)
        on_map += found.change.added
    rows: list[Row] = []
    for kind in ledger.kinds:
        path = folder / f"ledger_{kind}.csv"
        mine = [one for one in on_map if one.kind == kind]
        write_ledger(path, mine, catalogue[kind], TableStyle(None, crs=_CRS))
        with path.open(encoding="utf-8-sig", newline="") as file:
            rows += csv.DictReader(file, strict=True)
    return (*rows,)


def checked_ledger(
    name: str, ledger: Ledger, rows: tuple[Row, ...], truth: MappedFile
) -> CheckedLedger:
    """Rows beside what is true."""
    places = [
        MappedFeature(number, "point", np.array([[float(row[one]) for one in _PLACE]]), {})
        for number, row in enumerate(rows)
    ]
    true = list(truth.features)
    asked = [_is_asked(ledger, truth, one) for one in true]
    in_space = ledger.tool == "signs"
    matches = match_objects(places, true, asked, ledger.within_m, in_space=in_space)
    return CheckedLedger(name, ledger, matches, rows)


_PLACE = ("easting_m", "northing_m", "elevation_m")


def _is_asked(ledger: Ledger, truth: MappedFile, one: MappedFeature) -> bool:
    if ledger.tool == "signs":
        return is_asked(one)
    least = {"trees": ("trunk_points", trees.LEAST_TRUNK_POINTS),
             "poles": ("points", poles.LEAST_POINTS)}[ledger.tool]  # fmt: skip
    return is_in_span(one) and shows_enough(truth, one, *least)


def checked_street(scene: RoadScene) -> Iterator[CheckedLedger]:
    """All ledgers of a street."""
    for ledger in LEDGERS:
        with TemporaryDirectory(prefix="zuka-") as folder:
            rows = written_rows(ledger, scene.drives, Path(folder))
        yield checked_ledger(scene.name, ledger, rows, read_mapped(scene.truth(ledger.tool)))


def main(arguments: Sequence[str] | None = None) -> int:
    """Write the table to a page, or to standard output."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--markdown", type=Path)
    parser.add_argument("--samples", type=Path, nargs="*", default=[])
    parser.add_argument("--seeds", type=int, nargs="*", default=list(SEEDS))
    parser.add_argument("--length", type=float, default=LENGTH_M)
    options = parser.parse_args(arguments)
    table = [["street", "ledger", "rows", "right, false, missed", "columns against the truth"]]
    streets = chain(given_scenes(options.samples), simulated_scenes(options.seeds, options.length))
    for scene in streets:
        sys.stderr.write(f"{scene.name}: {scene.points:,} points\n")
        table += [one.cells() for one in checked_street(scene)]
    write_sections(options.markdown, {_HEADING: f"{_ABOUT}\n{markdown_table(table)}"})
    return 0


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())
