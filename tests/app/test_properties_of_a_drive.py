"""A drive gets another name and day, is replaced by a new delivery, and all of it is undone."""

from __future__ import annotations

import shutil
from dataclasses import dataclass
from datetime import date
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QDialogButtonBox, QFileDialog, QPushButton, QTreeWidget
from pytestqt.qtbot import QtBot

from app.document.document import Document
from app.window.window_parts import WindowParts
from processing.core.text import Text
from processing.map.catalogue import Geometry
from processing.map.change import Change
from processing.map.feature import Feature, PointReference, Position, Provenance, Status, Vertex
from processing.recording.drive import Drive
from processing.recording.measured_day import measured_day
from resources import path_of
from tests.app.conftest import WAIT_MS
from tests.builders import simulated_drive, write_laz
from widgets.dialogs.drive_properties import DrivePropertiesForm
from widgets.panels.project.project_drives import DRIVE

LABEL = Text.same("x")
ALT = Qt.KeyboardModifier.AltModifier


@pytest.fixture
def delivery(tmp_path) -> Path:
    """The points of one head with its trajectory."""
    folder = tmp_path / "納品"
    folder.mkdir()
    for name in ("left.laz", "trajectory.csv"):
        shutil.copy(path_of(f"sample_street/{name}"), folder)
    return folder


@dataclass
class Street:
    """A window with the drive in a new project, and who uses it."""

    bot: QtBot
    parts: WindowParts

    @property
    def document(self) -> Document:
        return self.parts.document

    @property
    def drive(self) -> Drive:
        return self.document.drives()[0]


@pytest.fixture
def street(qtbot: QtBot, parts: WindowParts, delivery: Path) -> Street:
    assert parts.document.create(delivery.parent / "通り.zuka", "")
    with qtbot.waitSignal(parts.document.drive_results.taken, timeout=WAIT_MS):
        parts.window.files_dropped.emit(tuple(sorted(delivery.iterdir())))
    return Street(qtbot, parts)


def _properties(street: Street) -> DrivePropertiesForm:
    """The form, called by Alt+Enter in the tree."""
    tree = street.parts.project_tree.findChild(QTreeWidget)
    folder = tree.topLevelItem(0)
    tree.setCurrentItem(folder.child(0))
    tree.setFocus()
    street.bot.keyClick(tree, Qt.Key.Key_Return, ALT)
    forms = street.parts.window.findChildren(DrivePropertiesForm)
    form = next(one for one in forms if one.isVisible())
    assert form.drive == folder.child(0).data(0, DRIVE)
    return form


def _type(field, words: str) -> None:
    """Type over what is there; Japanese comes in at once, as an input method gives it."""
    field.selectAll()
    field.insert(words)


def _accept(form: DrivePropertiesForm) -> None:
    form.findChild(QDialogButtonBox).button(QDialogButtonBox.StandardButton.Ok).click()


def _button(form: DrivePropertiesForm, words: str) -> QPushButton:
    return next(one for one in form.findChildren(QPushButton) if words in one.text())


def test_name_and_day_are_given_by_keys_and_undone(street):
    document = street.document
    form = _properties(street)
    assert form.name.text() == "left"
    assert form.day.text() == ""
    assert form.day.placeholderText() == "2023-08-24"
    _type(form.name, "国道20号 上り")
    _type(form.day, "2026-04-01")
    _accept(form)
    assert not form.isVisible()
    assert street.drive.info.name == "国道20号 上り"
    assert measured_day((street.drive,)) == date(2026, 4, 1)
    tree = street.parts.project_tree.findChild(QTreeWidget)
    assert tree.topLevelItem(0).child(0).text(0) == "国道20号 上り"
    assert document.undo()
    assert street.drive.info.name == "left"
    assert measured_day((street.drive,)) == date(2023, 8, 24)
    assert document.redo()
    folder = document.project.folder
    document.close()
    assert document.open(folder)
    assert document.drives()[0].info.name == "国道20号 上り"


def test_a_day_that_is_none_is_told_in_the_form_and_nothing_changes(street):
    form = _properties(street)
    _type(form.day, "yesterday")
    _accept(form)
    assert form.isVisible()
    assert "yesterday" in form.trouble.text()
    assert street.drive.info.measured_on == ""


def test_a_new_delivery_takes_the_place_of_a_drive_and_the_map_stays(street, tmp_path, monkeypatch):
    document = street.document
    old = street.drive
    at: Position = tuple(old.xyz(np.array([1000]))[0].tolist())
    vertices = (Vertex(at, PointReference(old.id, 1000)), Vertex((0.0, 0.0, 0.0)))
    drawn = Feature("line", "curb", Geometry.LINE, vertices)
    found = Feature(
        "waits",
        "curb",
        Geometry.LINE,
        vertices,
        status=Status.CANDIDATE,
        provenance=Provenance("curbs", 1, confidence=0.5),
    )
    assert document.apply(LABEL, Change(added=(drawn, found)))
    new = write_laz(simulated_drive(length_m=3.0), tmp_path / "second.laz")
    monkeypatch.setattr(QFileDialog, "getOpenFileNames", lambda *_: ([str(new)], ""))
    form = _properties(street)
    with street.bot.waitSignal(document.drive_results.taken, timeout=WAIT_MS):
        _button(form, "new delivery").click()
    assert not form.isVisible()
    (drive,) = document.drives()
    assert drive.id != old.id
    assert drive.info.name == "left"
    assert drive.count != old.count
    assert street.drive is drive
    assert document.feature("line") == drawn
    assert document.feature("waits") is None
    assert document.undo()
    assert [one.id for one in document.drives()] == [old.id]
    assert document.feature("waits") == found
    assert np.array_equal(document.drives()[0].xyz(np.array([1000]))[0], at)


def test_the_same_delivery_is_noticed_and_replaces_nothing(street, delivery, monkeypatch):
    document = street.document
    before = street.drive
    again = shutil.copy(delivery / "left.laz", delivery.parent / "copy.laz")
    monkeypatch.setattr(QFileDialog, "getOpenFileNames", lambda *_: ([str(again)], ""))
    reported = []
    document.reported.connect(lambda text: reported.append(text.en))
    with street.bot.waitSignal(document.drive_results.taken, timeout=WAIT_MS):
        _button(_properties(street), "new delivery").click()
    assert [one.id for one in document.drives()] == [before.id]
    assert reported == ["In the project already, so not imported again: copy.laz"]
