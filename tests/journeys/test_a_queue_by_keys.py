"""Fifty candidates judged by keys alone, each in the middle of every view."""

from __future__ import annotations

from contextlib import closing
from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtCore import QPointF, Qt
from PySide6.QtWidgets import QApplication

from app.review.review import Review
from app.window.window_parts import WindowParts
from processing.laboratory.bench.street_candidates import street_candidates
from processing.map.feature import Feature, Position, Status
from processing.map.feature_middle import middle_of
from processing.project.project import Project
from processing.tools.tool import CandidateResult
from tests.processing.project.candidates import found
from widgets.shared.cursor import PickedPosition

COUNT = 50
WITHIN_M = 0.10
WAIT_MS = 30_000
NEAR_PX = 200.0
KEYS = {"accept": Qt.Key.Key_Return, "reject": Qt.Key.Key_Delete, "next": Qt.Key.Key_N}


@pytest.fixture
def desk(surveyor, tmp_path, qtbot):
    """Give a window on the sample street that is arranged for checking."""
    surveyor.open_sample_street(tmp_path / "street.zuka")
    parts = surveyor.parts
    with qtbot.waitActive(parts.window):
        parts.window.activateWindow()
    parts.window.actions_by_id["layout-checking"].trigger()
    qtbot.waitUntil(lambda: parts.scene_view.is_settled, timeout=WAIT_MS)
    return surveyor


def test_a_queue_of_fifty_is_judged_by_keys_alone(desk, qtbot):
    parts, review = desk.parts, desk.parts.of(Review)
    assert parts.document.store_run(
        found(street_candidates(desk.drive, COUNT), drive=desk.drive.id)
    )
    parts.image_view.setFocus()
    parts.window.actions_by_id["review-start"].trigger()
    assert review.progress.left == COUNT
    confidences, wanted, keys, seen_by_camera = [], {}, 0, 0
    while review.current is not None:
        feature = review.current
        confidences.append(feature.provenance.confidence)
        seen_by_camera += assert_centred(parts, qtbot, feature)
        is_true = feature.provenance.confidence > 0.5
        wanted[feature.id] = Status.ACCEPTED if is_true else Status.REJECTED
        qtbot.keyClick(parts.image_view, KEYS["accept" if is_true else "reject"])
        keys += 1
    assert keys == COUNT
    assert confidences == sorted(confidences)
    assert seen_by_camera >= COUNT / 2
    decided = {id_: parts.document.feature(id_).status for id_ in wanted}
    assert decided == wanted
    assert review.progress.left == 0
    for _ in range(COUNT):
        parts.window.actions_by_id["undo"].trigger()
    assert {one.status for one in parts.document.features()} == {Status.CANDIDATE}
    assert review.progress.left == COUNT


def test_who_starts_a_review_from_a_form_judges_by_the_next_key(desk, qtbot):
    parts, review = desk.parts, desk.parts.of(Review)
    assert parts.document.store_run(found(street_candidates(desk.drive, 6), drive=desk.drive.id))
    parts.layers_panel.setFocus()
    parts.window.actions_by_id["review-start"].trigger()
    first = review.current
    qtbot.keyClick(QApplication.focusWidget(), Qt.Key.Key_Return)
    assert parts.document.feature(first.id).status is Status.ACCEPTED
    qtbot.keyClick(QApplication.focusWidget(), Qt.Key.Key_Delete)
    assert (review.progress.accepted, review.progress.rejected) == (1, 1)


def test_a_review_that_was_left_goes_on_by_the_next_key_when_its_project_is_opened(desk, qtbot):
    parts, review = desk.parts, desk.parts.of(Review)
    assert parts.document.store_run(found(street_candidates(desk.drive, 6), drive=desk.drive.id))
    parts.window.actions_by_id["review-start"].trigger()
    folder = parts.document.project.folder
    parts.layers_panel.setFocus()
    parts.document.close()
    assert parts.document.open(folder)
    assert parts.image_view.hasFocus()
    first = review.current
    qtbot.keyClick(QApplication.focusWidget(), Qt.Key.Key_Return)
    assert parts.document.feature(first.id).status is Status.ACCEPTED


def test_a_review_that_was_left_takes_up_what_came_in_place_of_its_candidates(desk):
    parts, review = desk.parts, desk.parts.of(Review)
    start = parts.window.actions_by_id["review-start"].trigger
    drive = desk.drive.id
    first = found(street_candidates(desk.drive, 6), drive=drive)
    came = found(street_candidates(desk.drive, 8), drive=drive)
    assert parts.document.store_run(first)
    start()
    folder = parts.document.project.folder
    parts.document.close()
    with closing(Project.open(folder)) as project:  # as a command line does it
        gone = tuple(one for one in project.features.all() if one.provenance.run == first.run.id)
        change = replace(came.change, removed=gone)
        project.features.apply(came.run.summary, change, run=came.run)
    assert parts.document.open(folder)
    assert review.progress.left == 0
    start()
    assert review.progress.left == 8


def test_keys_type_in_forms_and_draw_while_something_is_drawn(desk, qtbot):
    parts, review = desk.parts, desk.parts.of(Review)
    made = found(street_candidates(desk.drive, 6), drive=desk.drive.id)
    assert parts.document.store_run(made)
    parts.window.actions_by_id["review-start"].trigger()
    first = review.current
    parts.layers_panel.setFocus()
    parts.drawing_bar.setFocus()
    parts.toolbox.choose_kind(parts.document.catalogue()["curb_lower"])
    position = desk.position_of(int(made.change.added[0].vertices[0].measured.point))
    for shift in (0, 900):
        desk.click(desk.position_of(position.measured.point + shift).measured.point)
    assert parts.toolbox.current_tool.is_busy
    desk.key(Qt.Key.Key_Return)
    assert review.current == first
    assert len(list(parts.document.features())) == 7


def test_the_section_holds_trees_from_foot_to_top_and_comes_near_to_lines(desk):
    parts, review = desk.parts, desk.parts.of(Review)
    pane = parts.section_view.panes[0]
    seen = street_candidates(desk.drive, 24).candidates
    high_m = iter([9.0, 3.0, 14.0] * 8)
    candidates = [
        replace(one, attributes={"height_m": next(high_m)}) if one.geometry == "point" else one
        for one in seen
    ]
    result = CandidateResult(tuple(candidates))
    assert parts.document.store_run(found(result, drive=desk.drive.id))
    parts.window.actions_by_id["review-start"].trigger()
    while review.current is not None:
        height_m = review.current.attributes.get("height_m")
        if height_m is None:
            assert pane.viewport.scale >= NEAR_PX
        else:
            assert pane.height() / pane.viewport.scale_y >= 2 * height_m
        parts.window.actions_by_id["review-accept"].trigger()


def test_between_trees_the_section_keeps_the_zoom_that_was_chosen(desk):
    parts, review = desk.parts, desk.parts.of(Review)
    pane = parts.section_view.panes[0]
    seen = street_candidates(desk.drive, 12).candidates
    trees = [replace(one, attributes={"height_m": 5.0}) for one in seen if one.geometry == "point"]
    result = CandidateResult(tuple(trees))
    assert parts.document.store_run(found(result, drive=desk.drive.id))
    parts.window.actions_by_id["review-start"].trigger()
    pane.zoom_by(3.0)
    chosen = pane.viewport.scale
    for _ in trees[1:]:
        parts.window.actions_by_id["review-next"].trigger()
        assert review.current is not None
        assert pane.viewport.scale == chosen


def test_wires_are_seen_along_and_what_stands_below_them_across_the_street(desk):
    parts, review = desk.parts, desk.parts.of(Review)
    section = parts.section_view
    one = next(one for one in street_candidates(desk.drive, 24).candidates if len(one.xyz) == 1)
    high = one.xyz[0] + [0.0, 0.0, 1.0]
    along = np.array([[-3.0, 0.0, 0.2], [0.0, 0.0, 0.0], [3.0, 0.0, 0.2]])
    unknown = np.full(3, -1, np.int64)
    wire = replace(
        one, geometry="line", kind="wire", xyz=high + along, points=unknown, confidence=0.2
    )
    wire = replace(wire, attributes={"sag_m": 0.2}, drives=None)
    sign = replace(one, confidence=0.7, attributes={"height_m": 2.0})
    result = CandidateResult((wire, sign))
    assert parts.document.store_run(found(result, drive=desk.drive.id))
    parts.window.actions_by_id["review-start"].trigger()
    assert review.current.kind == "wire"
    assert section.settings.is_along
    assert section.standing.line.feature == review.current.id
    (pane,) = section.panes
    assert pane.width() / pane.viewport.scale == pytest.approx(1.2 * 6.0, rel=0.05)
    parts.window.actions_by_id["review-next"].trigger()
    assert not section.settings.is_along
    assert section.standing.line.drive == desk.drive.id


def assert_centred(parts: WindowParts, qtbot, feature: Feature) -> bool:
    """Every view has the candidate in its middle; says whether a camera image shows it."""
    middle = middle_of(feature)
    position = PickedPosition(middle.xyz, middle.measured, middle.is_occluded)
    for view, centre in centres(parts):
        at = view.position_of(position)
        assert at is not None
        away_px = np.hypot(at.x() - centre.x(), at.y() - centre.y())
        assert away_px <= max(1.0, pixels_of(view, position, WITHIN_M))
    assert parts.section_view.cut is not None
    _, _, aside = parts.section_view.cut.to_section(np.array([position.xyz]))[0]
    assert abs(aside) <= WITHIN_M
    camera = parts.camera_view
    if camera.projection() is None:
        return False
    at = camera.position_of(position)
    centre = QPointF(camera.width() / 2, camera.height() / 2)
    return at is not None and np.hypot(at.x() - centre.x(), at.y() - centre.y()) <= 1.0


def centres(parts: WindowParts):
    """The views that always show a place, and the middle of each picture."""
    image = parts.image_view
    viewport = image.viewport
    yield image, QPointF(viewport.width / 2, viewport.top + viewport.height / 2)
    for view in (parts.scene_view, parts.map_view):
        yield view, QPointF(view.width() / 2, view.height() / 2)


def pixels_of(view, position: PickedPosition, metres: float) -> float:
    """How many pixels a length is at a place, in the direction in which it is longest."""
    at, spots = view.position_of(position), []
    for axis in range(3):
        moved: Position = tuple(
            value + (metres if number == axis else 0.0) for number, value in enumerate(position.xyz)
        )
        spot = view.position_of(PickedPosition(moved))
        if spot is not None:
            spots.append(np.hypot(spot.x() - at.x(), spot.y() - at.y()))
    return float(max(spots, default=0.0))
