"""The scan lines of a group of pieces, flat on its plane, as outlines are laid on them."""

from __future__ import annotations

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.methods.road.signs.fit_kernels import (
    ALONG_U,
    ALONG_V,
    LINE,
    LONG,
    OPEN_END,
    OPEN_START,
    SPACING,
    U,
    V,
)
from processing.methods.road.signs.piece_kernels import BEFORE, BEHIND, FREE, FROM, STEP, TO
from processing.methods.road.signs.piece_kernels import SPACING as PIECE_SPACING
from processing.methods.road.signs.plate_groups import PlateGroup
from processing.methods.road.signs.scan_pieces import ScanPieces

_LEAST_STEP_M = 0.01
"""Between turns on a plate; less is a vehicle that stands, and says nothing about the next turn."""

_FAR_M = 10.0
"""Before a line that met nothing, its start: farther than any plate is wide."""

_LEAST_SPACING_M = 0.003
"""Between pulses: pieces of two points of one place have none."""


def lines_of(pieces: ScanPieces, group: PlateGroup) -> Floats:
    """(k, LINE) float64: a line for each piece of a group, in their order."""
    values = pieces.values[group.pieces]
    start, end = group.flat(values[:, FROM : FROM + 3]), group.flat(values[:, TO : TO + 3])
    lines = np.zeros((len(values), LINE))
    long = np.linalg.norm(end - start, axis=1)
    lines[:, [U, V]] = start
    lines[:, [ALONG_U, ALONG_V]] = (end - start) / np.maximum(long, 1e-6)[:, None]
    lines[:, LONG] = long
    lines[:, SPACING] = np.maximum(values[:, PIECE_SPACING], _LEAST_SPACING_M)
    for column, code in ((OPEN_START, BEFORE), (OPEN_END, BEHIND)):
        lines[:, column] = np.isin(values[:, code], (FREE, STEP))
    return lines


def empty_lines(pieces: ScanPieces, group: PlateGroup, lines: Floats) -> Floats:
    """(m, LINE) float64: the turns next to the first and the last that met the plate.

    Parameters
    ----------
    lines : (k, LINE) float64
        Of the group's pieces.
    """
    found = []
    drive, row = pieces.drive[group.pieces], pieces.row[group.pieces]
    for number in np.unique(drive).tolist():
        chosen = np.flatnonzero(drive == number)
        found += _next_turns(lines[chosen], row[chosen])
    return np.array(found, np.float64).reshape(-1, LINE)


def _next_turns(lines: Floats, rows: Integers) -> list[Floats]:
    """The turns before and behind those of one scanner."""
    weights = lines[:, LONG]
    along = _mean_direction(lines)
    across = np.array([-along[1], along[0]])
    offsets = (lines[:, [U, V]] + lines[:, LONG, None] / 2 * lines[:, [ALONG_U, ALONG_V]]) @ across
    # Passes and stops part the turns of a drive: the stretch with the most lines tells.
    order = np.argsort(rows, kind="stable")
    cuts = np.flatnonzero(np.diff(rows[order]) > 5) + 1
    best = max(np.split(order, cuts), key=len)
    if np.unique(rows[best]).size < 2:
        return []
    slope, start = np.polyfit(rows[best], offsets[best], 1, w=np.sqrt(weights[best] + 1e-3))
    if abs(slope) < _LEAST_STEP_M:
        return []
    middle = np.average(lines[best][:, [U, V]], axis=0) @ along
    found = []
    for turn in (rows[best].min() - 1, rows[best].max() + 1):
        line = np.zeros(LINE)
        line[[U, V]] = (start + slope * turn) * across + (middle - _FAR_M) * along
        line[[ALONG_U, ALONG_V]] = along
        line[SPACING] = float(np.median(lines[best, SPACING]))
        line[OPEN_START] = -1.0
        found.append(line)
    return found


def _mean_direction(lines: Floats) -> Floats:
    """(2,) unit: of lines that may run either way."""
    along = lines[:, [ALONG_U, ALONG_V]] * np.where(lines[:, [ALONG_V]] < 0, -1.0, 1.0)
    mean = np.average(along, axis=0, weights=lines[:, LONG] + 1e-6)
    return np.asarray(mean / max(float(np.linalg.norm(mean)), 1e-9))
