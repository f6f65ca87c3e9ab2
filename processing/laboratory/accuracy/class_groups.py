"""Classes joined into groups, so that what others named can be compared with what was found."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Integers
from processing.core.monitor import SilentMonitor
from processing.project.importing.import_request import ImportRequest
from processing.project.importing.importing import import_drives
from processing.recording.columns.source_order import sources_of
from processing.recording.drive import Drive
from processing.tools.run_shares import mark_all


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
