"""View actions: what is shown and how."""

from __future__ import annotations

from app.actions.action import Action
from app.window_parts import WindowParts
from processing.image.attributes import ATTRIBUTES
from processing.image.kinds import ImageKind
from processing.text import Text


def view_actions(parts: WindowParts) -> tuple[Action, ...]:
    """The view menu, from top to bottom; panels follow."""

    def show_everything() -> None:
        parts.image_view.show_everything()
        parts.scene_view.show_everything()

    def center() -> None:
        parts.image_view.center_on_selection()
        parts.scene_view.center_on_selection()

    def toggle_beside() -> None:
        action = parts.window.actions_by_id["side-by-side"]
        parts.window.stand_side_by_side(beside=action.isChecked())

    whole = Text("Show everything", "全体を表示")
    middle = Text("Centre on the selection", "選択位置を中央に表示")
    beside = Text("Views side by side", "ビューを左右に並べる")
    above, along = (
        Text("3D from above", "3Dを真上から表示"),
        Text("3D along the drive", "3Dを走行方向に表示"),
    )
    scene = parts.scene_view
    return (
        Action("everything", whole, show_everything, "view", ("Home",), "mdi6.fit-to-page-outline"),
        Action("center", middle, center, "view", ("F",)),
        Action("side-by-side", beside, toggle_beside, "view", is_checkable=True),
        Action("top-view", above, scene.look_from_above, "view", ("Ctrl+T",)),
        Action("along-view", along, scene.look_along_drive, "view", ("Ctrl+L",)),
        *_looks(parts),
    )


def _looks(parts: WindowParts) -> tuple[Action, ...]:
    """What points and images show: by name in the palette, in no menu."""
    settings = parts.document.shared.view_settings

    def shown_as(attribute: str) -> Action:
        def show() -> None:
            settings.change_look(attribute=attribute)

        title = ATTRIBUTES[attribute].title
        text = Text("Colour points by: {title}", "点の表示: {title}").filled(title=title)
        return Action(f"show-{attribute}", text, show)

    def image_as(kind: ImageKind) -> Action:
        def show() -> None:
            drive_id = settings.drive_id
            if drive_id and kind in parts.document.drive(drive_id).image_kinds:
                settings.show_image(drive_id, kind)

        text = Text("Kind of image: {title}", "画像の種類: {title}").filled(title=kind.title)
        return Action(f"image-{kind.value}", text, show)

    return (*map(shown_as, ATTRIBUTES), *map(image_as, ImageKind))
