"""Each benchmark runs on little data and gives figures that can be."""

from __future__ import annotations

import math
import re

import pytest

from processing.core.text import Text
from processing.laboratory.bench.case import BenchmarkOptions, Measurement
from processing.laboratory.bench.cases.extraction_case import measure_extraction
from processing.laboratory.bench.cases.extraction_growth import measure_extraction_growth
from processing.laboratory.bench.cases.ground_cases import measure_ground
from processing.laboratory.bench.cases.image_cases import measure_image, measure_switch
from processing.laboratory.bench.cases.import_cases import measure_import, measure_import_memory
from processing.laboratory.bench.cases.label_case import measure_labels
from processing.laboratory.bench.cases.noise_cases import measure_noise
from processing.laboratory.bench.cases.peer_cases import measure_normals, measure_searchable
from processing.laboratory.bench.cases.road_case import measure_road
from processing.laboratory.bench.cases.road_run import StageWatch
from processing.laboratory.bench.cases.simulate_case import measure_simulate
from processing.laboratory.bench.cases.volume_cases import (
    measure_volume,
    measure_volume_tin,
    measure_volume_view,
)
from processing.laboratory.bench.growth import exponent_of, measure_growth
from processing.laboratory.bench.volume_site import true_volumes
from processing.tools.listed.registry import extractors

LITTLE = BenchmarkOptions(most_points=20_000, share=0.2)


@pytest.mark.parametrize(
    "measure",
    [
        measure_import,
        measure_searchable,
        measure_image,
        measure_switch,
        measure_labels,
        measure_simulate,
        measure_volume_tin,
        measure_volume_view,
    ],
)
def test_a_benchmark_gives_one_positive_figure(measure: object) -> None:
    assert callable(measure)
    (row,) = measure(LITTLE)
    assert isinstance(row, Measurement)
    assert row.value is not None
    assert 0 < row.value < math.inf
    assert row.detail


def test_normals_are_compared_with_each_peer_or_it_says_that_one_is_missing() -> None:
    rows = measure_normals(LITTLE)
    assert [row.name for row in rows] == ["normals-open3d", "normals-pcl", "normals-cloudcompare"]
    assert rows[0].value is not None
    for row in rows:
        assert row.is_met is None
        assert (row.value is None) == ("is not installed" in row.detail)


def test_ground_has_a_time_and_says_which_peers_there_are() -> None:
    (row,) = measure_ground(LITTLE)
    assert row.value is not None
    assert row.target == 15.0
    assert "csf" in row.detail
    assert "pcl" in row.detail


def test_noise_is_compared_with_a_peer_and_the_combined_has_a_time() -> None:
    rows = measure_noise(LITTLE)
    radius, statistical, same, combined = rows
    assert [row.name for row in rows] == [
        f"noise-{name}" for name in ("radius", "statistical", "same", "combined")
    ]
    assert same.value == 0, same.detail
    for row in (radius, statistical, combined):
        assert row.value is not None
        assert row.value > 0
        assert row.target is not None


def test_each_extractor_and_all_of_them_are_timed_on_an_avenue() -> None:
    *tools, everything, classes = measure_extraction(LITTLE)
    assert [row.name for row in tools] == ["trees", "signs", "poles", "wires"]
    assert min(row.value or 0.0 for row in tools) > 0
    parts = [everything.figures[f"{name}_s"] for name in ("noise", *extractors())]
    assert min(parts) > 0
    assert sum(parts) == pytest.approx(everything.value)
    assert "curbs" in everything.detail
    assert min(classes.figures["alone_mpps"], classes.figures["looking_mpps"]) > 0


def test_each_extractor_of_things_has_an_exponent_and_all_of_them_their_memory() -> None:
    *tools, memory = measure_extraction_growth(BenchmarkOptions(most_points=300_000, share=0.2))
    assert [row.name for row in tools] == [
        f"growth-{name}" for name in ("trees", "signs", "poles", "wires")
    ]
    for row in tools:
        assert row.value is not None
        assert row.target == 1.05
        assert min(row.figures.values()) > 0
    assert memory.target == 1.5


def test_curbs_and_gutters_have_times_by_stage_and_length() -> None:
    rows = measure_road(LITTLE)
    assert [row.name for row in rows] == ["road", "road-growth", "road-memory", "road-stop"]
    for row in rows:
        assert row.value is not None or row.name == "road-memory"
        assert row.target is not None
    assert "curbs" in rows[0].detail
    assert "gutters" in rows[0].detail


def test_a_volume_has_times_by_stage_and_comes_near_what_was_moved() -> None:
    (row,) = measure_volume(BenchmarkOptions(most_points=200_000, share=0.2))
    assert row.value is not None
    assert row.target == 3.0
    assert row.figures["Summing"] > 0
    cut, fill = (float(word) for word in re.findall(r"(?:cut|fill) ([\d.]+) of", row.detail))
    true_cut, true_fill = true_volumes()
    assert cut == pytest.approx(true_cut, rel=0.1)
    assert fill == pytest.approx(true_fill, rel=0.1)


def test_stages_are_timed_from_one_told_to_the_next() -> None:
    watch = StageWatch()
    watch.report(0.0, Text("Reading", "読み込み中"))
    watch.report(0.5)
    watch.report(0.6, Text("Joining", "結合中"))
    watch.close()
    assert list(watch.seconds) == ["begin", "Reading", "Joining"]
    assert min(watch.seconds.values()) >= 0
    assert 0 < watch.longest_s < math.inf


def test_memory_of_an_import_is_some_of_it_in_no_file() -> None:
    (row,) = measure_import_memory(LITTLE)
    if row.value is not None:
        assert 0 < row.figures["anonymous_gib"] <= row.figures["resident_gib"] == row.value < 1.5


def test_growth_gives_an_exponent_and_the_time_of_each_size() -> None:
    rows = measure_growth(BenchmarkOptions(most_points=45_000, share=0.2))
    assert len(rows) == 9
    for row in rows:
        assert row.value is not None
        assert set(row.figures) == {"15000_s", "45000_s"}
        assert min(row.figures.values()) > 0


def test_the_exponent_of_a_power_law_is_found() -> None:
    sizes = [1, 10, 100]
    assert exponent_of(sizes, [2.0, 20.0, 200.0]) == pytest.approx(1.0)
    assert exponent_of(sizes, [3.0, 3.0, 3.0]) == pytest.approx(0.0)
    assert exponent_of(sizes, [1.0, 100.0, 10_000.0]) == pytest.approx(2.0)
