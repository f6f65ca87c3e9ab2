"""The catalogue as an office writes it: TOML, checked word for word, refused with the line."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, get_args

from processing.core.errors import UNCHANGED, BadFile
from processing.core.japanese_text import read_text
from processing.core.text import Text
from processing.map.catalogue import (
    LINE_TYPES,
    RESERVED_ATTRIBUTES,
    AttributeField,
    AttributeType,
    Catalogue,
    FeatureKind,
    Geometry,
)
from resources import path_of

_LARGEST_BYTES = 4 << 20
_THICKEST_M = 10.0
_ID = re.compile(r"[a-z][a-z0-9_]*")
_COLOUR = re.compile(r"#[0-9a-fA-F]{6}")
_DM_CODE = re.compile(r"[0-9]{4}")
_NOT_IN_LAYERS = re.compile(r"[<>/\\\":;?*|=,'`^\x00-\x1f\x7f]")
_KIND_KEYS = frozenset(
    {"id", "ja", "en", "geometry", "dm_code", "layer", "colour", "aci", "line_type", "symbol"}
    | {"attributes", "key", "thickness_m"}
)
_ATTRIBUTE_KEYS = frozenset({"id", "ja", "en", "type", "unit", "choices"})


def read_catalogue(path: Path) -> Catalogue:
    """Read the kinds that an office draws.

    Parameters
    ----------
    path : Path
        TOML in UTF-8 (or cp932): ``[attribute.NAME]`` tables with ``ja``, ``en``, ``type``,
        ``unit``, ``choices``, then one ``[[kind]]`` table for each kind.

    Raises
    ------
    MissingInput, NoSpace
        The file can't be read.
    BadFile
        It is no text or no catalogue; names the line.
    """
    text = read_text(path)
    whole = _Table(path, text.replace("\r\n", "\n").split("\n"), {}, 0)
    if len(text) > _LARGEST_BYTES:
        raise whole.refusal("", Text("The file is too long.", "ファイルが大きすぎます。"), line=1)
    try:
        data = tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise _not_toml(whole, error) from error
    whole = _Table(path, whole.lines, data, 0)
    whole.check_keys(frozenset({"attribute", "kind"}))
    attributes = _read_attributes(whole)
    kinds = tuple(_read_kind(table, attributes) for table in _kind_tables(whole))
    if not kinds:
        raise whole.refusal(
            "kind", Text("The catalogue has no kind.", "カタログに種別がありません。"), line=1
        )
    return Catalogue(kinds)


@dataclass(frozen=True)
class _Table:
    """A table of the file with the line of its header; 0 for the file itself."""

    path: Path
    lines: list[str]
    values: Mapping[str, Any]  # what TOML can hold
    header: int

    def line_of(self, key: str) -> int:
        """The line where a key of this table is set; its header's where it is not found."""
        setting = re.compile(rf'\s*["\']?{re.escape(key)}["\']?\s*[=.]')
        for number in range(self.header + 1, len(self.lines) + 1):
            line = self.lines[number - 1]
            if self.header and line.lstrip().startswith("["):
                break
            if setting.match(line) or (not self.header and _opens(line, key)):
                return number
        return max(self.header, 1)

    def refusal(self, key: str, what: Text, line: int | None = None) -> BadFile:
        """The error that names the line of a key."""
        number = self.line_of(key) if line is None else line
        return BadFile(
            what,
            Text(f"{self.path}, line {number:,}", f"{self.path}、{number:,}行目"),
            _CORRECT,
        )

    def check_keys(self, known: frozenset[str]) -> None:
        for key in self.values:
            if key not in known:
                raise self.refusal(
                    key,
                    Text(
                        "There is no entry “{key}”; known are: {known}.",
                        "「{key}」という項目はありません。使える項目: {known}",
                    ).filled(key=_short(key), known=", ".join(sorted(known))),
                )

    def word(self, key: str, *, default: str | None = None) -> str:
        """A text; without ``default`` it must be there and not be blank."""
        value = self.values.get(key, default)
        if not isinstance(value, str) or (default is None and not value.strip()):
            raise self.refusal(
                key,
                Text(
                    "The entry “{key}” is missing or is no text.",
                    "項目「{key}」がないか、文字列ではありません。",
                ).filled(key=key),
            )
        return value

    def matching(self, key: str, pattern: re.Pattern[str], meant: Text, default: str = "") -> str:
        """A text of a certain form, or ``default`` where it is left out."""
        value = self.word(key, default=default)
        if value != default and not pattern.fullmatch(value):
            raise self.not_allowed(key, value, meant)
        return value

    def one_of(self, key: str, allowed: Iterable[str], default: str | None = None) -> str:
        """One of some words."""
        value, words = self.word(key, default=default), tuple(allowed)
        if value not in words:
            raise self.not_allowed(key, value, Text.same(", ".join(words)))
        return value

    def not_allowed(self, key: str, value: object, meant: Text) -> BadFile:
        """The error for a value that a key can't have."""
        return self.refusal(
            key,
            Text(
                "“{value}” is not allowed for “{key}”; allowed: {meant}.",
                "「{key}」に「{value}」は使えません。使える値: {meant}",
            ).filled(value=_short(value), key=key, meant=meant),
        )

    def name(self) -> Text:
        """The names in both languages."""
        return Text(self.word("en"), self.word("ja"))


_CORRECT = Text(
    "Correct this line of the catalogue and open it again. {unchanged}",
    "カタログのこの行を修正して、開き直してください。{unchanged}",
).filled(unchanged=UNCHANGED)


def _read_attributes(whole: _Table) -> dict[str, AttributeField]:
    tables = whole.values.get("attribute", {})
    if not isinstance(tables, dict):
        raise whole.not_allowed("attribute", tables, Text.same("[attribute.NAME]"))
    read = {}
    headers = _headers(whole.lines)
    for name, values in tables.items():
        header = _line_of_header(headers, rf"attribute\s*\.\s*[\"']?{re.escape(name)}[\"']?")
        if not isinstance(values, dict):
            raise whole.not_allowed("attribute", name, Text.same("[attribute.NAME]"))
        read[name] = _read_attribute(_Table(whole.path, whole.lines, values, header), name)
    return read


def _read_attribute(table: _Table, name: str) -> AttributeField:
    table.check_keys(_ATTRIBUTE_KEYS)
    id_ = table.matching("id", _ID, _ID_MEANT, default=name)
    if not _ID.fullmatch(id_) or id_ in RESERVED_ATTRIBUTES:
        raise table.not_allowed("id", id_, _ID_MEANT)
    type_ = table.one_of("type", get_args(AttributeType))
    choices = _read_choices(table)
    if (type_ == "choice") != bool(choices):
        raise table.refusal(
            "choices" if choices else "type",
            Text(
                "Choices belong to the type “choice”, which needs at least one.",
                "choicesはtypeが「choice」のときだけ、1つ以上指定します。",
            ),
        )
    return AttributeField(
        id=id_,
        name=table.name(),
        type=type_,  # type: ignore[arg-type]  # checked against the type's own words
        unit=table.word("unit", default=""),
        choices=tuple(choices),
        choice_names=tuple(choices.values()),
    )


def _read_choices(table: _Table) -> dict[str, Text]:
    """``["a", "b"]``, or ``{ a = { ja = "…", en = "…" } }`` with names."""
    given = table.values.get("choices", {})
    meant = Text(
        '["a", "b"] or {a = {en = "…", ja = "…"}}', '["a"]または{a = {en = "…", ja = "…"}}'
    )
    if isinstance(given, list) and all(isinstance(one, str) and one for one in given):
        if len(set(given)) == len(given):
            return {one: Text.same(one) for one in given}
        raise table.not_allowed("choices", given, meant)
    if not isinstance(given, dict):
        raise table.not_allowed("choices", given, meant)
    choices = {}
    for value, names in given.items():
        if not isinstance(names, dict) or set(names) != {"en", "ja"} or not value:
            raise table.not_allowed("choices", value, meant)
        if not all(isinstance(name, str) and name.strip() for name in names.values()):
            raise table.not_allowed("choices", value, meant)
        choices[value] = Text(names["en"], names["ja"])
    return choices


def _kind_tables(whole: _Table) -> list[_Table]:
    values = whole.values.get("kind", [])
    if not isinstance(values, list) or not all(isinstance(one, dict) for one in values):
        raise whole.not_allowed("kind", values, Text.same("[[kind]]"))
    headers = _lines_of_headers(_headers(whole.lines), r"\[\s*kind\s*\]")
    # Kinds written as one inline array have no headers: the array's line stands for all.
    headers += [whole.line_of("kind")] * (len(values) - len(headers))
    tables = [
        _Table(whole.path, whole.lines, one, header)
        for one, header in zip(values, headers, strict=False)
    ]
    for key in ("id", "key"):
        _check_unique(tables, key)
    return tables


def _check_unique(tables: list[_Table], key: str) -> None:
    first: dict[str, int] = {}
    for table in tables:
        value = table.word(key, default="")
        if value and value in first:
            raise table.refusal(
                key,
                Text(
                    "“{value}” stands twice as “{key}”, first in line {line}.",
                    "「{key}」の「{value}」が重複しています（最初は{line}行目）。",
                ).filled(value=_short(value), key=key, line=first[value]),
            )
        first[value] = table.line_of(key)


def _read_kind(table: _Table, attributes: Mapping[str, AttributeField]) -> FeatureKind:
    table.check_keys(_KIND_KEYS)
    aci = table.values.get("aci")
    if not isinstance(aci, int) or isinstance(aci, bool) or not 1 <= aci <= 255:
        raise table.not_allowed("aci", aci, Text.same("1–255"))
    layer = table.word("layer")
    if _NOT_IN_LAYERS.search(layer) or len(layer) > 200 or layer != layer.strip():
        raise table.not_allowed("layer", layer, _LAYER_MEANT)
    id_ = table.word("id")
    if not _ID.fullmatch(id_):
        raise table.not_allowed("id", id_, _ID_MEANT)
    colour = table.word("colour")
    if not _COLOUR.fullmatch(colour):
        raise table.not_allowed("colour", colour, Text.same("#rrggbb"))
    return FeatureKind(
        id=id_,
        name=table.name(),
        geometry=Geometry(table.one_of("geometry", [one.value for one in Geometry])),
        dm_code=table.matching("dm_code", _DM_CODE, Text("four digits", "4桁の数字")),
        layer=layer,
        colour=colour.lower(),
        aci=aci,
        line_type=table.one_of("line_type", LINE_TYPES, default="continuous"),
        symbol=table.one_of("symbol", ("", *symbol_names()), default=""),
        attributes=_chosen_attributes(table, attributes),
        key=table.one_of("key", ("", *"1234567890"), default=""),
        thickness_m=_read_thickness(table),
    )


def _read_thickness(table: _Table) -> float:
    value = table.values.get("thickness_m", 0.0)
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if not is_number or not 0.0 <= value <= _THICKEST_M:
        raise table.not_allowed("thickness_m", value, Text.same(f"0–{_THICKEST_M:g}"))
    return float(value)


def _chosen_attributes(
    table: _Table, attributes: Mapping[str, AttributeField]
) -> tuple[AttributeField, ...]:
    names = table.values.get("attributes", [])
    if not isinstance(names, list):
        raise table.not_allowed("attributes", names, Text.same('["…", "…"]'))
    for name in names:
        if not isinstance(name, str) or name not in attributes:
            raise table.not_allowed("attributes", name, Text.same(", ".join(attributes) or "–"))
    chosen = tuple(attributes[name] for name in names)
    if len({one.id for one in chosen}) < len(chosen):
        raise table.refusal(
            "attributes",
            Text("An attribute stands twice in a kind.", "1つの種別に同じ属性が重複しています。"),
        )
    return chosen


@cache
def symbol_names() -> tuple[str, ...]:
    """The survey symbols that come with the program, by name."""
    return tuple(sorted(path.stem for path in path_of("symbols").glob("*.svg")))


_ID_MEANT = Text(
    "small letters, digits and _ that begin with a letter, not one of {reserved}",
    "英小文字で始まる英小文字・数字・_（{reserved} を除く）",
).filled(reserved=", ".join(sorted(RESERVED_ATTRIBUTES)))
_LAYER_MEANT = Text(
    "a name that DXF allows: no < > / \\ \" : ; ? * | = , ' ` ^",
    "DXFの画層名に使える文字（< > / \\ \" : ; ? * | = , ' ` ^ 以外）",
)


def _not_toml(whole: _Table, error: ValueError | RecursionError) -> BadFile:
    position = re.search(r"\(at line (\d+), column \d+\)", str(error))
    at_end = len(whole.lines) if "end of document" in str(error) else 1
    reason = re.sub(r"\s*\(at .*\)$", "", str(error))
    return whole.refusal(
        "",
        Text("The catalogue is not TOML: {reason}.", "TOMLとして読めません（{reason}）。").filled(
            reason=_short(reason)
        ),
        line=int(position[1]) if position else at_end,
    )


def _headers(lines: list[str]) -> list[tuple[int, str]]:
    """The lines that open a table, numbered from 1."""
    return [(number, line) for number, line in enumerate(lines, 1) if line.lstrip()[:1] == "["]


def _line_of_header(headers: list[tuple[int, str]], name: str) -> int:
    return next(iter(_lines_of_headers(headers, name)), 1)


def _lines_of_headers(headers: list[tuple[int, str]], name: str) -> list[int]:
    header = re.compile(rf"\s*\[\s*{name}\s*\]")
    return [number for number, line in headers if header.match(line)]


def _opens(line: str, key: str) -> bool:
    return re.match(rf"\s*\[+\s*[\"']?{re.escape(key)}[\"']?\s*[\].]", line) is not None


def _short(value: object) -> str:
    words = " ".join(str(value).split())
    return words if len(words) <= 80 else words[:79] + "…"
