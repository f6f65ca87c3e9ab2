"""Edit actions: steps back and forth, the selection."""

from __future__ import annotations

from app.actions.action import Action
from app.window_parts import WindowParts
from processing.text import Text
from widgets.mouse_tools.removal import removal_of


def edit_actions(parts: WindowParts) -> tuple[Action, ...]:
    """The edit menu, from top to bottom."""
    document = parts.document
    selection = document.shared.selection

    def delete_selected() -> None:
        chosen = [document.feature(id_) for id_ in selection.features]
        features = tuple(feature for feature in chosen if feature is not None)
        if features:
            document.apply(*removal_of(features))

    def select_all() -> None:
        hidden = document.shared.view_settings.hidden_kinds
        selection.choose_features(
            frozenset(feature.id for feature in document.features() if feature.kind not in hidden)
        )

    return (
        Action(
            "undo", Text("Undo", "元に戻す"), document.undo, "edit", ("Ctrl+Z",), "mdi6.undo", 2
        ),
        Action(
            "redo",
            Text("Redo", "やり直す"),
            document.redo,
            "edit",
            ("Ctrl+Y", "Ctrl+Shift+Z"),
            "mdi6.redo",
            2,
        ),
        Action(
            "delete",
            Text("Delete the selected features", "選択した地物を削除"),
            delete_selected,
            "edit",
        ),
        Action(
            "select-all",
            Text("Select all features", "すべての地物を選択"),
            select_all,
            "edit",
            ("Ctrl+A",),
        ),
        Action(
            "select-none",
            Text("Select nothing", "選択を解除"),
            selection.clear,
            "edit",
            ("Ctrl+Shift+A",),
        ),
    )
