"""A drive that lacks what was chosen is shown by what it has, and that is said in a line."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PySide6.QtWidgets import QComboBox, QStyleOptionComboBox

from app.document.document import Document
from app.jobs.jobs import JobQueue
from app.views.attribute_notices import AttributeNotices
from processing.image.attributes.attributes import colours
from processing.image.attributes.tile_cache import TileCache, TileRequest
from processing.image.images_of_drives import image_of
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from tests.processing.image.recordings import small_drive
from widgets.pictures.image_view_settings import ImageViewSettings
from widgets.shared.map_changes import MapChanges
from widgets.shared.view_settings import ViewSettings


class _Source:
    """Two drives, only the first one classified."""

    def __init__(self, folder: Path) -> None:
        self._drives = {one.id: one for one in (_drive(folder, "one"), _drive(folder, "two"))}
        first = next(iter(self._drives.values()))
        first.columns.add("label", np.full(first.count, 2, np.uint8))

    def drives(self) -> tuple[Drive, ...]:
        return tuple(self._drives.values())

    def drive(self, id_: str) -> Drive:
        return self._drives[id_]


def _drive(folder: Path, name: str) -> Drive:
    drive, _ = small_drive(folder / name)
    (folder / name / "drive.json").write_text(
        (folder / name / "drive.json").read_text("utf-8").replace(f'"{drive.id}"', f'"{name}"', 1),
        "utf-8",
    )
    return Drive(folder / name)


@pytest.fixture
def source(tmp_path: Path) -> _Source:
    return _Source(tmp_path)


def test_the_chooser_shows_what_the_drive_is_shown_by_and_the_other_what_was_chosen(
    qtbot, source: _Source
) -> None:
    settings, (first, second) = ViewSettings(), source.drives()
    choice = ImageViewSettings(source, MapChanges(), settings, language="en")
    qtbot.addWidget(choice)
    box = choice.findChildren(QComboBox)[2]
    settings.show_image(first.id, ImageKind.TRAJECTORY_CENTER)
    settings.change_look(attribute="class")
    assert box.currentData() == "class"
    settings.show_image(second.id, ImageKind.TRAJECTORY_CENTER)
    assert box.currentData() == "intensity"
    assert box.findData("class") < 0
    settings.show_image(first.id, ImageKind.TRAJECTORY_CENTER)
    assert box.currentData() == "class"


def test_tiles_of_a_drive_without_classes_show_its_intensity(qtbot, source: _Source) -> None:
    tiles, made = TileCache(), []
    tiles.use(source.drive)
    second = source.drives()[1]
    kind = ImageKind.TRAJECTORY_CENTER
    key = image_of(second, kind).pyramid.top
    tiles.request(
        TileRequest(second.id, kind, key, "class", 2.0, 98.0), lambda _, pixels: made.append(pixels)
    )
    qtbot.waitUntil(lambda: bool(made))
    tiles.close()
    expected = colours(second, made[0].points, "intensity", 2.0, 98.0)
    np.testing.assert_array_equal(made[0].colours, expected)
    assert tiles.is_stand_in(second.id)


def test_a_line_names_the_drives_that_lack_what_was_chosen(
    qtbot, source: _Source, monkeypatch: pytest.MonkeyPatch
) -> None:
    document = Document(JobQueue())
    monkeypatch.setattr(document, "drives", source.drives)
    news = AttributeNotices(document)
    with qtbot.waitSignal(news.reported) as reported:
        document.shared.view_settings.change_look(attribute="class")
    assert reported.args[0].en == (
        f"{source.drives()[1].info.name}: no “Class”; shown by “Intensity”."
    )
    with qtbot.assertNotEmitted(news.reported):
        document.shared.view_settings.change_look(attribute="intensity")


def test_words_that_do_not_fit_end_in_dots_and_the_name_of_the_drive_is_whole(
    qtbot, source: _Source
) -> None:
    choice = ImageViewSettings(source, MapChanges(), _shown(source), language="en")
    qtbot.addWidget(choice)
    choice.let_shrink()
    with qtbot.waitExposed(choice):
        choice.show()
    drive, _, attribute = choice.findChildren(QComboBox)
    choice.resize(choice.minimumSizeHint())
    assert _drawn_words(drive) == drive.currentText()
    assert drive.toolTip() == drive.currentText()
    assert _drawn_words(attribute).endswith("…")


def _shown(source: _Source) -> ViewSettings:
    settings = ViewSettings()
    drive, *_ = source.drives()
    settings.show_image(drive.id, drive.image_kinds[0])
    return settings


def _drawn_words(box: QComboBox) -> str:
    option = QStyleOptionComboBox()
    box.initStyleOption(option)
    return option.currentText
