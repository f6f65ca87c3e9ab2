"""What the program knows of a format: its names, what it holds, and who reads and writes it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from enum import Enum
from importlib import import_module
from pathlib import Path
from typing import Any

from processing.core.text import Text


class Content(Enum):
    """What a file can hold; the value is its name for people."""

    POINTS = Text("Points", "点群")
    TRAJECTORY = Text("Trajectories", "走行軌跡")
    IMAGES = Text("Image lists", "画像一覧")
    FEATURES = Text("Features", "地物")
    AREAS = Text("Areas", "範囲")
    LINES = Text("Lines", "線")
    SURFACE = Text("Surfaces", "サーフェス")
    RASTER = Text("Rasters", "ラスタ")
    DRAWING = Text("Drawings", "図面")
    TABLE = Text("Tables", "表")
    REPORT = Text("Reports", "帳票")
    NUMBERS = Text("Numbers", "数値")
    PICTURE = Text("Pictures", "画像")
    PLOT = Text("Plots", "グラフ")
    CLASSES = Text("Classes of points", "点のクラス")
    CATALOGUE = Text("Catalogues", "カタログ")
    LIMITS = Text("Tables of limits", "規格値表")


DELIVERED = (Content.POINTS, Content.TRAJECTORY, Content.IMAGES)
"""What a delivery consists of, and a drop on the window may bring."""

BY_MAKER = ""
"""In place of a function where each that makes such files writes them in its own way."""

MAP = "features"
"""How the file of a map is called that is handed in, before its ending."""


@dataclass(frozen=True)
class Format:
    """A kind of file.

    Functions are named as ``module:function`` and imported when they are called, so that a list
    of formats costs nothing. What each is called with depends on the content:

    ============ =========================================================================
    points       ``read(path) -> FloatFile``; LAS and text have doors of their own
    trajectory   ``read(path, crs) -> Trajectory``
    features     ``read(path) -> MappedFile``; ``write(path, delivery, monitor, never=)``
    areas        ``read(path, layer) -> (polygons, crs)``
    ============ =========================================================================

    For others it is the function that knows the content, as its docstring says.

    Attributes
    ----------
    id : str
        As ``zuka export --format`` names it.
    name : Text
    endings : tuple of str
        Small, with their dot; none of a format that is a folder.
    reads, writes : mapping of Content to str
        The functions for what the program reads from it, and writes to it; or `BY_MAKER`.
    magic : bytes
        How each such file begins; empty where nothing fixed stands there.
    sniff : str
        ``(start: bytes) -> bool`` on a file's first bytes, where a magic isn't enough.
    sniff_folder : str
        ``(folder: Path) -> bool``, of a format that is a folder.
    layers : str
        ``(path) -> tuple of str``, of a format whose areas lie on layers: those that have any.
    map_title : Text or None
        What the map is called that is handed in so; None where it isn't.
    writes_map : str
        ``(delivery, position, monitor)`` where the map is several files; otherwise it is one, as
        `Content.FEATURES` is written.
    options : type or None
        Declared parameters that writing a map takes.
    needs_crs : bool
        Whether nothing can be done with it without a reference system.
    pages : str
        Name of the PDF with its sheets, true to scale, among its files; empty without one.
    has_attributes : bool
        Whether a map in it says the features' attributes, which name their pictures.
    """

    id: str
    name: Text
    endings: tuple[str, ...]
    reads: Mapping[Content, str] = field(default_factory=dict)
    writes: Mapping[Content, str] = field(default_factory=dict)
    magic: bytes = b""
    sniff: str = ""
    sniff_folder: str = ""
    layers: str = ""
    map_title: Text | None = None
    writes_map: str = ""
    options: type[object] | None = None
    needs_crs: bool = False
    pages: str = ""
    has_attributes: bool = True

    @property
    def ending(self) -> str:
        """The one that is proposed."""
        return self.endings[0]

    @property
    def file_filter(self) -> Text:
        """Its name and endings, as a file dialog takes them."""
        return filter_of(self.name, self.endings)

    def begins(self, start: bytes) -> bool:
        """Whether a file with these first bytes is known to be of it."""
        if self.magic:
            return start.startswith(self.magic)
        return bool(self.sniff) and bool(function_of(self.sniff)(start))

    def is_folder(self, path: Path) -> bool:
        """Whether a folder as a whole is of it."""
        return bool(self.sniff_folder) and bool(function_of(self.sniff_folder)(path))

    # Any: the functions of a content have their own arguments; each door knows its own.
    def reader(self, content: Content) -> Callable[..., Any]:
        """The function that reads a content from it."""
        return function_of(self.reads[content])

    def writer(self, content: Content) -> Callable[..., Any]:
        """The function that writes a content to it."""
        return function_of(self.writes[content])


# Any: as of Format.reader.
def function_of(name: str) -> Callable[..., Any]:
    """The function of a ``module:function``; its module is imported now."""
    module, _, function = name.partition(":")
    found: Callable[..., Any] = getattr(import_module(module), function)
    return found


def filter_of(name: Text, endings: tuple[str, ...]) -> Text:
    """A name and endings as a file dialog takes them: ``Areas (*.geojson *.gpkg)``."""
    pattern = " ".join(f"*{ending}" for ending in endings)
    return Text(f"{name.en} ({pattern})", f"{name.ja} ({pattern})")
