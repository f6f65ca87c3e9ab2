"""The form for an import: what is filled in is what is asked for."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtWidgets import QCheckBox, QDialogButtonBox

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
