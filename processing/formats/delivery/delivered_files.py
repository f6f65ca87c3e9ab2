"""Names and places of files in an electronic delivery, checked against the rule."""

from __future__ import annotations

import re
from dataclasses import dataclass

from processing.core.errors import OutOfRange
from processing.core.text import Text

_FOLDER = re.compile(r"[A-Z0-9_]{1,8}")
_FILE = re.compile(r"[A-Z0-9_]{1,8}\.[A-Z0-9]{2,3}")

_ANOTHER = Text(
    "Give another name; nothing was written.",
    "別の名前を指定してください。何も書き込まれていません。",
)
SURVEY, TOPOGRAPHY = "SURVEY", "CHIKEI"
RECORDS, RESULTS = "WORK", "DATA"
"""測量記録 and 測量成果."""


@dataclass(frozen=True)
class SurveyFile:
    """A file of a delivery.

    Attributes
    ----------
    part : str
        `RECORDS` or `RESULTS`.
    folder : str
        Of the survey in that part (測量細区分フォルダ名).
    name : str
        With its ending.
    title : str
        What the standard calls it (測量成果名称).
    subtitle : str
        What it is of: a sheet's identifier.
    """

    part: str
    folder: str
    name: str
    title: str
    subtitle: str = ""

    @property
    def path(self) -> str:
        """From the delivery's folder."""
        return f"{SURVEY}/{TOPOGRAPHY}/{self.part}/{self.folder}/{self.name}"


def check_folder(name: str) -> str:
    """A folder's name as the rule has it; the same.

    Raises
    ------
    OutOfRange
        Other than up to 8 half-width capitals, digits and underscores.
    """
    if not _FOLDER.fullmatch(name):
        raise OutOfRange(
            Text(
                "A folder of a delivery has up to 8 half-width capitals, digits or underscores.",
                "電子納品のフォルダ名は、半角英大文字・数字・アンダースコアの8文字以内です。",
            ),
            Text.same(name or "–"),
            Text(
                "Give another name; nothing was written.",
                "別の名前を指定してください。何も書き込まれていません。",
            ),
        )
    return name


def check_file(name: str) -> str:
    """A file's name as the rule has it; the same.

    Raises
    ------
    OutOfRange
        Other than 8 half-width capitals, digits and underscores, a dot and 2 or 3 of them.
    """
    if not _FILE.fullmatch(name):
        raise OutOfRange(
            Text(
                "A file of a delivery has up to 8 half-width capitals, digits or underscores, and 2"
                " or 3 behind the dot.",
                "電子納品のファイル名は、半角英大文字・数字・アンダースコアの8文字以内と"
                "拡張子2～3文字です。",
            ),
            Text.same(name),
            Text(
                "Give another name; nothing was written.",
                "別の名前を指定してください。何も書き込まれていません。",
            ),
        )
    return name
