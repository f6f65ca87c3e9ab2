"""Streets as pictures: intensity, the true classes, those found, and where they differ."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Colours, Integers
from processing.core.text import Language
from processing.formats.pictures.confusion_svg import confusion_svg
from processing.formats.pictures.png import write_png
from processing.image.attributes.attributes import colours
from processing.image.attributes.colour_maps import EMPTY_COLOUR, class_colours, error_map_colours
from processing.image.images_of_drives import image_of
from processing.recording.columns.error_map import ErrorMapValue
from processing.recording.drive import Drive
from processing.scoring.points.confusion_matrix import ConfusionMatrix

_WIDEST, _LONGEST = 500, 2000
"""Pixels of a panel: four of them, and a minute of driving, fit a screen to scroll."""

_NOT_KNOWN = (0, 1)
_LANGUAGE: Language = "en"


def write_confusion(matrix: ConfusionMatrix, path: Path) -> None:
    """The matrix of a street as SVG."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(confusion_svg(matrix, _LANGUAGE), encoding="utf-8")


def write_label_image(
    drive: Drive, truth: NDArray[np.uint8], found: NDArray[np.uint8], path: Path
) -> None:
    """Four panels side by side: intensity, true classes, found classes, and what is wrong.

    Parameters
    ----------
    truth, found : (n,) uint8
        Codes of the drive's points; where the truth is unknown or “other” nothing is wrong.

    Raises
    ------
    NoSpace
    """
    image = image_of(drive, drive.image_kinds[0])
    step = max(1, -(-image.width // _WIDEST), -(-image.rows // _LONGEST))
    points = image.raster(range(image.rows), range(image.width), step)
    judged = np.where(truth == found, ErrorMapValue.RIGHTLY_KEPT, ErrorMapValue.WRONGLY_REMOVED)
    judged[np.isin(truth, _NOT_KNOWN)] = ErrorMapValue.RIGHTLY_REMOVED
    panels = [
        colours(drive, points, "intensity", 2.0, 98.0),
        _coloured(class_colours(), truth, points),
        _coloured(class_colours(), found, points),
        _coloured(error_map_colours(), judged.astype(np.uint8), points),
    ]
    whole = np.hstack(panels)
    path.parent.mkdir(parents=True, exist_ok=True)
    write_png(path, (whole.shape[0], whole.shape[1]), [whole])


def _coloured(table: Colours, codes: NDArray[np.uint8], points: Integers) -> Colours:
    shown: Colours = table[codes[np.maximum(points, 0)]]
    shown[points < 0] = EMPTY_COLOUR
    return shown
