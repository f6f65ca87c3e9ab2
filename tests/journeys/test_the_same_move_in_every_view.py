"""A vertex moved in any view gives the same coordinate in the exported drawing."""

from __future__ import annotations

from pathlib import Path

import ezdxf
import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QApplication

from processing.core.text import Text
from processing.image.images_of_drives import image_of
from processing.map.catalogue import Geometry
from processing.map.change import Change
from processing.map.feature import Feature, Vertex, new_feature_id
from processing.operations.export import ExportRequest
from processing.recording.camera_images.camera import Camera
from tests.journeys.conftest import Surveyor
from tests.mouse_events import NO_KEYS, move_mouse
from widgets.shared.cursor import PickedPosition

LEFT = Qt.MouseButton.LeftButton
FREE = Qt.KeyboardModifier.ControlModifier
"""Ctrl: the measured point itself, no snapping."""

WAIT_MS = 30_000
LAYER = "2213_歩道"
VIEWS = ("image", "scene", "section", "camera", "map")
SAME_M = 0.0015
"""Files hold millimetres."""

NEAR_M = 0.25
"""Several measured points lie under one pixel of a view that looks along the road."""


@pytest.fixture
def street(surveyor: Surveyor, tmp_path: Path, qtbot):
    """Give a window on the sample street with all views to be seen."""
    surveyor.open_sample_street(tmp_path / "street.zuka")
    surveyor.parts.window.actions_by_id["layout-checking"].trigger()
    qtbot.waitUntil(lambda: surveyor.parts.scene_view.is_settled, timeout=WAIT_MS)
    return surveyor


def test_a_vertex_moved_in_any_view_is_exported_alike(street: Surveyor, qtbot, tmp_path):
    parts = street.parts
    start, goal = positions_on_a_curb(street)
    line, other = line_from(start, "curb_upper"), line_from(goal, "curb_lower")
    assert parts.document.apply(Text("Draw", "作図"), Change(added=(line, other)))
    exported = {}
    for name in VIEWS:
        show(street, name, goal)
        parts.document.shared.selection.choose_features(frozenset({line.id}))
        parts.toolbox.choose("edit")
        drag(street, name, start, goal)
        exported[name] = exported_start(street, tmp_path / name)
        undo(street)
        assert parts.document.feature(line.id) == line
        drag(street, name, start, goal, FREE)
        freely = parts.document.feature(line.id).vertices[0]
        assert freely.measured is not None, name
        of_point = parts.document.drive(freely.measured.drive).xyz(
            np.array([freely.measured.point])
        )[0]
        assert np.allclose(of_point, freely.xyz, atol=SAME_M), name
        assert np.linalg.norm(of_point - goal.xyz) < NEAR_M, name
        undo(street)
    assert {tuple(np.round(position, 3).tolist()) for position in exported.values()} == {goal.xyz}


def positions_on_a_curb(street: Surveyor) -> tuple[PickedPosition, PickedPosition]:
    """Two points of the road within one section, a step apart, that a camera image shows."""
    drive = street.drive
    image = image_of(drive, street.document.shared.view_settings.image_kind)
    images = drive.images
    assert images is not None
    for row in range(image.rows // 5, image.rows - 20, 7):
        for column in range(int(0.38 * image.width), int(0.62 * image.width), 11):
            point = image.nearest_filled(row, column, 2)
            other = image.nearest_filled(row, column + 8, 2)
            if point < 0 or other < 0:
                continue
            xyz = drive.xyz(np.array([point, other]))
            if not 0.2 < np.linalg.norm(xyz[1] - xyz[0]) < 0.45:
                continue
            for taken in images:
                camera = Camera(taken)
                away = camera.distances_to(xyz)
                if away.max() < 14.0 and camera.shows(camera.pixels_of(xyz)).all():
                    return street.position_of(point), street.position_of(other)
    message = "no image shows the road"
    raise AssertionError(message)


def line_from(start: PickedPosition, kind: str) -> Feature:
    """Draw a line from a place to one two metres away, across the road."""
    x, y, z = start.xyz
    vertices = (Vertex(start.xyz, start.measured), Vertex((x + 2.0, y + 2.0, z)))
    return Feature(new_feature_id(), kind, Geometry.LINE, vertices)


def show(street: Surveyor, name: str, position: PickedPosition) -> None:
    """Bring a view to the front, close to a place, and wait until it is sharp."""
    parts, bot = street.parts, street.bot
    if name != "image":
        parts.view_docks.show_view(name)
    parts.document.shared.cursor.move_to(position)
    if name == "image":
        parts.image_view.show_one_to_one()
        parts.image_view.zoom_by(8.0)
        parts.image_view.center_on(position)
    elif name == "scene":
        camera = parts.scene_view.camera
        parts.scene_view.look_from_above()
        parts.scene_view.center_on(position)
        parts.scene_view.zoom_by(camera.distance_m / 4.0)
        bot.waitUntil(lambda: parts.scene_view.is_settled, timeout=WAIT_MS)
    elif name == "section":
        parts.section_view.show_position(position)
        with bot.waitSignal(parts.section_view.sharpened, timeout=WAIT_MS):
            parts.section_view.set_pinned(False)
            parts.section_view.step(1)
            parts.section_view.step(-1)
            parts.section_view.show_position(position)
        parts.section_view.panes[0].zoom_by(8.0)
        parts.section_view.panes[0].center_on(position)
    elif name == "camera":
        parts.camera_view.show_position(position)
        bot.waitUntil(lambda: parts.camera_view.is_sharp, timeout=WAIT_MS)
        parts.camera_view.zoom_by(6.0)
        parts.camera_view.center_on(position)
    else:
        # Clicks find the points that are in the picture, so it has to be there.
        with bot.waitSignal(parts.map_view.sharpened, timeout=WAIT_MS):
            parts.map_view.zoom_by(40.0)
            parts.map_view.center_on(position)


def undo(street: Surveyor) -> None:
    """Take the last step back, and let every view draw it."""
    street.parts.window.actions_by_id["undo"].trigger()
    QApplication.processEvents()


def drag(
    street: Surveyor, name: str, start: PickedPosition, goal: PickedPosition, keys=NO_KEYS
) -> None:
    """Take hold of the vertex and let it go at the goal, snapping to what is drawn there."""
    parts, bot = street.parts, street.bot
    view = getattr(parts, f"{name}_view")
    target = view
    if name == "scene":
        target = parts.scene_view.picture
    elif name == "section":
        target = parts.section_view.panes[0]
    source = target if name == "section" else view

    def spot(position: PickedPosition) -> QPoint:
        at = source.position_of(position)
        assert at is not None, name
        assert target.rect().contains(at.toPoint()), name
        return at.toPoint()

    before = parts.document.shared.map_changes.features_changed
    with bot.waitSignal(before, timeout=WAIT_MS):
        move_mouse(target, spot(start))
        bot.mousePress(target, LEFT, NO_KEYS, spot(start))
        middle = (spot(start) + spot(goal)) / 2
        move_mouse(target, middle, LEFT)
        move_mouse(target, spot(goal), LEFT, keys)
        bot.mouseRelease(target, LEFT, keys, spot(goal))


def exported_start(street: Surveyor, folder: Path) -> np.ndarray:
    """Where the line begins in the drawing that is handed in."""
    request = ExportRequest(("dxf",), folder)
    street.wait_for_job(lambda: street.document.export(request))
    (path,) = folder.glob("*.dxf")
    drawn = ezdxf.readfile(path).modelspace().query("POLYLINE")
    (line,) = (one for one in drawn if one.dxf.layer == LAYER)
    return np.array(next(iter(line.points())).xyz)
