"""MessageBar: trouble said once, in the window, without stopping anybody."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QToolButton, QVBoxLayout, QWidget

from processing.core.errors import UserError
from processing.core.text import Language, Text

_TROUBLE = "#7a2e16"
_NEWS = "#1d4f6e"


class MessageBar(QFrame):
    """A line above the views with what is wrong, where, and what to do; hidden when all is well."""

    def __init__(self, language: Language, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._language = language
        self._error: UserError | None = None
        self.setObjectName("messageBar")
        self._what = QLabel(self)
        self._rest = QLabel(self)
        for label in (self._what, self._rest):
            label.setWordWrap(True)
            label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        font = self._what.font()
        font.setBold(True)
        self._what.setFont(font)
        self._remedy, self._other = QToolButton(self), QToolButton(self)
        words = QVBoxLayout()
        words.setSpacing(2)
        words.addWidget(self._what)
        words.addWidget(self._rest)
        self._close = QToolButton(self)
        self._close.setObjectName("closeMessage")
        self._close.setText("✕")
        self._close.setToolTip(self.tr("Close this message"))
        self._close.setAutoRaise(True)
        self._close.clicked.connect(self.hide)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(12, 8, 8, 8)
        layout.addLayout(words, 1)
        for button in (self._remedy, self._other):
            layout.addWidget(button, 0, Qt.AlignmentFlag.AlignVCenter)
        layout.addWidget(self._close, 0, Qt.AlignmentFlag.AlignTop)
        self.hide()

    @property
    def text(self) -> str:
        """What it says; empty while hidden."""
        return "" if self.isHidden() else f"{self._what.text()} {self._rest.text()}"

    @property
    def error(self) -> UserError | None:
        """What is wrong; None while hidden."""
        return None if self.isHidden() else self._error

    def show_error(
        self, error: UserError, remedy: QAction | None = None, other: QAction | None = None
    ) -> None:
        """Say what is wrong until it is closed or something else is wrong.

        Parameters
        ----------
        remedy, other : QAction, optional
            What can be done about it at once; buttons for it are shown.
        """
        self._offer(remedy, other)
        self._paint(_TROUBLE)
        self._error = error
        self._what.setText(error.what.in_language(self._language))
        where, advice = (part.in_language(self._language) for part in (error.where, error.remedy))
        self._rest.setText(f"{where}\n{advice}")
        self._rest.show()
        self.show()

    def show_news(
        self, news: Text, action: QAction | None = None, other: QAction | None = None
    ) -> None:
        """Say what was done, with what one may want to do next, until something else is said."""
        self._offer(action, other)
        self._paint(_NEWS)
        self._error = None
        self._what.setText(news.in_language(self._language))
        self._rest.clear()
        self._rest.hide()
        self.show()

    def _offer(self, action: QAction | None, other: QAction | None) -> None:
        for button, shown in ((self._remedy, action), (self._other, other)):
            for old in button.actions():
                button.removeAction(old)
            button.setVisible(shown is not None)
            if shown is not None:
                button.setDefaultAction(shown)
                has_menu = shown.menu() is not None
                modes = QToolButton.ToolButtonPopupMode
                button.setPopupMode(modes.InstantPopup if has_menu else modes.DelayedPopup)

    def _paint(self, background: str) -> None:
        self.setStyleSheet(
            f"#messageBar {{ background: {background}; }} "
            "#messageBar QLabel, #closeMessage { color: #ffffff; }"
        )
