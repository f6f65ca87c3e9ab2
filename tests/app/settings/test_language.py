"""The language changes while the program runs: other widgets, the same work."""

from __future__ import annotations

import threading
from pathlib import Path

import numpy as np
import pytest
import shiboken6
from PySide6.QtCore import SIGNAL, QCoreApplication, QMetaMethod, QObject, Qt
from PySide6.QtWidgets import QWidget
from pytestqt.qtbot import QtBot

from app.window.window_parts import WindowParts
from processing.core.text import Text
from processing.map.catalogue import Geometry
from processing.map.feature import PointReference, Vertex
from processing.project.importing.importing import ImportRequest
from processing.recording.drive import Drive
from tests.builders import simulated_drive, write_laz, write_trajectory_csv
from widgets.mouse_tools.mouse_tool import Hit
from widgets.shared.cursor import PickedPosition

WAIT_MS = 60_000


@pytest.fixture
def street(qtbot: QtBot, parts: WindowParts, tmp_path: Path) -> WindowParts:
    """The window with a recording, whose 3D picture is there."""
    drive = simulated_drive(3)
    request = ImportRequest(
        (write_laz(drive, tmp_path / "left.laz"),),
        (write_trajectory_csv(drive, tmp_path / "way.csv"),),
        crs="EPSG:6677",
    )
    with qtbot.waitSignal(parts.jobs.finished, timeout=WAIT_MS):
        parts.document.import_into_new(tmp_path / "s.zuka", request)
    qtbot.waitUntil(lambda: not parts.jobs.is_busy, timeout=WAIT_MS)
    qtbot.waitUntil(lambda: parts.scene_view.picture is not None, timeout=WAIT_MS)
    return parts


def speak(qtbot: QtBot, parts: WindowParts, language: str) -> None:
    """Choose a language as a user does, and wait until the old widgets are gone."""
    old = [parts.image_view, parts.scene_view, parts.window.centralWidget()]
    parts.window.actions_by_id[f"language-{language}"].trigger()
    qtbot.waitUntil(lambda: parts.language == language, timeout=WAIT_MS)
    qtbot.waitUntil(lambda: not any(map(shiboken6.isValid, old)), timeout=WAIT_MS)
    qtbot.waitUntil(parts.window.updatesEnabled, timeout=WAIT_MS)


def drive_of(parts: WindowParts) -> Drive:
    return parts.document.drive(parts.document.shared.view_settings.drive_id)


def hit_on(parts: WindowParts, point: int) -> Hit:
    x, y, z = drive_of(parts).xyz(np.array([point]))[0].tolist()
    return Hit(PickedPosition((x, y, z), PointReference(drive_of(parts).id, point)))


def line_kind(parts: WindowParts):
    kinds = parts.document.catalogue().kinds
    return next(kind for kind in kinds if kind.geometry is Geometry.LINE)


def menu_titles(parts: WindowParts) -> list[str]:
    return [action.text() for action in parts.window.menuBar().actions()]


def test_the_window_speaks_the_language_at_once_and_at_the_next_start(
    qtbot: QtBot, parts: WindowParts
) -> None:
    english = menu_titles(parts)
    speak(qtbot, parts, "ja")
    assert menu_titles(parts)[0] == "ファイル(&F)"
    assert parts.settings.language == "ja"
    speak(qtbot, parts, "en")
    assert menu_titles(parts) == english


def test_words_of_the_language_before_are_no_longer_translated(
    qtbot: QtBot, parts: WindowParts
) -> None:
    speak(qtbot, parts, "ja")
    assert QCoreApplication.translate("QPlatformTheme", "Cancel") == "キャンセル"
    speak(qtbot, parts, "en")
    assert QCoreApplication.translate("QPlatformTheme", "Cancel") == "Cancel"


def test_choosing_the_language_that_is_spoken_changes_nothing(
    qtbot: QtBot, parts: WindowParts
) -> None:
    view = parts.image_view
    parts.window.actions_by_id["language-en"].trigger()
    qtbot.wait(0)
    assert parts.image_view is view
    assert shiboken6.isValid(view)


def test_what_is_looked_at_is_looked_at_again(qtbot: QtBot, street: WindowParts) -> None:
    shared = street.document.shared
    position = hit_on(street, 5).position
    assert position is not None
    shared.cursor.move_to(position)
    street.image_view.show_one_to_one()
    street.image_view.zoom_by(3.0)
    street.image_view.center_on(position)
    street.scene_view.look_from_above()
    street.scene_view.set_shading(is_on=False)
    street.window.area.stand_side_by_side(beside=True)
    street.processing_panel.show_tool("segments")
    qtbot.wait(0)
    before = street.image_view.viewport
    camera = street.scene_view.camera
    drive, kind = shared.view_settings.drive_id, shared.view_settings.image_kind
    speak(qtbot, street, "ja")
    after = street.image_view.viewport
    assert (after.zoom, after.centre, after.extent) == (before.zoom, before.centre, before.extent)
    assert street.scene_view.camera == camera
    assert shared.cursor.position == position
    assert (shared.view_settings.drive_id, shared.view_settings.image_kind) == (drive, kind)
    assert street.window.area.is_beside
    assert street.window.actions_by_id["side-by-side"].isChecked()
    assert street.processing_panel.tool == "segments"
    scene = street.scene_view
    qtbot.waitUntil(
        lambda: scene.cloud is not None and not scene.cloud.is_shading_wanted, timeout=WAIT_MS
    )


def test_docks_stay_where_they_were_put(qtbot: QtBot, street: WindowParts) -> None:
    street.window.actions_by_id["panel-jobs"].trigger()
    street.window.actions_by_id["panel-project"].trigger()
    qtbot.wait(0)

    def stand() -> dict[str, tuple[bool, int]]:
        window = street.window
        names = ("project", "layers", "processing", "attributes", "jobs")
        docks = {name: window.findChild(QWidget, name) for name in names}
        return {
            # A dock behind another one has no size of its own.
            name: (dock.isHidden(), 0 if dock.visibleRegion().isEmpty() else dock.width())
            for name, dock in docks.items()
        }

    before = stand()
    assert before["project"][0]
    speak(qtbot, street, "ja")
    qtbot.waitUntil(lambda: stand() == before, timeout=30_000)


def test_a_line_that_is_being_drawn_goes_on_in_the_new_views(
    qtbot: QtBot, street: WindowParts
) -> None:
    street.toolbox.choose_kind(line_kind(street))
    tool = street.toolbox.name
    for point in (10, 400):
        street.image_view.center_on(hit_on(street, point).position)
        spot = street.image_view.position_of(hit_on(street, point).position).toPoint()
        qtbot.mouseClick(street.image_view, Qt.MouseButton.LeftButton, pos=spot)
    drawn = street.document.shared.sketch.drawing.vertices
    assert len(drawn) == 2
    speak(qtbot, street, "ja")
    assert street.toolbox.name == tool
    assert street.toolbox.kind == line_kind(street)
    assert street.document.shared.sketch.drawing.vertices == drawn
    assert street.window.actions_by_id[f"tool-{tool}"].isChecked()
    qtbot.keyClick(street.image_view, Qt.Key.Key_Return)
    (feature,) = street.document.features()
    assert positions(feature.vertices) == positions(drawn)
    assert street.document.undo()
    assert not list(street.document.features())


def positions(vertices: tuple[Vertex, ...]) -> list[tuple[float, float, float]]:
    return [vertex.xyz for vertex in vertices]


def test_selection_and_undo_survive(qtbot: QtBot, street: WindowParts) -> None:
    street.toolbox.choose_kind(line_kind(street))
    for point in (10, 400):
        street.image_view.center_on(hit_on(street, point).position)
        spot = street.image_view.position_of(hit_on(street, point).position).toPoint()
        qtbot.mouseClick(street.image_view, Qt.MouseButton.LeftButton, pos=spot)
    qtbot.keyClick(street.image_view, Qt.Key.Key_Return)
    street.window.actions_by_id["select-all"].trigger()
    chosen = street.document.shared.selection.features
    assert len(chosen) == 1
    speak(qtbot, street, "ja")
    assert street.document.shared.selection.features == chosen
    undo = street.window.actions_by_id["undo"]
    assert undo.isEnabled()
    assert undo.text().startswith("元に戻す: ")
    undo.trigger()
    assert not list(street.document.features())


def test_a_job_goes_on_and_is_shown_in_the_new_panel(qtbot: QtBot, parts: WindowParts) -> None:
    go_on = threading.Event()
    job = parts.jobs.start(Text("Count", "集計"), lambda _monitor: go_on.wait(30))
    speak(qtbot, parts, "ja")
    assert [(view.title, view.is_over) for view in parts.jobs_panel.shown()] == [("集計", False)]
    with qtbot.waitSignal(parts.jobs.finished) as ended:
        go_on.set()
    assert ended.args == [job, True]
    assert parts.jobs_panel.shown()[0].is_over


def test_a_refusal_is_said_again_in_the_new_language(
    qtbot: QtBot, parts: WindowParts, tmp_path: Path
) -> None:
    assert not parts.document.open(tmp_path / "nowhere.zuka")
    assert parts.message_bar.text
    english = parts.message_bar.text
    speak(qtbot, parts, "ja")
    assert parts.message_bar.text not in ("", english)


def test_a_form_of_the_keys_goes_with_the_language_it_speaks(
    qtbot: QtBot, parts: WindowParts
) -> None:
    parts.window.actions_by_id["shortcuts"].trigger()
    parts.window.actions_by_id["palette"].trigger()
    names = {"ShortcutsForm", "CommandPalette"}
    old = [one for one in parts.window.findChildren(QWidget) if type(one).__name__ in names]
    assert len(old) == 2
    speak(qtbot, parts, "ja")
    assert not any(map(shiboken6.isValid, old))


def test_after_three_changes_no_old_widget_is_alive(qtbot: QtBot, street: WindowParts) -> None:
    old: list[QWidget] = []
    count = len(street.window.findChildren(QWidget))
    for language in ("ja", "en", "ja"):
        old += [street.image_view, street.scene_view, street.scene_view.picture]
        old += [street.layers_panel, street.jobs_panel, street.start_page, street.status_line]
        old += [street.window.menuBar(), street.window.actions_by_id["open"]]
        speak(qtbot, street, language)
        qtbot.waitUntil(lambda: street.scene_view.picture is not None, timeout=WAIT_MS)
    assert [widget for widget in old if shiboken6.isValid(widget)] == []
    assert abs(len(street.window.findChildren(QWidget)) - count) <= 12  # menus' own parts
    pictures = [
        one for one in street.window.findChildren(QWidget) if type(one).__name__ == "ScenePicture"
    ]
    assert pictures == [street.scene_view.picture]


def test_after_three_changes_each_signal_reaches_as_many_as_before(
    qtbot: QtBot, street: WindowParts
) -> None:
    shared = street.document.shared
    lasting = {
        "document": street.document,
        "undo": street.document.undo_stack,
        "jobs": street.jobs,
        "toolbox": street.toolbox,
        "cursor": shared.cursor,
        "selection": shared.selection,
        "map": shared.map_changes,
        "settings": shared.view_settings,
        "sketch": shared.sketch,
        "window": street.window,
    }
    before = {name: receivers_of(owner) for name, owner in lasting.items()}
    assert before["cursor"]["moved(PyObject)"] >= 3
    for language in ("ja", "en", "ja"):
        speak(qtbot, street, language)
        qtbot.waitUntil(lambda: street.scene_view.picture is not None, timeout=WAIT_MS)
    after = {name: receivers_of(owner) for name, owner in lasting.items()}
    assert after == before


def receivers_of(owner: QObject) -> dict[str, int]:
    """How many listen to each signal of a class of ours."""
    described = owner.metaObject()
    methods = [
        described.method(at) for at in range(described.methodOffset(), described.methodCount())
    ]
    signatures = [
        method.methodSignature().data().decode()
        for method in methods
        if method.methodType() == QMetaMethod.MethodType.Signal
    ]
    return {signature: owner.receivers(SIGNAL(signature)) for signature in signatures}
