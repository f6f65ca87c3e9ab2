"""Values as people and other programs write them: TOML or JSON, read by a value's own types.

A frozen dataclass of plain values, paths, days, choices, geometry (as WKT) and such dataclasses
becomes a table; what has its default is left out. There is no second list of its fields: the types
that Python knows are the declaration.
"""

from __future__ import annotations

import dataclasses
import json
import re
import tomllib
import types
from collections.abc import Mapping
from datetime import date
from enum import Enum
from pathlib import Path
from typing import Any, Literal, TypeVar, Union, cast, get_args, get_origin, get_type_hints

import shapely
from shapely.geometry.base import BaseGeometry

from processing.core.errors import BadFile, OutOfRange, use_one_of
from processing.core.text import Text

ValueT = TypeVar("ValueT")
Table = dict[str, Any]  # what TOML and JSON hold

_BARE = re.compile(r"[A-Za-z0-9_-]+")
_NOT_READ = object()
_REMEDY = Text(
    "Write it as the program does: a table of TOML or JSON.",
    "プログラムが書き出すのと同じ形のTOMLまたはJSONで記述してください。",
)


def table_of(value: object) -> Table:
    """A dataclass as a table; fields that have their default are left out."""
    table: Table = {}
    for field in dataclasses.fields(cast("Any", value)):  # a dataclass, by construction
        given = getattr(value, field.name)
        if given != _default_of(field):
            table[field.name] = _plain(given)
    return table


def value_from(wanted: type[ValueT], table: Mapping[str, object], where: str = "") -> ValueT:
    """A dataclass from a table.

    Parameters
    ----------
    where : str
        What the table is called in messages.

    Raises
    ------
    OutOfRange
        A name that there isn't, a missing one, or a value of another type.
    """
    types_of = get_type_hints(wanted)
    known = {field.name: field for field in dataclasses.fields(cast("Any", wanted))}
    given: Table = {}
    for name, written in table.items():
        if name not in known:
            raise OutOfRange(
                Text("There is no such setting.", "そのような設定はありません。"),
                Text.same(_joined(where, name)),
                use_one_of(known),
            )
        given[name] = _read(types_of[name], written, _joined(where, name))
    for name, field in known.items():
        if name not in given and _default_of(field) is dataclasses.MISSING:
            raise OutOfRange(
                Text("A setting is missing.", "必要な設定がありません。"),
                Text.same(_joined(where, name)),
                _REMEDY,
            )
    return wanted(**given)


def toml_text(table: Mapping[str, object]) -> str:
    """A table as TOML: its own values first, then the tables in it.

    Raises
    ------
    OutOfRange
        A word holds what is no character, as names of files may.
    """
    lines: list[str] = []
    _write_table(table, "", lines)
    return "\n".join(lines) + "\n"


def json_text(table: Mapping[str, object]) -> str:
    """A table as JSON."""
    return json.dumps(table, ensure_ascii=False, indent=1) + "\n"


def table_from_text(text: str, where: str) -> Table:
    """The table that a text holds, JSON where it begins with a brace, else TOML.

    Raises
    ------
    BadFile
        It holds none.
    """
    try:
        if text.lstrip().startswith("{"):
            return cast("Table", json.loads(text))
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise BadFile(
            Text(
                "It is neither TOML nor JSON: {reason}.", "TOMLでもJSONでもありません（{reason}）。"
            ).filled(reason=" ".join(str(error).split())[:120]),
            Text.same(where),
            _REMEDY,
        ) from error


def _default_of(field: dataclasses.Field[Any]) -> object:
    if field.default_factory is not dataclasses.MISSING:
        return field.default_factory()
    return field.default


def _plain(value: object) -> object:
    if isinstance(value, Path):
        return str(value)
    if isinstance(value, Enum):
        return value.value
    if isinstance(value, date):
        return value.isoformat()
    if isinstance(value, BaseGeometry):
        return shapely.to_wkt(value, rounding_precision=-1)
    if isinstance(value, tuple):
        return [_plain(one) for one in value]
    if isinstance(value, Mapping):
        return {str(name): _plain(one) for name, one in value.items()}
    return table_of(value) if dataclasses.is_dataclass(value) else value


def _joined(where: str, name: str) -> str:
    return f"{where}.{name}" if where else name


def _read(wanted: Any, written: object, where: str) -> Any:  # a field's own type
    """A written value as a field wants it."""
    found = _as(wanted, written, where)
    if found is _NOT_READ:
        raise OutOfRange(
            Text("The value is not of the right type.", "値の種類が正しくありません。"),
            Text.same(f"{where}={written}"[:120]),
            _REMEDY,
        )
    return found


def _as(wanted: Any, written: object, where: str) -> Any:  # as above
    origin, inner = get_origin(wanted), get_args(wanted)
    if origin in (Union, types.UnionType):
        if type(written) in inner:
            return written
        read = (_as(one, written, where) for one in inner if one is not type(None))
        return next((one for one in read if one is not _NOT_READ), _NOT_READ)
    if origin is tuple:
        if not isinstance(written, list):
            return _NOT_READ
        return tuple(_read(inner[0], one, f"{where}[{n}]") for n, one in enumerate(written))
    if origin is Literal:
        return written if written in inner else _NOT_READ
    if dataclasses.is_dataclass(wanted) or origin is not None:
        if not isinstance(written, Mapping):
            return _NOT_READ
        if origin is None:
            return value_from(wanted, written, where)
        return {name: _read(inner[1], one, _joined(where, name)) for name, one in written.items()}
    return _as_plain(wanted, written)


def _as_plain(wanted: Any, written: object) -> Any:  # as above
    if wanted is Path and isinstance(written, str):
        return Path(written)
    if wanted is float and type(written) is int:
        return float(written)
    if isinstance(wanted, type) and issubclass(wanted, (Enum, date, BaseGeometry)):
        return _as_word(wanted, written)
    # A yes is a whole number to Python, but not to people.
    return written if type(written) is wanted else _NOT_READ


def _as_word(wanted: type[Enum | date | BaseGeometry], written: object) -> object:
    """A choice, a day or a geometry from how it is written."""
    if not isinstance(written, str):
        return _NOT_READ
    try:
        if issubclass(wanted, BaseGeometry):
            return shapely.from_wkt(written)
        return date.fromisoformat(written) if issubclass(wanted, date) else wanted(written)
    except (ValueError, shapely.errors.ShapelyError):
        return _NOT_READ


def _write_table(table: Mapping[str, object], name: str, lines: list[str]) -> None:
    inner = {key: one for key, one in table.items() if isinstance(one, Mapping)}
    for key, one in table.items():
        if key not in inner:
            lines.append(f"{_key(key)} = {toml_value(one)}")
    for key, one in inner.items():
        whole = _joined(name, _key(key))
        lines.extend(["", f"[{whole}]"])
        _write_table(one, whole, lines)


def _key(name: str) -> str:
    return name if _BARE.fullmatch(name) else _quoted(name)


def toml_value(value: object) -> str:
    """A value as TOML, on one line.

    Raises
    ------
    OutOfRange
        As :func:`toml_text`.
    """
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(toml_value, value))}]"
    if isinstance(value, Mapping):
        return f"{{{', '.join(f'{_key(key)} = {toml_value(one)}' for key, one in value.items())}}}"
    if isinstance(value, (int, float)):
        return repr(value)
    return _quoted(str(value))


def _quoted(words: str) -> str:
    try:
        words.encode("utf-8")
    except UnicodeEncodeError as error:
        raise OutOfRange(
            Text("A name holds what is no character.", "名前に文字でないものが含まれています。"),
            Text.same(ascii(words)),
            Text("Rename the file.", "ファイル名を変更してください。"),
        ) from error
    # TOML's strings are JSON's, but for one control character.
    return json.dumps(words, ensure_ascii=False).replace("\x7f", "\\u007f")
