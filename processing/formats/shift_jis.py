"""Text for files in Shift_JIS (cp932): what it lacks is replaced by a rule, and that is told."""

from __future__ import annotations

import unicodedata

from processing.core.text import Text

TWINS = str.maketrans("〜−—‖", "～－―∥")
"""Unicode has two of each, and Shift_JIS has the other one: every Japanese editor swaps them."""

_MISSING = "〓"
"""What Japanese printers set for a character that they lack."""


class ShiftJisText:
    """Brings texts into cp932, and remembers what was lost on the way."""

    def __init__(self) -> None:
        self._replaced: dict[str, str] = {}
        self._shortened: dict[str, str] = {}

    def fitted(self, words: str, most_bytes: int | None = None) -> str:
        """A line of text that cp932 holds, cut behind a whole character where it is too long.

        A character that is missing becomes its twin in cp932, else its compatible form (NFKC: ² is
        2, ㎥ stays), else 〓. Control characters are blanks.

        Parameters
        ----------
        most_bytes : int, optional
            In cp932, where kanji have two.
        """
        line = "".join(" " if unicodedata.category(one)[0] == "C" else one for one in words)
        fitting = "".join(map(self._character, line.translate(TWINS))).strip()
        if most_bytes is None or len(fitting.encode("cp932")) <= most_bytes:
            return fitting
        cut = fitting.encode("cp932")[:most_bytes].decode("cp932", "ignore").rstrip()
        self._shortened[fitting] = cut
        return cut

    def _character(self, one: str) -> str:
        if _has(one):
            return one
        compatible = unicodedata.normalize("NFKC", one)
        self._replaced[one] = compatible if compatible and _has(compatible) else _MISSING
        return self._replaced[one]

    @property
    def notes(self) -> tuple[Text, ...]:
        """A sentence about characters that were replaced, one about texts that were cut."""
        found = []
        if self._replaced:
            pairs = "  ".join(
                f"{one} (U+{ord(one):04X}) → {other}" for one, other in self._replaced.items()
            )
            found.append(
                Text(
                    "Shift_JIS lacks characters, which were replaced: {pairs}.",
                    "Shift_JISにない文字を置き換えました: {pairs}",
                ).filled(pairs=pairs)
            )
        if self._shortened:
            pairs = "  ".join(f"“{one}” → “{cut}”" for one, cut in self._shortened.items())
            found.append(
                Text(
                    "Texts are longer than the format holds and were cut: {pairs}.",
                    "形式の長さを超える文字列を切り詰めました: {pairs}",
                ).filled(pairs=pairs)
            )
        return tuple(found)


def _has(words: str) -> bool:
    try:
        words.encode("cp932")
    except UnicodeEncodeError:
        return False
    return True
