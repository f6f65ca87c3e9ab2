"""Classes of real streets that people labelled point by point, as a table.

``python -m processing.laboratory.accuracy.real_street_classes DATA_FOLDER --markdown
docs/accuracy.md`` makes the page's section; without ``--markdown`` it is written to standard
output. Streets are found and read as :mod:`processing.laboratory.accuracy.filters.street_ground`
does. What a data set names more finely than the program, or otherwise, is joined; what has no
counterpart counts neither way.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.laboratory.accuracy.filters.filter_tables import markdown_table
from processing.laboratory.accuracy.filters.filters import write_sections
from processing.project.importing.import_request import ImportRequest
from processing.project.importing.importing import import_drives
from processing.recording.columns.source_order import sources_of
from processing.recording.drive import Drive
from processing.tools.classify import ClassifyParameters
from processing.tools.runner import RunRequest, columns_of, run

HEADING = "### Classes of real streets"

GROUPS: Mapping[str, tuple[int, ...]] = {
    "ground": (2, 3, 11, 67),
    "building": (6,),
    "vegetation": (4, 5),
    "pole-like": (66,),
    "wire": (14,),
    "vehicle": (64,),
}
"""What the program's classes are there."""

_LABELS: Mapping[str, Mapping[str, tuple[int, ...]]] = {
    "street_oakland": {
        "ground": (1200, 1202, 1203, 1204, 1205, 1206),
        "building": (1400, 1403, 1404, 1405, 1406, 1410, 1411, 1412),
        "vegetation": (1300, 1304, 1305, 1306),
        "pole-like": (1103, 1107, 1110, 1112, 1116, 1302, 1303),
        "wire": (1100, 1101, 1102, 1105),
        "vehicle": (1500, 1501),
    },
    "street_semantic_kitti": {
        "ground": (9, 10, 11, 12, 17),
        "building": (13,),
        "vegetation": (15,),
        "pole-like": (16, 18),
        "vehicle": (1, 2, 3, 4, 5, 6, 7, 8),
    },
}
"""Walls, fences, grass, signs, lamps and what nobody named count neither way."""

_NONE = len(GROUPS)


def main(arguments: list[str]) -> int:
    """Classify and score the streets of a folder."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("data", type=Path)
    parser.add_argument("--markdown", type=Path)
    chosen = parser.parse_args(arguments)
    table = markdown_table(list(_rows(chosen.data)))
    write_sections(chosen.markdown, {HEADING: f"{_ABOUT}\n{table}"})
    return 0


def _rows(data: Path) -> Iterator[list[str]]:
    yield ["streets", "points", "mean F", *GROUPS]
    for name, labels in _LABELS.items():
        counts = np.zeros((_NONE, _NONE + 1), np.int64)
        for cloud in sorted(data.glob(f"**/{name}/*.laz")):
            with np.load(cloud.parent / "truth" / f"{cloud.stem}.npz") as truth:
                true = _groups_of(truth["label"].astype(np.int64), labels)
            said = _groups_of(_classes_of(cloud).astype(np.int64), GROUPS)
            known = true < _NONE
            np.add.at(counts, (true[known], said[known]), 1)
        if counts.any():
            yield [name, f"{counts.sum():,}", *_f_measures(counts)]


def _groups_of(codes: NDArray[np.int64], groups: Mapping[str, Sequence[int]]) -> NDArray[np.int64]:
    """(n,) the number of each one's group; the last number for what is in none."""
    numbers = list(GROUPS)
    found = np.full(codes.size, _NONE)
    for name, own in groups.items():
        found[np.isin(codes, own)] = numbers.index(name)
    return found


def _classes_of(cloud: Path) -> NDArray[np.uint8]:
    """(n,) the classes of a file's points, in its order."""
    with TemporaryDirectory(prefix="zuka-") as position:
        request = ImportRequest((cloud,))
        (folder,) = import_drives(request, Path(position) / "drives", SilentMonitor())
        drive = Drive(folder)
        asked = RunRequest("classify", drive, ClassifyParameters())
        result = run(asked, SilentMonitor(), into=Path(position) / "classes")
        found = np.array(columns_of(result)["classification"])
        _, indices = sources_of(drive.columns, drive.info.source_runs, 0, drive.count, sources=1)
    in_order = np.zeros(found.size, np.uint8)
    in_order[indices] = found
    return in_order


def _f_measures(counts: NDArray[np.int64]) -> list[str]:
    """Mean F over the groups that there are, and F of each."""
    hits = np.diagonal(counts)
    true, said = counts.sum(axis=1), counts[:, :_NONE].sum(axis=0)
    f = 2 * hits / np.maximum(true + said, 1)
    is_there = true > 0
    each = [f"{one:.3f}" if there else "–" for one, there in zip(f, is_there, strict=True)]
    return [f"{f[is_there].mean():.3f}", *each]


_ABOUT = """\
`python -m processing.laboratory.accuracy.real_street_classes DATA_FOLDER --markdown \
docs/accuracy.md` makes this section: points labelled by hand, profiles of a scanner on a car \
(Munoz and others 2009) and single scans of a spinning one (Behley and others 2019), classified \
without trajectory or times, as they are delivered; none was learnt from. Ground is ground, grass, \
roads and curbs together, vegetation low plants and crowns, pole-like poles and trunks. Walls, \
fences, grass, signs and what nobody named count neither way. Asked is a mean of .80.
"""


if __name__ == "__main__":
    write_every_character()
    sys.exit(main(sys.argv[1:]))
