"""Tool: one processing method, declared once.

The form in the processing panel, ``zuka tools``, ``zuka run``, batch jobs and the manual are made
from this declaration. A tool is a pure function of a block of points: no file, no view, no global.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from enum import Enum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.image.grid import PixelGrid
from processing.monitor import Monitor
from processing.text import Text


class Needs(Enum):
    """What a tool asks of a cloud."""

    POINTS = "points"
    PIXELS = "pixels"
    TURNS = "turns"
    TRAJECTORY = "trajectory"


@dataclass(frozen=True)
class PointBlock:
    """A stretch of a recording, as a tool sees it.

    Attributes
    ----------
    xyz : (n, 3) float64
        m, project CRS, acquisition order.
    intensity : (n,) uint16
    time : (n,) float64
        Seconds on the trajectory's clock; NaN where a file has none.
    classification : (n,) uint8
    grid : PixelGrid
        The block's pixels: which point is whose neighbour in the acquisition image.
    """

    xyz: NDArray[np.float64]
    intensity: NDArray[np.uint16]
    time: NDArray[np.float64]
    classification: NDArray[np.uint8]
    grid: PixelGrid


@dataclass(frozen=True)
class PointResult:
    """One value or vector per point of the block, by column name.

    Attributes
    ----------
    columns : mapping of str to array
        Each (n,) or (n, k), in the block's order.
    """

    columns: Mapping[str, NDArray[Any]] = field(default_factory=dict)  # dtype is the column's own


# A tool's parameters are its own frozen dataclass, so the runner can't know their type.
Compute = Callable[[PointBlock, Any, Monitor], PointResult]


@dataclass(frozen=True)
class OutputColumn:
    """A per-point result: its name in files, type, width and words for people."""

    name: str
    dtype: str
    width: int
    title: Text


@dataclass(frozen=True)
class Tool:
    """One processing method.

    Attributes
    ----------
    id : str
        The name on the command line and in provenance.
    version : int
        Raised when the same input and parameters give another result.
    overlap_rows : int
        Rows of the image that a block needs beyond its own on either side; −1: the tool can't be
        cut into blocks and gets the recording whole.
    outputs : tuple of OutputColumn
        What it gives per point.
    """

    id: str
    name: Text
    explanation: Text
    group: Text
    needs: Needs
    parameters: type[Any]  # a frozen dataclass of fields from processing.tools.parameters
    compute: Compute
    outputs: tuple[OutputColumn, ...]
    overlap_rows: int
    version: int = 1
