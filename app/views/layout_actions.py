"""Layout actions: which views stand where, and the keys that bring each to the front."""

from __future__ import annotations

from app.layout.view_docks import LAYOUT_NAMES, ViewLayout
from app.window.action import Action
from app.window.window_parts import WindowParts
from processing.core.text import Text

_HINTS = {
    ViewLayout.DRAWING: Text(
        "The image above, 3D and one more view below.", "上に画像、下に3Dとほかのビューを並べます。"
    ),
    ViewLayout.CHECKING: Text(
        "Image, section, camera and 3D at once, to judge candidates.",
        "画像・断面・カメラ・3Dを同時に表示して候補を確認します。",
    ),
    ViewLayout.EARTHWORK: Text(
        "The map and the section fill the window, volumes beside them.",
        "地図と断面を大きく表示し、土量パネルを開きます。",
    ),
    ViewLayout.TWO_SCREENS: Text(
        "The image fills this window, the other views a second one.",
        "画像をこのウィンドウに、ほかのビューを別ウィンドウに表示します。",
    ),
}


def layout_actions(parts: WindowParts) -> tuple[Action, ...]:
    """The layouts, in a menu of their own."""

    def standing(layout: ViewLayout, key: str) -> Action:
        def place() -> None:
            parts.window.area.place(layout)
            parts.window.bring_panels(layout)

        return Action(
            f"layout-{layout.value}",
            LAYOUT_NAMES[layout],
            place,
            "view/layouts",
            (key,),
            hint=_HINTS[layout],
            needs_project=True,
        )

    return tuple(
        standing(layout, f"Ctrl+Alt+{number}") for number, layout in enumerate(ViewLayout, start=1)
    )


def adopt_view_toggles(parts: WindowParts) -> None:
    """Put Qt's own switches of the views into the menu of views."""
    for number, (id_, (title, toggle)) in enumerate(parts.view_docks.toggles().items()):
        text = Text("View: {title}", "ビュー: {title}").filled(title=title)
        action = Action(
            f"view-{id_}",
            text,
            toggle.trigger,
            "view",
            needs_project=True,
            begins_group=number == 0,
        )
        parts.window.actions_made.adopt(action, toggle)
