"""Ground of real streets that people labelled point by point, as a table.

``python -m processing.laboratory.accuracy.filters.street_ground DATA_FOLDER --markdown
docs/accuracy.md`` makes the page's section; without ``--markdown`` it is written to standard
output. Streets are folders ``street_oakland`` and ``street_semantic_kitti`` with ``NAME.laz`` and
``truth/NAME.npz``, whose ``label`` holds one of the data set's own numbers a point.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.formats.points.point_codes import read_result
from processing.laboratory.accuracy.filters.filter_tables import markdown_table
from processing.laboratory.accuracy.filters.filters import write_sections
from processing.methods.ground.filters.adaptive import GroundAssumptions, find_ground

HEADING = "## Ground of real streets"


@dataclass(frozen=True)
class StreetLabels:
    """What the labels of a data set mean for the ground.

    Attributes
    ----------
    folder : str
    ground, uncounted, low, high : frozenset of int
        Ground; vegetation and what nobody named; walls, fences, shrubs and stairs; buildings and
        vehicles. All other labels are things and count in the precision alone.
    """

    folder: str
    ground: frozenset[int]
    uncounted: frozenset[int]
    low: frozenset[int]
    high: frozenset[int]


DATA_SETS = (
    StreetLabels(
        "street_oakland",
        ground=frozenset((1200, 1202, 1203, 1204, 1205, 1206)),
        uncounted=frozenset((1000, 1001, 1002, 1003, 1004, 1005, 1300, 1301, 1304, 1305)),
        low=frozenset((1207, 1306, 1401, 1402, 1407, 1408, 1409)),
        high=frozenset((1400, 1403, 1404, 1405, 1406, 1410, 1411, 1412, 1501)),
    ),
    StreetLabels(
        "street_semantic_kitti",
        ground=frozenset((9, 10, 11, 12, 17)),
        uncounted=frozenset((0, 15)),
        low=frozenset((14,)),
        high=frozenset((1, 2, 3, 4, 5, 13)),
    ),
)
"""The public halves of both; in Oakland “load bearing” is ground that one can walk on."""


def main(arguments: list[str]) -> int:
    """Score the streets of a folder."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("data", type=Path)
    parser.add_argument("--markdown", type=Path)
    chosen = parser.parse_args(arguments)
    table = markdown_table(list(_rows(chosen.data)))
    write_sections(chosen.markdown, {HEADING: f"{_ABOUT}\n{table}"})
    return 0


def _rows(data: Path) -> Iterator[list[str]]:
    yield ["street", "points", "cell (m)", "ground R", "P", "low things left", "high things left"]
    for labels in DATA_SETS:
        counts = np.zeros(7, np.int64)
        for cloud in sorted(data.glob(f"**/{labels.folder}/*.laz")):
            own, points, size_m = _counts(cloud, labels)
            counts += own
            yield [f"{labels.folder}, {cloud.stem}", f"{points:,}", f"{size_m:.2f}", *_shares(own)]
        if counts.any():
            yield [f"**{labels.folder}, all**", "", "", *_shares(counts)]


def _counts(cloud: Path, labels: StreetLabels) -> tuple[NDArray[np.int64], int, float]:
    """Ground found, ground, things taken for ground, and of low and of high ones both numbers."""
    blocks = [block.xyz for block in read_result(cloud).blocks() if block.xyz is not None]
    with np.load(cloud.parent / "truth" / f"{cloud.stem}.npz") as truth:
        label = truth["label"].astype(np.int64)
    surface = find_ground(lambda: blocks, GroundAssumptions(), SilentMonitor())
    found = np.concatenate([surface.is_ground(xyz) for xyz in blocks])
    ground, uncounted, low, high = (
        np.isin(label, list(kind))
        for kind in (labels.ground, labels.uncounted, labels.low, labels.high)
    )
    wrong = found & ~ground & ~uncounted
    masks = (found & ground, ground, wrong, found & low, low, found & high, high)
    counts = np.array([mask.sum() for mask in masks], np.int64)
    return counts, len(label), surface.grid.size_m


def _shares(counts: NDArray[np.int64]) -> list[str]:
    hits, ground, wrong, low, of_low, high, of_high = counts.tolist()
    shares = [(hits, ground, 3), (hits, hits + wrong, 3), (low, of_low, 3), (high, of_high, 3)]
    return [f"{part / whole:.{digits}f}" if whole else "–" for part, whole, digits in shares]


_ABOUT = """\
`python -m processing.laboratory.accuracy.filters.street_ground DATA_FOLDER --markdown \
docs/accuracy.md` makes this section: points labelled by hand, profiles of a scanner on a car \
(Munoz and others 2009) and single scans of a spinning one (Behley and others 2019). Vegetation \
counts neither way; low things are walls, fences, shrubs and stairs, high ones buildings and \
vehicles, each with the share of its points that became ground.
"""


if __name__ == "__main__":
    write_every_character()
    sys.exit(main(sys.argv[1:]))
