"""A format that the program doesn't have, in one file, as a new one is added: TINY."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from processing.core.monitor import Monitor
from processing.core.parameters import count
from processing.core.safe_write import write_safely
from processing.core.text import Text
from processing.formats.format import Content, Format
from processing.formats.map_delivery import MapDelivery
from processing.formats.points.delivered.delivered_floats import ColumnBlock, FloatFile

_HERE = "tests.processing.formats.tiny_format"


@dataclass(frozen=True)
class TinyOptions:
    """What can be chosen for it."""

    tiny_decimals: int = count(1, low=0, high=3, name=Text("Decimals of TINY", "TINYの桁数"))


TINY = Format(
    "tiny",
    Text("Tiny", "小形式"),
    (".tiny",),
    reads={Content.POINTS: f"{_HERE}:open_tiny"},
    writes={Content.FEATURES: f"{_HERE}:write_tiny"},
    magic=b"TINY",
    map_title=Text("Tiny drawing", "小さな図面"),
    options=TinyOptions,
)


def open_tiny(path: Path) -> FloatFile:
    """The points of a file: a word, then x, y and z on each line."""

    def blocks() -> Iterator[ColumnBlock]:
        yield {"xyz": np.loadtxt(path, skiprows=1, ndmin=2)}

    return FloatFile(path, "TINY", blocks)


def write_tiny(
    path: Path, delivery: MapDelivery, _monitor: Monitor, *, never: Iterable[Path] = ()
) -> None:
    """Write a feature's kind and its first position on each line."""
    digits = delivery.options_of(TinyOptions).tiny_decimals
    lines = [
        " ".join([one.kind, *(f"{value:.{digits}f}" for value in one.vertices[0].xyz)])
        for one in delivery.features
    ]
    with write_safely(path, never=never) as temporary:
        temporary.write_text("\n".join(["TINY", *lines, ""]), encoding="utf-8")
