"""The manual in the program, and the system's browser for those who want it there."""

from __future__ import annotations

from PySide6.QtCore import QUrl
from PySide6.QtGui import QDesktopServices

from app.window.window_parts import WindowParts
from processing.core.errors import MissingInput
from processing.core.text import Text
from resources import path_of
from widgets.dialogs.manual import ManualWindow


def show_manual(parts: WindowParts, position: str = "") -> None:
    """Show the manual in the user's language; the window that is open is raised.

    Parameters
    ----------
    position : str
        Where to open it, such as ``"simulate.html#making"``; empty: where it is open already, or
        else at its contents.
    """
    folder = path_of(f"manual/{parts.language}")
    made = None
    for one in parts.window.findChildren(ManualWindow):
        if one.isVisible() and one.folder == folder:
            made = one
        else:
            one.close()  # in another language
    if made is None:
        made = ManualWindow(folder, parts.window)
        made.browser_requested.connect(lambda page: open_outside(parts, page))
    if position:
        made.show_page(position)
    made.show()
    made.raise_()
    made.activateWindow()


def open_outside(parts: WindowParts, what: QUrl) -> None:
    """Have the system show a file or folder; where it can't, say where that is.

    Some systems say that they do and then find no program, so the place is told in any case.
    """
    position = Text.same(what.toLocalFile())
    if QDesktopServices.openUrl(what):
        parts.document.reported.emit(
            Text("Handed to the system: {place}", "システムに渡しました: {place}").filled(
                place=position
            )
        )
        return
    parts.message_bar.show_error(
        MissingInput(
            Text(
                "The system has no program that shows this.",
                "表示できるプログラムがシステムに見つかりません。",
            ),
            position,
            Text("Open it with a program of your own.", "別のプログラムで開いてください。"),
        )
    )
