"""The panel of labels: classes, counts, the brush."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QComboBox, QPushButton, QTreeWidget

from processing.labels.label_column import make_column, write_labels
from processing.labels.rules import PaintOver, PaintRule
from tests.widgets.builders import OpenMap, imported_drive
from widgets.panels.project.label_panel import LabelPanel
from widgets.panels.tree_items import children_of
from widgets.parts.number_field import NumberField

LEFT = Qt.MouseButton.LeftButton


@pytest.fixture
def street(tmp_path) -> OpenMap:
    return OpenMap((imported_drive(tmp_path / "street"),))


@pytest.fixture
def panel(qtbot, street) -> LabelPanel:
    shown = LabelPanel(street, street.shared, "en")
    qtbot.addWidget(shown)
    shown.resize(260, 520)
    shown.show()
    qtbot.waitExposed(shown)
    qtbot.waitUntil(lambda: not shown.tally.is_counting, timeout=30_000)
    return shown


def rows(panel: LabelPanel) -> dict[str, tuple[str, str]]:
    items = children_of(panel.findChild(QTreeWidget))
    return {item.text(0): (item.text(1), item.text(2)) for item in items}


def test_the_panel_counts_the_points_of_each_label_as_they_change(qtbot, street, panel):
    (drive,) = street.drives()
    assert rows(panel)["Road surface"] == ("", "")
    assert rows(panel)["No label (erase)"] == ("", "0")
    make_column(drive)
    points = np.arange(2500)
    write_labels(drive, points, np.where(points < 2000, 11, 240).astype(np.uint8))
    with qtbot.waitSignal(panel.tally.changed, timeout=30_000):
        street.shared.map_changes.labels_changed.emit(drive.id, points)
    assert rows(panel)["Road surface"] == ("2,000", "")
    # A code that the table of classes lacks is shown by its number.
    assert rows(panel)["Class 240"] == ("500", "")
    write_labels(drive, points, np.zeros(2500, np.uint8))
    with qtbot.waitSignal(panel.tally.changed, timeout=30_000):
        street.shared.map_changes.labels_changed.emit(drive.id, points)
    assert "Class 240" not in rows(panel)
    assert panel.tally.by_code[0] == drive.count


def test_a_delivered_class_counts_where_no_label_lies_over_it(qtbot, street, panel):
    (drive,) = street.drives()
    delivered = np.full(drive.count, 2, np.uint8)
    delivered[:100] = 6
    drive.columns.add("classification", delivered)
    make_column(drive)
    points = np.arange(60)
    write_labels(drive, points, np.full(60, 2, np.uint8))
    with qtbot.waitSignal(panel.tally.changed, timeout=30_000):
        street.shared.map_changes.labels_changed.emit(drive.id, points)
    assert rows(panel)["Building"][0] == "40"
    assert rows(panel)["Ground"][0] == f"{drive.count - 40:,}"
    (ground,) = (
        item for item in children_of(panel.findChild(QTreeWidget)) if item.text(0) == "Ground"
    )
    words = f"Points of this class: 60 by labels, {drive.count - 100:,} as delivered"
    assert ground.toolTip(1) == words
    panel.hide()
    write_labels(drive, points, np.full(60, 0, np.uint8))
    street.shared.map_changes.labels_changed.emit(drive.id, points)
    assert not panel.tally.is_counting
    with qtbot.waitSignal(panel.tally.changed, timeout=30_000):
        panel.show()
    assert rows(panel)["Building"][0] == "100"


def test_a_click_on_a_class_takes_it_on_the_brush_and_the_palette_is_shown(qtbot, street, panel):
    tree = panel.findChild(QTreeWidget)
    building = next(item for item in children_of(tree) if item.text(0) == "Building")
    qtbot.mouseClick(tree.viewport(), LEFT, pos=tree.visualItemRect(building).center())
    assert street.shared.labels.rule.code == 6
    assert tree.currentItem() is building
    street.shared.labels.choose(0)
    assert tree.currentItem().text(0) == "No label (erase)"
    assert not building.font(0).bold()


def test_what_is_painted_over_and_the_radius_go_both_ways(qtbot, street, panel):
    palette, over = street.shared.labels, panel.findChild(QComboBox)
    over.activated.emit(1)
    assert palette.rule.over is PaintOver.UNLABELLED
    palette.paint_over(PaintOver.ONE_CLASS, 67)
    assert over.currentText() == "Only Curb"
    over.activated.emit(over.findText("All points"))
    assert palette.rule == PaintRule(palette.rule.code)
    field = panel.findChild(NumberField)
    field.setValue(1.25)
    assert palette.radius_m == 1.25
    palette.widen(-1)
    assert field.value() == 1.0
    for _ in range(50):
        palette.widen(1)
    assert field.value() == field.maximum() == 10.0


def test_the_labels_are_shown_on_request(qtbot, street, panel):
    button = panel.findChild(QPushButton)
    assert button.isEnabled()
    qtbot.mouseClick(button, LEFT, pos=QPoint(5, 5))
    assert street.shared.view_settings.look.attribute == "label"
    assert not button.isEnabled()


def test_a_damaged_column_counts_nothing_and_stops_nothing(qtbot, street):
    (drive,) = street.drives()
    (drive.folder / "label.bin").write_bytes(b"\x01\x02")
    panel = LabelPanel(street, street.shared, "ja")
    qtbot.addWidget(panel)
    qtbot.waitUntil(lambda: not panel.tally.is_counting, timeout=30_000)
    assert not panel.tally.by_code.any()
    assert rows(panel)["路面"] == ("", "")
