"""The image turned and mirrored: the same clicks mean the same points in every lay."""

from __future__ import annotations

import itertools
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PySide6.QtCore import QPoint, QPointF, QRectF, Qt

from processing.core.monitor import SilentMonitor
from processing.image.images_of_drives import image_of
from processing.map.catalogue import Geometry
from processing.project.importing.import_request import ImportRequest
from processing.project.importing.importing import import_drives
from processing.project.project import Project
from processing.recording.kinds import ImageKind
from processing.section.stations import Stations
from tests.builders import simulated_drive, write_laz, write_trajectory_csv
from tests.widgets.builders import path_tool, position_on
from tests.widgets.image_view.conftest import ImageViewUser
from widgets.image_view.minimap import Minimap
from widgets.image_view.orientation.drive_orientation import orientation_of
from widgets.image_view.orientation.oriented_image import Span
from widgets.image_view.orientation.viewport import Viewport
from widgets.image_view.ruler import Ruler
from widgets.mouse_tools.editing.select import Select
from widgets.shared.image_orientation import ImageOrientation

ORIENTATIONS = [ImageOrientation(*choice) for choice in itertools.product((False, True), repeat=3)]
STREET = Viewport(900, 700, (1300.0, 1000.0), stretch=3.0, zoom=0.9, centre=(300.0, 500.0), top=20)

every_orientation = pytest.mark.parametrize("orientation", ORIENTATIONS, ids=str)


def turn(user: ImageViewUser, orientation: ImageOrientation) -> None:
    """Turn the picture about the middle point, sharp again."""
    user.map.shared.view_settings.orient_image(orientation)
    user.view.center_on(position_on(user.drive, user.points_across(3)[1]))


@every_orientation
def test_a_vertex_clicked_has_the_same_coordinate_in_every_orientation(
    user: ImageViewUser, orientation: ImageOrientation
) -> None:
    turn(user, orientation)
    points = user.points_across(3)
    user.take(path_tool(user.map, Geometry.LINE))
    for point in points:
        user.click(user.spot(point), Qt.KeyboardModifier.ControlModifier)
    user.key(Qt.Key.Key_Return)
    (feature,) = user.map.stored.values()
    wanted = [position_on(user.drive, point).xyz for point in points]
    assert [vertex.xyz for vertex in feature.vertices] == wanted


@every_orientation
def test_a_vertex_under_the_mouse_is_hit_in_every_orientation(
    user: ImageViewUser, orientation: ImageOrientation
) -> None:
    points = user.points_across(3)
    feature = user.map.add(Geometry.LINE, user.drive, *points)
    turn(user, orientation)
    user.take(Select(user.map, user.map.shared))
    user.click(user.spot(points[1]))
    assert user.map.shared.selection.features == {feature.id}


@every_orientation
def test_the_street_runs_as_the_orientation_says(
    user: ImageViewUser, orientation: ImageOrientation
) -> None:
    turn(user, orientation)
    image = image_of(user.drive, ImageKind.TRAJECTORY_CENTER)
    first, later = user.points_across(2)
    moved = user.spot(later) - user.spot(first)
    along = -moved.y() if orientation.is_vertical else moved.x()
    assert along * (-1 if orientation.is_reversed_along else 1) > 0
    picture = user.view.picture
    assert picture is not None
    rows, columns = image.pixel_of(np.array([first, later]))
    goes_down = np.diff(picture.positions(rows, columns.astype(np.int64))[:, 1])[0] > 0
    across = moved.x() if orientation.is_vertical else moved.y()
    assert (across > 0) == (goes_down != orientation.is_mirrored_across)


@every_orientation
def test_what_is_painted_turns_with_the_picture(
    user: ImageViewUser, orientation: ImageOrientation
) -> None:
    with user.qtbot.waitSignal(user.view.sharpened, timeout=30_000):
        user.map.shared.view_settings.change_look(attribute="height")
    turn(user, orientation)
    points = user.points_across(5)
    shown = user.view.grab().toImage()
    upright = ImageOrientation()
    seen = [shown.pixelColor(user.spot(point)).name() for point in points]
    turn(user, upright)
    wanted = [user.view.grab().toImage().pixelColor(user.spot(point)).name() for point in points]
    assert seen == wanted


@every_orientation
def test_a_box_holds_the_same_points_in_every_orientation(
    user: ImageViewUser, orientation: ImageOrientation
) -> None:
    points = user.points_across(3)
    user.take(Select(user.map, user.map.shared))
    turn(user, orientation)
    spots = [user.spot(point) for point in points]
    left, right = min(spot.x() for spot in spots), max(spot.x() for spot in spots)
    top, bottom = min(spot.y() for spot in spots), max(spot.y() for spot in spots)
    user.drag(QPoint(left - 1, top - 1), QPoint(right + 1, bottom + 1))
    chosen = user.map.shared.selection.points.get(user.drive.id, np.empty(0, np.int64))
    assert set(points) <= set(chosen.tolist())


@pytest.mark.parametrize(
    "orientation", [ImageOrientation(), ImageOrientation(is_vertical=True)], ids=str
)
def test_ruler_and_minimap_stand_along_the_street(
    user: ImageViewUser, orientation: ImageOrientation
) -> None:
    turn(user, orientation)
    view, viewport = user.view, user.view.viewport
    ruler, minimap = view.findChild(Ruler), view.findChild(Minimap)
    assert isinstance(ruler, Ruler)
    assert isinstance(minimap, Minimap)
    parts = [QRectF(ruler.geometry()), viewport.window, QRectF(minimap.geometry())]
    if orientation.is_vertical:
        assert [part.left() for part in parts] == [0, 20, view.width() - 40]
        assert sum(part.width() for part in parts) == view.width()
    else:
        assert [part.top() for part in parts] == [0, 20, view.height() - 40]
        assert sum(part.height() for part in parts) == view.height()


@every_orientation
def test_a_press_on_the_minimap_goes_there(
    user: ImageViewUser, orientation: ImageOrientation
) -> None:
    turn(user, orientation)
    minimap = user.view.findChild(Minimap)
    assert isinstance(minimap, Minimap)
    share = 0.8  # of the drive; the minimap shows it in the same lay
    share_shown = 1 - share if orientation.is_reversed_along != orientation.is_vertical else share
    spot = (
        QPoint(10, round(share_shown * minimap.height()))
        if orientation.is_vertical
        else QPoint(round(share_shown * minimap.width()), 10)
    )
    user.qtbot.mouseClick(minimap, Qt.MouseButton.LeftButton, pos=spot)
    viewport = user.view.viewport
    assert viewport.centre[0] == pytest.approx(share * viewport.extent[0], rel=0.01)


def test_the_wheel_with_shift_goes_on_along_a_street_that_goes_up(user: ImageViewUser) -> None:
    turn(user, ImageOrientation(is_vertical=True))
    before = user.view.viewport
    user.wheel(QPoint(300, 300), 1, Qt.KeyboardModifier.ShiftModifier)
    after = user.view.viewport
    assert after.centre[0] > before.centre[0]
    assert after.centre[1] == before.centre[1]


def test_a_top_view_keeps_north_up(user: ImageViewUser) -> None:
    settings = user.map.shared.view_settings
    settings.orient_image(ImageOrientation(is_vertical=True, is_mirrored_across=True))
    picture = user.view.picture
    assert picture is not None
    top = replace(picture, rows_go_right=False)
    assert top.turned(settings.image_orientation) == ImageOrientation()


positions = st.tuples(st.floats(-500, 2000), st.floats(-500, 2000))


@given(st.sampled_from(ORIENTATIONS), positions, st.floats(0.1, 20), st.floats(0.2, 6))
def test_picture_to_screen_and_back_is_the_same_place(
    orientation: ImageOrientation, position: tuple[float, float], zoom: float, stretch: float
) -> None:
    viewport = replace(STREET, zoom=zoom, stretch=stretch, left=7.0).laid(orientation)
    x, y = viewport.position_of(*position)
    assert viewport.to_picture(x, y) == pytest.approx(position, abs=1e-6)
    assert viewport.to_screen(np.array([position]))[0] == pytest.approx((x, y), abs=1e-6)
    mapped = viewport.transform().map(QPointF(*position))
    assert (mapped.x(), mapped.y()) == pytest.approx((x, y), abs=1e-6)


@given(st.sampled_from(ORIENTATIONS), st.floats(0.5, 2), st.floats(0, 900), st.floats(20, 720))
def test_zooming_keeps_what_is_under_the_mouse(
    orientation: ImageOrientation, factor: float, x: float, y: float
) -> None:
    viewport = replace(STREET, zoom=2.0).laid(orientation).centred_on(650, 500)
    before = viewport.to_picture(x, y)
    after = viewport.zoomed(factor, x, y).to_picture(x, y)
    inside = all(
        0 < position < size for position, size in zip(before, viewport.extent, strict=True)
    )
    if inside:
        assert after == pytest.approx(before, abs=1e-6)


@given(st.sampled_from(ORIENTATIONS), st.floats(-60, 60), st.floats(-60, 60))
def test_a_pan_moves_the_picture_with_the_mouse(
    orientation: ImageOrientation, right: float, down: float
) -> None:
    viewport = STREET.laid(orientation).centred_on(650, 500)
    x, y = viewport.position_of(600, 480)
    moved = viewport.panned(right, down).position_of(600, 480)
    assert moved == pytest.approx((x + right, y + down), abs=1e-6)


@every_orientation
def test_what_is_seen_is_what_lies_in_the_window(orientation: ImageOrientation) -> None:
    viewport = STREET.laid(orientation)
    window = viewport.window
    seen = viewport.span_of(window.left(), window.top(), window.right(), window.bottom())
    span = viewport.span
    wanted = (span.left, span.top, span.right, span.bottom)
    assert (seen.left, seen.top, seen.right, seen.bottom) == pytest.approx(wanted)
    around = viewport.rectangle_of(Span(span.left, span.top, span.right, span.bottom))
    assert around.toRect() == window.toRect()


@every_orientation
def test_everything_and_the_start_fit_the_window(orientation: ImageOrientation) -> None:
    viewport = STREET.laid(orientation)
    whole = viewport.with_everything(3.0)
    rectangle = whole.rectangle_of(Span(0, 0, *whole.extent))
    assert whole.window.contains(rectangle)
    start = viewport.with_start()
    assert start.span.left == pytest.approx(0)
    assert start.zoom_v * 1000 == pytest.approx(start.across_px)


def test_the_rulers_station_is_the_distance_along_the_vehicles_path(tmp_path: Path) -> None:
    simulated = simulated_drive(length_m=4.0)
    points = write_laz(simulated, tmp_path / "left.laz")
    request = ImportRequest((points,), (write_trajectory_csv(simulated, tmp_path / "way.csv"),))
    with closing(Project.create(tmp_path / "p.zuka", "")) as project:
        found = import_drives(request, project.temporary_folder(), SilentMonitor())
        (drive,) = project.adopt_drives(found)
        assert drive.trajectory is not None
        image = image_of(drive, ImageKind.TRAJECTORY_CENTER)
        orientation = orientation_of(drive, image)
        stations = Stations.of_trajectory(drive.trajectory)
        rows = np.linspace(0, image.rows - 1, 7).astype(np.int64)
        times = image.row_times[rows].tolist()
        expected = [stations.station_at_time(time) or 0.0 for time in times]
        measured = orientation.station_m(rows.astype(np.float64))
        np.testing.assert_allclose(measured, np.array(expected), atol=0.05)
        assert expected[0] > 0.1  # the path begins before the points
        np.testing.assert_allclose(orientation.rows_at_stations(measured), rows, atol=0.5)
