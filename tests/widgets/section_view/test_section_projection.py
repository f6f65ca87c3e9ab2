"""How space lies on a section: upside up, left on the left, cut off at the slab's faces."""

from __future__ import annotations

import numpy as np
import pytest

from processing.section.cut import Cut
from widgets.section_view.picture.feed import distance_colours
from widgets.section_view.picture.projection import SectionProjection
from widgets.shared.snap_state import WorkingPlane

PROJECTION = SectionProjection(Cut((10.0, 20.0, 100.0), (1.0, 0.0), 1.0, 15.0))
"""Across a line that leads north."""


def test_what_is_higher_is_further_up_and_what_is_outside_the_slab_nowhere() -> None:
    positions = PROJECTION.to_plane(np.array([[8.0, 20.4, 101.5], [8.0, 20.6, 101.5]]))
    assert positions[0] == pytest.approx([-2.0, -1.5])
    assert np.isnan(positions[1]).all()
    assert PROJECTION.is_near(np.array([[8.0, 20.4, 101.5], [8.0, 20.6, 101.5]])).tolist() == [
        True,
        False,
    ]
    assert PROJECTION.height_of(-1.5) == pytest.approx(101.5)


def test_a_line_is_shown_between_the_faces_of_the_slab() -> None:
    xyz = np.array([[12.0, 18.0, 100.0], [12.0, 22.0, 104.0], [12.0, 30.0, 104.0]])
    through, beyond = PROJECTION.lines_on_plane(xyz, np.array([[0, 1], [1, 2]]))
    assert through == pytest.approx(np.array([[2.0, -1.5], [2.0, -2.5]]))
    assert beyond.shape == (0, 2)


def test_a_line_in_the_plane_of_the_section_is_shown_whole() -> None:
    xyz = np.array([[12.0, 20.0, 100.0], [14.0, 20.0, 101.0], [14.0, 21.0, 1.0], [9.0, 21.0, 1.0]])
    level, outside = PROJECTION.lines_on_plane(xyz, np.array([[0, 1], [2, 3]]))
    assert level == pytest.approx(np.array([[2.0, 0.0], [4.0, -1.0]]))
    assert outside.shape == (0, 2)


def test_the_line_of_sight_goes_square_through_the_slab() -> None:
    ray = PROJECTION.ray((-2.0, -1.5))
    assert ray is not None
    assert ray.origin == pytest.approx((8.0, 19.5, 101.5))
    assert ray.direction == pytest.approx((0.0, 1.0, 0.0))
    upright = WorkingPlane((8.0, 20.2, 0.0), (0.0, 1.0, 0.0))
    assert upright.meets(ray.origin, ray.direction) == pytest.approx((8.0, 20.2, 101.5))


def test_colours_tell_before_from_behind_the_plane() -> None:
    behind, in_plane, before = distance_colours(np.array([0.5, 0.0, -0.5]), 0.5).tolist()
    assert behind == [0, 114, 178]
    assert in_plane == [240, 240, 240]
    assert before == [230, 159, 0]
