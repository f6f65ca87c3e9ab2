"""Which side of a plate is its face: the brighter one, or what its brightness says of one alone."""

from __future__ import annotations

import numpy as np
import pytest

from processing.methods.road.signs.piece_kernels import BRIGHTS, COUNT, PIECE, SHINE, VIEW
from processing.methods.road.signs.plate_sides import PlateSides, sides_of
from processing.methods.road.signs.scan_pieces import ScanPieces

NORTH = np.array([0.0, 1.0, 0.0])
POINTS = 20
METAL, WHITE, FACE = -1.0, 2.0, 9.0
"""Standard deviations above the middle of diffuse things."""


def sides(
    *seen: tuple[float, float], elsewhere: float = FACE, by_another: bool = False
) -> PlateSides:
    """What is told of a plate, by where it was seen from and how bright each view was.

    Parameters
    ----------
    seen : (way, shine)
        1: from its northern side, -1: from the southern one.
    elsewhere : float
        How bright another plate of the same survey is.
    by_another : bool
        Whether another head met that one.
    """
    views = [*seen, (1.0, elsewhere)]
    values = np.zeros((len(views), PIECE))
    for piece, (way, bright) in zip(values, views, strict=True):
        piece[VIEW + 1] = -way
        piece[COUNT], piece[SHINE] = POINTS, POINTS * bright
        piece[BRIGHTS] = POINTS if bright >= 4.5 else 0
    none = np.zeros(len(views), np.int64)
    drive = none.copy()
    drive[-1] = by_another
    pieces = ScanPieces(values, drive, none, np.zeros(len(views)), none > 0)
    return sides_of(pieces, np.arange(len(seen)), NORTH)


def test_a_face_that_hardly_outshines_its_back_is_still_the_face() -> None:
    # As on a scale of decibels: no point of it reaches what is bright elsewhere.
    told = sides((1.0, METAL), (-1.0, WHITE), elsewhere=WHITE)
    assert told.facing[1] == -1
    assert (told.front_seen, told.is_sure) == (True, True)


def test_sides_that_are_equally_bright_say_so() -> None:
    told = sides((1.0, METAL), (-1.0, METAL + 0.1))
    assert told.facing[1] == -1
    assert not told.is_sure


@pytest.mark.parametrize(("shine", "facing"), [(FACE, 1), (3.0, 1), (METAL, -1)])
def test_a_side_that_was_seen_alone_is_a_face_if_it_shines_and_a_back_if_it_is_dull(
    shine: float, facing: float
) -> None:
    told = sides((1.0, shine))
    assert told.facing[1] == facing
    assert (told.front_seen, told.is_sure) == (facing > 0, True)


def test_a_side_as_bright_as_white_paint_may_be_either() -> None:
    assert not sides((1.0, WHITE)).is_sure


def test_a_dull_side_may_be_a_face_where_nothing_of_the_recording_shines() -> None:
    told = sides((1.0, METAL), elsewhere=WHITE)
    assert told.facing[1] == -1
    assert not told.is_sure


def test_without_intensity_nothing_is_told() -> None:
    for seen in ([(1.0, 0.0)], [(1.0, 0.0), (-1.0, 0.0)]):
        assert not sides(*seen, elsewhere=0.0).is_sure


def test_what_a_head_saw_is_told_by_what_shone_to_another_head_of_the_survey() -> None:
    told = sides((1.0, METAL), by_another=True)
    assert told.is_sure
    assert told.shine == METAL


@pytest.mark.parametrize(("shine", "elsewhere", "faint"), [(6.0, 9.0, 2 / 3), (6.0, 6.0, 0.0)])
def test_a_wall_that_shines_a_little_is_faint_beside_faces_and_a_face_among_its_like_is_not(
    shine: float, elsewhere: float, faint: float
) -> None:
    told = sides((1.0, shine), elsewhere=elsewhere)
    assert told.bright == 1.0
    assert told.faint == pytest.approx(faint)


def test_what_is_dull_is_not_faint() -> None:
    assert sides((1.0, WHITE)).faint == 0.0
