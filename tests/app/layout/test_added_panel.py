"""A panel is added by one declaration; dock, switch, key and layout follow."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QDockWidget, QLabel, QWidget
from pytestqt.qtbot import QtBot

from app import panel_places
from app.application import build_window
from app.layout.view_docks import ViewLayout
from app.panel_places import PANELS, Panel
from app.settings.settings import Settings
from app.window.window_contents import PanelPlace
from app.window.window_parts import WindowParts, take_down
from processing.core.text import Text
from processing.project.project import Project


def _make(parts: WindowParts) -> QWidget:
    """A line that says how many drives are open."""
    label = QLabel()

    def tell() -> None:
        label.setText(str(len(parts.document.drives())))

    parts.document.opened.connect(tell)
    return label


PANEL = Panel(
    "counted",
    Text("Counted drives", "走行データ数"),
    _make,
    PanelPlace(
        Qt.DockWidgetArea.RightDockWidgetArea,
        248,
        100,
        key="Ctrl+Alt+9",
        front_px=((ViewLayout.CHECKING, 100),),
    ),
)


@pytest.fixture
def parts(qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[WindowParts]:
    """Give a shown window with one panel more, on an empty project."""
    monkeypatch.setattr(panel_places, "PANELS", (*PANELS, PANEL))
    Project.create(tmp_path / "a.zuka", "EPSG:6677").close()
    made = build_window(Settings(tmp_path / "settings.ini"), tmp_path)
    qtbot.addWidget(made.window)
    with qtbot.waitExposed(made.window):
        made.window.show()
    assert made.document.open(tmp_path / "a.zuka")
    yield made
    take_down(made)


def _dock(parts: WindowParts) -> QDockWidget:
    dock = parts.window.findChild(QDockWidget, "counted")
    assert isinstance(dock, QDockWidget)
    return dock


def test_a_declared_panel_has_its_dock_its_switch_and_its_key(parts: WindowParts) -> None:
    assert _dock(parts).isVisible()
    widget = _dock(parts).widget()
    assert isinstance(widget, QLabel)
    assert widget.text() == "0"
    switch = _dock(parts).toggleViewAction()
    assert "Ctrl+Alt+9" in [key.toString() for key in switch.shortcuts()]
    assert switch in parts.window.actions_by_id.values()
    switch.trigger()
    assert not _dock(parts).isVisible()


def test_a_layout_that_a_panel_belongs_to_brings_it_to_the_front(parts: WindowParts) -> None:
    _dock(parts).hide()
    parts.window.actions_by_id["layout-drawing"].trigger()
    assert not _dock(parts).isVisible()
    parts.window.actions_by_id["layout-checking"].trigger()
    assert _dock(parts).isVisible()
