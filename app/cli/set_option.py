"""The option ``--set NAME=VALUE``, which many commands share."""

from __future__ import annotations

from processing.core.errors import OutOfRange
from processing.core.text import Text


def settings_of_words(words: list[str]) -> dict[str, str]:
    """What ``--set NAME=VALUE`` says, by name.

    Raises
    ------
    OutOfRange
        A setting has no value.
    """
    settings = {}
    for word in words:
        name, sign, value = word.partition("=")
        if not sign:
            raise OutOfRange(
                Text("A setting has no value.", "設定に値がありません。"),
                Text.same(f"--set {word}"),
                Text("Write --set NAME=VALUE.", "--set 名前=値 の形で指定してください。"),
            )
        settings[name] = value
    return settings
