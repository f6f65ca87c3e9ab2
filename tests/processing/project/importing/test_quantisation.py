"""Integers of several files come to one lattice only where no coordinate changes."""

import numpy as np

from processing.project.importing.quantisation import shift_between
from processing.recording.columns.quantisation import Quantisation

MILLIMETRES = Quantisation((0.001,) * 3, (1000.0, 2000.0, 0.0))


def test_another_offset_is_a_shift_that_keeps_every_coordinate():
    source = Quantisation((0.001,) * 3, (-11500.5, -35000.25, 100.0))
    move = shift_between(source, MILLIMETRES)
    integers = np.array([[1, 2, 3], [-7, 1_000_000, 5]], dtype=np.int32)
    moved = move.applied(integers)
    before = integers * 0.001 + np.array(source.offset)
    after = moved * 0.001 + np.array(MILLIMETRES.offset)
    assert np.abs(before - after).max() < 1e-9


def test_a_coarser_file_fits_a_finer_lattice_but_not_the_reverse():
    coarse = Quantisation((0.01,) * 3, (0.0, 0.0, 0.0))
    assert shift_between(coarse, MILLIMETRES) is not None
    assert shift_between(MILLIMETRES, coarse) is None


def test_an_offset_between_two_lattice_points_is_refused():
    assert shift_between(Quantisation((0.001,) * 3, (0.0004, 0.0, 0.0)), MILLIMETRES) is None


def test_what_leaves_32_bits_is_refused():
    far = Quantisation((0.001,) * 3, (9_000_000.0, 0.0, 0.0))
    move = shift_between(far, MILLIMETRES)
    assert move.applied(np.zeros((1, 3), dtype=np.int32)) is None
