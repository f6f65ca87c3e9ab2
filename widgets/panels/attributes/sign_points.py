"""What a sign looks like: its picture from a camera, or painted of the points on its plate."""

from __future__ import annotations

import numpy as np
from PySide6.QtGui import QImage, QPixmap

from processing.core.errors import UserError
from processing.image.attributes.plate_points import PlatePlace, picture_of
from processing.map.feature import Feature
from widgets.shared.map_source import MapSource

_MEASURED = ("facing_deg", "tilt_deg", "width_m", "plate_high_m")
_USUAL_TURNS = 20
"""Of the scanner on a plate, where nobody counted them."""


def picture_of_sign(features: tuple[Feature, ...], source: MapSource) -> QPixmap | None:
    """The picture of one sign; None of several, or where neither camera nor points show it."""
    if len(features) != 1:
        return None
    photo = source.photo(features[0])
    return _of_points(features[0], source) if photo is None else QPixmap(str(photo))


def _of_points(feature: Feature, source: MapSource) -> QPixmap | None:
    values = [feature.attributes.get(name) for name in _MEASURED]
    reference = feature.vertices[0].measured if feature.vertices else None
    if reference is None or not all(isinstance(one, int | float) for one in values):
        return None
    facing, tilt, wide, high = (float(str(one)) for one in values)
    turns = feature.attributes.get("scan_lines")
    plate = PlatePlace(
        np.array(feature.vertices[0].xyz),
        facing,
        tilt,
        wide_m=wide,
        high_m=high,
        turns=turns if isinstance(turns, int) else _USUAL_TURNS,
    )
    try:
        pixels = picture_of(source.drive(reference.drive), reference.point, plate)
    except (KeyError, UserError):  # the drive is gone or damaged: said where it is shown
        return None
    if pixels is None:
        return None
    height, width = pixels.shape[:2]
    image = QImage(pixels.tobytes(), width, height, 3 * width, QImage.Format.Format_RGB888)
    return QPixmap.fromImage(image)
