"""The manual's pages as what they name: actions, keys, words of the window, links, headings."""

from __future__ import annotations

from dataclasses import dataclass, field
from html.parser import HTMLParser
from pathlib import Path

from processing.core.text import Language
from tests.house_rules.sources import ROOT

MANUAL = ROOT / "resources" / "manual"
LANGUAGES: tuple[Language, ...] = ("en", "ja")
_WITHOUT_END = {"meta", "link", "input", "br", "img"}


@dataclass
class Quoted:
    """Words that stand in an element, and the action that they are said of."""

    words: str
    action: str = ""


@dataclass
class Page:
    """One page.

    Attributes
    ----------
    names : list of Quoted
        Words of the window (``<i>``).
    keys : list of Quoted
        Keys (``<kbd>``).
    code : list of str
        What is typed or read as it stands (``<code>``).
    paragraphs : dict of str to str
        Text of each section by the id of its heading; '' for what comes before the first.
    kinds : dict of str to str
        Names of kinds of features by their id.
    """

    path: Path
    names: list[Quoted] = field(default_factory=list)
    keys: list[Quoted] = field(default_factory=list)
    code: list[str] = field(default_factory=list)
    links: list[str] = field(default_factory=list)
    paragraphs: dict[str, str] = field(default_factory=lambda: {"": ""})
    kinds: dict[str, str] = field(default_factory=dict)
    language: str = ""
    unclosed: list[str] = field(default_factory=list)

    @property
    def ids(self) -> tuple[str, ...]:
        """Places that links may lead to, in their order."""
        return tuple(id_ for id_ in self.paragraphs if id_)


def read_page(path: Path) -> Page:
    """Give what a page names."""
    reader = _Reader(Page(path))
    reader.feed(path.read_text(encoding="utf-8"))
    reader.close()
    reader.page.unclosed += reader.open
    return reader.page


def pages(language: str) -> list[Page]:
    """Give all pages of a language."""
    return [read_page(path) for path in sorted((MANUAL / language).glob("*.html"))]


class _Reader(HTMLParser):
    def __init__(self, page: Page) -> None:
        super().__init__()
        self.page = page
        self.open: list[str] = []
        self._section = ""
        self._in_heading = False
        self._quoted: Quoted | None = None
        self._kind = ""

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        told = {name: value or "" for name, value in attrs}
        if tag not in _WITHOUT_END:
            self.open.append(tag)
        if tag == "html":
            self.page.language = told.get("lang", "")
        for name in ("href", "src"):
            if name in told:
                self.page.links.append(told[name])
        if tag in ("h2", "h3"):
            self._section, self._in_heading = told["id"], True
            self.page.paragraphs[self._section] = ""
        if tag in ("i", "kbd"):
            self._quoted = Quoted("", told.get("data-action", ""))
            (self.page.names if tag == "i" else self.page.keys).append(self._quoted)
        if tag == "code":
            self.page.code.append("")
        self._kind = told.get("data-kind", "")

    def handle_endtag(self, tag: str) -> None:
        while self.open and (ended := self.open.pop()) != tag:
            self.page.unclosed.append(ended)
        if tag in ("h2", "h3"):
            self._in_heading = False
        if tag in ("i", "kbd"):
            self._quoted = None
        self._kind = ""

    def handle_data(self, data: str) -> None:
        if self._quoted is not None:
            self._quoted.words += data
        if "code" in self.open:
            self.page.code[-1] += data
        if self._kind:
            self.page.kinds[self._kind] = self.page.kinds.get(self._kind, "") + data
        if not self._in_heading and "main" in self.open:
            self.page.paragraphs[self._section] += data
