"""Shapefiles read as a map, whatever code page and reference system they say or leave out."""

from __future__ import annotations

import codecs
from pathlib import Path

from processing.core.errors import BadFile, MissingInput, report_as_user_error
from processing.core.text import Text
from processing.formats.vectors.mapped_shapes import read_layers
from processing.scoring.features.mapped_features import MappedFile

_JAPANESE_DRIVERS = (0x13, 0x7B)
"""Language drivers of dBASE and FoxPro for code page 932."""

_DRIVER_AT = 29
_NAMES = {"932": "cp932", "ansi932": "cp932", "sjis": "cp932", "65001": "utf-8", "utf8": "utf-8"}
_COPY_ALL = Text(
    "Copy all files of the Shapefile (.shp, .shx, .dbf) into one folder.",
    "シェープファイルの一式（.shp・.shx・.dbf）を同じフォルダに置いてください。",
)


def read_shapefile_features(path: Path) -> MappedFile:
    """The points, lines and areas of a Shapefile; parts of one are features of their own.

    Texts are in the code page of the ``.cpg``; without one in that of the table's own mark, else in
    UTF-8 or cp932, whichever they are. The layer of a feature is the file's name unless it says
    another; without a ``.prj`` the map says no reference system.

    Raises
    ------
    MissingInput, NoSpace
        A part is missing or can't be read.
    BadFile
        It is none, or damaged; its texts are not in the code page that it says.

    References
    ----------
    ESRI, Shapefile technical description, 1998; dBASE table file format, level 5.
    """
    with report_as_user_error(path), path.open("rb"):
        str(path).encode()
    for ending in (".shx", ".dbf"):
        if _part(path, ending) is None:
            raise MissingInput(
                Text(
                    "The Shapefile lacks its {ending}.", "シェープファイルの{ending}がありません。"
                ).filled(ending=ending),
                Text.same(str(path)),
                _COPY_ALL,
            )
    encoding = _encoding_of(path)
    name = Text("Shapefile", "シェープファイル")
    return read_layers(path, name, encoding=encoding, layer=path.stem)


def _part(path: Path, ending: str) -> Path | None:
    """The file beside it with an ending in small or capital letters."""
    beside = (path.with_suffix(one) for one in (ending, ending.upper()))
    return next((one for one in beside if one.is_file()), None)


def _encoding_of(path: Path) -> str:
    table = _part(path, ".dbf") or path
    with report_as_user_error(table):
        data = table.read_bytes()
    head = int.from_bytes(data[8:10], "little")
    said = _said_encoding(path)
    texts = data[head:]
    fitting = [one for one in ("utf-8", "cp932") if _reads(texts, one)]
    driver = data[_DRIVER_AT] if len(data) > _DRIVER_AT else 0
    if not said:
        is_japanese = driver in _JAPANESE_DRIVERS and "cp932" in fitting
        return "cp932" if is_japanese else next(iter(fitting), "cp932")
    is_plain = texts.isascii()
    is_other = said != "utf-8" and "utf-8" in fitting
    if not is_plain and (is_other or not _reads(texts, said)):
        raise BadFile(
            Text(
                "The texts are not in the code page that the .cpg says ({said}).",
                "文字列が.cpgに書かれた文字コード（{said}）ではありません。",
            ).filled(said=said),
            Text.same(str(table)),
            Text(
                "Write {fits} into the .cpg, or delete it.",
                ".cpgの内容を{fits}に直すか、.cpgを削除してください。",
            ).filled(fits=next(iter(fitting), "CP932").upper()),
        )
    return said


def _reads(texts: bytes, encoding: str) -> bool:
    try:
        texts.decode(encoding)
    except UnicodeDecodeError:
        return False
    return True


def _said_encoding(path: Path) -> str:
    """What the .cpg says, as Python calls it; empty without one."""
    part = _part(path, ".cpg")
    if part is None:
        return ""
    with report_as_user_error(part):
        words = part.read_bytes()[:64].decode("ascii", "replace").strip()
    plain = words.lower().replace(" ", "").replace("-", "").replace("_", "")
    try:
        found = codecs.lookup(_NAMES.get(plain, words)).name if words else ""
    except LookupError as error:
        raise BadFile(
            Text("The .cpg says no known code page.", ".cpgに書かれた文字コードが不明です。"),
            Text.same(f"{part}: {words}"),
            Text("Write UTF-8 or CP932 into it.", "UTF-8またはCP932と書いてください。"),
        ) from error
    return "cp932" if found == "shift_jis" else found
