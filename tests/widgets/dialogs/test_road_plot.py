"""The window of the road model turns its pages."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtWidgets import QLabel, QPushButton

from app.roads.road_viewing import plots_in
from processing.formats.pictures.paper_svg import paper_svg
from processing.formats.sheets.paper_shapes import BLACK, Pen, box_line
from widgets.dialogs.road_plot import RoadPlotView


def page(width: float) -> bytes:
    shape = box_line(Pen("A", BLACK), (0.0, 0.0), (width, 20.0), is_filled=True)
    return paper_svg([shape], (40.0, 20.0)).encode()


def test_pages_are_turned_to_and_fro(qtbot) -> None:
    view = RoadPlotView()
    qtbot.addWidget(view)
    view.show_pages([page(10.0), page(40.0)])
    view.show()
    (label,) = view.findChildren(QLabel)
    buttons = {one.text(): one for one in view.findChildren(QPushButton)}
    assert label.text() == "1 / 2"
    assert not buttons["Previous"].isEnabled()
    buttons["Next"].click()
    assert (view.page, label.text()) == (1, "2 / 2")
    middle = view.grab().toImage()
    assert middle.pixelColor(middle.width() // 2, middle.height() // 3).lightness() < 50
    buttons["Previous"].click()
    assert view.page == 0


def test_without_pages_nothing_is_shown(qtbot) -> None:
    view = RoadPlotView()
    qtbot.addWidget(view)
    view.show_pages([])
    view.show()
    assert view.page == 0


def test_plots_come_in_the_order_of_the_road(tmp_path: Path) -> None:
    for name in ("road_10.svg", "road.svg", "road_2.svg", "road.png"):
        (tmp_path / name).touch()
    assert [one.name for one in plots_in(tmp_path)] == ["road.svg", "road_2.svg", "road_10.svg"]
