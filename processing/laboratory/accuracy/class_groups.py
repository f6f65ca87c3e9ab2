"""Classes joined into groups, so that what others named can be compared with what was found."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Integers
from processing.core.monitor import SilentMonitor
from processing.laboratory.accuracy.filters.filter_tables import markdown_table
from processing.laboratory.accuracy.filters.filters import write_sections
from processing.project.importing.import_request import ImportRequest
from processing.project.importing.importing import import_drives
from processing.recording.columns.source_order import sources_of
from processing.recording.drive import Drive
from processing.tools.running.run_shares import mark_all


@dataclass(frozen=True)
class TrueGroups:
    """A file of points and the group that each is truly of.

    Attributes
    ----------
    name : str
        Clouds of one name make one row of the table.
    cloud : Path
    true : (n,) int64
        By the file's order; the number of groups where a point is of none.
    """

    name: str
    cloud: Path
    true: NDArray[np.int64]


def groups_of(
    codes: NDArray[np.integer], groups: Mapping[str, Sequence[int]], names: Iterable[str]
) -> NDArray[np.int64]:
    """(n,) the place of each one's group among the names; their number for what is in none."""
    numbers = list(names)
    found = np.full(codes.size, len(numbers))
    for name, own in groups.items():
        found[np.isin(codes, own)] = numbers.index(name)
    return found


def classes_of(cloud: Path) -> NDArray[np.uint8]:
    """(n,) the classes of a file's points, in its order; its drives are classified together."""
    parts: list[tuple[Integers, NDArray[np.uint8]]] = []
    with TemporaryDirectory(prefix="zuka-") as position:
        folder = Path(position)
        imported = import_drives(ImportRequest((cloud,)), folder / "drives", SilentMonitor())
        drives = [Drive(one) for one in imported]
        mark_all("classify", drives, SilentMonitor(), into=folder / "classes")
        for drive in drives:
            runs = drive.info.source_runs
            _, indices = sources_of(drive.columns, runs, 0, drive.count, sources=1)
            parts.append((np.array(indices), np.array(drive.columns["classification"])))
    in_order = np.zeros(sum(found.size for _, found in parts), np.uint8)
    for indices, found in parts:
        in_order[indices] = found
    return in_order


def write_group_table(
    heading: str,
    about: str,
    clouds: Iterable[TrueGroups],
    groups: Mapping[str, Sequence[int]],
    markdown: Path | None,
) -> None:
    """Classify clouds and write what was found of each group as a section of a page.

    Parameters
    ----------
    groups : mapping of str to sequence of int
        The program's classes that each group joins; what is true is counted by them.
    markdown : Path, optional
        The page; without one the section goes to standard output.
    """
    counts: dict[str, NDArray[np.int64]] = {}
    for one in clouds:
        said, known = groups_of(classes_of(one.cloud), groups, groups), one.true < len(groups)
        shape = (len(groups), len(groups) + 1)
        own = counts.setdefault(one.name, np.zeros(shape, np.int64))
        np.add.at(own, (one.true[known], said[known]), 1)
    rows = [["clouds", "points", "mean F", *groups]]
    rows += [[name, f"{own.sum():,}", *f_measures(own)] for name, own in counts.items()]
    write_sections(markdown, {heading: f"{about}\n{markdown_table(rows)}"})


def f_measures(counts: NDArray[np.int64]) -> list[str]:
    """Mean F over the groups that there are, and F of each.

    Parameters
    ----------
    counts : (k, k + 1) int64
        True by found; the last column is in no group.
    """
    hits = np.diagonal(counts)
    true, said = counts.sum(axis=1), counts[:, :-1].sum(axis=0)
    f = 2 * hits / np.maximum(true + said, 1)
    is_there = true > 0
    each = [f"{one:.3f}" if there else "–" for one, there in zip(f, is_there, strict=True)]
    return [f"{f[is_there].mean():.3f}", *each]
