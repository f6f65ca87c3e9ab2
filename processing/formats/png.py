"""PNG pictures, written whole."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.formats.safe_write import written_safely


def write_png(path: Path, colours: NDArray[np.uint8]) -> None:
    """Write a picture.

    Parameters
    ----------
    colours : (h, w, 3) uint8
        Red, green, blue.

    Raises
    ------
    NoSpace
        The disk is full or refuses the write.
    """
    import cv2

    done, data = cv2.imencode(".png", colours[:, :, ::-1])
    if not done:
        message = f"a picture of shape {colours.shape} could not be encoded"
        raise ValueError(message)
    with written_safely(path) as temporary:
        temporary.write_bytes(data.tobytes())
