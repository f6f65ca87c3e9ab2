"""Both edges of curbs to 5 cm: on streets of seeds that nobody looked at, and on deliveries.

``python -m processing.laboratory.accuracy.road.curb_streets --samples FOLDER…
--markdown docs/accuracy.md``. A delivery of passes that drift (``pass1.csv``, ``pass1_*.laz``, …)
is scored pass by pass with ``truth_pass1`` …, and together with ``truth_mean``.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from processing.core.arrays import Floats
from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.formats.vectors.mapped_shapes import read_mapped
from processing.laboratory.accuracy.filters.filter_tables import markdown_table
from processing.laboratory.accuracy.filters.filters import write_sections
from processing.laboratory.accuracy.road.road_scenes import found_by, options_of, worn_options_of
from processing.laboratory.simulate.requests import StreetRequest
from processing.laboratory.simulate.streets import simulate_street
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.drive import Drive
from processing.scoring.features.curb_lines import score_edges
from processing.scoring.features.mapped_features import MappedFile

TOLERANCE_M, NEAR_M = 0.05, 12.0
"""In plan; and how far from the vehicle's path lies what it passes rather than side streets."""

_CRS = "EPSG:6677"
_HEADING = "## Curbs to 5 cm"
_ABOUT = """`python -m processing.laboratory.accuracy.road.curb_streets --samples FOLDER… \
--markdown docs/accuracy.md`: both edges, 2 m sections within 5 cm, dropped curbs included. The \
own streets are of seeds that nobody had looked at (7319 was, later), worn ones with settled, \
tilted and rounded stones, a trajectory that drifts by 2 cm and heads mounted 0.02° off. Passes of \
one street are scored alone with the truth of their own drift, and together with that of their mean.
"""


class Counts(NamedTuple):
    """Sections of both edges that were found, false and missed."""

    found: int
    false: int
    missed: int

    def __str__(self) -> str:
        asked = 2 * self.found + self.false + self.missed
        share = f"{200 * self.found / asked:.1f} %" if asked else "–"
        return f"{self.found}, {self.false}, {self.missed} | {share}"


class StreetRow(NamedTuple):
    """What was found on one street: everywhere, and within `NEAR_M` of the vehicle's path."""

    name: str
    all: Counts
    near: Counts


def fresh_streets() -> dict[str, StreetRequest]:
    """The own streets, by name."""
    worn = {
        seed: replace(worn_options_of(number, seed, long_m), style=style, sensor=sensor, passes=1)
        for number, seed, long_m, style, sensor in (
            (1, 7311, 60.0, "urban", "vq450"),
            (2, 7316, 60.0, "urban", "vq250"),
            (1, 7313, 70.0, "highway", "vq250"),
            (2, 7318, 60.0, "highway", "vq450"),
        )
    }
    worn[7314] = replace(worn_options_of(2, 7314, 60.0), style="urban", sensor="lynx", passes=2)
    plain = {
        7312: replace(options_of(0, 7312, 60.0), style="urban", sensor="vq250"),
        7315: replace(options_of(1, 7315, 60.0), style="rural", sensor="vq250", passes=1),
        7317: replace(options_of(1, 7317, 60.0), style="rural", sensor="lynx", passes=1),
        7319: replace(options_of(1, 7319, 60.0), style="rural", sensor="vq450", passes=1),
    }
    return {
        f"{one.style} {one.sensor} {seed}"
        + (" worn" if one.wear else "")
        + (" twice" if one.passes > 1 else ""): one
        for seed, one in sorted({**worn, **plain}.items())
    }


def score_street(name: str, drives: Sequence[Drive], truth: MappedFile) -> StreetRow:
    """What the tool finds with its own parameters on a street that was imported."""
    edges = score_edges(found_by("curbs", drives).result, truth, TOLERANCE_M)
    path = cKDTree(
        np.vstack([one.trajectory.xyz[:, :2] for one in drives if one.trajectory is not None])
    )

    def count(within_m: float) -> Counts:
        def is_near(xyz: Floats) -> bool:
            return bool(path.query(xyz[:, :2].mean(axis=0))[0] < within_m)

        asked = [
            found
            for edge in edges.values()
            for section, found in zip(edge.asked, edge.is_found.tolist(), strict=True)
            if is_near(section.xyz)
        ]
        false = sum(
            is_near(part) for edge in edges.values() for line in edge.lines for part in line.false
        )
        return Counts(sum(asked), false, len(asked) - sum(asked))

    return StreetRow(name, count(np.inf), count(NEAR_M))


def section_of(streets: Sequence[StreetRow]) -> str:
    """The section of the page, without its heading."""
    heads = ["street", "found, false, missed", "F", f"within {NEAR_M:g} m", "F"]
    rows = [[one.name, *f"{one.all} | {one.near}".split(" | ")] for one in streets]
    return f"{_ABOUT}\n{markdown_table([heads, *rows])}\n"


def main(arguments: Sequence[str] | None = None) -> int:
    """Write the table to a page, or to standard output."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--markdown", type=Path)
    parser.add_argument("--samples", type=Path, nargs="*", default=[])
    options = parser.parse_args(arguments)
    streets = [*_own(), *(one for folder in options.samples for one in _given(folder))]
    write_sections(options.markdown, {_HEADING: section_of(streets)})
    return 0


def _own() -> Iterator[StreetRow]:
    for name, request in fresh_streets().items():
        with TemporaryDirectory(prefix="zuka-") as position:
            folder = Path(position) / "street"
            simulate_street(request, folder, SilentMonitor())
            files = sorted(folder.glob("*.laz")), sorted(folder.glob("trajectory*.csv"))
            drives = _imported(*files, Path(position) / "drives")
            yield score_street(name, drives, read_mapped(folder / "truth" / "curbs.geojson"))


def _given(folder: Path) -> Iterator[StreetRow]:
    passes = sorted(folder.glob("pass[0-9].csv"))
    with TemporaryDirectory(prefix="zuka-") as position:
        if not passes:
            files = sorted(folder.glob("*.laz")), sorted(folder.glob("trajectory*.csv"))
            drives = _imported(*files, Path(position))
            yield score_street(folder.name, drives, read_mapped(folder / "truth" / "curbs.geojson"))
            return
        every: list[Drive] = []
        for one in passes:
            files = sorted(folder.glob(f"{one.stem}_*.laz")), [one]
            drives = _imported(*files, Path(position) / one.stem)
            every += drives
            truth = read_mapped(folder / f"truth_{one.stem}" / "curbs.geojson")
            yield score_street(f"{folder.name}, {one.stem}", drives, truth)
        truth = read_mapped(folder / "truth_mean" / "curbs.geojson")
        yield score_street(f"{folder.name}, together", every, truth)


def _imported(clouds: Sequence[Path], trajectories: Sequence[Path], into: Path) -> list[Drive]:
    request = ImportRequest(tuple(clouds), tuple(trajectories), crs=_CRS)
    return [Drive(folder) for folder in import_drives(request, into, SilentMonitor())]


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())
