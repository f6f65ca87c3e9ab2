"""Whether a standing scanner stood where its file says: poses are often lost or applied twice."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.recording.columns.columns import Columns
from processing.recording.columns.quantisation import Quantisation

ScannerPosition = tuple[float, float, float]

_SWEEPS = 24
"""Sweeps that are looked at, spread over the scan."""

_FEWEST_POINTS, _MOST_POINTS = 12, 400
"""Points of a sweep. By trial; no measurement is recorded."""

_FEWEST_SWEEPS = 3
"""Planes from which a position follows: three meet in a point."""

_THICKEST = 0.02
"""Share of their width that points of a sweep may lie off a plane, as its smallest variances: a
seventh."""


def check_scanner_position(
    columns: Columns,
    quantisation: Quantisation,
    sweep_length: int,
    position: ScannerPosition | None,
) -> ScannerPosition | None:
    """The place of a scanner, if the points agree with it.

    A mirror sends the beams of a sweep into one plane through the scanner. So seen from where it
    stood, each sweep is a line; seen from elsewhere most of them are not.

    Parameters
    ----------
    columns : Columns
        ``xyz`` and ``pulse`` in the order of the cells.
    sweep_length : int
        Cells of a sweep.
    position : tuple of float or None
        m, as the file says.

    Returns
    -------
    tuple of float or None
        None where the file doesn't say, where it is wrong, and where too few points could tell.
    """
    if position is None:
        return None
    pulses: NDArray[np.int64] = columns["pulse"]
    last = int(pulses[-1]) // sweep_length
    thickness = []
    for sweep in np.unique(np.linspace(0, last, _SWEEPS).astype(np.int64)):
        start, stop = np.searchsorted(pulses, [sweep * sweep_length, (sweep + 1) * sweep_length])
        if stop - start < _FEWEST_POINTS:
            continue
        step = max(1, int(stop - start) // _MOST_POINTS)
        xyz = quantisation.metres(columns["xyz"][start:stop:step])
        beams = xyz - np.array(position)
        lengths = np.linalg.norm(beams, axis=1, keepdims=True)
        if (lengths > 0).all():
            values = np.linalg.svd(beams / lengths, compute_uv=False)
            thickness.append(float(values[2] / max(values[1], 1e-12)))
    is_seen_from = len(thickness) >= _FEWEST_SWEEPS and np.median(thickness) <= _THICKEST
    return position if is_seen_from else None
