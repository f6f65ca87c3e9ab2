"""``zuka image``: a point-cloud image as a PNG file, rows downwards as the scanner wrote them."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TypeVar

from app.cli.opened import opened_input, terminal_monitor
from app.cli.output import print_lines
from processing.errors import OutOfRange
from processing.formats.png import write_png
from processing.image.attributes import ATTRIBUTES, colours
from processing.image.kinds import ImageKind
from processing.points.drive import Drive
from processing.text import Text

_MOST_PIXELS = 400_000_000
WordT = TypeVar("WordT")


def command(arguments: argparse.Namespace) -> int:
    """Write one image for each drive of the input."""
    kind = _word(arguments.kind, {kind.value: kind for kind in ImageKind})
    attribute = _word(arguments.attribute, {name: name for name in ATTRIBUTES})
    monitor = terminal_monitor()
    with opened_input(arguments, monitor) as opened:
        for number, drive in enumerate(opened.drives):
            path = _path_of(arguments.output, number, drive)
            rows, columns = write_image(drive, kind, attribute, path)
            print_lines(f"{path}: {rows} x {columns}")
    return 0


def write_image(drive: Drive, kind: ImageKind, attribute: str, path: Path) -> tuple[int, int]:
    """Write a drive's image; gives its rows and columns.

    An image of more than 400 million pixels is written with every second, third … row and column.

    Raises
    ------
    Unsuitable
        The drive can't be shown so.
    NoSpace
    """
    image = drive.image(kind)
    step = 1
    while (image.rows // step) * (image.width // step) > _MOST_PIXELS:
        step += 1
    points = image.raster(range(image.rows), range(image.width), step)
    write_png(path, colours(drive, points, attribute, 2.0, 98.0))
    return points.shape[0], points.shape[1]


def _path_of(output: Path, number: int, drive: Drive) -> Path:
    """The output itself for the first drive; the others have their name added."""
    if number == 0:
        return output
    name = "".join(letter if letter.isalnum() else "-" for letter in drive.info.name)
    return output.with_name(f"{output.stem}-{number + 1}-{name}{output.suffix}")


def _word(word: str, known: dict[str, WordT]) -> WordT:
    if word not in known:
        raise OutOfRange(
            Text("There is no such image.", "そのような画像はありません。"),
            Text.same(word),
            Text("Use one of: {names}.", "次のいずれかを指定してください: {names}").filled(
                names=", ".join(known)
            ),
        )
    return known[word]
