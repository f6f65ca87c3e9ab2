"""The table of limits as it is written: TOML, checked word for word, refused with the line."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any, TypeGuard

from processing.core.errors import BadFile
from processing.core.text import Text
from processing.core.toml_lines import line_error, short, toml_content, toml_of
from processing.methods.earthwork.as_built.limits import (
    AllowedRange,
    AsBuiltLimits,
    FaceKind,
    FaceLimits,
    WorkType,
)
from resources import path_of

BUNDLED = "catalogue/as_built_limits.toml"
_LARGEST_MM, _LARGEST_MARGIN_MM, _LARGEST_DENSITY = 100_000.0, 10_000.0, 1_000_000.0
"""What a table may say (mm, mm, values a square metre): more is a slip of the unit."""

_MM, _PERCENT = 1000.0, 100.0
_ID = re.compile(r"[a-z][a-z0-9_]*")
_CORRECT = Text(
    "Correct this line of the table and open it again; nothing was written.",
    "規格値表のこの行を修正して、開き直してください。何も書き込まれていません。",
)


@lru_cache(maxsize=1)
def as_built_limits() -> AsBuiltLimits:
    """The table that comes with the program."""
    return read_limits(path_of(BUNDLED))


def read_limits(path: Path) -> AsBuiltLimits:
    """Read a table of limits; its form is explained in the one that comes with the program.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        It can't be read; it is not TOML in UTF-8; an entry is missing, unknown or out of range:
        the line is named.
    """
    return limits_of(toml_content(path), path)


def limits_of(content: bytes, path: Path) -> AsBuiltLimits:
    """The table of limits that a file holds, or held when it was read.

    Raises
    ------
    BadFile
        As :func:`read_limits`.
    """
    lines, values = toml_of(content, path, _CORRECT)
    return _limits(_Entry(path, lines, values, 0))


@dataclass(frozen=True)
class _Entry:
    """A table of the file with the line of its header; 0 for the file itself."""

    path: Path
    lines: Sequence[str]
    values: Mapping[str, Any]  # what TOML can hold
    header: int

    def refused(self, key: str, what: Text) -> BadFile:
        return line_error(what, self.path, self._line_of(key), _CORRECT)

    def not_allowed(self, key: str, meant: Text) -> BadFile:
        """The error for a key that is missing or has a value that it can't have."""
        if key not in self.values:
            what = Text(
                "The entry “{key}” is missing: {meant}.", "項目「{key}」がありません（{meant}）。"
            )
            return self.refused(key, what.filled(key=key, meant=meant))
        what = Text(
            "“{value}” is not allowed for “{key}”; allowed: {meant}.",
            "「{key}」に「{value}」は使えません。使える値: {meant}",
        )
        return self.refused(key, what.filled(value=short(self.values[key]), key=key, meant=meant))

    def check_keys(self, *known: str) -> None:
        for key in self.values:
            if key not in known:
                what = Text(
                    "There is no entry “{key}”; known are: {known}.",
                    "「{key}」という項目はありません。使える項目: {known}",
                )
                raise self.refused(key, what.filled(key=short(key), known=", ".join(known)))

    def name(self, key: str) -> Text:
        value = self.values.get(key)
        meant = Text.same('{ en = "…", ja = "…" }')
        if not isinstance(value, dict) or set(value) != {"en", "ja"}:
            raise self.not_allowed(key, meant)
        if not all(isinstance(one, str) and one.strip() for one in value.values()):
            raise self.not_allowed(key, meant)
        return Text(value["en"].strip(), value["ja"].strip())

    def number(self, key: str, largest: float, *, above_zero: bool) -> float:
        value = self.values.get(key)
        if not _is_number(value) or not 0.0 <= value <= largest or (above_zero and value == 0):
            low = ">" if above_zero else "≥"
            raise self.not_allowed(key, Text.same(f"{low} 0, ≤ {largest:g}"))
        return float(value)

    def allowed(self, key: str) -> AllowedRange:
        """``50``, or ``[-50, inf]``, mm."""
        value = self.values.get(key)
        ends = [-value, value] if _is_number(value) else value
        meant = Text("50, or [-50, 30], or [-50, inf] (mm)", "50、[-50, 30]、[-50, inf]（mm）")
        if not isinstance(ends, list) or len(ends) != 2 or not all(map(_is_number, ends)):
            raise self.not_allowed(key, meant)
        low, high = ends
        is_one_finite = math.isfinite(low) or math.isfinite(high)
        sizes = [size for size in (-low, high) if math.isfinite(size)]
        if not is_one_finite or not all(0.0 < size <= _LARGEST_MM for size in sizes) or low > high:
            raise self.not_allowed(key, meant)
        return AllowedRange(low / _MM, high / _MM)

    def tables(self, key: str, header: str) -> list[_Entry]:
        """The tables of an array below this entry, each with the line of its header."""
        values = self.values.get(key)
        if not isinstance(values, list) or not values:
            raise self.not_allowed(key, Text.same(f"[[{header}]]"))
        if not all(isinstance(one, dict) for one in values):
            raise self.not_allowed(key, Text.same(f"[[{header}]]"))
        pattern = re.compile(r"\s*\[\[\s*" + re.escape(header).replace(r"\.", r"\s*\.\s*"))
        found = [
            number
            for number, line in enumerate(self.lines, 1)
            if number > self.header and re.match(pattern.pattern + r"\s*\]\]", line)
        ]
        # Tables written in another form have no headers: this entry's line stands for them.
        found += [max(self.header, 1)] * len(values)
        return [
            _Entry(self.path, self.lines, one, line)
            for one, line in zip(values, found, strict=False)
        ]

    def _line_of(self, key: str) -> int:
        setting = re.compile(rf'\s*\[*["\']?{re.escape(key)}["\']?\s*[=.\]]')
        for number in range(self.header + 1, len(self.lines) + 1):
            line = self.lines[number - 1]
            if self.header and line.lstrip().startswith("["):
                break
            if key and setting.match(line):
                return number
        return max(self.header, 1)


def _limits(whole: _Entry) -> AsBuiltLimits:
    whole.check_keys("standard", "work_type")
    values = whole.values.get("standard")
    if not isinstance(values, dict):
        raise whole.not_allowed("standard", Text.same("[standard]"))
    opens = re.compile(r"\s*\[\s*standard\s*\]")
    line = next((n for n, one in enumerate(whole.lines, 1) if opens.match(one)), 1)
    standard = _Entry(whole.path, whole.lines, values, line)
    standard.check_keys("name", "edition", "rejected_percent", "margin_mm", "density_per_m2")
    entries = whole.tables("work_type", "work_type")
    return AsBuiltLimits(
        standard=standard.name("name"),
        edition=standard.name("edition"),
        rejected_share=standard.number("rejected_percent", _PERCENT, above_zero=False) / _PERCENT,
        margin_m=standard.number("margin_mm", _LARGEST_MARGIN_MM, above_zero=False) / _MM,
        density_per_m2=standard.number("density_per_m2", _LARGEST_DENSITY, above_zero=False),
        work_types=_work_types(entries),
    )


def _work_types(entries: Sequence[_Entry]) -> tuple[WorkType, ...]:
    read: dict[str, WorkType] = {}
    for entry in entries:
        entry.check_keys("id", "name", "face")
        id_ = entry.values.get("id")
        if not isinstance(id_, str) or not _ID.fullmatch(id_):
            meant = Text("small letters, digits and _", "英小文字・数字・_")
            raise entry.not_allowed("id", meant)
        if id_ in read:
            raise entry.refused("id", _TWICE.filled(value=id_))
        read[id_] = WorkType(id_, entry.name("name"), _faces(entry))
    return tuple(read.values())


def _faces(work_type: _Entry) -> tuple[FaceLimits, ...]:
    read: dict[FaceKind, FaceLimits] = {}
    for entry in work_type.tables("face", "work_type.face"):
        entry.check_keys("face", "name", "mean_mm", "single_mm")
        kinds = [one.value for one in FaceKind]
        if entry.values.get("face") not in kinds:
            raise entry.not_allowed("face", Text.same(", ".join(kinds)))
        face = FaceKind(entry.values["face"])
        if face in read:
            raise entry.refused("face", _TWICE.filled(value=face.value))
        mean, single = entry.allowed("mean_mm"), entry.allowed("single_mm")
        read[face] = FaceLimits(face, entry.name("name"), mean, single)
    return tuple(read.values())


_TWICE = Text("“{value}” stands twice.", "「{value}」が重複しています。")


def _is_number(value: object) -> TypeGuard[float]:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and not math.isnan(value)
