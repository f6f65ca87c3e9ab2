"""Classes of points as results and truths have them: point files, arrays of NumPy, text."""

from __future__ import annotations

import zipfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import BadFile, MissingInput, report_as_user_error
from processing.core.text import Text
from processing.formats.format import Content
from processing.formats.points.point_files import read_chunks, read_info
from processing.formats.points.text.text_numbers import TextPart, number_blocks
from processing.formats.registry import FORMATS
from processing.recording.columns.array_files import map_array, read_arrays
from processing.recording.columns.quantisation import Quantisation
from processing.scoring.points.coded_points import CodedFile, CodedPoints

_LOOKED_AT = 4096
_BLOCK = 1_000_000
_CODES = ("code", "codes", "label", "labels", "classification")
_TEXT_COLUMNS = 4
_LARGEST = 255

# Any: arrays of whatever type the file has.
Arrays = Mapping[str, NDArray[Any]]


def read_result(path: Path) -> CodedFile:
    """A point file with classes, as tools write it.

    Parameters
    ----------
    path : Path
        LAS or LAZ; another point file that has a classification.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        It can't be read, is damaged, or has no classes.
    """
    info = read_info(path)
    if "classification" not in info.attributes:
        raise BadFile(
            Text(
                "The file has no classes of points.", "点のクラス（classification）がありません。"
            ),
            Text.same(str(path)),
            Text("Choose a LAS or LAZ file.", "LASまたはLAZを指定してください。"),
        )
    quantisation = Quantisation(info.scale, info.offset)

    def blocks() -> Iterator[CodedPoints]:
        for chunk in read_chunks(path, _BLOCK):
            xyz = quantisation.metres(chunk.columns["xyz"])
            yield CodedPoints(chunk.columns["classification"], xyz)

    return CodedFile(path, info.count, max(info.scale), has_positions=True, blocks=blocks)


def read_truth(
    path: Path, *, if_false: int, if_true: int, flags: Mapping[str, tuple[int, int]]
) -> CodedFile:
    """True classes of points.

    Parameters
    ----------
    path : Path
        A point file with classes (:func:`read_result`); an ``.npy`` of one code per point, with
        ``kinds…`` of the same ending beside ``labels…``; an ``.npz`` with ``code`` (or
        ``classification``, or one of ``flags``) and any number of arrays of small whole numbers,
        the kinds; text with x y z class on each line and no header, as the ISPRS filter test.
    if_false, if_true : int
        What 0 and 1 mean in text that has no other classes.
    flags : mapping of str to (int, int)
        Arrays of yes and no that stand for codes: those for no and for yes.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        It can't be read, is damaged, or has no classes.
    """
    with report_as_user_error(path), path.open("rb") as file:
        start = file.read(_LOOKED_AT)
    found = FORMATS.recognised(start, Content.CLASSES)
    if found is not None and found[0].id in _ARRAYS:
        return _of_arrays(path, _ARRAYS[found[0].id](path), flags)
    if _is_isprs_text(start):
        return _of_text(path, if_false, if_true)
    return read_result(path)


def _loaded_array(path: Path) -> Arrays:
    arrays = {"code": _map_array(path)}
    beside = path.with_name(path.name.replace("labels", "kinds", 1))
    if beside != path and beside.exists():
        arrays["kind"] = _map_array(beside)
    return arrays


def _map_array(path: Path) -> NDArray[Any]:
    try:
        with report_as_user_error(path):
            return map_array(path)
    except (ValueError, EOFError) as error:
        raise _make_damage_error(path) from error


def _loaded_arrays(path: Path) -> Arrays:
    try:
        with report_as_user_error(path):
            return read_arrays(path)
    except (ValueError, EOFError, zipfile.BadZipFile, KeyError) as error:
        raise _make_damage_error(path) from error


_ARRAYS = {"npy": _loaded_array, "npz": _loaded_arrays}


def _of_arrays(path: Path, arrays: Arrays, flags: Mapping[str, tuple[int, int]]) -> CodedFile:
    codes = _codes_of(path, arrays, flags)
    kinds = {
        name: values
        for name, values in arrays.items()
        if values.shape == codes.shape
        and values.dtype.kind in "iu"
        and values.dtype.itemsize <= np.dtype(np.int16).itemsize
        and name not in _CODES
    }

    def blocks() -> Iterator[CodedPoints]:
        for start in range(0, codes.size, _BLOCK):
            part = slice(start, start + _BLOCK)
            yield CodedPoints(
                np.asarray(codes[part]).astype(np.uint8),
                kinds={name: np.asarray(one[part]).astype(np.int16) for name, one in kinds.items()},
            )

    return CodedFile(path, codes.size, 0.0, has_positions=False, blocks=blocks)


def _codes_of(
    path: Path, arrays: Arrays, flags: Mapping[str, tuple[int, int]]
) -> NDArray[np.integer[Any]]:
    name = next((one for one in _CODES if one in arrays), None)
    if name is not None:
        codes = arrays[name]
        if codes.ndim == 1 and codes.dtype.kind in "iu":
            if codes.size and (codes.min() < 0 or codes.max() > _LARGEST):
                raise _no_codes(path, f"{name}: {codes.min()} … {codes.max()}")
            return codes
        raise _no_codes(path, f"{name}: {codes.dtype} {codes.shape}")
    for flag, (no, yes) in flags.items():
        values = arrays.get(flag)
        if values is not None and values.ndim == 1 and values.dtype.kind == "b":
            return np.where(values, np.uint8(yes), np.uint8(no))
    raise MissingInput(
        Text(
            "There is no array of true classes.",
            "正解のクラスを表す配列がありません。",
        ),
        Text.same(f"{path}: {', '.join(arrays)}"),
        Text(
            "Name it “code”, or use: {names}.",
            "「code」という名前にするか、次を使ってください: {names}",
        ).filled(names=", ".join((*_CODES[1:], *flags))),
    )


def _is_isprs_text(start: bytes) -> bool:
    line = next((line for line in start.splitlines() if line.strip()), b"")
    words = line.replace(b",", b" ").replace(b";", b" ").split()
    if len(words) != _TEXT_COLUMNS:
        return False
    try:
        return all(np.isfinite(float(word)) for word in words)
    except ValueError:
        return False


def _of_text(path: Path, if_false: int, if_true: int) -> CodedFile:
    count, largest = 0, 0
    for block in number_blocks(TextPart(path), _TEXT_COLUMNS):
        bad = ~np.isfinite(block).all(axis=1)
        bad |= (block[:, 3] != np.rint(block[:, 3])) | (block[:, 3] < 0) | (block[:, 3] > _LARGEST)
        if bad.any():
            point = count + int(np.argmax(bad)) + 1
            raise BadFile(
                Text(
                    "A point has no place, or no class between 0 and 255.",
                    "座標、または0～255のクラスがない点があります。",
                ),
                Text(f"{path}, point {point:,}", f"{path}、{point:,}番目の点"),
                _AGAIN,
            )
        count += len(block)
        largest = max(largest, int(block[:, 3].max(initial=0)))
    codes_of = np.arange(_LARGEST + 1, dtype=np.uint8)
    if largest <= 1:
        codes_of[:2] = if_false, if_true

    def blocks() -> Iterator[CodedPoints]:
        for numbers in number_blocks(TextPart(path), _TEXT_COLUMNS):
            yield CodedPoints(codes_of[numbers[:, 3].astype(np.intp)], numbers[:, :3])

    return CodedFile(path, count, 0.0, has_positions=True, blocks=blocks)


def _no_codes(path: Path, reported: str) -> BadFile:
    return BadFile(
        Text("True classes are whole numbers from 0 to 255.", "正解のクラスは0～255の整数です。"),
        Text.same(f"{path}, {reported}"),
        _AGAIN,
    )


def _make_damage_error(path: Path) -> BadFile:
    return BadFile(
        Text("The arrays in the file are damaged.", "ファイル内の配列が壊れています。"),
        Text.same(str(path)),
        _AGAIN,
    )


_AGAIN = Text(
    "Make the truth again, or copy it again.", "正解を作り直すか、コピーし直してください。"
)
