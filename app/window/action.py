"""Action: something a user can do, as data; menus, toolbar, palette and keys are made from it."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from processing.core.text import Text

NOTHING = Text("", "")
_SAYS_ITS_GROUP = ": "


@dataclass(frozen=True)
class Action:
    """One thing a user can do.

    Attributes
    ----------
    id : str
        Unique; the name of the ``QAction``.
    menu : str
        Id of its menu, or of a menu within it as in ``"view/theme"``; empty for none.
    keys : tuple of str
        Shortcuts as Qt writes them, in one spelling for all systems; the user may choose others.
    icon : str
        A name of the icon set; empty for none.
    toolbar : int
        Its group in the toolbar, from 1; 0 when it isn't there.
    is_checkable, is_checked : bool
        Whether it stays pressed, and whether it is at first.
    group : str
        Checkable actions of one group exclude each other.
    hint : Text
        What it does, in one sentence, for its tooltip; empty where the name says it.
    needs_project : bool
        It can only be done while a project is open.
    why_disabled : Text
        Why it may be disabled while a project is open; empty where that isn't known.
    begins_group : bool
        A line is drawn above it in its menu; above its submenu where it is the first in that.
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
    hint: Text = NOTHING
    needs_project: bool = False
    is_checked: bool = False
    why_disabled: Text = NOTHING
    begins_group: bool = False

    @property
    def name(self) -> Text:
        """The name by which it is found outside its menu, without dots that only a menu needs."""
        bare = Text(self.text.en.rstrip("…"), self.text.ja.rstrip("…"))
        title = SUBMENUS.get(self.menu)
        return (
            bare
            if title is None or _SAYS_ITS_GROUP in bare.en
            else Text("{menu}: {name}", "{menu}: {name}").filled(menu=title, name=bare)
        )

    @property
    def menu_name(self) -> Text:
        """The name of the menu it is in; empty when it is in none."""
        title = dict(MENUS).get(self.menu.partition("/")[0], NOTHING)
        return Text(_bare(title.en), _bare(title.ja))


def grouped(*groups: Sequence[Action]) -> tuple[Action, ...]:
    """All actions of several groups, which a menu shows with a line between them."""
    return tuple(
        replace(action, begins_group=True) if number == 0 else action
        for group in groups
        for number, action in enumerate(group)
    )


def map_action(
    id_: str,
    text: Text,
    run: Callable[[], object],
    key: str = "",
    hint: Text = NOTHING,
    *,
    menu: str,
) -> Action:
    """An action on the open map, with one key or none."""
    return Action(id_, text, run, menu, (key,) if key else (), hint=hint, needs_project=True)


MENUS: tuple[tuple[str, Text], ...] = (
    ("file", Text("&File", "ファイル(&F)")),
    ("edit", Text("&Edit", "編集(&E)")),
    ("view", Text("&View", "表示(&V)")),
    ("draw", Text("&Draw", "作図(&D)")),
    ("process", Text("&Process", "処理(&P)")),
    ("review", Text("&Review", "確認(&R)")),
    ("help", Text("&Help", "ヘルプ(&H)")),
)
"""Menus from left to right."""

SUBMENUS: Mapping[str, Text] = {
    "file/recent": Text("Recent projects", "最近使ったプロジェクト"),
    "view/image": Text("Image", "画像"),
    "view/clip": Text("3D shows", "3Dの表示範囲"),
    "view/layouts": Text("Layouts", "レイアウト"),
    "view/section": Text("Section", "断面"),
    "view/panels": Text("Panels", "パネル"),
    "view/theme": Text("Theme", "配色"),
    # Both words, so that who can't read the language spoken finds it.
    "view/language": Text("Language / 言語", "言語 / Language"),
    "edit/select": Text("Select", "選択"),
    "edit/lines": Text("Lines", "線の編集"),
    "edit/status": Text("Status", "状態"),
    "draw/widths": Text("Widths and measurements", "幅と計測結果"),
    "process/map": Text("Other lines and areas of a road map", "道路地図のその他の線・範囲"),
    "process/settings": Text("Settings of a tool", "ツールの設定"),
    "draw/templates": Text("Templates", "テンプレート"),
    "draw/kinds": Text("Kinds by number key", "数字キーの種別"),
    "draw/snap": Text("Snap", "スナップ"),
    "draw/plane": Text("Working plane", "作業平面"),
    "draw/labels": Text("Labels of points", "点のラベル"),
}
"""Menus within menus; each stands where its first action stands."""

NEEDS_PROJECT = Text("Open a project first.", "先にプロジェクトを開いてください。")
"""Why an action that needs a project is disabled."""


_ACCESS_KEY = re.compile(r"\(&\w\)|&(?=\w)")


def _bare(name: str) -> str:
    """Without the mark of an access key and without the dots that promise a form."""
    return _ACCESS_KEY.sub("", name).rstrip("…")
