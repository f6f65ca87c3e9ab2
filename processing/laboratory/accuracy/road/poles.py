"""Poles and wires against known streets: of seeds that nobody looked at, and deliveries.

``python -m processing.laboratory.accuracy.road.poles --samples FOLDER…
--markdown docs/accuracy.md``
"""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

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
from processing.scoring.features.file_scores import FileScore
from processing.scoring.features.poles import pole_score
from processing.scoring.features.wires import wire_score

_CRS = "EPSG:6677"
_HEADING = "## Poles and wires"
_SEEDS = (*(range(first, first + 4) for first in (8101, 8111, 8121)), range(8151, 8157))
_UNSEEN = range(8181, 8187)
"""Of own streets: the last ones nobody looked at before they were scored."""

_ABOUT = """`python -m processing.laboratory.accuracy.road.poles --samples FOLDER… \
--markdown docs/accuracy.md`: poles with 20 points and more that the vehicle passed, one to one \
within 0.5 m, posts of banners, shops and bus stops of the type "other"; wires by length in space \
within 5 cm, where a point shows them. Nobody looked at the own streets 8181 to 8186; the \
trajectories of worn ones drift by 2 cm, which their wires, 10 m from the vehicle, show in full.
"""


class PoleRow(NamedTuple):
    """What was found on one street."""

    street: str
    poles: FileScore
    wires: FileScore | None
    was_looked_at: bool = True


def fresh_streets() -> dict[str, StreetRequest]:
    """The own streets, by name."""
    requests = [
        _request_of(number % 4, seed)
        for seeds in (*_SEEDS, _UNSEEN)
        for number, seed in enumerate(seeds)
    ]
    return {
        f"{one.style} {one.sensor} {one.seed}" + (" worn" if one.wear else ""): one
        for one in requests
    }


def _request_of(kind: int, seed: int) -> StreetRequest:
    """One of four kinds of streets."""
    options = (worn_options_of if kind == 1 else options_of)(kind, seed, 70.0)
    style = "rural" if kind == 2 else "urban"
    sensor = ("vq250", "vq450", "lynx", "lynx")[kind]
    return replace(options, style=style, sensor=sensor, passes=1 if kind == 3 else options.passes)


def score_street(name: str, drives: Sequence[Drive], truth: Path) -> PoleRow:
    """What the tools find with their own parameters on a street that was imported."""
    poles = pole_score(found_by("poles", drives).result, read_mapped(truth / "poles.geojson"))
    path = truth / "wires.geojson"
    if not path.is_file() or not (true := read_mapped(path)).features:
        return PoleRow(name, poles, None)
    return PoleRow(name, poles, wire_score(found_by("wires", drives).result, true))


def section_of(rows: Sequence[PoleRow]) -> str:
    """The section of the page, without its heading."""
    heads = ["street", "poles found, false, missed", "F", "right type", "foot", "diameter",
             "wires found, false, missed", "F"]  # fmt: skip
    cells = [heads]
    for row in rows:
        kinds = row.poles.shares[0].share
        counts = row.poles.counts[0].counts
        cells.append(
            [
                row.street,
                f"{counts.hits}, {counts.false_alarms}, {counts.misses}",
                _f(counts.hits, counts.false_alarms, counts.misses),
                f"{kinds.hits} of {kinds.of}",
                *(_centimetres(row.poles, one) for one in ("place", "diameter")),
                *_wires(row.wires),
            ]
        )
    unseen = [row for row in rows if not row.was_looked_at]
    cells += [_sum_of("not looked at before", unseen)] if unseen else []
    cells.append(_sum_of("all", rows))
    return f"{_ABOUT}\n{markdown_table(cells)}\n"


def _sum_of(label: str, rows: Sequence[PoleRow]) -> list[str]:
    total: Counter[str] = Counter()
    for row in rows:
        kinds, counts = row.poles.shares[0].share, row.poles.counts[0].counts
        total["hits"] += counts.hits
        total["false"] += counts.false_alarms
        total["missed"] += counts.misses
        total["right"] += int(kinds.hits)
        total["typed"] += int(kinds.of)
    asked = [total[one] for one in ("hits", "false", "missed")]
    told = ", ".join(map(str, asked))
    types = f"{total['right']} of {total['typed']}"
    wires = [row.wires.counts[0].counts for row in rows if row.wires is not None]
    metres = [
        sum(getattr(one, name) for one in wires) / 10 for name in ("hits", "false_alarms", "misses")
    ]
    found = ", ".join(f"{one:.0f} m" for one in metres)
    return [label, told, _f(*asked), types, "", "", found, _f(*metres)]


def _wires(score: FileScore | None) -> list[str]:
    if score is None:
        return ["–", "–"]
    counts = score.counts[0].counts
    metres = [one / 10 for one in (counts.hits, counts.false_alarms, counts.misses)]
    return [", ".join(f"{one:.0f} m" for one in metres), _f(*metres)]


def _f(hits: float, false: float, missed: float) -> str:
    asked = 2 * hits + false + missed
    return f"{200 * hits / asked:.1f} %" if asked else "–"


def _centimetres(score: FileScore, name: str) -> str:
    """Root mean square error."""
    return f"{100 * score.errors_of(name).rms:.1f} cm"


def main(arguments: Sequence[str] | None = None) -> int:
    """Write the table to a page, or to standard output."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--markdown", type=Path)
    parser.add_argument("--samples", type=Path, nargs="*", default=[])
    options = parser.parse_args(arguments)
    rows = [*_own(), *(_given(folder) for folder in options.samples)]
    write_sections(options.markdown, {_HEADING: section_of(rows)})
    return 0


def _own() -> Iterator[PoleRow]:
    for name, request in fresh_streets().items():
        with TemporaryDirectory(prefix="zuka-") as position:
            folder = Path(position) / "street"
            simulate_street(request, folder, SilentMonitor())
            drives = _imported(folder, Path(position) / "drives")
            row = score_street(name, drives, folder / "truth")
            yield row._replace(was_looked_at=request.seed not in _UNSEEN)


def _given(folder: Path) -> PoleRow:
    with TemporaryDirectory(prefix="zuka-") as position:
        return score_street(folder.name, _imported(folder, Path(position)), folder / "truth")


def _imported(folder: Path, into: Path) -> list[Drive]:
    """All drives of a delivery; of several passes each file goes with its pass' trajectory."""
    passes: list[Path | None] = [*sorted(folder.glob("pass[0-9].csv"))]
    found: list[Drive] = []
    for one in passes or [None]:
        clouds = sorted(folder.glob(f"{one.stem}_*.laz" if one else "*.laz"))
        paths = [one] if one else sorted(folder.glob("trajectory*.csv"))
        request = ImportRequest(tuple(clouds), tuple(paths), crs=_CRS)
        part = into / (one.stem if one else "all")
        found += [Drive(path) for path in import_drives(request, part, SilentMonitor())]
    return found


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())
