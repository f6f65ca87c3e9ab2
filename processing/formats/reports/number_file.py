"""A JSON file of named numbers, as ``zuka run volume`` writes it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path

from processing.core.errors import BadFile
from processing.core.japanese_text import read_text
from processing.core.stored_json import json_of
from processing.core.text import Text


def read_numbers(path: Path, needed: Sequence[str]) -> Mapping[str, float]:
    """The numbers at the top of a JSON object, by their names; what is no number is left out.

    Parameters
    ----------
    needed : sequence of str
        Names that must be there.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        It can't be read, is no JSON object, or lacks a number.
    """
    text = read_text(path)
    try:
        whole = json_of(text)
    except ValueError as error:
        raise _no_object(path) from error
    if not isinstance(whole, dict):
        raise _no_object(path)
    numbers = {
        name: float(value)
        for name, value in whole.items()
        if isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)
    }
    lacking = [name for name in needed if name not in numbers]
    if lacking:
        raise BadFile(
            Text("The file has no number {names}.", "ファイルに数値 {names} がありません。").filled(
                names=", ".join(lacking)
            ),
            Text.same(str(path)),
            Text(
                "Choose what the tool wrote, or a truth with the same names.",
                "ツールの出力、または同じ名前の値を持つ正解を指定してください。",
            ),
        )
    return numbers


def _no_object(path: Path) -> BadFile:
    return BadFile(
        Text("The file is no JSON object.", "JSONオブジェクトではありません。"),
        Text.same(str(path)),
        Text("Choose a .json file of volumes.", "土量の .json ファイルを指定してください。"),
    )
