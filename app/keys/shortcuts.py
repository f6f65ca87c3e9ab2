"""Shortcuts: which key does what, by default and by the user's choice; no Qt in it.

Keys are written as Qt writes them in one spelling for all systems: ``Ctrl+Shift+P``.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from processing.core.text import Text

ShortcutKeys = tuple[str, ...]


@dataclass(frozen=True)
class FixedKey:
    """What a key or the mouse does in every view, whatever the user chooses elsewhere.

    Attributes
    ----------
    gesture : Text
        The key or the hand's movement in words.
    name : Text
        What it does.
    keys : tuple of str
        Keys that no action can have; empty for the mouse.
    action : str
        The one action that has the key as well, since it does the same; or empty.
    in_review : str
        The one action that has the key while candidates are judged and nothing is drawn; or empty.
    """

    gesture: Text
    name: Text
    keys: ShortcutKeys = ()
    action: str = ""
    in_review: str = ""


FIXED: tuple[FixedKey, ...] = (
    FixedKey(
        Text("Left button", "左ボタン"),
        Text("Act with the tool in the hand", "手持ちのツールで操作"),
    ),
    FixedKey(
        Text("Enter, right button, double click", "Enter、右ボタン、ダブルクリック"),
        Text("Finish what is being drawn", "作図中の図形を確定"),
        ("Return", "Enter"),
        in_review="review-accept",
    ),
    FixedKey(
        Text("Backspace", "Backspace"),
        Text("Take back the last vertex", "最後の頂点を取り消す"),
        ("Backspace",),
    ),
    FixedKey(
        Text("Esc", "Esc"),
        Text("Drop what is being drawn; leave the tool", "作図をやめる・ツールを離れる"),
        ("Esc",),
    ),
    FixedKey(
        Text("Delete", "Delete"),
        Text("Remove the vertex under the mouse, or the selection", "頂点または選択した地物を削除"),
        ("Del",),
        "delete",
        "review-reject",
    ),
    FixedKey(
        Text("Shift while drawing", "作図中のShift"), Text("Hold the direction", "方向を固定")
    ),
    FixedKey(Text("Ctrl while drawing", "作図中のCtrl"), Text("No snapping", "スナップしない")),
    FixedKey(
        Text("Tab", "Tab"),
        Text("Go through the kinds used last", "最近使った種別を順に選ぶ"),
        ("Tab", "Shift+Tab"),
        "cycle-kind",
    ),
    FixedKey(Text("Wheel", "ホイール"), Text("Zoom at the mouse", "マウスの位置で拡大・縮小")),
    FixedKey(
        Text("Shift + wheel", "Shift + ホイール"),
        Text("Move along the drive", "走行方向に移動"),
    ),
    FixedKey(
        Text("Ctrl + wheel in 3D", "3DでCtrl + ホイール"), Text("Size of points", "点の大きさ")
    ),
    FixedKey(
        Text("Middle drag, Space + drag", "中ボタンでドラッグ、Space + ドラッグ"),
        Text("Push the picture", "表示位置を動かす"),
        ("Space",),
    ),
    FixedKey(
        Text("Right drag in 3D", "3Dで右ボタンのドラッグ"), Text("Turn the view", "視点を回す")
    ),
    FixedKey(
        Text("Arrow keys", "矢印キー"),
        Text("Move the picture", "表示位置を動かす"),
        ("Left", "Right", "Up", "Down"),
    ),
    FixedKey(
        Text("+ and −", "+ と −"),
        Text("Zoom about the middle", "中央で拡大・縮小"),
        ("+", "-", "="),
    ),
    FixedKey(
        Text("Page Up, Page Down in the camera view", "カメラビューでPage Up、Page Down"),
        Text("The other images that see the place", "その位置を写すほかの画像"),
    ),
    FixedKey(Text("Home", "Home"), Text("Show everything", "全体を表示"), ("Home",), "everything"),
    FixedKey(
        Text("F", "F"), Text("Centre on the selection", "選択位置を中央に表示"), ("F",), "center"
    ),
)
"""Keys and gestures of the views."""


@dataclass(frozen=True)
class Conflict:
    """What speaks against giving a key to an action.

    Attributes
    ----------
    owner : str
        The action that would lose the key; empty when the views need it.
    fixed : FixedKey or None
        What the key does in the views.
    """

    owner: str = ""
    fixed: FixedKey | None = None


@dataclass(frozen=True)
class Shortcuts:
    """The keys of all actions; a change gives a new one. No key ever does two things.

    Attributes
    ----------
    defaults : mapping of str to tuple of str
        By action; every action is in it, with no keys if it has none.
    chosen : mapping of str to tuple of str
        What the user wants instead.
    """

    defaults: Mapping[str, ShortcutKeys]
    chosen: Mapping[str, ShortcutKeys] = field(default_factory=dict)

    def keys_of(self, action: str) -> ShortcutKeys:
        """The keys of an action; a default one that was given away is not among them."""
        if action in self.chosen:
            return self.chosen[action]
        given_away = {
            key for other, keys in self.chosen.items() if other in self.defaults for key in keys
        }
        return tuple(key for key in self.defaults[action] if key not in given_away)

    def all_keys(self) -> dict[str, ShortcutKeys]:
        """The keys of every action."""
        return {action: self.keys_of(action) for action in self.defaults}

    def is_changed(self, action: str) -> bool:
        """Whether an action has other keys than by default."""
        return self.keys_of(action) != self.defaults[action]

    def conflict(self, action: str, key: str) -> Conflict | None:
        """What speaks against giving a key to an action; None when nothing does."""
        for fixed in FIXED:
            if key in fixed.keys and action not in (fixed.action, fixed.in_review):
                return Conflict(fixed=fixed)
        for other in self.defaults:
            if other != action and key in self.keys_of(other):
                return Conflict(owner=other)
        return None

    def with_key(self, action: str, key: str) -> Shortcuts:
        """An action reached by this key only; who had it loses it. No key for an empty one."""
        keys = (key,) if key else ()
        chosen = {
            other: tuple(one for one in others if one not in keys)
            for other, others in self.chosen.items()
            if other != action
        }
        if keys != self.defaults[action]:
            chosen[action] = keys
        return replace(self, chosen=chosen)

    def with_default(self, action: str) -> Shortcuts:
        """An action with its own keys again, but for those that another was given."""
        chosen = {other: keys for other, keys in self.chosen.items() if other != action}
        return replace(self, chosen=chosen)

    def with_defaults(self) -> Shortcuts:
        """Every action with its own keys again."""
        return replace(self, chosen={})
