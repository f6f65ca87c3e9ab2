"""The palette of feature kinds: all that the project's catalogue has, by name."""

from __future__ import annotations

from PySide6.QtGui import QAction, QKeySequence

from app.window.window_parts import WindowParts
from processing.map.catalogue import FeatureKind
from widgets.feature_drawing.swatch import swatch_of
from widgets.parts.command_palette import CommandPalette, NamedAction
from widgets.parts.literal_text import literal


def show_kind_palette(parts: WindowParts) -> None:
    """Let the user choose what to draw by typing a part of its name in either language."""
    recent = [kind.id for kind in parts.toolbox.recent_kinds]
    kinds = named_kinds(parts)
    palette = CommandPalette(kinds, parts.language, parts.window.centralWidget(), used=recent)
    for one in kinds:
        one.action.setParent(palette)  # a hundred actions that would stay behind each time
    palette.setWindowTitle(parts.window.tr("What to draw"))
    palette.show()


def named_kinds(parts: WindowParts) -> list[NamedAction]:
    """All kinds as actions that choose them."""
    return [_named(parts, kind) for kind in parts.document.catalogue()]


def _named(parts: WindowParts, kind: FeatureKind) -> NamedAction:
    action = QAction(literal(kind.name.in_language(parts.language)), parts.window.centralWidget())
    action.setIcon(swatch_of(kind.colour))
    action.setShortcut(QKeySequence(kind.key))
    action.triggered.connect(lambda: parts.toolbox.choose_kind(kind))
    return NamedAction(f"kind-{kind.id}", kind.name, action)
