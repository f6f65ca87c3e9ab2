"""Two drives of one street: each has its image, the same place is found in both."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QTreeWidget

from app.importing.source_watch import SourceWatch
from processing.core.errors import InUse
from processing.image.images_of_drives import image_of
from processing.project.project import Project
from tests.journeys.conftest import WAIT_MS, Surveyor
from tests.journeys.street_twice import make_street_twice
from widgets.image_view.shown_cursor import NEAR_M
from widgets.panels.tree_items import children_of

LEFT = Qt.MouseButton.LeftButton


@pytest.fixture(scope="module")
def job(tmp_path_factory) -> Path:
    """A folder with the project and its delivery; read only."""
    folder = tmp_path_factory.mktemp("job")
    make_street_twice(folder)
    return folder


@pytest.fixture
def at_street(surveyor: Surveyor, job: Path, tmp_path: Path) -> Iterator[Surveyor]:
    """A window on a copy of the project, whose delivery lies beside it."""
    shutil.copytree(job, tmp_path / "job")
    with surveyor.bot.waitSignal(surveyor.parts.of(SourceWatch).looked, timeout=WAIT_MS):
        assert surveyor.document.open(tmp_path / "job" / "street.zuka")
    return surveyor


def drive_of(surveyor: Surveyor, name: str):
    return next(one for one in surveyor.document.drives() if one.info.name.startswith(name))


def box_of(tree: QTreeWidget, item) -> QPoint:
    rect = tree.visualItemRect(item)
    return QPoint(rect.left() + 8, rect.center().y())


def tree_of(surveyor: Surveyor) -> QTreeWidget:
    tree = surveyor.parts.project_tree.findChild(QTreeWidget)
    surveyor.parts.project_tree.window().show()
    return tree


def test_a_click_in_one_image_is_the_nearest_point_in_the_other_driven_back(at_street):
    there, back = drive_of(at_street, "there"), drive_of(at_street, "back")
    views = at_street.parts.image_views
    other = views.show_beside(back.id)
    assert other is not None
    assert other.viewport.orientation.is_reversed_along
    image = image_of(there, at_street.document.shared.view_settings.image_kind)
    point = at_street.shown_point(image.rows // 2, image.width // 2)
    at_street.click(point)
    position = at_street.document.shared.cursor.position
    assert position is not None
    away = np.linalg.norm(back.xyz(slice(None)) - np.array(position.xyz), axis=1)
    assert away.min() < NEAR_M
    shown = other.position_of(position)
    rows, columns = other.picture.image.pixel_of(np.array([int(away.argmin())]))
    spot = other.picture.positions(rows, columns.astype(np.int64))[0]
    assert (shown.x(), shown.y()) == other.viewport.position_of(*spot.tolist())
    # Locked scrolling has brought it into the window, about where it is in the first image.
    first = views.main.position_of(position)
    assert other.viewport.shows(*spot.tolist(), 0.0)
    assert abs(first.x() - shown.x()) < 0.25 * other.width()


def test_a_drive_is_hidden_and_shown_by_its_box_and_the_image_stays(at_street):
    tree = tree_of(at_street)
    second = children_of(children_of(tree)[0])[1]
    settings = at_street.document.shared.view_settings
    shown = settings.drive_id
    with at_street.bot.waitSignal(settings.hidden_drives_changed, timeout=WAIT_MS):
        at_street.bot.mouseClick(tree.viewport(), LEFT, pos=box_of(tree, second))
    assert settings.hidden_drives == {drive_of(at_street, second.text(0)).id}
    assert settings.drive_id == shown
    with at_street.bot.waitSignal(settings.hidden_drives_changed, timeout=WAIT_MS):
        children_of(tree)[0].setCheckState(0, Qt.CheckState.Unchecked)
    assert len(settings.hidden_drives) == 2
    with at_street.bot.waitSignal(settings.hidden_drives_changed, timeout=WAIT_MS):
        children_of(tree)[0].setCheckState(0, Qt.CheckState.Checked)
    assert settings.hidden_drives == frozenset()


def test_what_is_shown_where_is_as_it_was_at_the_next_opening(at_street):
    there, back = drive_of(at_street, "there"), drive_of(at_street, "back")
    settings, views = at_street.document.shared.view_settings, at_street.parts.image_views
    settings.show_image(back.id, back.image_kinds[1])
    assert views.show_beside(there.id) is not None
    settings.hide_drives(frozenset({there.id}))
    shown = views.images
    folder = at_street.document.project.folder
    at_street.document.close()
    assert views.images == ()
    assert settings.hidden_drives == frozenset()
    assert at_street.document.open(folder)
    assert views.images == shown
    assert (settings.drive_id, settings.image_kind) == (back.id, back.image_kinds[1])
    assert settings.hidden_drives == {there.id}


def test_a_fourth_drive_beside_takes_the_place_of_the_last_one(at_street):
    there, back = drive_of(at_street, "there"), drive_of(at_street, "back")
    views = at_street.parts.image_views
    views.add()
    views.add()
    assert not views.can_add
    assert views.show_beside(back.id) is not None
    assert views.show_beside("nothing") is None
    assert [one.drive_id for one in views.images] == [back.id, there.id]


def test_files_that_are_missing_are_told_marked_and_found_by_one_choice(surveyor, job, tmp_path):
    shutil.copytree(job / "street.zuka", tmp_path / "desk" / "street.zuka")
    watch, bar = surveyor.parts.of(SourceWatch), surveyor.parts.message_bar
    hidden = job.with_name("away")
    job.rename(hidden)
    try:
        with surveyor.bot.waitSignal(watch.looked, timeout=WAIT_MS):
            assert surveyor.document.open(tmp_path / "desk" / "street.zuka")
        assert len(watch.troubles) == 2
        assert "not where they were: 2" in bar.text
        items = children_of(children_of(tree_of(surveyor))[0])
        assert all(not item.icon(0).isNull() for item in items)
        assert all("is missing" in item.toolTip(0) for item in items)
        with surveyor.bot.waitSignal(watch.looked, timeout=WAIT_MS):
            watch.look_in(tmp_path)
        assert "not where they were: 2" in bar.text
        with surveyor.bot.waitSignal(watch.looked, timeout=WAIT_MS):
            watch.look_in(hidden / "delivery")
        assert watch.troubles == ()
        assert bar.text == ""
        assert all(item.icon(0).isNull() for item in items)
    finally:
        hidden.rename(job)


def test_a_window_on_a_moved_copy_opens_beside_the_first(at_street, tmp_path):
    folder = at_street.document.project.folder
    shutil.copytree(folder, tmp_path / "copy.zuka")
    project = Project.open(tmp_path / "copy.zuka")
    assert len(project.drives) == 2
    project.close()
    with pytest.raises(InUse, match="another window"):
        Project.open(folder)
