"""Labels painted in the window: seen at once, undone by keys, kept over a restart."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from processing.image.attributes.colour_maps import class_colours
from processing.image.images_of_drives import image_of
from processing.labels.label_column import labels_of
from processing.labels.strokes import points_under_brush
from tests.journeys.conftest import WAIT_MS
from tests.mouse_events import NO_KEYS, move_mouse

LEFT = Qt.MouseButton.LeftButton
CONTROL = Qt.KeyboardModifier.ControlModifier


class Painter:
    """The surveyor with a brush in the hand."""

    def __init__(self, surveyor):
        self.surveyor = surveyor
        self.view = surveyor.parts.image_view
        window = surveyor.parts.window
        with surveyor.bot.waitActive(window):
            window.activateWindow()
        self.view.setFocus()
        self.do("tool-paint-brush")
        drive = surveyor.drive
        image = image_of(drive, surveyor.document.shared.view_settings.image_kind)
        self.point = surveyor.shown_point(image.rows // 2, image.width // 2)
        self.spot = surveyor.pixel_of(self.point)

    def do(self, action: str) -> None:
        self.surveyor.parts.window.actions_by_id[action].trigger()

    @property
    def labels(self):
        drive = self.surveyor.drive
        return labels_of(drive, np.arange(drive.count))

    def press(self):
        QTest.mousePress(self.view, LEFT, NO_KEYS, self.spot)

    def drag(self, steps: int = 5):
        for step in range(1, steps + 1):
            move_mouse(self.view, self.spot + QPoint(6 * step, 0), LEFT)

    def release(self, steps: int = 5):
        QTest.mouseRelease(self.view, LEFT, NO_KEYS, self.spot + QPoint(6 * steps, 0))

    def stroke(self):
        self.press()
        self.drag()
        self.release()

    def colour(self) -> tuple[int, int, int]:
        pixel = self.view.grab().toImage().pixelColor(self.spot)
        return pixel.red(), pixel.green(), pixel.blue()


@pytest.fixture
def painter(surveyor, tmp_path):
    surveyor.open_sample_street(tmp_path / "street.zuka")
    return Painter(surveyor)


def test_a_stroke_is_seen_undone_redone_and_kept(painter, surveyor, tmp_path):
    bot, document, view = surveyor.bot, surveyor.document, painter.view
    bot.keyClick(view, "6")
    assert document.shared.labels.rule.code == 6
    painter.do("brush-larger")
    assert document.shared.labels.radius_m == 0.375
    painter.stroke()
    position = np.array(surveyor.position_of(painter.point).xyz)
    under = points_under_brush(surveyor.drive, position, position, 0.375)
    painted = painter.labels
    assert under.size > 5
    assert (painted[under] == 6).all()
    assert document.undo_stack.undo_label.en == "Label points: Building"
    building = tuple(class_colours()[6].tolist())
    bot.waitUntil(lambda: painter.colour() == building, timeout=WAIT_MS)
    bot.keyClick(view, Qt.Key.Key_Z, CONTROL)
    assert not painter.labels.any()
    bot.waitUntil(lambda: painter.colour() != building, timeout=WAIT_MS)
    bot.keyClick(view, Qt.Key.Key_Y, CONTROL)
    np.testing.assert_array_equal(painter.labels, painted)
    bot.waitUntil(lambda: painter.colour() == building, timeout=WAIT_MS)
    document.close()
    assert document.open(tmp_path / "street.zuka")
    np.testing.assert_array_equal(painter.labels, painted)
    assert document.undo()
    assert not painter.labels.any()


def test_escape_and_undo_in_the_middle_of_a_stroke_drop_only_the_stroke(painter, surveyor):
    bot, view = surveyor.bot, painter.view
    painter.stroke()
    painted = painter.labels
    assert painted.any()
    bot.keyClick(view, "7")
    for key, modifiers in ((Qt.Key.Key_Escape, NO_KEYS), (Qt.Key.Key_Z, CONTROL)):
        painter.press()
        painter.drag(3)
        bot.keyClick(view, key, modifiers)
        painter.drag(5)
        painter.release()
        np.testing.assert_array_equal(painter.labels, painted)
        assert surveyor.parts.toolbox.name == "paint-brush"
    painter.stroke()
    assert 7 in painter.labels


def test_two_strokes_while_a_tool_stores_its_columns_are_both_kept(painter, surveyor):
    bot, view, document = surveyor.bot, painter.view, surveyor.document

    def run_and_paint():
        job = document.start_run("normals", surveyor.drive.id, _usual("normals"))
        painter.stroke()
        bot.keyClick(view, "5")
        painter.stroke()
        return job

    surveyor.wait_for_job(run_and_paint)
    assert set(painter.labels) >= {0, 5}
    # The columns are a step among the strokes.
    seen = [set(painter.labels) for _ in range(3) if document.undo()]
    assert {0, 2} in seen
    assert seen[-1] == {0}


def _usual(tool: str):
    from processing.tools.listed.registry import TOOLS

    return TOOLS[tool].parameters()


def test_a_lasso_in_3d_labels_every_measured_point_inside_it(painter, surveyor):
    bot, document = surveyor.bot, surveyor.document
    scene = surveyor.parts.scene_view
    bot.waitUntil(lambda: scene.is_settled, timeout=WAIT_MS)
    painter.do("tool-paint-lasso")
    picture = scene.picture
    middle = scene.rect().center()
    # Counter-clockwise about the middle, back to its start.
    corners = [QPoint(-60, -30), QPoint(-60, 40), QPoint(70, 40), QPoint(70, -30), QPoint(-60, -30)]
    spots = [middle + corner for corner in corners]
    QTest.mousePress(picture, LEFT, NO_KEYS, spots[0])
    for spot in spots[1:]:
        # The view looks at where the mouse is as often as it can, not at every event.
        move_mouse(picture, spot, LEFT)
        scene._mouse._on_look_up_timeout()
    projection = scene._hits.projection
    before = document.undo_stack.undo_label
    QTest.mouseRelease(picture, LEFT, NO_KEYS, spots[-1])
    bot.waitUntil(lambda: document.undo_stack.undo_label != before, timeout=WAIT_MS)
    found = 0
    for drive in document.drives():
        local_xyz = drive.local_xyz(slice(0, drive.count), document.origin())
        pixels, _ = projection.to_screen(local_xyz)
        inside = [
            (pixels[:, 0] > spots[0].x() - by)
            & (pixels[:, 0] < spots[2].x() + by)
            & (pixels[:, 1] > spots[0].y() - by)
            & (pixels[:, 1] < spots[1].y() + by)
            for by in (-1, 1)
        ]
        labelled = labels_of(drive, np.arange(drive.count)) > 0
        assert labelled[inside[0]].all()
        assert not labelled[~inside[1]].any()
        found += int(inside[0].sum())
    assert found > sum(one.tile.points.size for one in scene._hits.drawn) / 100
    reported: list[object] = []
    document.reported.connect(reported.append)
    document.refused.connect(reported.append)
    assert document.undo()
    every = [(drive, np.arange(drive.count)) for drive in document.drives()]

    def is_taken_back() -> None:
        assert not any(labels_of(*one).any() for one in every), reported

    bot.waitUntil(is_taken_back, timeout=WAIT_MS)
