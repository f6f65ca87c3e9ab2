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
from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np

from processing.core.output_streams import write_every_character
from processing.laboratory.accuracy.class_groups import (
    TrueGroups,
    groups_of,
    write_group_table,
)

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


def main(arguments: list[str]) -> int:
    """Classify and score the streets of a folder."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("data", type=Path)
    parser.add_argument("--markdown", type=Path)
    chosen = parser.parse_args(arguments)
    write_group_table(HEADING, _ABOUT, _streets(chosen.data), GROUPS, chosen.markdown)
    return 0


def _streets(data: Path) -> Iterator[TrueGroups]:
    for name, labels in _LABELS.items():
        for cloud in sorted(data.glob(f"**/{name}/*.laz")):
            with np.load(cloud.parent / "truth" / f"{cloud.stem}.npz") as truth:
                true = groups_of(truth["label"].astype(np.int64), labels, GROUPS)
            yield TrueGroups(name, cloud, true)


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
