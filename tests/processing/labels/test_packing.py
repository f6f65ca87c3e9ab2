"""Packed points and codes: exactly what was packed, in few bytes, and damage is noticed."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from processing.labels.packing import pack_codes, pack_points, unpack_codes, unpack_points

POINTS = st.sets(st.integers(0, 300) | st.integers(0, 2**40), max_size=60)


@given(POINTS)
def test_packed_points_come_back_exactly(points):
    rising = np.array(sorted(points), dtype=np.int64)
    unpacked = unpack_points(pack_points(rising))
    assert unpacked.dtype == np.int64
    np.testing.assert_array_equal(unpacked, rising)


@given(st.binary(max_size=50))
def test_packed_codes_come_back_exactly(codes):
    kept = np.frombuffer(codes, np.uint8)
    np.testing.assert_array_equal(unpack_codes(pack_codes(kept)), kept)


def test_a_run_of_a_million_points_takes_few_bytes():
    points = np.arange(1_000_000) + 5
    assert len(pack_points(points)) < 100
    assert len(pack_codes(np.full(points.size, 11, np.uint8))) < 10_000


@pytest.mark.parametrize("points", [[3, 3], [5, 4], [-1, 2]])
def test_points_that_do_not_rise_are_refused(points):
    with pytest.raises(ValueError, match="rise"):
        pack_points(np.array(points, dtype=np.int64))


def test_damaged_bytes_are_noticed():
    packed = pack_points(np.array([1, 2, 3, 9, 10]))
    for damaged in (b"\x07" + packed[1:], packed[:-6], packed[:1]):
        with pytest.raises(ValueError, match=r"runs|Error|incomplete"):
            unpack_points(damaged)
    with pytest.raises(ValueError, match="Error"):
        unpack_codes(b"no codes")
