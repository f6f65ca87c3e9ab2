"""Colours go where LAS keeps them, in the point format nearest to the delivered one."""

from __future__ import annotations

from pathlib import Path

import laspy
import numpy as np
import pytest

from processing.core.monitor import SilentMonitor
from processing.formats.points.las_results import write_results
from tests.delivered_files import make_las, ply_bytes

_COUNT = 500
_FORMAT_WITH_COLOUR = {0: 2, 1: 3, 2: 2, 3: 3, 4: 5, 5: 5, 6: 7, 7: 7, 8: 8, 9: 10, 10: 10}


def some_colours() -> np.ndarray:
    return np.random.default_rng(3).integers(0, 65536, (_COUNT, 3)).astype(np.uint16)


@pytest.mark.parametrize("highest_class", [None, 67])
@pytest.mark.parametrize("point_format", range(11))
def test_colours_are_written_and_everything_else_stays(
    tmp_path: Path, point_format: int, highest_class: int | None
) -> None:
    source, output = tmp_path / "in.laz", tmp_path / "out.laz"
    make_las(source, point_format=point_format, with_extra=True)
    results = {"color": some_colours(), "is_seen": np.ones(_COUNT, np.uint8)}
    if highest_class is not None:
        results["classification"] = np.full(_COUNT, highest_class, np.uint8)
    write_results(source, output, results, SilentMonitor())
    before, after = laspy.read(source), laspy.read(output)
    is_promoted = point_format < 6 and highest_class is not None
    promoted = {0: 7, 1: 7, 2: 7, 3: 7, 4: 10, 5: 10}
    wanted = promoted[point_format] if is_promoted else _FORMAT_WITH_COLOUR[point_format]
    assert after.header.point_format.id == wanted
    found = np.column_stack([after.red, after.green, after.blue])
    np.testing.assert_array_equal(found, results["color"])
    np.testing.assert_array_equal(after.is_seen, results["is_seen"])
    changed = {"red", "green", "blue", "classification", "scan_angle_rank"}
    for name in set(before.point_format.dimension_names) - changed:
        np.testing.assert_array_equal(
            np.asarray(after[name]), np.asarray(before[name]), err_msg=name
        )


def test_colours_of_a_file_that_is_not_las(tmp_path: Path) -> None:
    source, output = tmp_path / "in.ply", tmp_path / "out.las"
    source.write_bytes(ply_bytes())
    count = len(laspy.read(_plain(source, tmp_path)).points)
    colours = some_colours()[:count]
    write_results(source, output, {"color": colours}, SilentMonitor())
    after = laspy.read(output)
    assert after.header.point_format.id == 7
    np.testing.assert_array_equal(np.column_stack([after.red, after.green, after.blue]), colours)


def _plain(source: Path, folder: Path) -> Path:
    """The same points without colours, to count them."""
    write_results(source, folder / "plain.las", {}, SilentMonitor())
    return folder / "plain.las"
