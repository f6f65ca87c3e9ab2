"""Pixels of a camera image, never more of them than asked for, whatever the file's size."""

from __future__ import annotations

import struct
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import BadFile, report_as_user_error
from processing.core.text import Text
from processing.recording.camera_images.image_list import CameraImage

MOST_PIXELS = 16_000_000
"""Larger images are shown and used at a half, a quarter or an eighth."""

_MOST_WHOLE = 134_000_000
"""Files that cannot be read reduced are refused from so many pixels on: 400 MB in memory."""

_HEAD_BYTES = 1 << 20
"""In which the size of an image stands: behind thumbnails and other notes of cameras."""

_SIZE_TOLERANCE = 0.01
"""By this share a picture may differ in shape from what the list says: rounding of a reduced
one."""

_FRAMES = frozenset(range(0xC0, 0xD0)) - {0xC4, 0xC8, 0xCC}
"""Markers of JPEG frames, which hold the size (ITU-T T.81, table B.1): C0 to CF but for tables and
extensions."""

_PROGRESSIVE = frozenset({0xC2, 0xC6, 0xCA, 0xCE})
"""Those of progressive frames, which no decoder reads reduced."""


@dataclass(frozen=True)
class ImagePixels:
    """What an image shows.

    Attributes
    ----------
    pixels : (h, w, 3) uint8
        Red, green, blue.
    note : Text or None
        What the user should know: shown coarser, or of another size than listed.
    """

    image: CameraImage
    pixels: NDArray[np.uint8]
    note: Text | None = None

    @property
    def scale(self) -> tuple[float, float]:
        """Pixels of the listed image for one of these, across and down."""
        height, width = self.pixels.shape[:2]
        return self.image.width_px / width, self.image.height_px / height

    def colours_at(self, positions: NDArray[np.float64]) -> NDArray[np.uint8]:
        """Colours at (n, 2) columns and rows of the listed image, (n, 3); inside it."""
        height, width = self.pixels.shape[:2]
        across, down = self.scale
        # Pixels have their middles at whole numbers.
        columns = np.floor((positions[:, 0] + 0.5) / across).astype(np.int64)
        rows = np.floor((positions[:, 1] + 0.5) / down).astype(np.int64)
        columns, rows = np.clip(columns, 0, width - 1), np.clip(rows, 0, height - 1)
        return np.asarray(self.pixels[rows, columns])


def read_pixels(image: CameraImage, most_pixels: int = MOST_PIXELS) -> ImagePixels:
    """Read an image, coarser where it has more pixels than wanted.

    Raises
    ------
    MissingInput, NoSpace
        The file is gone or may not be read.
    BadFile
        It is no image, is damaged, has another shape than the list says, or is so large that it
        could only be read whole.
    """
    import cv2

    with report_as_user_error(image.path):
        # Not cv2.imread: it can't open names outside the system's code page on Windows.
        content = np.fromfile(image.path, np.uint8)
    size, reads_in_parts = _size_in(bytes(content[:_HEAD_BYTES]))
    listed = (image.width_px, image.height_px)
    _check_shape(image.path, size or listed, listed)
    width, height = size or listed
    reduction = 1
    while reduction < 8 and width * height > most_pixels * reduction**2:
        reduction *= 2
    if not reads_in_parts and width * height > _MOST_WHOLE:
        raise _bad(image.path, _TOO_LARGE.filled(size=round(width * height / 1e6)), _AS_JPEG)
    flags = {
        1: cv2.IMREAD_COLOR,
        2: cv2.IMREAD_REDUCED_COLOR_2,
        4: cv2.IMREAD_REDUCED_COLOR_4,
        8: cv2.IMREAD_REDUCED_COLOR_8,
    }
    try:
        # Orientation angles belong to the pixels as stored, whichever way up a viewer shows them.
        wanted = flags[reduction] | cv2.IMREAD_IGNORE_ORIENTATION
        found = cv2.imdecode(content, wanted) if content.size else None
    except cv2.error:
        found = None
    if found is None:
        raise _bad(image.path, _NO_IMAGE, _COPY_AGAIN)
    if size is None:
        size = (found.shape[1] * reduction, found.shape[0] * reduction)
        _check_shape(image.path, size, listed)
    pixels = np.ascontiguousarray(found[:, :, ::-1], dtype=np.uint8)
    return ImagePixels(image, pixels, _note(size, listed, reduction))


def _check_shape(path: Path, size: tuple[int, int], listed: tuple[int, int]) -> None:
    """Refuse what isn't the listed image at another scale: its pixels mean other directions."""
    across, down = size[0] / listed[0], size[1] / listed[1]
    if abs(across / down - 1) > _SIZE_TOLERANCE:
        raise _bad(
            path,
            _OTHER_SHAPE.filled(size=f"{size[0]} × {size[1]}", listed=f"{listed[0]} × {listed[1]}"),
            _ORIGINALS,
        )


def _note(size: tuple[int, int], listed: tuple[int, int], reduction: int) -> Text | None:
    if size != listed:
        return _SCALED.filled(size=f"{size[0]} × {size[1]}", listed=f"{listed[0]} × {listed[1]}")
    if reduction > 1:
        return _REDUCED.filled(size=round(size[0] * size[1] / 1e6), part=f"1/{reduction}")
    return None


def _size_in(head: bytes) -> tuple[tuple[int, int] | None, bool]:
    """Width and height as a file's head says them, and whether it can be read coarser at once."""
    if head.startswith(b"\x89PNG\r\n\x1a\n") and len(head) >= 24:
        width, height = struct.unpack_from(">II", head, 16)
        return ((width, height) if width and height else None), False
    if not head.startswith(b"\xff\xd8"):
        return None, False
    position = 2
    while position + 9 <= len(head):
        marker, length = struct.unpack_from(">BxH", head, position)[0], 0
        kind = head[position + 1]
        if marker != 0xFF:
            break
        if kind == 0xFF or 0xD0 <= kind <= 0xD8:
            position += 1 if kind == 0xFF else 2
            continue
        length = struct.unpack_from(">H", head, position + 2)[0]
        if kind in _FRAMES:
            height, width = struct.unpack_from(">HH", head, position + 5)
            return ((width, height) if width and height else None), kind not in _PROGRESSIVE
        position += 2 + length
    return None, False


def _bad(path: Path, what: Text, remedy: Text) -> BadFile:
    return BadFile(what, Text.same(str(path)), remedy)


_NO_IMAGE = Text(
    "The file is no image that can be read, or it is damaged.",
    "画像として読み込めないか、ファイルが壊れています。",
)
_COPY_AGAIN = Text(
    "Copy the image again from the delivery.", "納品元から画像をコピーし直してください。"
)
_OTHER_SHAPE = Text(
    "The image has {size} pixels where the list says {listed}.",
    "画像サイズが {size} 画素で、一覧の {listed} 画素と一致しません。",
)
_ORIGINALS = Text(
    "Use the images as they were taken, neither turned nor cropped, or correct the list.",
    "回転や切り抜きをしていない撮影時の画像を使うか、一覧を修正してください。",
)
_TOO_LARGE = Text(
    "The image has {size} megapixels in a format that can only be read whole.",
    "画像が {size} メガピクセルあり、一部ずつ読み込めない形式です。",
)
_AS_JPEG = Text(
    "Save it as an ordinary (baseline) JPEG.", "通常（ベースライン）のJPEGで保存し直してください。"
)
_SCALED = Text(
    "The image has {size} pixels where the list says {listed}; it is scaled.",
    "画像サイズが {size} 画素のため、一覧の {listed} 画素に合わせて拡大縮小しています。",
)
_REDUCED = Text(
    "The image has {size} megapixels and is shown at {part} of its size.",
    "画像が {size} メガピクセルあるため、{part} に縮小しています。",
)
