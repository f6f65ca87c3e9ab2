"""Surfaces of LandXML and J-LandXML: designs as triangles, with their break lines.

LandXML's points are north, east, height; they are turned to easting and northing here and nowhere
else. None of the libraries that the program has reads the format.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import BadFile, OutOfRange, Unsuitable, use_one_of
from processing.core.monitor import Monitor, SilentMonitor
from processing.core.text import Text
from processing.formats.surfaces.landxml_records import DrawnSurface, LandXmlHeader, records_of
from processing.formats.surfaces.landxml_systems import METRES, system_of_names
from processing.methods.earthwork.geometry.triangle_surface import TriangleSurface

_LEAST_AREA_M2 = 1e-8
"""Seen from above; what is smaller is an upright or collapsed face and holds no volume."""

_MOST_METRES = 1e8
_EXPORT_TIN = Text(
    "Export the surface with its triangles (TIN: Pnts and Faces).",
    "サーフェスを三角形網（TIN、PntsとFaces）で書き出してください。",
)


@dataclass(frozen=True)
class LandXmlSurface:
    """A surface as its file has it.

    Attributes
    ----------
    surface : TriangleSurface
        m; only corners of its triangles.
    description : str
        ``ExistingGround`` for terrain in J-LandXML.
    breaklines : tuple of (k, 3) float64
        Easting, northing, height, m.
    invisible, flat : int
        Faces left out: marked as not part of the surface, or without area seen from above.
    """

    surface: TriangleSurface
    description: str
    breaklines: tuple[NDArray[np.float64], ...]
    invisible: int
    flat: int


@dataclass(frozen=True)
class LandXmlFile:
    """What a LandXML file says of surfaces.

    Attributes
    ----------
    path : Path
    surfaces : tuple of LandXmlSurface
        Those of triangles, in the file's order.
    crs : str
        ``EPSG:n``, or empty where the file names none that is known.
    height_datum : str
        As the file names it (``T.P``, ``Y.P``); empty where it doesn't.
    zero_above_tp_m : float
        How high the zero of the heights lies above Tokyo Peil (differTP).
    unit : str
        Of the file's numbers, which are converted to metres here.
    """

    path: Path
    surfaces: tuple[LandXmlSurface, ...]
    crs: str
    height_datum: str
    zero_above_tp_m: float
    unit: str

    def only(self) -> LandXmlSurface:
        """The surface, where there is one.

        Raises
        ------
        Unsuitable
            There are several; tells their names.
        """
        if len(self.surfaces) > 1:
            names = ", ".join(one.surface.name or "-" for one in self.surfaces)
            raise Unsuitable(
                Text(
                    "The file has several surfaces: {names}.",
                    "複数のサーフェスがあります（{names}）。",
                ).filled(names=names),
                Text.same(str(self.path)),
                Text("Name the one that is meant.", "使用するサーフェスの名前を指定してください。"),
            )
        return self.surfaces[0]


def read_landxml(path: Path, *, surface: str = "", monitor: Monitor | None = None) -> LandXmlFile:
    """The surfaces of triangles in a LandXML 1.0 to 1.2 or J-LandXML file.

    Parameters
    ----------
    surface : str
        Only the one of this name; empty for all.

    Raises
    ------
    BadFile
        It is no LandXML, damaged, or a face or point in it makes no sense; tells the line.
    OutOfRange
        No surface has this name, or several have.
    Unsuitable
        It has no surface, or none of triangles.
    MissingInput, NoSpace
        It can't be read.
    Cancelled

    References
    ----------
    LandXML 1.2 (Surfaces, CoordinateSystem, Units); MLIT, J-LandXML 1.7.
    """
    header, drawn = records_of(path, monitor or SilentMonitor())
    chosen = _choose_surfaces(path, drawn, surface)
    scale = _scale(path, header)
    return LandXmlFile(
        path,
        tuple(_surface(path, one, scale) for one in chosen),
        system_of_names(header.system),
        header.system.get("verticalDatum", "").strip(),
        _difference(path, header),
        header.units.get("linearUnit", "meter"),
    )


def _choose_surfaces(path: Path, drawn: list[DrawnSurface], name: str) -> list[DrawnSurface]:
    where = Text.same(str(path))
    if not drawn:
        raise Unsuitable(
            Text("The file has no surface.", "サーフェスがありません。"), where, _EXPORT_TIN
        )
    found = [one for one in drawn if not name or one.name == name]
    if name and len(found) != 1:
        what = Text("The file has no such surface.", "その名前のサーフェスはありません。")
        if found:
            what = Text("Several surfaces have this name.", "同じ名前のサーフェスが複数あります。")
        raise OutOfRange(
            what, Text.same(f"{path}, {name}"), use_one_of(one.name or "-" for one in drawn)
        )
    with_faces = [one for one in found if one.is_tin and len(one.face_corners)]
    if not with_faces:
        raise Unsuitable(
            Text(
                "No surface has triangles: {names}.",
                "三角形網のあるサーフェスがありません（{names}）。",
            ).filled(names=", ".join(one.name or "-" for one in found)),
            where,
            _EXPORT_TIN,
        )
    return with_faces


def _scale(path: Path, header: LandXmlHeader) -> NDArray[np.float64]:
    """What makes metres of a file's easting, northing and height."""
    length = header.units.get("linearUnit", "meter")
    height = header.units.get("elevationUnit", length)
    for unit in (length, height):
        if unit.lower() not in METRES:
            raise BadFile(
                Text(
                    "The unit of length “{unit}” is not known.",
                    "長さの単位「{unit}」は未対応です。",
                ).filled(unit=unit),
                Text.same(str(path)),
                Text("Export the file in metres.", "メートル単位で書き出してください。"),
            )
    across = METRES[length.lower()]
    up = METRES[height.lower()]
    if {height.lower(), length.lower()} == {"feet", "ussurveyfoot"}:
        up = across  # heights are in “feet” there, whichever foot it is
    return np.array([across, across, up])


def _difference(path: Path, header: LandXmlHeader) -> float:
    words = header.system_properties.get("differTP", "").strip()
    try:
        value = float(words or 0.0)
    except ValueError:
        value = np.nan
    if not np.isfinite(value):
        raise BadFile(
            Text(
                "The height of the datum above T.P. (differTP) is no number: “{words}”.",
                "T.P.との差（differTP）が数値ではありません（「{words}」）。",
            ).filled(words=words),
            Text.same(str(path)),
            Text("Correct it in the file.", "ファイルを修正してください。"),
        )
    return value


def _surface(path: Path, drawn: DrawnSurface, scale: NDArray[np.float64]) -> LandXmlSurface:
    rows = _rows_of_corners(path, drawn)
    positions = drawn.positions[:, [1, 0, 2]] * scale
    used, corners = np.unique(rows, return_inverse=True)
    xyz = positions[used]
    corners = corners.reshape(-1, 3).astype(np.int64, copy=False)
    _require_positions(path, drawn, xyz[corners])
    # Counted from a corner: products of survey coordinates keep too few digits.
    first, second, third = (xyz[corners[:, at], :2] - xyz[corners[0, 0], :2] for at in range(3))
    (ax, ay), (bx, by) = (second - first).T, (third - first).T
    has_area = np.abs(ax * by - ay * bx) / 2 > _LEAST_AREA_M2
    if not has_area.any():
        raise _make_refusal(
            path,
            Text("All faces are without area seen from above.", "すべての面の平面積がゼロです。"),
            drawn.name,
            int(drawn.face_lines[0]),
        )
    used, kept = np.unique(corners[has_area], return_inverse=True)
    return LandXmlSurface(
        TriangleSurface(xyz[used], kept.reshape(-1, 3).astype(np.int64, copy=False), drawn.name),
        drawn.description,
        tuple(line[:, [1, 0, 2]] * scale for line in drawn.breaklines),
        drawn.invisible,
        int(np.count_nonzero(~has_area)),
    )


def _rows_of_corners(path: Path, drawn: DrawnSurface) -> NDArray[np.int64]:
    order = np.argsort(drawn.ids, kind="stable")
    ids = drawn.ids[order]
    twice = np.flatnonzero(ids[1:] == ids[:-1])
    if len(twice):
        row = int(order[twice[0] + 1])
        what = Text("Two points have the id {id}.", "点番号{id}が重複しています。")
        raise _make_refusal(
            path, what.filled(id=int(ids[twice[0]])), drawn.name, int(drawn.point_lines[row])
        )
    wanted = drawn.face_corners
    at = np.minimum(np.searchsorted(ids, wanted), max(len(ids) - 1, 0))
    is_missing = ids[at] != wanted if len(ids) else np.ones(wanted.shape, np.bool_)
    if is_missing.any():
        face, corner = np.argwhere(is_missing)[0].tolist()
        raise _make_refusal(
            path,
            Text(
                "Face {face:,} has the point {id}, which is missing.",
                "{face:,}番目の面の点{id}がありません。",
            ).filled(face=face + 1, id=int(wanted[face, corner])),
            drawn.name,
            int(drawn.face_lines[face]),
        )
    rows: NDArray[np.int64] = order[at]
    return rows


def _require_positions(path: Path, drawn: DrawnSurface, positions: NDArray[np.float64]) -> None:
    """Refuse faces with a corner without a height, or far beyond any coordinate."""
    is_bad = ~(np.abs(positions) < _MOST_METRES).all(axis=2)
    if is_bad.any():
        face, corner = np.argwhere(is_bad)[0].tolist()
        what = Text(
            "Face {face:,} has the point {id}, which has no height or lies beyond all coordinates.",
            "{face:,}番目の面の点{id}に標高がないか、座標が大きすぎます。",
        ).filled(face=face + 1, id=int(drawn.face_corners[face, corner]))
        raise _make_refusal(path, what, drawn.name, int(drawn.face_lines[face]))


def _make_refusal(path: Path, what: Text, name: str, line: int) -> BadFile:
    where = Text(
        f"{path}, line {line:,}, surface {name or '-'}",
        f"{path}、{line:,}行目、サーフェス {name or '-'}",
    )
    return BadFile(
        what, where, Text("Export the surface again.", "サーフェスを書き出し直してください。")
    )
