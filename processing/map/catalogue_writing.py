"""The catalogue written down as TOML, so that an office has something to start from."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from processing.core.safe_write import write_safely
from processing.core.text import Text
from processing.map.catalogue import AttributeField, Catalogue, FeatureKind
from processing.map.catalogue_file import read_catalogue

_HEAD = """\
# Feature kinds of a map; UTF-8. How to change them: docs/catalogue.md.
# 地物カタログ（UTF-8）。書き方は docs/catalogue.md を参照してください。
# An id that maps already use should stay: features know their kind by it.
# 使用中の id は変更しないでください。地物は id で種別を参照します。
"""


def write_catalogue(path: Path, catalogue: Catalogue, *, never: Iterable[Path] = ()) -> None:
    """Write a catalogue so that :func:`read_catalogue` gives the same.

    Parameters
    ----------
    never : iterable of Path
        Files that must not be overwritten.

    Raises
    ------
    InUse, NoSpace, MissingInput
        What stands against writing; what was there is as it was.
    BadFile
        The catalogue holds what a file of it can't: it could not be read again.
    """
    with catalogue_replaced(path, catalogue, never=never):
        pass


@contextmanager
def catalogue_replaced(
    path: Path, catalogue: Catalogue, *, never: Iterable[Path] = ()
) -> Iterator[None]:
    """As :func:`write_catalogue`; the file takes its name when the body is through."""
    with write_safely(path, never=never) as temporary:
        temporary.write_text(catalogue_text(catalogue), encoding="utf-8", newline="\n")
        read_catalogue(temporary)
        yield


def catalogue_text(catalogue: Catalogue) -> str:
    """A catalogue as TOML, with each attribute once."""
    names = _attribute_names(catalogue)
    parts = [_HEAD]
    parts += [_attribute_table(name, field) for field, name in names.items()]
    parts += [_kind_table(kind, names) for kind in catalogue]
    return "\n".join(parts)


def _attribute_names(catalogue: Catalogue) -> dict[AttributeField, str]:
    """A table's name for each attribute: its id, numbered where kinds mean different things."""
    fields = dict.fromkeys(field for kind in catalogue for field in kind.attributes)
    ids = {field.id for field in fields}
    names: dict[AttributeField, str] = {}
    taken: set[str] = set()
    for field in fields:
        name, number = field.id, 1
        while name in taken or (number > 1 and name in ids):
            number += 1
            name = f"{field.id}_{number}"
        taken.add(name)
        names[field] = name
    return names


def _attribute_table(name: str, field: AttributeField) -> str:
    lines = [f"[attribute.{name}]"]
    if name != field.id:
        lines.append(_setting("id", field.id))
    lines += [*_names(field.name), _setting("type", field.type)]
    if field.unit:
        lines.append(_setting("unit", field.unit))
    if field.choices:
        lines.append(_choices(field))
    return "\n".join(lines) + "\n"


def _kind_table(kind: FeatureKind, names: dict[AttributeField, str]) -> str:
    lines = ["[[kind]]", _setting("id", kind.id), *_names(kind.name)]
    lines.append(_setting("geometry", kind.geometry.value))
    if kind.dm_code:
        lines.append(_setting("dm_code", kind.dm_code))
    lines += [_setting("layer", kind.layer), _setting("colour", kind.colour), f"aci = {kind.aci}"]
    if kind.line_type != "continuous":
        lines.append(_setting("line_type", kind.line_type))
    if kind.symbol:
        lines.append(_setting("symbol", kind.symbol))
    if kind.attributes:
        chosen = ", ".join(_quote_value(names[field]) for field in kind.attributes)
        lines.append(f"attributes = [{chosen}]")
    if kind.key:
        lines.append(_setting("key", kind.key))
    if kind.thickness_m:
        lines.append(f"thickness_m = {kind.thickness_m!r}")
    return "\n".join(lines) + "\n"


def _names(name: Text) -> list[str]:
    return [_setting("ja", name.ja), _setting("en", name.en)]


def _choices(field: AttributeField) -> str:
    named = [
        f"{_quote_value(value)} = {{ en = {_quote_value(name.en)}, ja = {_quote_value(name.ja)} }}"
        for value in field.choices
        for name in (field.name_of_choice(value),)
    ]
    return f"choices = {{ {', '.join(named)} }}"


def _setting(key: str, value: str) -> str:
    return f"{key} = {_quote_value(value)}"


def _quote_value(value: str) -> str:
    # JSON's strings are TOML's, but for the one control character that JSON leaves bare.
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
