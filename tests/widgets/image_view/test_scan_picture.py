"""A standing scanner's image is laid before the eye as the scanner saw its surroundings."""

import numpy as np
import pytest

from processing.core.monitor import SilentMonitor
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from tests.structured_scans import SphereScan, ptx_text, sphere_scan
from widgets.image_view.orientation.locked_scrolling import position_along
from widgets.image_view.orientation.oriented_image import OrientedImage
from widgets.shared.image_orientation import ImageOrientation


def _picture(tmp_path, scan: SphereScan) -> OrientedImage:
    path = tmp_path / "room.ptx"
    path.write_text(ptx_text(scan))
    (folder,) = import_drives(ImportRequest((path,)), tmp_path / "made", SilentMonitor())
    return OrientedImage.of(Drive(folder), ImageKind.SCAN)


def _turned_over(scan: SphereScan, axis: int) -> SphereScan:
    cells = scan.cells.copy()
    cells[:, axis] = scan.shape[axis] - 1 - cells[:, axis]
    return SphereScan(scan.position, scan.centre, cells, scan.xyz, scan.shape)


@pytest.mark.parametrize("is_upside_down", [False, True])
@pytest.mark.parametrize("is_anticlockwise", [False, True])
def test_the_sky_is_up_and_right_is_right(tmp_path, is_upside_down, is_anticlockwise):
    scan = sphere_scan()
    scan = _turned_over(scan, 1) if is_upside_down else scan
    scan = _turned_over(scan, 0) if is_anticlockwise else scan
    picture = _picture(tmp_path, scan)
    orientation = picture.turned(ImageOrientation(is_vertical=True, is_mirrored_across=True))
    assert orientation == ImageOrientation(is_reversed_along=is_anticlockwise)
    points = np.arange(picture.drive.count)
    positions = picture.positions(*picture.image.pixel_of(points))
    beams = picture.drive.xyz(points) - scan.position
    assert np.corrcoef(positions[:, 1], beams[:, 2])[0, 1] < -0.9
    right = -positions[:, 0] if orientation.is_reversed_along else positions[:, 0]
    clockwise = -np.unwrap(np.arctan2(beams[:, 1], beams[:, 0])[np.argsort(right, kind="stable")])
    assert np.polyfit(np.sort(right), clockwise, 1)[0] > 0


def test_a_pixel_is_as_wide_as_it_is_in_the_room(tmp_path):
    picture = _picture(tmp_path, sphere_scan(60, 40))
    # 6 degrees from sweep to sweep, 3.08 degrees from place to place.
    assert picture.stretch == pytest.approx(6.0 / 3.08, rel=0.35)


def test_another_picture_of_the_room_goes_to_the_same_place(tmp_path):
    picture = _picture(tmp_path, sphere_scan())
    position = position_along(picture, (30.5, 20.5), picture)
    assert position is not None
    assert abs(position[0] - 30.5) <= 1
    assert position[1] is not None
    assert abs(position[1] - 20.5) <= 1
