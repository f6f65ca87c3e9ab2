"""Paint tools alone: hits in, changes of labels out."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from processing.core.text import Text
from processing.image.images_of_drives import image_of
from processing.labels.label_column import labels_of, make_column, write_labels
from processing.labels.rules import PaintOver
from processing.labels.strokes import points_under_brush
from processing.map.change import Change
from processing.recording.drive import Drive
from processing.section.cut import Cut
from tests.widgets.builders import OpenMap, do_now, imported_drive, position_on
from widgets.mouse_tools.mouse_tool import DragShape, EnclosedHits, Hit
from widgets.mouse_tools.painting.paint_brush import PaintBrush
from widgets.mouse_tools.painting.paint_outline import PaintOutline
from widgets.mouse_tools.painting.paint_segments import IN_NO_SEGMENT, NO_SEGMENTS, PaintSegments
from widgets.mouse_tools.painting.paint_tool import NOTHING_THERE, PaintTool
from widgets.section_view.picture.projection import SectionProjection

NOWHERE = Hit(None)


class Later:
    """Work in the background that is done when the test says so."""

    def __init__(self) -> None:
        self.waiting: list[tuple[Callable[[], object], Callable[[object | None], None]]] = []

    def __call__(self, work: Callable[[], object], take: Callable[[object | None], None]) -> None:
        self.waiting.append((work, take))

    def do_all(self) -> None:
        while self.waiting:
            work, take = self.waiting.pop(0)
            take(work())


class Easel:
    """A drive on a map, and what paint tools do to it."""

    def __init__(self, drive: Drive) -> None:
        self.drive = drive
        self.map = OpenMap((drive,))
        self.changes: list[tuple[Text, Change]] = []
        self.reported: list[Text] = []

    @property
    def palette(self):
        return self.map.shared.labels

    @property
    def labels(self) -> np.ndarray:
        return labels_of(self.drive, np.arange(self.drive.count))

    @property
    def chosen(self) -> np.ndarray:
        return self.map.shared.selection.points.get(self.drive.id, np.empty(0, np.int64))

    def use(self, tool: PaintTool) -> PaintTool:
        tool.change_requested.connect(self.apply)
        tool.reported.connect(self.reported.append)
        return tool

    def apply(self, label: Text, change: Change) -> None:
        self.changes.append((label, change))
        for one in change.labels:
            drive = self.map.drive(one.drive)
            make_column(drive)
            assert (labels_of(drive, one.unpacked_points()) == one.codes_before()).all()
            write_labels(drive, one.unpacked_points(), one.codes_after())
            self.map.shared.map_changes.labels_changed.emit(drive.id, one.unpacked_points())

    def hit(self, point: int) -> Hit:
        return Hit(position_on(self.drive, point))

    def brush(self, point: int) -> np.ndarray:
        position = np.array(position_on(self.drive, point).xyz)
        return points_under_brush(self.drive, position, position, self.palette.radius_m)


@pytest.fixture
def easel(qapp, tmp_path) -> Easel:
    return Easel(imported_drive(tmp_path / "street"))


def brush(easel: Easel) -> PaintTool:
    return easel.use(PaintBrush(easel.map, easel.map.shared, do_now))


def test_a_click_of_the_brush_labels_the_points_about_it(easel):
    tool = brush(easel)
    easel.palette.choose(11)
    tool.press(easel.hit(5000))
    assert tool.is_busy
    assert easel.changes == []
    np.testing.assert_array_equal(easel.chosen, easel.brush(5000))
    tool.release(easel.hit(5000))
    assert not tool.is_busy
    assert easel.chosen.size == 0
    np.testing.assert_array_equal(np.flatnonzero(easel.labels), easel.brush(5000))
    assert set(easel.labels) == {0, 11}
    ((label, _),) = easel.changes
    assert label.en == "Label points: Road surface"
    assert label.ja == "点のラベル: 路面"


def test_a_drag_labels_what_lies_between_its_places_too(easel):
    tool = brush(easel)
    drive = easel.drive
    first = 5000
    xyz = drive.xyz(slice(0, drive.count))
    # A point on the same ground less than a metre farther.
    away = np.linalg.norm(xyz - xyz[first], axis=1)
    last = int(np.argmin(np.abs(away - 0.9) + 10 * np.abs(xyz[:, 2] - xyz[first, 2])))
    tool.press(easel.hit(first))
    tool.move(easel.hit(last))
    tool.release(easel.hit(last))
    wanted = points_under_brush(drive, xyz[first], xyz[last], easel.palette.radius_m)
    np.testing.assert_array_equal(np.flatnonzero(easel.labels), wanted)
    assert len(easel.changes) == 1


def test_what_was_chosen_before_a_stroke_is_chosen_after_it(easel):
    tool = brush(easel)
    mine = np.array([3, 4, 5])
    easel.map.shared.selection.choose_points({easel.drive.id: mine})
    tool.press(easel.hit(5000))
    tool.release(easel.hit(5000))
    np.testing.assert_array_equal(easel.chosen, mine)


@pytest.mark.parametrize("end", ["leave", "step_back", "settle", "forget"])
def test_escape_undo_or_another_tool_in_the_middle_of_a_stroke_drop_it(easel, end):
    tool = brush(easel)
    tool.press(easel.hit(5000))
    tool.move(easel.hit(5003))
    getattr(tool, end)()
    assert not tool.is_busy
    assert easel.chosen.size == 0
    tool.move(easel.hit(5006))
    tool.release(easel.hit(5006))
    assert easel.changes == []
    tool.press(easel.hit(5000))
    tool.release(easel.hit(5000))
    assert len(easel.changes) == 1


def test_escape_without_a_stroke_gives_the_hand_back(easel, qtbot):
    tool = brush(easel)
    with qtbot.waitSignal(tool.finished, timeout=30_000):
        tool.leave()


def test_a_stroke_that_begins_over_nothing_paints_nothing(easel):
    tool = brush(easel)
    tool.press(NOWHERE)
    tool.move(easel.hit(100))
    tool.release(easel.hit(100))
    assert easel.changes == []


def test_only_points_without_a_label_or_of_one_class_are_painted(easel):
    tool = brush(easel)
    easel.palette.choose(11)
    tool.press(easel.hit(5000))
    tool.release(easel.hit(5000))
    road = easel.labels.copy()
    easel.palette.choose(67)
    easel.palette.set_radius(0.6)
    easel.palette.paint_over(PaintOver.UNLABELLED)
    tool.press(easel.hit(5000))
    tool.release(easel.hit(5000))
    assert (easel.labels[road == 11] == 11).all()
    assert (easel.labels == 67).any()
    curb = np.flatnonzero(easel.labels == 67)
    easel.palette.choose(0)
    easel.palette.paint_over(PaintOver.ONE_CLASS, 11)
    tool.press(easel.hit(5000))
    tool.release(easel.hit(5000))
    np.testing.assert_array_equal(np.flatnonzero(easel.labels), curb)
    tool.press(easel.hit(5000))
    tool.release(easel.hit(5000))
    assert easel.reported[-1] == NOTHING_THERE
    assert len(easel.changes) == 3


def test_the_labels_are_shown_while_painting_over_grey_points(easel):
    settings = easel.map.shared.view_settings
    tool = brush(easel)
    tool.press(easel.hit(5000))
    assert settings.look.attribute == "label"
    tool.leave()
    settings.change_look(attribute="height")
    tool.press(easel.hit(5000))
    assert settings.look.attribute == "height"
    tool.leave()


def test_an_outline_labels_all_points_inside_drawn_or_not(easel):
    tool = easel.use(PaintOutline(easel.map, easel.map.shared, do_now, DragShape.LASSO))
    assert tool.drag_shape(NOWHERE) is DragShape.LASSO
    name, every = easel.drive.id, np.arange(100, 200)
    tool.choose_box(EnclosedHits(frozenset(), {name: every[::7]}, find_every=lambda: {name: every}))
    np.testing.assert_array_equal(np.flatnonzero(easel.labels), every)
    # A view may give points in any order; drives that are gone are passed over.
    unordered = np.array([900, 300, 900, 301])
    tool.choose_box(EnclosedHits(frozenset(), {name: unordered, "gone": every}))
    assert np.flatnonzero(easel.labels)[-3:].tolist() == [300, 301, 900]
    assert not tool.is_busy


def test_a_long_stroke_is_made_anew_where_an_undo_came_between(easel):
    later = Later()
    tool = easel.use(PaintOutline(easel.map, easel.map.shared, later, DragShape.BOX))
    name = easel.drive.id
    easel.palette.choose(6)
    make_column(easel.drive)
    tool.choose_box(EnclosedHits(frozenset(), {}, find_every=lambda: {name: np.arange(50)}))
    work, take = later.waiting.pop()
    result = work()
    undone = np.arange(10, 20)
    write_labels(easel.drive, undone, np.full(10, 2, np.uint8))
    easel.map.shared.map_changes.labels_changed.emit(name, undone)
    take(result)
    assert tool.is_busy
    later.do_all()
    assert not tool.is_busy
    assert (easel.labels[:50] == 6).all()
    ((_, change),) = easel.changes
    assert change.labels[0].codes_before()[10:20].tolist() == [2] * 10


def test_two_long_strokes_quickly_are_both_done_and_escape_drops_the_last(easel):
    later = Later()
    tool = easel.use(PaintOutline(easel.map, easel.map.shared, later, DragShape.BOX))
    name = easel.drive.id
    for first in (0, 30, 70):
        points = np.arange(first, first + 40)
        easel.palette.choose(2 + first)
        tool.choose_box(
            EnclosedHits(frozenset(), {}, find_every=lambda points=points: {name: points})
        )
    tool.leave()
    later.do_all()
    assert (easel.labels[:30] == 2).all()
    assert (easel.labels[30:70] == 32).all()
    assert not easel.labels[70:].any()
    assert not tool.is_busy


def test_work_that_failed_leaves_the_hand_free(easel):
    later = Later()
    tool = easel.use(PaintOutline(easel.map, easel.map.shared, later, DragShape.BOX))
    tool.choose_box(EnclosedHits(frozenset(), {}, find_every=dict))
    _, take = later.waiting.pop()
    take(None)
    assert not tool.is_busy
    assert easel.changes == []


def segmented(easel: Easel) -> np.ndarray:
    segments = (np.arange(easel.drive.count, dtype=np.int32) // 40) % 50 - 1
    easel.drive.columns.add("segment", segments)
    return segments


def test_without_segments_one_sentence_says_what_to_do(easel):
    tool = easel.use(PaintSegments(easel.map, easel.map.shared, do_now))
    tool.press(easel.hit(50))
    tool.release(easel.hit(50))
    assert easel.reported == [NO_SEGMENTS]
    assert not tool.is_busy


def test_a_click_labels_the_whole_segment_and_nothing_else(easel):
    segments = segmented(easel)
    tool = easel.use(PaintSegments(easel.map, easel.map.shared, do_now))
    easel.palette.choose(6)
    tool.press(easel.hit(85))
    np.testing.assert_array_equal(easel.chosen, np.flatnonzero(segments == 1))
    tool.release(easel.hit(85))
    np.testing.assert_array_equal(np.flatnonzero(easel.labels), np.flatnonzero(segments == 1))
    tool.press(easel.hit(5))
    tool.release(easel.hit(5))
    assert IN_NO_SEGMENT in easel.reported
    assert len(easel.changes) == 1


def test_a_drag_floods_every_segment_that_it_goes_over_in_one_step(easel):
    segments = segmented(easel)
    tool = easel.use(PaintSegments(easel.map, easel.map.shared, do_now))
    easel.palette.choose(6)
    tool.press(easel.hit(85))
    for point in (125, 165, 205):
        tool.move(easel.hit(point))
    tool.release(easel.hit(205))
    assert len(easel.changes) == 1
    painted = set(segments[np.flatnonzero(easel.labels)].tolist())
    assert {1, 2, 3, 4} <= painted
    for segment in painted:
        assert (easel.labels[segments == segment] == 6).all()


def test_escape_in_a_flood_drops_it_though_work_is_under_way(easel):
    segmented(easel)
    later = Later()
    tool = easel.use(PaintSegments(easel.map, easel.map.shared, later))
    tool.press(easel.hit(85))
    tool.move(easel.hit(125))
    tool.leave()
    later.do_all()
    assert easel.changes == []
    assert easel.chosen.size == 0


def test_noise_that_is_hidden_is_not_painted(easel):
    tool = brush(easel)
    make_column(easel.drive)
    under = easel.brush(5000)
    write_labels(easel.drive, under[:5], np.full(5, 7, np.uint8))
    easel.map.shared.view_settings.change_look(hides_noise=True)
    tool.press(easel.hit(5000))
    tool.release(easel.hit(5000))
    assert (easel.labels[under[:5]] == 7).all()
    assert (easel.labels[under[5:]] == easel.palette.rule.code).all()
    easel.map.shared.view_settings.change_look(hides_noise=False)
    tool.press(easel.hit(5000))
    tool.release(easel.hit(5000))
    assert (easel.labels[under] == easel.palette.rule.code).all()


def test_only_one_class_is_painted_over_by_what_counts_of_each_point(easel):
    tool = brush(easel)
    under = easel.brush(5000)
    delivered = np.zeros(easel.drive.count, np.uint8)
    delivered[under[:6]] = 18
    easel.drive.columns.add("classification", delivered)
    make_column(easel.drive)
    write_labels(easel.drive, under[:2], np.full(2, 6, np.uint8))
    easel.palette.choose(1)
    easel.palette.paint_over(PaintOver.ONE_CLASS, 18)
    tool.press(easel.hit(5000))
    tool.release(easel.hit(5000))
    np.testing.assert_array_equal(easel.labels[under[:6]], [6, 6, 1, 1, 1, 1])
    assert not easel.labels[under[6:]].any()


def test_in_a_section_the_brush_is_a_circle_through_the_slab_of_every_drive(easel, tmp_path):
    other = imported_drive(tmp_path / "other", head="right", seed=2)
    easel.map.all_drives = (easel.drive, other)
    tool = brush(easel)
    easel.palette.set_radius(0.5)
    xyz = easel.drive.xyz(np.array([5000]))[0]
    cut = Cut(tuple(xyz.tolist()), (1.0, 0.0), width_m=0.6)
    projection = SectionProjection(cut)
    for drive in easel.map.drives():
        image_of(drive, drive.image_kinds[-1]).pyramid.prepare()

    def hit(offset: float) -> Hit:
        return Hit(None, ray=projection.ray((offset, 0.0)))

    tool.press(hit(-1.0))
    tool.move(hit(1.0))
    tool.release(hit(1.0))
    ((_, change),) = easel.changes
    painted = {one.drive: one.unpacked_points() for one in change.labels}
    for drive in easel.map.drives():
        section = cut.to_section(drive.xyz(slice(0, drive.count)))
        aside = np.maximum(np.abs(section[:, 0]) - 1.0, 0.0)
        inside = np.hypot(aside, section[:, 1] - xyz[2]) <= 0.5
        inside &= np.abs(section[:, 2]) <= 0.3
        assert inside.any()
        np.testing.assert_array_equal(painted[drive.id], np.flatnonzero(inside))
