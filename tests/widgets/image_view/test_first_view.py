"""What one sees of a cloud without a way when it comes: all of it, and it stays."""

import numpy as np
import pytest

from processing.core.monitor import SilentMonitor
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from widgets.image_view.orientation.navigation import viewport_on
from widgets.image_view.orientation.oriented_image import OrientedImage
from widgets.image_view.orientation.viewport import Viewport


@pytest.fixture
def strip(tmp_path) -> OrientedImage:
    """Three points of a wide and low cloud; most rows of its picture are empty."""
    path = tmp_path / "strip.xyz"
    path.write_text("0 0 0\n50 30 1\n400 0 2\n")
    (folder,) = import_drives(ImportRequest((path,)), tmp_path / "made", SilentMonitor())
    return OrientedImage.of(Drive(folder), ImageKind.TOP_VIEW)


def test_all_of_a_view_from_above_is_shown_at_first(strip):
    viewport = viewport_on(strip, None, Viewport(300, 200, (1.0, 1.0), centre=(0.5, 0.5)))
    pixels = strip.image.pixel_of(np.arange(3))
    for u, v in strip.positions(*pixels).tolist():
        assert viewport.shows(u, v, 0.0)


def test_a_picture_that_is_shown_again_stays_where_it_is(strip):
    first = viewport_on(strip, None, Viewport(300, 200, (1.0, 1.0), centre=(0.5, 0.5)))
    near = first.zoomed(3.0, 100.0, 100.0)
    again = OrientedImage.of(strip.drive, ImageKind.TOP_VIEW)
    assert viewport_on(again, strip, near) == near
