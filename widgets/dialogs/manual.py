"""ManualWindow: the manual in a window of its own, for machines with or without a browser."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from PySide6.QtCore import QByteArray, QEvent, Qt, QUrl, Signal
from PySide6.QtGui import QKeySequence, QPalette, QShortcut, QTextCursor
from PySide6.QtWidgets import (
    QHBoxLayout,
    QLineEdit,
    QSplitter,
    QTextBrowser,
    QTextEdit,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)
from typing_extensions import override

from widgets.parts.icon_button import IconButton
from widgets.parts.manual_pages import Section, found_sections, page_html, sections

_INDEX = "index.html"
_POSITION = Qt.ItemDataRole.UserRole
_MARGIN_PX = 20
_SIZE_PX = (1040, 760)
_SIDE_PX = 280
_STYLE = """
body {{ font-size: 14px; line-height: 125%; color: {ink}; }}
h1 {{ font-size: 22px; }} h2 {{ font-size: 18px; margin-top: 24px; }} h3 {{ font-size: 15px; }}
a {{ color: {link}; }}
i {{ {quoted} }}
kbd, code {{ font-size: 13px; background-color: {key}; }}
pre {{ font-size: 13px; background-color: {key}; white-space: pre-wrap; }}
th {{ text-align: left; font-weight: 600; white-space: nowrap; }}
th, td {{ padding: 3px 14px 3px 0; vertical-align: top; }}
dt {{ font-weight: 600; margin-top: 10px; }} dd {{ margin-left: 18px; }}
"""
_QUOTED = {"ja": "font-style: normal; font-weight: 600;", "en": "font-style: italic;"}


class ManualWindow(QWidget):
    """Contents and search at the left, the page at the right; local files only.

    Parameters
    ----------
    folder : Path
        The pages of one language.

    Signals
    -------
    browser_requested(page: QUrl)
        The page is to be shown by the system's browser.
    """

    browser_requested = Signal(QUrl)

    def __init__(self, folder: Path, parent: QWidget | None = None) -> None:
        super().__init__(parent, Qt.WindowType.Window)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.folder = folder
        self._page = _Page(folder, self)
        self._words = QLineEdit(self)
        self._words.setPlaceholderText(self.tr("Search the manual"))
        self._words.setClearButtonEnabled(True)
        self._list = QTreeWidget(self)
        self._list.setHeaderHidden(True)
        self._list.setUniformRowHeights(True)
        self._back = self._button("mdi6.arrow-left", self.tr("Back"), "Alt+Left")
        self._forward = self._button("mdi6.arrow-right", self.tr("Forward"), "Alt+Right")
        self._contents = self._button("mdi6.home-outline", self.tr("Contents"), "Alt+Home")
        self._browser = self._button("mdi6.open-in-new", self.tr("Open in the browser"), "Ctrl+B")
        self._lay_out()
        self._connect()
        self._on_words_text_changed("")
        self.show_page(_INDEX)

    def show_page(self, name: str) -> None:
        """Show a page, or a place in it: ``"simulate.html#making"``."""
        page, _, anchor = name.partition("#")
        url = QUrl.fromLocalFile(str(self.folder / page))
        if anchor:
            url.setFragment(anchor)
        self._page.setSource(url)

    @override
    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange:
            self._page.dress()

    def _button(self, sign: str, name: str, key: str) -> IconButton:
        keys = QKeySequence(key)
        tip = keys.toString(QKeySequence.SequenceFormat.NativeText)
        button = IconButton(sign, name, tip, self)
        QShortcut(keys, self, button.click)
        return button

    def _lay_out(self) -> None:
        buttons = QHBoxLayout()
        for button in (self._back, self._forward, self._contents, self._browser):
            buttons.addWidget(button)
        buttons.addStretch(1)
        side = QWidget(self)
        column = QVBoxLayout(side)
        column.setContentsMargins(6, 6, 0, 6)
        column.addLayout(buttons)
        column.addWidget(self._words)
        column.addWidget(self._list, 1)
        split = QSplitter(self)
        split.addWidget(side)
        split.addWidget(self._page)
        split.setStretchFactor(1, 1)
        split.setSizes([_SIDE_PX, _SIZE_PX[0] - _SIDE_PX])
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(split)
        self.resize(*_SIZE_PX)

    def _connect(self) -> None:
        self._back.clicked.connect(self._page.backward)
        self._forward.clicked.connect(self._page.forward)
        self._contents.clicked.connect(self._page.home)
        self._browser.clicked.connect(self._on_browser_clicked)
        self._page.backwardAvailable.connect(self._back.setEnabled)
        self._page.forwardAvailable.connect(self._forward.setEnabled)
        self._page.sourceChanged.connect(self._on_page_source_changed)
        self._words.textChanged.connect(self._on_words_text_changed)
        self._words.returnPressed.connect(self._on_words_return_pressed)
        self._list.itemActivated.connect(self._on_list_item_clicked)
        self._list.itemClicked.connect(self._on_list_item_clicked)
        keys = QKeySequence.StandardKey
        QShortcut(QKeySequence(keys.Find), self, self._words.setFocus)
        QShortcut(QKeySequence(keys.FindNext), self, self._page.show_next)
        QShortcut(QKeySequence(keys.FindPrevious), self, self._page.show_previous)
        QShortcut(QKeySequence(Qt.Key.Key_Escape), self, self.close)

    def _on_browser_clicked(self) -> None:
        self.browser_requested.emit(self._page.source())

    def _on_page_source_changed(self) -> None:
        self.setWindowTitle(self._page.documentTitle())
        self._page.mark(self._words.text())

    def _on_words_text_changed(self, words: str) -> None:
        """Contents as a tree, or what was found as a list."""
        self._list.clear()
        self._list.setRootIsDecorated(not words.strip())
        if words.strip():
            self._list_found(found_sections(self.folder, words))
        else:
            self._list_contents(sections(self.folder))
        self._page.mark(words)

    def _list_contents(self, shown: tuple[Section, ...]) -> None:
        pages: dict[Path, QTreeWidgetItem] = {}
        for one in shown:
            above = pages.get(one.page)
            item = QTreeWidgetItem(self._list if above is None else above, [one.title])
            item.setData(0, _POSITION, _position(one))
            pages.setdefault(one.page, item)

    def _list_found(self, found: tuple[Section, ...]) -> None:
        for one in found:
            is_page = one.title == one.page_title
            words = one.title if is_page else f"{one.title} – {one.page_title}"
            item = QTreeWidgetItem(self._list, [words])
            item.setToolTip(0, words)
            item.setData(0, _POSITION, _position(one))
        if not found:
            item = QTreeWidgetItem(self._list, [self.tr("Nothing found.")])
            item.setFlags(Qt.ItemFlag.NoItemFlags)

    def _on_words_return_pressed(self) -> None:
        """The first hit at once, then one mark after the other on its page."""
        first, current = self._list.topLevelItem(0), self._list.currentItem()
        if current is not None:
            self._page.show_next()
        elif first is not None and self._words.text().strip():
            self._list.setCurrentItem(first)
            self._on_list_item_clicked(first)

    def _on_list_item_clicked(self, item: QTreeWidgetItem) -> None:
        position = item.data(0, _POSITION)
        if position:
            self.show_page(str(position))


def _position(section: Section) -> str:
    return f"{section.page.name}#{section.anchor}" if section.anchor else section.page.name


class _Page(QTextBrowser):
    """A page of the manual; whatever lies outside its folder is neither read nor fetched."""

    def __init__(self, folder: Path, parent: QWidget) -> None:
        super().__init__(parent)
        self._root = folder.parent.resolve()
        self._language = folder.name
        self.setOpenExternalLinks(False)
        self.document().setDocumentMargin(_MARGIN_PX)
        self.setFrameShape(QTextBrowser.Shape.NoFrame)
        self.dress()

    def dress(self) -> None:
        """Take the colours of the palette."""
        palette = self.palette()
        style = _STYLE.format(
            ink=palette.color(QPalette.ColorRole.Text).name(),
            link=palette.color(QPalette.ColorRole.Link).name(),
            key=palette.color(QPalette.ColorRole.Midlight).name(),
            quoted=_QUOTED.get(self._language, ""),
        )
        self.document().setDefaultStyleSheet(style)
        if self.source().isValid():
            self.reload()

    # What it gives is Qt's own QVariant.
    @override
    def loadResource(self, type: int, name: QUrl | str) -> Any:
        asked = QUrl(name)
        url = self.source().resolved(asked) if asked.isRelative() else asked
        path = Path(url.toLocalFile()).resolve() if url.isLocalFile() else None
        if path is None or not path.is_relative_to(self._root) or not path.is_file():
            return QByteArray()
        if path.suffix == ".html":
            return page_html(path)
        return super().loadResource(type, url)

    def mark(self, words: str) -> None:
        """Mark every place where one of these words stands."""
        marks = []
        for word in words.split():
            cursor = self.document().find(word)
            while not cursor.isNull():
                marks.append(self._mark_at(cursor))
                cursor = self.document().find(word, cursor)
        marks.sort(key=lambda one: one.cursor.position())
        self.setExtraSelections(marks)

    def show_next(self) -> None:
        """Go to the next mark, from the last to the first."""
        at = self.textCursor().position()
        ends = [one.cursor.position() for one in self.extraSelections()]
        self._go_to(next((end for end in ends if end > at), ends[0] if ends else at))

    def show_previous(self) -> None:
        """Go to the mark before, from the first to the last."""
        at = self.textCursor().position()
        ends = [one.cursor.position() for one in self.extraSelections()]
        self._go_to(next((end for end in reversed(ends) if end < at), ends[-1] if ends else at))

    def _go_to(self, position: int) -> None:
        cursor = QTextCursor(self.document())
        cursor.setPosition(position)
        self.setTextCursor(cursor)
        self.ensureCursorVisible()

    def _mark_at(self, cursor: QTextCursor) -> QTextEdit.ExtraSelection:
        mark = QTextEdit.ExtraSelection()
        mark.cursor = QTextCursor(cursor)
        mark.format.setBackground(self.palette().color(QPalette.ColorRole.Highlight))
        mark.format.setForeground(self.palette().color(QPalette.ColorRole.HighlightedText))
        return mark
