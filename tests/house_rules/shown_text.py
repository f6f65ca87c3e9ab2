"""Finds words that a user would see and no translator would: literals in calls that show text."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

# The positions of the arguments that are shown, for each function or class that shows text.
SHOWS: dict[str, tuple[int, ...]] = {
    **dict.fromkeys(
        [
            "QLabel",
            "QGroupBox",
            "QDockWidget",
            "QMenu",
            "QCheckBox",
            "QListWidgetItem",
            "QTableWidgetItem",
            "QStandardItem",
            "setText",
            "setWindowTitle",
            "setToolTip",
            "setStatusTip",
            "setWhatsThis",
            "setTitle",
            "setPlaceholderText",
            "setAccessibleName",
            "setAccessibleDescription",
            "setSuffix",
            "setPrefix",
            "setSpecialValueText",
            "setInformativeText",
            "setLabelText",
            "setCancelButtonText",
            "setPlainText",
            "setHtml",
            "setHeaderLabels",
            "setHorizontalHeaderLabels",
            "addItem",
            "addItems",
            "addRow",
            "addToolBar",
            "addSection",
            "showMessage",
            "setWindowIconText",
            "setIconText",
            "add_text",
        ],
        (0,),
    ),
    **dict.fromkeys(["QAction", "QPushButton", "QRadioButton", "QToolButton", "addAction"], (0, 1)),
    **dict.fromkeys(
        ["addMenu", "addButton", "insertItem", "setTabText", "setItemText", "setTabToolTip"], (0, 1)
    ),
    **dict.fromkeys(["information", "warning", "critical", "question", "about", "addTab"], (1, 2)),
    **dict.fromkeys(
        ["getOpenFileName", "getOpenFileNames", "getSaveFileName", "getText"], (1, 2, 3)
    ),
    **dict.fromkeys(
        ["getExistingDirectory", "getItem", "getInt", "getDouble", "QProgressDialog"], (0, 1, 2)
    ),
    "insertTab": (1, 2),
    "drawText": (0, 1, 2, 3, 4, 5),
}
KEYWORDS = {"text", "title", "label", "caption", "toolTip", "windowTitle", "placeholderText"}
# Written alike in both languages: units, codes, names of formats and of the program.
SAME = {
    *[
        "mm",
        "cm",
        "km",
        "px",
        "deg",
        "ms",
        "GB",
        "MB",
        "kB",
        "EPSG",
        "DXF",
        "CSV",
        "GPKG",
        "LAS",
        "LAZ",
        "PLY",
        "SBET",
        "XYZ",
        "TXT",
        "Zuka",
        "OK",
    ],
    *["JSON", "GeoJSON", "GeoPackage", "COPC"],
}


def shown_literals(source: str) -> list[str]:
    """Give the literals with words that a call shows to the user, with their lines."""
    return [
        f"line {literal.lineno}: {literal.value!r}"
        for node in ast.walk(ast.parse(source))
        if isinstance(node, ast.Call)
        for shown in _shown_arguments(node)
        for literal in _literals(shown)
        if _has_words(str(literal.value))
    ]


def _shown_arguments(call: ast.Call) -> Iterator[ast.expr]:
    positions = SHOWS.get(_name_of(call.func))
    if positions is None:
        return
    for position in positions:
        if position < len(call.args):
            yield call.args[position]
    for keyword in call.keywords:
        if keyword.arg in KEYWORDS:
            yield keyword.value


def _name_of(function: ast.expr) -> str:
    if isinstance(function, ast.Attribute):
        return function.attr
    return function.id if isinstance(function, ast.Name) else ""


def _literals(shown: ast.expr) -> Iterator[ast.Constant]:
    """Give the string literals that a shown expression is put together from.

    Calls are not entered, so what goes through ``tr``, ``translate`` or ``Text`` is not given;
    of ``"…".format(…)`` and ``"…".join(…)`` the string itself is.
    """
    match shown:
        case ast.Constant(value=str()):
            yield shown
        case ast.JoinedStr(values=parts) | ast.List(elts=parts) | ast.Tuple(elts=parts):
            for part in parts:
                yield from _literals(part)
        case ast.BinOp(left=left, right=right):
            yield from _literals(left)
            yield from _literals(right)
        case ast.IfExp(body=one, orelse=other):
            yield from _literals(one)
            yield from _literals(other)
        case ast.BoolOp(values=parts):
            for part in parts:
                yield from _literals(part)
        case ast.Call(func=ast.Attribute(value=value, attr="format" | "join")):
            yield from _literals(value)


def _has_words(text: str) -> bool:
    plain = re.sub(r"<[^>]*>|&\w+;|\*\.\w+", " ", text)
    return any(len(word) > 1 and word not in SAME for word in re.findall(r"[^\W\d_]+", plain))
