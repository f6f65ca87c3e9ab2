"""RequestedPosition: where somebody wants to know why a tool took something or not."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.image.scan_lines.scanlines import Scanlines
from processing.recording.drive import Drive


@dataclass(frozen=True)
class RequestedPosition:
    """A place that somebody wants to know about.

    Attributes
    ----------
    drive : Drive
    xyz : (3,) float64
        m, project CRS.
    scanlines : Scanlines
        The one scanline nearest to it.
    """

    drive: Drive
    xyz: NDArray[np.float64]
    scanlines: Scanlines
