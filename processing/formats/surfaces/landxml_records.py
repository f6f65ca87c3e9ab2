"""What stands in a LandXML file about surfaces: points, faces, break lines, units and system."""

from __future__ import annotations

import math
from array import array
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.formats.surfaces.checked_xml import CheckedXml

_CORRECT = Text(
    "Correct the line, or export the file again.", "該当行を修正するか、書き出し直してください。"
)


@dataclass
class LandXmlHeader:
    """What a file says of all its numbers: attributes as written.

    Attributes
    ----------
    units : dict
        Of ``Metric`` or ``Imperial``.
    system : dict
        Of ``CoordinateSystem``.
    system_properties : dict
        Its properties: label to value.
    """

    units: dict[str, str] = field(default_factory=dict)
    system: dict[str, str] = field(default_factory=dict)
    system_properties: dict[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class DrawnSurface:
    """A surface as its file has it, in the file's axes and unit.

    Attributes
    ----------
    is_tin : bool
        Made of triangles, by what the file says.
    ids : (n,) int64
        Of the points.
    positions : (n, 3) float64
        North, east, height; NaN for a height that is not there.
    face_corners : (t, 3) int64
        Ids of points.
    point_lines, face_lines : (n,), (t,) int64
        Where they stand in the file, from 1.
    breaklines : tuple of (k, 3) float64
        North, east, height.
    invisible : int
        Faces that are marked as not part of the surface; they are left out.
    """

    name: str
    description: str
    is_tin: bool
    ids: NDArray[np.int64]
    positions: NDArray[np.float64]
    face_corners: NDArray[np.int64]
    point_lines: NDArray[np.int64]
    face_lines: NDArray[np.int64]
    breaklines: tuple[NDArray[np.float64], ...]
    invisible: int


def records_of(path: Path, monitor: Monitor) -> tuple[LandXmlHeader, list[DrawnSurface]]:
    """Read a file once, from its beginning to its end.

    Raises
    ------
    UserError
        What :meth:`processing.formats.surfaces.checked_xml.CheckedXml.read` raises; ``BadFile`` too
        for a number that is none, a face that is no triangle and a break line without heights.
    """
    reading = _Reading(path)
    reading.xml.read(reading.on_start, reading.on_end, monitor)
    return reading.header, reading.surfaces


@dataclass
class _Growing:
    """A surface while it is read."""

    name: str
    description: str
    is_tin: bool = True
    ids: array[int] = field(default_factory=lambda: array("q"))
    positions: array[float] = field(default_factory=lambda: array("d"))
    corners: array[int] = field(default_factory=lambda: array("q"))
    point_lines: array[int] = field(default_factory=lambda: array("q"))
    face_lines: array[int] = field(default_factory=lambda: array("q"))
    breaklines: list[NDArray[np.float64]] = field(default_factory=list)
    invisible: int = 0

    def finished(self) -> DrawnSurface:
        """The surface, whole."""
        return DrawnSurface(
            self.name,
            self.description,
            self.is_tin,
            np.array(self.ids, dtype=np.int64),
            np.array(self.positions, dtype=np.float64).reshape(-1, 3),
            np.array(self.corners, dtype=np.int64).reshape(-1, 3),
            np.array(self.point_lines, dtype=np.int64),
            np.array(self.face_lines, dtype=np.int64),
            tuple(self.breaklines),
            self.invisible,
        )


class _Reading:
    """Where a reading is, and what it has found."""

    def __init__(self, path: Path) -> None:
        self.xml = CheckedXml(path, "LandXML")
        self.header = LandXmlHeader()
        self.surfaces: list[DrawnSurface] = []
        self._surface: _Growing | None = None
        self._path: list[str] = []
        self._pieces: list[str] = []
        self._attributes: dict[str, str] = {}
        self._line = 0

    def on_start(self, name: str, attributes: dict[str, str]) -> None:
        """An element begins."""
        parent = self._path[-1] if self._path else ""
        self._path.append(name)
        if self._surface is None:
            self._on_header(name, parent, attributes)
        elif name == "Definition":
            self._surface.is_tin = attributes.get("surfType", "TIN").lower() == "tin"
        elif (name, parent) in (("P", "Pnts"), ("F", "Faces"), ("PntList3D", "Breakline")):
            self._attributes = attributes
            self._line = self.xml.line
            self._pieces.clear()
            self.xml.listen_to_text(self._pieces.append)

    def on_end(self, name: str) -> None:
        """An element ends."""
        self._path.pop()
        surface = self._surface
        if surface is None:
            return
        parent = self._path[-1]
        if name == "P" and parent == "Pnts":
            self._add_point(surface)
        elif name == "F" and parent == "Faces":
            self._add_face(surface)
        elif name == "PntList3D" and parent == "Breakline":
            self._add_breakline(surface)
        elif name == "Surface":
            self.surfaces.append(surface.finished())
            self._surface = None

    def _on_header(self, name: str, parent: str, attributes: dict[str, str]) -> None:
        if name == "Surface" and parent == "Surfaces":
            self._surface = _Growing(attributes.get("name", ""), attributes.get("desc", ""))
        elif parent == "Units":
            self.header.units.update(attributes)
        elif name == "CoordinateSystem":
            self.header.system.update(attributes)
        elif name == "Property" and "CoordinateSystem" in self._path:
            self.header.system_properties[attributes.get("label", "")] = attributes.get("value", "")

    def _words(self) -> list[str]:
        """The words of the element that ends."""
        self.xml.listen_to_text(None)
        return "".join(self._pieces).split()

    def _add_point(self, surface: _Growing) -> None:
        words = self._words()
        id_ = self._attributes.get("id", "")
        if len(words) not in (2, 3):
            what = Text(
                "The point {id} has {count} numbers instead of north, east and height.",
                "点{id}の座標が{count}個あります（X・Y・標高の3個が必要）。",
            )
            raise self._make_refusal(what.filled(id=id_ or "-", count=len(words)))
        surface.ids.append(self._whole(id_))
        surface.positions.extend(map(self._number, words))
        if len(words) == 2:
            surface.positions.append(math.nan)
        surface.point_lines.append(self._line)

    def _add_face(self, surface: _Growing) -> None:
        words = self._words()
        if self._attributes.get("i", "0").strip() not in ("0", ""):
            surface.invisible += 1
            return
        if not surface.is_tin:
            return  # of four corners and more
        if len(words) != 3:
            what = Text(
                "A face has {count} corners; a TIN has triangles.",
                "面の頂点が{count}個あります（TINは三角形です）。",
            )
            raise self._make_refusal(what.filled(count=len(words)))
        surface.corners.extend(map(self._whole, words))
        surface.face_lines.append(self._line)

    def _add_breakline(self, surface: _Growing) -> None:
        words = self._words()
        if len(words) % 3:
            what = Text(
                "A break line has {count} numbers, which are no triples of north, east and height.",
                "ブレークラインの数値が{count}個あり、X・Y・標高の組になっていません。",
            )
            raise self._make_refusal(what.filled(count=len(words)))
        if words:
            positions = np.array(list(map(self._number, words)), dtype=np.float64)
            surface.breaklines.append(positions.reshape(-1, 3))

    def _number(self, word: str) -> float:
        try:
            value = float(word)
        except ValueError:
            value = math.nan
        if not math.isfinite(value) or "_" in word:
            raise self._make_refusal(
                Text("“{word}” is no number.", "「{word}」は数値ではありません。").filled(
                    word=word[:40]
                ),
                Text(
                    "Write numbers with a point for decimals, blanks between them.",
                    "小数点は「.」とし、数値は空白で区切ってください。",
                ),
            )
        return value

    def _whole(self, word: str) -> int:
        try:
            value = int(word)
        except ValueError:
            value = -1
        if not 0 <= value < 1 << 62 or "_" in word:
            raise self._make_refusal(
                Text(
                    "“{word}” is no number of a point.", "「{word}」は点番号として使えません。"
                ).filled(word=word[:40])
            )
        return value

    def _make_refusal(self, what: Text, remedy: Text = _CORRECT) -> Exception:
        return self.xml.refused(what, self._line, remedy)
