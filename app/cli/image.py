"""``zuka image``: a point-cloud image as a PNG file, rows downwards as the scanner wrote them."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from app.cli.opened import opened_input, terminal_monitor
from app.cli.output import print_lines
from processing.core.errors import name_with_type
from processing.core.monitor import Monitor, SilentMonitor
from processing.core.text import Text
from processing.formats.format import Content
from processing.formats.pictures.png import MOST_PIXELS, MOST_ROWS, write_png
from processing.formats.registry import FORMATS
from processing.image.attributes.attributes import ATTRIBUTES, colours
from processing.image.images_of_drives import image_of
from processing.image.point_image import PointCloudImage
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind

_STRIP_PIXELS = 2_000_000
WordT = TypeVar("WordT")


def command(arguments: argparse.Namespace) -> int:
    """Write one image for each drive of the input."""
    kind = _word(arguments.kind, {kind.value: kind for kind in ImageKind})
    attribute = _word(arguments.attribute, {name: name for name in ATTRIBUTES})
    FORMATS.format_to_write(arguments.output, Content.PICTURE)
    monitor = terminal_monitor()
    with opened_input(arguments, monitor) as opened:
        for number, drive in enumerate(opened.drives):
            path = _path_of(arguments.output, number, drive)
            rows, columns = write_image(drive, kind, attribute, path, monitor)
            print_lines(f"{path}: {rows} x {columns}")
    return 0


def write_image(
    drive: Drive, kind: ImageKind, attribute: str, path: Path, monitor: Monitor | None = None
) -> tuple[int, int]:
    """Write a drive's image; gives its rows and columns.

    An image that other programs couldn't open any more is written with every second, third … row
    and column, which is told.

    Raises
    ------
    Unsuitable
        The drive can't be shown so.
    NoSpace, Cancelled
    """
    monitor = monitor or SilentMonitor()
    image = image_of(drive, kind)
    step = 1
    while not _can_be_opened(-(-image.rows // step), -(-image.width // step)):
        step += 1
    size = -(-image.rows // step), -(-image.width // step)
    if step > 1:
        monitor.report(0.0, _THINNED.filled(step=step))
    write_png(path, size, _strips(drive, image, attribute, step, monitor))
    return size


_THINNED = Text(
    "The image is too large for one picture: only one of {step} rows and columns is written",
    "画像が大きすぎるため、{step}行・{step}列ごとに1つだけを出力します",
)


def _can_be_opened(rows: int, columns: int) -> bool:
    return rows <= MOST_ROWS and rows * columns <= MOST_PIXELS


def _strips(
    drive: Drive, image: PointCloudImage, attribute: str, step: int, monitor: Monitor
) -> Iterator[NDArray[np.uint8]]:
    """The picture from the top, a strip of rows at a time."""
    rows = step * max(1, _STRIP_PIXELS // max(1, image.width))
    for start in range(0, image.rows, rows):
        monitor.check()
        monitor.report(start / image.rows)
        strip = range(start, min(start + rows, image.rows))
        points = image.raster(strip, range(image.width), step)
        yield colours(drive, points, attribute, 2.0, 98.0)


def _path_of(output: Path, number: int, drive: Drive) -> Path:
    """The output itself for the first drive; the others have their name added."""
    if number == 0:
        return output
    name = "".join(letter if letter.isalnum() else "-" for letter in drive.info.name)
    return output.with_name(f"{output.stem}-{number + 1}-{name}{output.suffix}")


def _word(word: str, known: dict[str, WordT]) -> WordT:
    return name_with_type(
        known, word, Text("There is no such image.", "そのような画像はありません。")
    )
