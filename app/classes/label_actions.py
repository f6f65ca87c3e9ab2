"""Label actions: the brush, what it paints over, the class on it."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from app.window.action import Action, map_action
from app.window.window_parts import WindowParts
from processing.core.text import Text
from processing.recording.columns.classes import class_key, point_classes
from widgets.mouse_tools.painting.paint_tool import ERASE, PaintTool, class_name

_label = partial(map_action, menu="draw/labels")


def label_actions(parts: WindowParts) -> tuple[Action, ...]:
    """What is done to the brush; the paint tools themselves are among the tools."""
    palette = parts.document.shared.labels

    def widening(notches: int) -> Callable[[], None]:
        def widen() -> None:
            palette.widen(notches)
            words = Text("Brush radius {radius:.2f} m", "ブラシ半径 {radius:.2f} m")
            parts.status_line.show_message(words.filled(radius=palette.radius_m))

        return widen

    def erase() -> None:
        palette.choose(0)
        parts.status_line.show_message(ERASE)

    return (
        _label("brush-smaller", Text("Smaller brush", "ブラシを小さく"), widening(-1), "["),
        _label("brush-larger", Text("Larger brush", "ブラシを大きく"), widening(1), "]"),
        _label(
            "erase-labels",
            Text("Paint with the eraser", "消しゴムで塗る"),
            erase,
            "Shift+Y",
            Text("Points painted lose their label.", "塗った点のラベルが消えます。"),
        ),
    )


def choose_class(parts: WindowParts, key: str) -> bool:
    """Let a number key choose a class while a paint tool is in the hand; says whether it did.

    A key chooses the class of its code, 0 the eraser, 8 noise that isn't below the ground.
    """
    codes = {class_key(one.code): one.code for one in point_classes()} | {"0": 0}
    if not isinstance(parts.toolbox.tool, PaintTool) or not key or key not in codes:
        return False
    parts.document.shared.labels.choose(codes[key])
    parts.status_line.show_message(class_name(codes[key]) if codes[key] else ERASE)
    return True
