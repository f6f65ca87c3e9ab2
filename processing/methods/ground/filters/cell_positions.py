"""Whether a cloud has enough positions in plan for a ground; the same sentence for all methods."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import OutOfRange
from processing.core.text import Text

Blocks = Callable[[], Iterable[NDArray[np.float64]]]

_LEAST = 3
"""Positions in plan: a surface needs a triangle."""


def require_three_positions(blocks: Blocks) -> None:
    """Raise when finite points lie at fewer than three positions in plan; copies count once.

    Parameters
    ----------
    blocks : callable
        Gives the cloud's blocks, each (n, 3) float64, m; read until the third position is met.

    Raises
    ------
    OutOfRange
    """
    found: list[NDArray[np.float64]] = []
    for xyz in blocks():
        positions = xyz[np.isfinite(xyz).all(axis=1), :2]
        for known in found:
            positions = positions[np.any(positions != known, axis=1)]
        while len(positions):
            found.append(positions[0])
            if len(found) == _LEAST:
                return
            positions = positions[np.any(positions != positions[0], axis=1)]
    raise OutOfRange(
        Text(
            f"Ground needs points at three or more places in plan; the cloud has {len(found)}.",
            f"地面の抽出には、平面位置の異なる点が3点以上必要です（この点群では{len(found)}か所）。",
        ),
        Text("The whole cloud", "点群全体"),
        Text("Choose a cloud with more points.", "点数の多い点群を選んでください。"),
    )
