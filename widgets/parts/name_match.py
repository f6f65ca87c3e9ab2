"""How well what was typed fits a name: for lists that are narrowed by typing."""

from __future__ import annotations

import re
import unicodedata


def match_rank(typed: str, name: str) -> int | None:
    """How far a name is from what was typed; 0 is nearest, None fits not at all.

    Every word that was typed must be found: at the beginning of the name (0), at the beginning of
    one of its words (1), within one (2), or by its letters in their order (3); the worst counts.
    Upper and lower case, full and half width are the same.

    >>> [match_rank(typed, "Open project") for typed in ("op", "pro", "ject", "opj", "jo")]
    [0, 1, 2, 3, None]
    """
    name = _plain(name)
    ranks = [_word_rank(word, name) for word in _plain(typed).split()]
    found = [rank for rank in ranks if rank is not None]
    return None if len(found) < len(ranks) else max(found, default=0)


def _word_rank(word: str, name: str) -> int | None:
    if name.startswith(word):
        return 0
    if re.search(rf"(?<!\w){re.escape(word)}", name):
        return 1
    if word in name:
        return 2
    letters = iter(name)
    return 3 if all(letter in letters for letter in word) else None


def _plain(text: str) -> str:
    return unicodedata.normalize("NFKC", text).casefold()
