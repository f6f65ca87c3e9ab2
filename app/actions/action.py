"""Action: something a user can do, as data; menus, toolbar, palette and keys are made from it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from processing.text import Text


@dataclass(frozen=True)
class Action:
    """One thing a user can do.

    Attributes
    ----------
    id : str
        Unique; the name of the ``QAction``.
    menu : str
        Id of its menu; empty for none.
    keys : tuple of str
        Shortcuts as Qt writes them, in one spelling for all systems.
    icon : str
        A name of the icon set; empty for none.
    toolbar : int
        Its group in the toolbar, from 1; 0 when it isn't there.
    is_checkable : bool
        Whether it stays pressed.
    group : str
        Checkable actions of one group exclude each other.
    """

    id: str
    text: Text
    run: Callable[[], object]
    menu: str = ""
    keys: tuple[str, ...] = ()
    icon: str = ""
    toolbar: int = 0
    is_checkable: bool = False
    group: str = ""


MENUS: tuple[tuple[str, Text], ...] = (
    ("file", Text("&File", "ファイル(&F)")),
    ("edit", Text("&Edit", "編集(&E)")),
    ("view", Text("&View", "表示(&V)")),
    ("draw", Text("&Draw", "作図(&D)")),
    ("process", Text("&Process", "処理(&P)")),
    ("help", Text("&Help", "ヘルプ(&H)")),
)
"""Menus from left to right."""
