"""Classes of clouds from the air against what others say of them, as a table.

``python -m processing.laboratory.accuracy.aerial_classes DATA_FOLDER --markdown docs/accuracy.md``
makes the page's section; without ``--markdown`` it is written to standard output.

A cloud is either a delivered tile with classes, ``als/*.laz``, or a simulated flight,
``waveform/in/points.laz`` with ``waveform/truth/truth.npz``. The delivered classes are not seen by
the program while it classifies: it says what every point is anew.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path

import laspy
import numpy as np

from processing.core.output_streams import write_every_character
from processing.laboratory.accuracy.class_groups import (
    TrueGroups,
    groups_of,
    write_group_table,
)

HEADING = "### Classes of clouds from the air"

GROUPS: Mapping[str, tuple[int, ...]] = {
    "ground": (2, 3, 11, 67),
    "vegetation": (4, 5),
    "building": (6,),
    "wire": (14,),
    "tower": (15,),
}
"""What the program's classes are there."""

_DELIVERED: Mapping[str, tuple[int, ...]] = {
    "ground": (2,),
    "vegetation": (3, 4, 5),
    "building": (6,),
}
"""The numbers of a delivered tile as LAS 1.4 defines them: its class 3 are low plants."""

_FLOWN: Mapping[str, tuple[int, ...]] = {**GROUPS, "ground": (2, 11)}


def main(arguments: list[str]) -> int:
    """Classify and score the clouds of a folder."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("data", type=Path)
    parser.add_argument("--markdown", type=Path)
    chosen = parser.parse_args(arguments)
    write_group_table(HEADING, _ABOUT, _clouds(chosen.data), GROUPS, chosen.markdown)
    return 0


def _clouds(data: Path) -> Iterator[TrueGroups]:
    for cloud in sorted(data.glob("**/als/*.laz")):
        delivered = np.asarray(laspy.read(cloud).classification)
        if set(_DELIVERED["building"]) <= set(delivered.tolist()):
            yield TrueGroups(cloud.stem, cloud, groups_of(delivered, _DELIVERED, GROUPS))
    for cloud in sorted(data.glob("**/waveform/in/points.laz")):
        with np.load(cloud.parent.parent / "truth" / "truth.npz") as truth:
            true = groups_of(truth["label"], _FLOWN, GROUPS)
        yield TrueGroups("simulated flight", cloud, true)


_ABOUT = """\
`python -m processing.laboratory.accuracy.aerial_classes DATA_FOLDER --markdown docs/accuracy.md` \
makes this section: a delivered tile of IGN's lidar HD with the classes that it was delivered \
with, thinned to .3 points/m², and the flight of another simulator at 9 points/m² as points alone, \
its two strips together. Ground and road count together, as do low plants and trees. Neither was \
learnt from; that brightness isn't asked was decided on them.
"""


if __name__ == "__main__":
    write_every_character()
    sys.exit(main(sys.argv[1:]))
