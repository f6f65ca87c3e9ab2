"""Results are the input's points with classes and extra dimensions, and nothing else changed."""

from __future__ import annotations

from pathlib import Path

import laspy
import numpy as np
import pytest

from processing.core.errors import Cancelled, InUse, OutOfRange
from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.formats.points.las.las import read_info
from processing.formats.points.las_results import write_results
from tests.delivered_files import make_las, ply_bytes
from tests.monitors import CancelledAfter

_COUNT = 500


def _results(highest_class: int) -> dict[str, np.ndarray]:
    random = np.random.default_rng(1)
    classes = random.integers(0, highest_class, _COUNT).astype(np.uint8)
    classes[0] = highest_class
    return {
        "classification": classes,
        "confidence": random.random(_COUNT).astype(np.float32),
        "label": random.integers(0, 9, _COUNT).astype(np.uint16),
    }


@pytest.mark.parametrize("ending", ["las", "laz"])
@pytest.mark.parametrize("highest_class", [18, 67])
@pytest.mark.parametrize("point_format", range(11))
def test_every_attribute_of_every_format_survives(
    tmp_path: Path, point_format: int, highest_class: int, ending: str
) -> None:
    source, output = tmp_path / "in.laz", tmp_path / f"out.{ending}"
    make_las(source, point_format=point_format, with_extra=True)
    results = _results(highest_class)
    write_results(source, output, results, SilentMonitor())
    before, after = laspy.read(source), laspy.read(output)
    for name, values in results.items():
        np.testing.assert_array_equal(np.asarray(after[name]), values)
    for name in before.point_format.dimension_names:
        if name == "classification":
            continue
        own = "scan_angle" if name not in after.point_format.dimension_names else name
        found = np.asarray(after[own])
        if own != name:
            found = np.rint(found * 0.006)
        np.testing.assert_array_equal(found, np.asarray(before[name]), err_msg=name)
    is_promoted = point_format < 6 and highest_class > 31
    assert (after.header.point_format.id == point_format) is not is_promoted
    np.testing.assert_array_equal(after.header.offsets, before.header.offsets)
    np.testing.assert_array_equal(after.header.maxs, before.header.maxs)
    assert read_info(output).crs == read_info(source).crs == "EPSG:6677"


def test_records_beside_the_points_are_taken_over(tmp_path: Path) -> None:
    source, output = tmp_path / "in.las", tmp_path / "out.laz"
    make_las(source)
    las = laspy.read(source)
    las.header.vlrs.append(laspy.VLR("Office", 7, "note", b"\x01\x02"))
    las.evlrs.append(laspy.VLR("Office", 8, "long", b"\x03" * 70_000))
    las.write(source)
    write_results(source, output, _results(18), SilentMonitor())
    after = laspy.read(output)
    assert after.header.vlrs.get_by_id("Office", (7,))[0].record_data == b"\x01\x02"
    assert after.evlrs.get_by_id("Office", (8,))[0].record_data == b"\x03" * 70_000


def test_results_may_come_in_parts(tmp_path: Path) -> None:
    source, output = tmp_path / "in.laz", tmp_path / "out.laz"
    make_las(source, point_format=1)
    whole = _results(67)
    write_results(
        source,
        output,
        lambda start, stop: {name: values[start:stop] for name, values in whole.items()},
        SilentMonitor(),
    )
    np.testing.assert_array_equal(laspy.read(output).classification, whole["classification"])


def test_an_extra_dimension_of_the_same_name_and_type_is_replaced(tmp_path: Path) -> None:
    source, once, twice = (tmp_path / f"{name}.laz" for name in ("a", "b", "c"))
    make_las(source)
    results = _results(18)
    write_results(source, once, results, SilentMonitor())
    write_results(once, twice, {"confidence": results["confidence"] / 2}, SilentMonitor())
    after = laspy.read(twice)
    np.testing.assert_array_equal(after["confidence"], results["confidence"] / 2)
    np.testing.assert_array_equal(after["label"], results["label"])
    assert list(after.point_format.extra_dimension_names) == ["confidence", "label"]


def test_points_of_a_ply_become_las_with_their_times(tmp_path: Path) -> None:
    source, output = tmp_path / "in.ply", tmp_path / "out.laz"
    source.write_bytes(ply_bytes(count=40))
    classes = np.arange(40, dtype=np.uint8)
    write_results(source, output, {"classification": classes}, SilentMonitor())
    after = laspy.read(output)
    np.testing.assert_array_equal(after.classification, classes)
    np.testing.assert_allclose(after.x, 649_000 + 0.5 * np.arange(40), atol=1e-4)
    np.testing.assert_allclose(after.gps_time, 54_160 + 0.001 * np.arange(40))
    assert after.header.number_of_points_by_return[0] == 40


def test_a_cancelled_write_leaves_nothing_behind(tmp_path: Path) -> None:
    source, output = tmp_path / "in.laz", tmp_path / "out.laz"
    make_las(source)
    with pytest.raises(Cancelled):
        write_results(source, output, _results(18), CancelledAfter())
    assert list(tmp_path.iterdir()) == [source]


def test_the_input_is_never_overwritten(tmp_path: Path) -> None:
    source = tmp_path / "in.laz"
    make_las(source)
    before = source.read_bytes()
    with pytest.raises(InUse) as refusal:
        write_results(source, source, _results(18), SilentMonitor())
    assert isinstance(refusal.value.remedy, Text)
    assert source.read_bytes() == before


def test_an_output_that_is_neither_las_nor_laz_is_refused(tmp_path: Path) -> None:
    source = tmp_path / "in.laz"
    make_las(source)
    with pytest.raises(OutOfRange, match=r"out\.ply"):
        write_results(source, tmp_path / "out.ply", _results(18), SilentMonitor())
