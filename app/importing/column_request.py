"""Asks what the columns of a text file are, where the file doesn't say so for certain."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from PySide6.QtCore import Qt

from app.window.window_parts import WindowParts
from processing.core.errors import UserError
from processing.core.text import Text
from processing.formats.points.point_files import columns_needed
from processing.formats.points.text.column_words import PASSED_OVER
from processing.formats.points.text.text_header import read_beginning
from processing.project.importing.importing import ImportRequest
from widgets.dialogs.point_columns import ColumnsForm

_TITLES = {
    PASSED_OVER: Text("passed over", "読み込まない"),
    "x": Text("x (east)", "x（東）"),
    "y": Text("y (north)", "y（北）"),
    "z": Text("z (height)", "z（標高）"),
    "intensity": Text("intensity", "反射強度"),
    "red": Text("red", "赤"),
    "green": Text("green", "緑"),
    "blue": Text("blue", "青"),
    "gpstime": Text("time", "時刻"),
    "classification": Text("class", "クラス"),
}


def with_columns(
    parts: WindowParts, request: ImportRequest, start: Callable[[ImportRequest], None]
) -> None:
    """Start an import, after its text files' columns were named if that is needed.

    Parameters
    ----------
    start : callable
        Gets the request with what was answered; not called where the form is closed.
    """
    needed = columns_needed(request.inputs)
    if needed is None:
        start(request)
        return
    try:
        begins = read_beginning(needed.path)
    except UserError as error:
        parts.message_bar.show_error(error)
        return
    language = parts.language
    form = ColumnsForm(
        f"{needed.path.name}: {needed.what.in_language(language)}",
        tuple((field, title.in_language(language)) for field, title in _TITLES.items()),
        begins.rows,
        parts.window,
    )
    form.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    form.columns_named.connect(lambda columns: start(replace(request, columns=columns)))
    form.show()
