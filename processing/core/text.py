"""One sentence in the program's two languages, as data: what lies below Qt speaks through it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Language = Literal["en", "ja"]


@dataclass(frozen=True)
class Text:
    """A sentence, or a name, in English and Japanese.

    Attributes
    ----------
    en, ja : str
        The two versions; ``{name}`` places are filled by :meth:`filled`.
    """

    en: str
    ja: str

    @staticmethod
    def same(words: str) -> Text:
        """Words that are the same in both languages: a file's name, a number, a code."""
        return Text(words, words)

    def filled(self, **values: object) -> Text:
        """The text with its ``{name}`` places filled; a `Text` value gives its own language."""
        return Text(
            self.en.format(**{key: _in(value, "en") for key, value in values.items()}),
            self.ja.format(**{key: _in(value, "ja") for key, value in values.items()}),
        )

    def in_language(self, language: Language) -> str:
        """The words in one language."""
        return self.ja if language == "ja" else self.en


def _in(value: object, language: Language) -> object:
    return value.in_language(language) if isinstance(value, Text) else value
