"""Ground of real streets that people labelled point by point, as a table.

``python -m processing.laboratory.accuracy.filters.street_ground DATA_FOLDER --markdown
docs/accuracy.md`` makes the page's section; without ``--markdown`` it is written to standard
output. Streets are folders ``street_oakland`` and ``street_semantic_kitti`` with ``NAME.laz`` and
``truth/NAME.npz``, whose ``label`` holds one of the data set's own numbers a point.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import NamedTuple

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
    ground, uncounted, high : frozenset of int
        Ground; vegetation and what nobody named; buildings and vehicles. All other labels are
        things and count in the precision alone.
    low : mapping of str to frozenset of int
        Low things, by their kind.
    """

    folder: str
    ground: frozenset[int]
    uncounted: frozenset[int]
    low: Mapping[str, frozenset[int]]
    high: frozenset[int]

    @property
    def any_low(self) -> frozenset[int]:
        """Low things of all kinds."""
        return frozenset[int]().union(*self.low.values())


class JudgedStreet(NamedTuple):
    """A street's ground as the program finds it.

    Attributes
    ----------
    name : str
    label : (n,) int64
        What each point is.
    found : (n,) bool
        Whether it became ground.
    size_m : float
        Side of a cell.
    """

    name: str
    label: NDArray[np.int64]
    found: NDArray[np.bool_]
    size_m: float


_LabelledStreets = tuple[StreetLabels, Sequence[JudgedStreet]]

DATA_SETS = (
    StreetLabels(
        "street_oakland",
        ground=frozenset((1200, 1202, 1203, 1204, 1205, 1206)),
        uncounted=frozenset((1000, 1001, 1002, 1003, 1004, 1005, 1300, 1301, 1304, 1305)),
        low={
            "walls, fences and gates": frozenset((1401, 1407, 1408, 1409)),
            "shrubs": frozenset((1306,)),
            "stairs and ledges": frozenset((1207, 1402)),
        },
        high=frozenset((1400, 1403, 1404, 1405, 1406, 1410, 1411, 1412, 1501)),
    ),
    StreetLabels(
        "street_semantic_kitti",
        ground=frozenset((9, 10, 11, 12, 17)),
        uncounted=frozenset((0, 15)),
        low={"fences": frozenset((14,))},
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
    streets = [(labels, list(_streets(chosen.data, labels))) for labels in DATA_SETS]
    tables = (markdown_table(list(rows(streets))) for rows in (_street_rows, _kind_rows))
    write_sections(chosen.markdown, {HEADING: "\n".join((_ABOUT, *tables))})
    return 0


def _streets(data: Path, labels: StreetLabels) -> Iterator[JudgedStreet]:
    for cloud in sorted(data.glob(f"**/{labels.folder}/*.laz")):
        blocks = [block.xyz for block in read_result(cloud).blocks() if block.xyz is not None]
        with np.load(cloud.parent / "truth" / f"{cloud.stem}.npz") as truth:
            label = truth["label"].astype(np.int64)
        surface = find_ground(partial(list, blocks), GroundAssumptions(), SilentMonitor())
        found = np.concatenate([surface.is_ground(xyz) for xyz in blocks])
        yield JudgedStreet(cloud.stem, label, found, surface.grid.size_m)


def _street_rows(streets: Sequence[_LabelledStreets]) -> Iterator[list[str]]:
    yield ["street", "points", "cell (m)", "ground R", "P", "low things left", "high things left"]
    for labels, own in streets:
        counts = np.zeros(7, np.int64)
        for street in own:
            of_street = _counts(street, labels)
            counts += of_street
            size = [f"{len(street.label):,}", f"{street.size_m:.2f}"]
            yield [f"{labels.folder}, {street.name}", *size, *_shares(of_street)]
        if counts.any():
            yield [f"**{labels.folder}, all**", "", "", *_shares(counts)]


def _kind_rows(streets: Sequence[_LabelledStreets]) -> Iterator[list[str]]:
    yield ["low things of all streets", "points", "left as ground"]
    for labels, own in streets:
        for kind, codes in labels.low.items():
            masks = [np.isin(street.label, list(codes)) for street in own]
            points = sum(int(mask.sum()) for mask in masks)
            left = sum(
                int((mask & street.found).sum()) for mask, street in zip(masks, own, strict=True)
            )
            if points:
                yield [f"{labels.folder}, {kind}", f"{points:,}", f"{left / points:.3f}"]


def _counts(street: JudgedStreet, labels: StreetLabels) -> NDArray[np.int64]:
    """Ground found, ground, things taken for ground, and of low and of high ones both numbers."""
    found = street.found
    ground, uncounted, low, high = (
        np.isin(street.label, list(kind))
        for kind in (labels.ground, labels.uncounted, labels.any_low, labels.high)
    )
    wrong = found & ~ground & ~uncounted
    masks = (found & ground, ground, wrong, found & low, low, found & high, high)
    return np.array([mask.sum() for mask in masks], np.int64)


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
