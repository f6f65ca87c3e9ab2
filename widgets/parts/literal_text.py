"""Names on buttons and in menus, where Qt takes “&” for the mark of a key."""

from __future__ import annotations


def literal(name: str) -> str:
    """A name as the text of a button or an action that shows just this name."""
    return name.replace("&", "&&")
