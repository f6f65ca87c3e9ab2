"""Draw actions: the tool in the hand and the kind it draws."""

from __future__ import annotations

from app.actions.action import Action
from app.window_parts import WindowParts
from processing.project.catalogue import FeatureKind
from processing.text import Text

_TOOLS = (
    ("select", Text("Pointer", "選択"), ("S",), "mdi6.cursor-default-outline"),
    ("point", Text("Point", "点"), ("P",), "mdi6.map-marker-outline"),
    ("line", Text("Line", "線"), ("L",), "mdi6.vector-polyline"),
    ("area", Text("Area", "面"), ("A",), "mdi6.vector-polygon"),
    ("edit", Text("Edit vertices", "頂点編集"), ("V",), "mdi6.vector-polyline-edit"),
)


def draw_actions(parts: WindowParts) -> tuple[Action, ...]:
    """The draw menu: tools, then the kinds that have a key."""
    toolbox = parts.toolbox

    def choosing(name: str) -> Action:
        def choose() -> None:
            toolbox.choose(name)

        _, text, keys, icon = next(tool for tool in _TOOLS if tool[0] == name)
        return Action(
            f"tool-{name}", text, choose, "draw", keys, icon, 3, is_checkable=True, group="tool"
        )

    def drawing(kind: FeatureKind) -> Action:
        def choose() -> None:
            toolbox.choose_kind(kind)

        text = Text("Draw: {name}", "作図: {name}").filled(name=kind.name)
        keys = (kind.key,) if kind.key else ()
        return Action(f"kind-{kind.id}", text, choose, "draw" if kind.key else "", keys)

    kinds = parts.document.catalogue().kinds
    return (*(choosing(name) for name, *_ in _TOOLS), *(drawing(kind) for kind in kinds))
