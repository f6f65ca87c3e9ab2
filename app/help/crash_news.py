"""Crash news: told at the start that the window ended by itself the last time."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QUrl
from PySide6.QtGui import QAction

from app.help.manual import open_outside
from app.window.window_parts import WindowParts
from processing.core.errors import UserError
from processing.core.text import Text


class BrokenRun(UserError):
    """A run of the window broke off: a crash, a kill or a power cut."""


def tell_of_crashes(parts: WindowParts, reports: tuple[Path, ...]) -> None:
    """Say that there are new crash reports, and offer to look at the newest one."""
    if not reports:
        return
    newest = reports[-1]
    words = Text("Show the report", "レポートを表示").in_language(parts.language)
    show = QAction(words, parts.window.centralWidget())
    show.triggered.connect(lambda: open_outside(parts, QUrl.fromLocalFile(str(newest))))
    error = BrokenRun(
        Text(
            "Zuka did not end properly the last time.",
            "前回、Zukaは正常に終了しませんでした。",
        ),
        Text.same(str(newest)),
        Text(
            "What you saved is there; the report was written on this computer only, please send "
            "it to us if the program crashed.",
            "保存済みの内容は残っています。レポートはこのコンピューターにだけ書かれています。"
            "プログラムが異常終了した場合はお送りください。",
        ),
    )
    parts.message_bar.show_error(error, show)
