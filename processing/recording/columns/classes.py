"""Point classes: the codes that points may carry, with names and colours."""

from __future__ import annotations

import re
import tomllib
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

from processing.core.errors import BadFile, report_as_user_error
from processing.core.text import Text
from resources import path_of

_LAST_KEY = 9
_HIGH_NOISE, _KEY_OF_HIGH_NOISE = 18, "8"
_COLOUR = re.compile(r"#[0-9a-fA-F]{6}")


@dataclass(frozen=True)
class PointClass:
    """One class of points.

    Attributes
    ----------
    code : int
        As in the column ``classification``, 0 to 255.
    colour : str
        ``#rrggbb``.
    """

    code: int
    name: Text
    colour: str

    @property
    def rgb(self) -> tuple[int, int, int]:
        """The colour, 0 to 255 each."""
        red, green, blue = bytes.fromhex(self.colour[1:])
        return red, green, blue


@lru_cache(maxsize=1)
def point_classes() -> tuple[PointClass, ...]:
    """The classes that come with the program, by rising code."""
    return read_classes(path_of("catalogue/classes.toml"))


def class_key(code: int) -> str:
    """The number key that takes a class, with a paint tool in the hand; empty without one.

    It is the class's own number; 8, which no class has, takes noise that isn't below the ground.
    """
    if code == _HIGH_NOISE:
        return _KEY_OF_HIGH_NOISE
    return str(code) if 0 <= code <= _LAST_KEY and str(code) != _KEY_OF_HIGH_NOISE else ""


def read_classes(path: Path) -> tuple[PointClass, ...]:
    """Read a table of point classes.

    Raises
    ------
    MissingInput, BadFile
        There is no such file; it is not TOML; an entry is not as it should be.
    """
    with report_as_user_error(path):
        content = path.read_bytes()
    try:
        entries = tomllib.loads(content.decode("utf-8")).get("class", [])
    except ValueError as error:
        raise _bad(path, str(error)) from error
    if not isinstance(entries, list):
        raise _bad(path, "class")
    classes: dict[int, PointClass] = {}
    for number, entry in enumerate(entries, start=1):
        position = f"[[class]] {number}"
        one = _point_class(entry)
        if one is None or one.code in classes:
            raise _bad(path, position)
        classes[one.code] = one
    return tuple(classes[code] for code in sorted(classes))


# An entry comes from TOML, where every value may be of any type.
def _point_class(entry: Any) -> PointClass | None:
    if not isinstance(entry, dict):
        return None
    code, colour, name = entry.get("code"), entry.get("colour"), entry.get("name")
    if not isinstance(code, int) or not 0 <= code <= 255:
        return None
    if not isinstance(colour, str) or not _COLOUR.fullmatch(colour):
        return None
    if not isinstance(name, dict) or not all(isinstance(name.get(k), str) for k in ("en", "ja")):
        return None
    return PointClass(code, Text(name["en"], name["ja"]), colour)


def _bad(path: Path, position: str) -> BadFile:
    return BadFile(
        Text("The table of point classes is damaged.", "点クラス表の内容が正しくありません。"),
        Text.same(f"{path}: {position}"),
        Text(
            "Each class needs its own code (0 to 255), names in en and ja, and a #rrggbb colour.",
            "各クラスには重複しないコード（0～255）、英語と日本語の名称、#rrggbb形式の色が必要です。",
        ),
    )
