"""Words are shown as they are: nothing in the window can take them for HTML.

``app/settings/edged_style.py`` makes every label plain, also those of tooltips and of Qt's own
forms. What would show HTML all the same, or another style, is named here and used nowhere.
"""

from __future__ import annotations

import re

from tests.house_rules.sources import python_files, text_of

SHOWS_HTML = re.compile(
    r"\b(RichText|AutoText|MarkdownText|setTextFormat|setHtml|insertHtml|setMarkdown|appendHtml"
    r"|QTextBrowser|QTextEdit|QTextDocument|QStaticText|QGraphicsTextItem|QErrorMessage"
    r"|QSplashScreen|QWhatsThis|setWhatsThis|WhatsThisRole|QWebEngineView)\b|\.setStyle\("
)
ALLOWED = {
    "app/settings/edged_style.py": ["setTextFormat"],
    "app/settings/theme.py": [".setStyle("],
    # The manual's own pages, and no file but those below its folder.
    "widgets/dialogs/manual.py": ["QTextBrowser", "QTextEdit"],
}


def what_shows_html(source: str) -> list[str]:
    return sorted({found.group() for found in SHOWS_HTML.finditer(source)})


def test_nothing_in_the_window_shows_html() -> None:
    found = {name: what_shows_html(text_of(name)) for name in python_files("app", "widgets")}
    assert {name: words for name, words in found.items() if words} == ALLOWED


def test_what_shows_html_is_caught() -> None:
    for line, word in (
        ("label.setTextFormat(Qt.TextFormat.RichText)", "setTextFormat"),
        ("page = QTextBrowser(self)", "QTextBrowser"),
        ("item.setData(0, Qt.ItemDataRole.WhatsThisRole, name)", "WhatsThisRole"),
        ("widget.setStyle(QCommonStyle())", ".setStyle("),
    ):
        assert word in what_shows_html(line)
    assert what_shows_html("label = QLabel(name)\nlabel.setStyleSheet('color: red')\n") == []
