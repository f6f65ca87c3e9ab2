"""Trunks, poles, signs and wires of real streets that people labelled point by point, as a table.

``python -m processing.laboratory.accuracy.real_street_things DATA_FOLDER --markdown
docs/accuracy.md`` makes the page's section; without ``--markdown`` it is written to standard
output. Streets are found as :mod:`processing.laboratory.accuracy.filters.street_ground` finds them.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np

from processing.core.arrays import Flags, Floats, Integers
from processing.core.errors import UserError
from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.formats.points.point_codes import read_result
from processing.laboratory.accuracy.filters.filter_tables import markdown_table
from processing.laboratory.accuracy.filters.filters import write_sections
from processing.project.importing.import_request import ImportRequest
from processing.project.importing.importing import import_drives
from processing.recording.drive import Drive
from processing.scoring.features.one_to_one import pairs_within
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix
from processing.tools.listed.registry import TOOLS
from processing.tools.running.runner import RunRequest, run
from processing.tools.tool import Candidate, CandidateResult

HEADING = "### Trunks, poles, signs and wires of real streets"

REACH_M = 1.0
"""Of a foot from the middle of the lowest two metres of a labelled thing, in plan."""

_TOGETHER_M, _FEWEST, _LEAST_HIGH_M = 0.5, 20, 1.0
"""Labelled points nearer than this in plan are of one thing; how many make one, as the thesis asks
of trees; and how high it is at least, signs aside, whose plates are lower."""

_ABOUT_M = 0.4
"""What stands so near to a foot tells what something wrong stands on."""

_BANDS = (20, 50, 100)
"""Labelled points of a thing: from so many on it is in that band."""

_ON_WIRE_M = 0.2
"""How far a labelled point may lie off a wire that was found."""

TOOL_OF: Mapping[str, str] = {
    "trunks": "trees",
    "poles": "poles",
    "signs": "signs",
    "wires": "wires",
}


@dataclass(frozen=True)
class ThingLabels:
    """What the labels of a data set mean.

    Attributes
    ----------
    folder : str
    codes : mapping of str to tuple of int
        By :data:`TOOL_OF`.
    unnamed : tuple of int
        Points that nobody named, or so coarsely that they may be anything.
    leaves : tuple of int
        Foliage: stems of small trees and shrubs mostly have its name.
    """

    folder: str
    codes: Mapping[str, tuple[int, ...]]
    unnamed: tuple[int, ...]
    leaves: tuple[int, ...]


DATA_SETS = (
    ThingLabels(
        "street_oakland",
        {
            "trunks": (1302, 1303),
            "poles": (1103, 1106, 1107, 1110, 1112, 1116),
            "signs": (1111,),
            "wires": (1100, 1101, 1102),
        },
        (1000, 1001, 1002, 1003, 1004, 1005),
        (1300,),
    ),
    ThingLabels(
        "street_semantic_kitti", {"trunks": (16,), "poles": (18,), "signs": (19,)}, (0,), (15,)
    ),
)


class ThingScore(NamedTuple):
    """Things of one kind on one street.

    ``points``: how many labelled points each true one has; ``found``: which of them were found;
    ``wrong``: candidates that stand on something else; ``in_leaves``: those of them on foliage.
    """

    points: Integers
    found: Flags
    wrong: int
    in_leaves: int


class WireScore(NamedTuple):
    """``labelled``, ``hit``: points of wires, and those on one found; ``wrong``, ``all``: steps."""

    labelled: int
    hit: int
    wrong: int
    all: int


def main(arguments: list[str]) -> int:
    """Find and score the things of the streets of a folder."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("data", type=Path)
    parser.add_argument("--markdown", type=Path)
    chosen = parser.parse_args(arguments)
    rows, wires = [_HEAD], [_WIRE_HEAD]
    for labels in DATA_SETS:
        streets = list(_streets(chosen.data, labels))
        if not streets:
            continue
        for name in labels.codes:
            if name == "wires":
                wires.append([labels.folder, *_wire_cells([wire_points(one) for one in streets])])
            else:
                found = [found_things(one, name) for one in streets]
                rows.append([labels.folder, name, *_cells(found)])
    tables = [markdown_table(rows)]
    if len(wires) > 1:
        tables.append(markdown_table(wires))
    write_sections(chosen.markdown, {HEADING: "\n".join((_ABOUT, *tables))})
    return 0


@dataclass(frozen=True, eq=False)
class SearchedStreet:
    """A street with what it is labelled as and what was found on it.

    Attributes
    ----------
    labels : ThingLabels
    xyz : (n, 3) float64
    label : (n,) int64
    candidates : mapping of str to tuple of Candidate
        By :data:`TOOL_OF`.
    """

    labels: ThingLabels
    xyz: Floats
    label: Integers
    candidates: Mapping[str, tuple[Candidate, ...]]


def _streets(data: Path, labels: ThingLabels) -> Iterator[SearchedStreet]:
    for cloud in sorted(data.glob(f"**/{labels.folder}/*.laz")):
        blocks = [block.xyz for block in read_result(cloud).blocks() if block.xyz is not None]
        with np.load(cloud.parent / "truth" / f"{cloud.stem}.npz") as truth:
            label = truth["label"].astype(np.int64)
        found = _candidates(cloud, labels.codes)
        yield SearchedStreet(labels, np.concatenate(blocks), label, found)


def _candidates(cloud: Path, names: Iterable[str]) -> dict[str, tuple[Candidate, ...]]:
    """What the tools find on a file, delivered without anything beside it."""
    found: dict[str, tuple[Candidate, ...]] = {}
    with TemporaryDirectory(prefix="zuka-") as position:
        folder = Path(position)
        imported = import_drives(ImportRequest((cloud,)), folder / "drives", SilentMonitor())
        drives = [Drive(one) for one in imported]
        for name in names:
            tool = TOOL_OF[name]
            request = RunRequest(tool, drives[0], TOOLS[tool].parameters(), tuple(drives[1:]))
            try:
                result = run(request, SilentMonitor(), into=folder / tool)
            except UserError:  # what a recording can't tell is told to the user, and found by none
                found[name] = ()
                continue
            found[name] = result.candidates if isinstance(result, CandidateResult) else ()
    return found


def found_things(street: SearchedStreet, name: str) -> ThingScore:
    """The things of a kind, one to one with what was found."""
    from scipy.spatial import cKDTree

    is_own = np.isin(street.label, street.labels.codes[name])
    things = _things(street.xyz[is_own], 0.0 if name == "signs" else _LEAST_HIGH_M)
    feet = np.array([one.xyz[0, :2] for one in street.candidates[name]]).reshape(-1, 2)
    middles = np.array([foot_of(one) for one in things]).reshape(-1, 2)
    found, used = np.zeros(len(things), np.bool_), np.zeros(len(feet), np.bool_)
    of_foot, of_thing = pairs_within(feet, middles, REACH_M)
    found[of_thing] = used[of_foot] = True
    is_named = ~np.isin(street.label, street.labels.unnamed)
    if name == "poles":  # a plate that has a name hangs on a pole that has none
        is_named &= ~np.isin(street.label, street.labels.codes["signs"])
    is_leaf = np.isin(street.label, street.labels.leaves)
    tree = cKDTree(street.xyz[:, :2])
    wrong = in_leaves = 0
    for near in tree.query_ball_point(feet[~used], _ABOUT_M):
        named = np.array(near, np.int64)[is_named[near]]
        if named.size > len(near) / 2 and is_own[named].mean() < 1 / 2:
            wrong += 1
            in_leaves += bool(is_leaf[named].mean() > 1 / 2)
    return ThingScore(np.array([len(one) for one in things], np.int64), found, wrong, in_leaves)


def _things(xyz: Floats, least_high_m: float) -> list[Floats]:
    """Labelled points that hang together in plan, each as (n, 3)."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    if len(xyz) < _FEWEST:
        return []
    pairs = cKDTree(xyz[:, :2]).query_pairs(_TOGETHER_M, output_type="ndarray")
    ones = np.ones(len(pairs))
    linked = coo_matrix((ones, (pairs[:, 0], pairs[:, 1])), shape=(len(xyz), len(xyz)))
    _, owner = connected_components(linked, directed=False)
    parts = [xyz[owner == number] for number in np.unique(owner).tolist()]
    return [one for one in parts if len(one) >= _FEWEST and np.ptp(one[:, 2]) >= least_high_m]


def foot_of(thing: Floats) -> Floats:
    """(2,) where a thing of (n, 3) points stands: the middle of its lowest two metres."""
    low = thing[thing[:, 2] <= thing[:, 2].min() + 2.0]
    return np.asarray(np.median(low[:, :2], axis=0))


def wire_points(street: SearchedStreet) -> WireScore:
    """Labelled points of wires on found ones, and steps of found ones on something else."""
    from scipy.spatial import cKDTree

    is_own = np.isin(street.label, street.labels.codes["wires"])
    steps = np.concatenate([np.empty((0, 3)), *map(_steps_along, street.candidates["wires"])])
    own = street.xyz[is_own]
    if not len(steps) or not len(own):
        return WireScore(len(own), 0, len(steps), len(steps))
    hit = np.isfinite(cKDTree(steps).query(own, distance_upper_bound=_ON_WIRE_M)[0]).sum()
    is_open = is_own | np.isin(street.label, street.labels.unnamed)
    away, nearest = cKDTree(street.xyz).query(steps, distance_upper_bound=_ABOUT_M)
    wrong = (~is_open[np.asarray(nearest)[np.isfinite(away)]]).sum()
    return WireScore(len(own), int(hit), int(wrong), len(steps))


def _steps_along(wire: Candidate) -> Floats:
    """Places every decimetre along a wire: (n, 3)."""
    lengths = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(wire.xyz, axis=0), axis=1))])
    at = np.arange(0.0, lengths[-1], 0.1)
    return np.column_stack([np.interp(at, lengths, axis) for axis in wire.xyz.T])


def _cells(streets: Sequence[ThingScore]) -> list[str]:
    points = np.concatenate([one.points for one in streets])
    found = np.concatenate([one.found for one in streets])
    wrong = sum(one.wrong for one in streets)
    in_leaves = sum(one.in_leaves for one in streets)
    hits = int(found.sum())
    counts = BinaryConfusionMatrix(hits, wrong, found.size - hits, 0)
    f = counts.f_measure if hits else 0.0
    ends = (*_BANDS[1:], np.inf)
    bands = [(points >= low) & (points < high) for low, high in zip(_BANDS, ends, strict=True)]
    return [
        f"{counts.hits}, {counts.false_alarms}, {counts.misses}",
        f"{f:.1%}".replace("%", " %"),
        str(in_leaves),
        *(f"{int(found[band].sum())} of {int(band.sum())}" for band in bands),
    ]


def _wire_cells(streets: Sequence[WireScore]) -> list[str]:
    labelled, hit, wrong, steps = (sum(part) for part in zip(*streets, strict=True))
    return [
        f"{labelled:,}",
        f"{hit / labelled:.1%}".replace("%", " %") if labelled else "–",
        f"{steps / 10:.0f} m",
        f"{wrong / 10:.0f} m",
    ]


_HEAD = ["data set", "things", "found, false, missed", "F", "of the false, in foliage"]
_HEAD += [f"of {low} to {high - 1} points" for low, high in pairwise(_BANDS)]
_HEAD += [f"of {_BANDS[-1]} and more"]
_WIRE_HEAD = ["data set", "points of wires", "on one found", "found", "of it on something else"]

_ABOUT = """\
`python -m processing.laboratory.accuracy.real_street_things DATA_FOLDER --markdown \
docs/accuracy.md` makes this section: points labelled by hand, profiles of a scanner on a car \
(Munoz and others 2009) and single scans of a spinning one (Behley and others 2019), searched \
without trajectory or times, as they are delivered, by each tool with its own parameters; none \
was learnt from. Labelled points that hang together in plan are a thing, if they are 20 and \
stand 1 m high (plates of signs lower); it is found if a foot lies within 1 m, one to one. What \
stands mostly on points of another name is false. Wires count by points within 20 cm. A pole under \
a labelled plate counts neither way, and stems of small trees mostly have the name of foliage.

Both are far sparser than what round shafts are fitted on, and shaken: a pole shows as two to five \
upright lines of points a decimetre apart, each smooth to millimetres and off its neighbours by \
centimetres. Where half of the cubes of 0.4 m hold six points or fewer, three quarters of those at \
the height of trunks eighteen or fewer, and those that half of the points lie in forty or fewer, \
trunks and poles are told by what stands on, beside and above columns in decimetres, by models \
learnt on simulated sparse profiles and single \
scans (`python -m processing.laboratory.road_training.coarse_training`), none of them from a \
recording; settings were chosen by simulated streets, but the figures were looked \
at while the facts were made. The fit of shafts alone had found 4, 4, 26 and 0, 1, 20 of Oakland, \
2, 2, 131 and 7, 1, 35 of SemanticKITTI. A single scan sees two or three metres of most things and \
no crown: bare trunks and poles of the same width can't be told apart there, in simulated scans as \
in real ones. Signs can't be told in Oakland, which has no intensity, nor in single scans, whose \
order of measurement isn't known.
"""


if __name__ == "__main__":
    write_every_character()
    sys.exit(main(sys.argv[1:]))
