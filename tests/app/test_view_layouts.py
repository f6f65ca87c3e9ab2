"""Each layout shows the views that it promises."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtWidgets import QDockWidget
from pytestqt.qtbot import QtBot

from app.layout.view_docks import ViewLayout
from app.window.window_parts import WindowParts
from tests.app.conftest import shown_window

_IN_FRONT = {
    ViewLayout.DRAWING: ["scene", "section"],
    ViewLayout.CHECKING: ["section", "camera", "scene"],
    ViewLayout.EARTHWORK: ["map", "section"],
    ViewLayout.TWO_SCREENS: ["scene", "section"],
}


@pytest.fixture
def parts(qtbot: QtBot, tmp_path: Path) -> Iterator[WindowParts]:
    with shown_window(qtbot, tmp_path) as parts:
        parts.document.create(tmp_path / "street.zuka", "EPSG:6677")
        yield parts


def in_front(parts: WindowParts) -> list[str]:
    """The views that are seen, from left to right."""
    docks = [
        dock
        for dock in parts.view_docks.findChildren(QDockWidget)
        if dock.isVisible() and dock.x() >= 0  # Qt keeps those behind a tab off the window
    ]
    docks.sort(key=lambda dock: dock.x())
    return [dock.objectName().removeprefix("view-") for dock in docks]


@pytest.mark.parametrize("before", ViewLayout)
@pytest.mark.parametrize("layout", ViewLayout)
def test_a_layout_shows_its_views_whatever_was_before(
    qtbot: QtBot, parts: WindowParts, before: ViewLayout, layout: ViewLayout
) -> None:
    for one in (before, layout):
        parts.window.area.place(one)
        qtbot.waitUntil(lambda one=one: in_front(parts) == _IN_FRONT[one], timeout=30_000)
    parts.window.area.place(ViewLayout.DRAWING)


def test_all_views_are_there_in_each_layout(qtbot: QtBot, parts: WindowParts) -> None:
    for layout in ViewLayout:
        parts.window.area.place(layout)
        qtbot.waitUntil(lambda layout=layout: in_front(parts) == _IN_FRONT[layout], timeout=30_000)
        docks = parts.view_docks.findChildren(QDockWidget)
        assert not any(dock.isHidden() or dock.isFloating() for dock in docks)
    parts.window.area.place(ViewLayout.DRAWING)


def test_a_low_screen_has_room_for_every_panel_and_layout(qtbot: QtBot, parts: WindowParts) -> None:
    for layout in (ViewLayout.CHECKING, ViewLayout.EARTHWORK, ViewLayout.DRAWING):
        parts.window.actions_by_id[f"layout-{layout.value}"].trigger()
        for panel in ("templates", "labels", "processing", "evaluation", "features"):
            parts.window.show_panel(panel)
            qtbot.waitUntil(
                lambda: parts.window.findChild(QDockWidget, "layers").height() > 0, timeout=30_000
            )
            assert (parts.window.width(), parts.window.height()) == (1366, 768)
