"""Which drives were recorded at the same time: passes of one street lie centimetres apart."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from processing.recording.drive import Drive


def passes_of(drives: Sequence[Drive]) -> list[list[int]]:
    """Numbers of the drives of each pass; each is in exactly one."""
    passes: list[tuple[float, float, list[int]]] = []
    for number, drive in enumerate(drives):
        first, last = _span(drive)
        met = [one for one in passes if one[0] <= last and first <= one[1]]
        passes = [one for one in passes if one not in met]
        members = [number, *(member for one in met for member in one[2])]
        first, last = min([first, *(m[0] for m in met)]), max([last, *(m[1] for m in met)])
        passes.append((first, last, sorted(members)))
    return [one[2] for one in passes]


def _span(drive: Drive) -> tuple[float, float]:
    """First and last time, s; any time for a recording without times."""
    if not drive.count or not drive.info.has_measured_times:
        return -np.inf, np.inf
    first, last = drive.columns["time"][[0, drive.count - 1]].tolist()
    return min(first, last), max(first, last)
