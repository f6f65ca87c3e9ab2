"""What a disk says reaches the user through the compressor."""

from __future__ import annotations

import errno
from pathlib import Path

import numpy as np
import pytest

from processing.laboratory.simulate.scanning.delivered_files import DeliveredPoints, PointFile

_FULL = Path("/dev/full")


def _points(count: int) -> DeliveredPoints:
    random = np.random.default_rng(1)
    ones = np.ones(count, np.uint8)
    xyz = random.uniform(0, 1000, (count, 3))
    strengths = random.integers(0, 65_535, count).astype(np.uint16)
    return DeliveredPoints(xyz, np.arange(count) * 1e-5, strengths, ones, ones, 1)


def _fill() -> None:
    with PointFile(_FULL, np.zeros(3)) as file:
        file.write(_points(400_000))


def test_a_full_disk_is_told_as_such_while_points_are_compressed() -> None:
    with pytest.raises(OSError, match="No space") as told:
        _fill()
    assert told.value.errno == errno.ENOSPC
