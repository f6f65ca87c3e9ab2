"""The manual's pages for the program's own window: as plain HTML, and as sections to search."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from html import unescape
from pathlib import Path

_BROWSERS_OWN = re.compile(
    r"<nav.*?</nav>|<form.*?</form>|<ol id=\"found\".*?</ol>|<script.*?</script>|<link[^>]*>", re.S
)
_ENTRY = re.compile(r'<dt><a href="([^"]+)">')
_HEADING = re.compile(r'<h([123])(?: id="([^"]+)")?>(.*?)</h\1>', re.S)
_TAG = re.compile(r"<[^>]+>")
_SPACE = re.compile(r"\s+")


@dataclass(frozen=True)
class Section:
    """A heading with the text below it.

    Attributes
    ----------
    page : Path
    anchor : str
        The heading's id; empty for the beginning of a page.
    page_title, title, text : str
    """

    page: Path
    anchor: str
    page_title: str
    title: str
    text: str


def page_html(path: Path) -> str:
    """A page without what only a browser shows: its bar of links, its search, its style."""
    return _BROWSERS_OWN.sub("", path.read_text(encoding="utf-8"))


@cache
def sections(folder: Path) -> tuple[Section, ...]:
    """All sections of a language's pages, in the order of the contents."""
    index = (folder / "index.html").read_text(encoding="utf-8")
    names = _ENTRY.findall(index)
    return tuple(one for name in names for one in _sections_of(folder / name))


def found_sections(folder: Path, words: str) -> tuple[Section, ...]:
    """The sections in which all words stand, those first that have them in their heading."""
    wanted = words.casefold().split()
    if not wanted:
        return ()
    found = [one for one in sections(folder) if _has_all(wanted, f"{one.title} {one.text}")]
    return tuple(sorted(found, key=lambda one: not _has_all(wanted, one.title)))


def _has_all(wanted: Sequence[str], text: str) -> bool:
    return all(word in text.casefold() for word in wanted)


def _sections_of(path: Path) -> list[Section]:
    html = page_html(path).partition("<main>")[2]
    headings = list(_HEADING.finditer(html))
    ends = [one.start() for one in headings[1:]] + [len(html)]
    page_title = _plain(headings[0][3])
    return [
        Section(path, one[2] or "", page_title, _plain(one[3]), _plain(html[one.end() : end]))
        for one, end in zip(headings, ends, strict=True)
    ]


def _plain(html: str) -> str:
    return _SPACE.sub(" ", unescape(_TAG.sub("", html))).strip()
