"""The form for an import: what is filled in is what is asked for."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PySide6.QtWidgets import QCheckBox, QDialogButtonBox

from widgets.dialogs.delivery_map import DeliveryMap, DeliveryShapes
from widgets.dialogs.delivery_table import DeliveredRow, DeliveryTable
from widgets.dialogs.import_drive import ImportForm


@pytest.mark.parametrize("as_labels", [False, True])
def test_delivered_classes_become_labels_only_when_that_is_asked_for(qtbot, as_labels):
    form = ImportForm(Path("/street"), (Path("/left.laz"),))
    qtbot.addWidget(form)
    form.findChild(QCheckBox).setChecked(as_labels)
    with qtbot.waitSignal(form.import_requested) as asked:
        form.findChild(QDialogButtonBox).accepted.emit()
    (request,) = asked.args
    assert request.classes_as_labels is as_labels
    assert request.files == (Path("/left.laz"),)
    assert request.project.name == "street.zuka"


def test_what_lies_beside_the_files_is_taken_when_it_is_ticked(qtbot, tmp_path):
    form = ImportForm(Path("/street"), (Path("/left.laz"),))
    qtbot.addWidget(form)
    form.show()
    form.offer((Path("/trajectory.csv"),), is_lacking=True)
    form.offer_images((Path("/images.csv"),))
    form.offer_project(tmp_path / "old.zuka")
    boxes = {box.text().split(" ")[0]: box for box in form.findChildren(QCheckBox)}
    boxes["Add"].setChecked(True)
    with qtbot.waitSignal(form.import_requested) as asked:
        form.findChild(QDialogButtonBox).accepted.emit()
    (request,) = asked.args
    assert [path.name for path in request.files] == ["left.laz", "trajectory.csv", "images.csv"]
    assert request.project == tmp_path / "old.zuka"


def test_the_form_shows_what_files_hold_and_where_they_lie(qtbot):
    form = ImportForm(Path("/street"), (Path("/street/left.laz"), Path("/street/way.csv")))
    qtbot.addWidget(form)
    shapes = DeliveryShapes([(0.0, 0.0, 30.0, 10.0)], [np.array([[1.0, 1.0], [29.0, 9.0]])])
    rows = (
        DeliveredRow(Path("/street/left.laz"), ("Points", "290,429 points")),
        DeliveredRow(Path("/street/way.csv"), ("Trajectories", "1,100 records")),
    )
    form.show_delivery(rows, shapes, "Recorded together: left.laz")
    table = form.findChild(DeliveryTable)
    shown = [[table.topLevelItem(row).text(column) for column in range(3)] for row in range(2)]
    assert shown == [
        ["left.laz", "Points", "290,429 points"],
        ["way.csv", "Trajectories", "1,100 records"],
    ]
    picture = form.findChild(DeliveryMap).grab().toImage()
    colours = {picture.pixelColor(x, y).name() for x in range(285) for y in range(190)}
    assert len(colours) > 3
    assert form.files == (Path("/street/left.laz"), Path("/street/way.csv"))
