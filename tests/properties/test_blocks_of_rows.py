"""A tool gives the same to the bit, whether a recording is cut into blocks or not."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from processing.image.kinds import ImageKind
from processing.image.point_image import PointCloudImage
from processing.monitor import SilentMonitor
from processing.points.drive import Drive
from processing.tools.blocks import blocks_of, results_of
from processing.tools.normals import NORMALS, NormalsParameters
from processing.tools.segments import SEGMENTS, SegmentsParameters
from processing.tools.tool import PointBlock, PointResult, Tool
from tests.processing.image.recordings import random_recording, small_drive


def block_of(image: PointCloudImage, xyz: np.ndarray, rows: range) -> PointBlock:
    grid, points = image.grid(rows)
    count = points.stop - points.start
    return PointBlock(
        xyz=xyz[points],
        intensity=np.zeros(count, np.uint16),
        time=np.zeros(count),
        classification=np.zeros(count, np.uint8),
        grid=grid,
    )


def by_blocks(
    tool: Tool, image: PointCloudImage, xyz: np.ndarray, parameters: object, points: int
) -> PointResult:
    results = results_of(tool, image.row_starts)
    for block in blocks_of(image.row_starts, tool.overlap_rows, points):
        part = block_of(image, xyz, block.rows_with_overlap)
        results.add(block, tool.compute(part, parameters, SilentMonitor()))
    return results.finished()


def assert_same(one: PointResult, other: PointResult) -> None:
    assert one.columns.keys() == other.columns.keys()
    for name, values in one.columns.items():
        assert values.dtype == other.columns[name].dtype
        np.testing.assert_array_equal(values, other.columns[name])


@pytest.fixture(scope="module")
def drive(tmp_path_factory: pytest.TempPathFactory) -> Drive:
    folder = tmp_path_factory.mktemp("drive") / "d"
    return small_drive(folder, 7, multi_return_share=0.2, lost_share=0.2)[0]


@pytest.mark.parametrize(
    ("tool", "parameters"),
    [
        (NORMALS, NormalsParameters()),
        (SEGMENTS, SegmentsParameters()),
        (SEGMENTS, SegmentsParameters(bend_deg=180.0, distance_m=0.1, spacing_ratio=1.2)),
    ],
)
@given(points=st.integers(1, 12_000))
@settings(max_examples=15)
def test_a_street_by_blocks_is_the_whole_street(
    drive: Drive, tool: Tool, parameters: object, points: int
) -> None:
    image = drive.image(ImageKind.TRAJECTORY_REVERSIBLE)
    xyz = drive.xyz(slice(None))
    whole = tool.compute(block_of(image, xyz, range(image.rows)), parameters, SilentMonitor())
    assert_same(by_blocks(tool, image, xyz, parameters, points), whole)


@given(
    seed=st.integers(0, 1000),
    turns=st.integers(1, 30),
    points=st.integers(1, 200),
    spread=st.sampled_from([0.05, 0.3, 1.0]),
    stop=st.sampled_from([0, 5000]),
)
@settings(max_examples=150)
def test_components_of_random_points_by_blocks_are_those_of_the_whole(
    seed: int, turns: int, points: int, spread: float, stop: int
) -> None:
    recording = random_recording(seed, pulses_per_turn=9, turns=turns, stop_pulses=stop)
    image = PointCloudImage(ImageKind.TRAJECTORY_REVERSIBLE, recording.pulses, recording.turns)
    rows, columns = image.pixel_of(np.arange(image.drive_count))
    xyz = np.column_stack([columns * 0.25, rows * 0.25, columns * 0.0])
    xyz += np.random.default_rng(seed).normal(0, spread, xyz.shape)
    parameters = SegmentsParameters(bend_deg=180.0)
    whole = SEGMENTS.compute(block_of(image, xyz, range(image.rows)), parameters, SilentMonitor())
    assert_same(by_blocks(SEGMENTS, image, xyz, parameters, points), whole)


@given(
    counts=st.lists(st.integers(0, 50), min_size=0, max_size=60),
    overlap=st.integers(-1, 20),
    points=st.integers(1, 500),
)
def test_blocks_own_every_row_once_and_bring_the_overlap(
    counts: list[int], overlap: int, points: int
) -> None:
    row_starts = np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)
    blocks = list(blocks_of(row_starts, overlap, points))
    assert [row for block in blocks for row in block.rows] == list(range(len(counts)))
    for block in blocks:
        assert block.rows_with_overlap.start == max(0, block.rows.start - max(overlap, 0))
        assert block.rows_with_overlap.stop == min(len(counts), block.rows.stop + max(overlap, 0))
    if overlap < 0:
        assert len(blocks) <= 1


def test_a_component_that_only_its_far_end_joins_gets_one_number() -> None:
    # A U: two arms that only the last row connects, in blocks of a row each.
    recording_rows = 12
    row_starts = np.arange(recording_rows + 1, dtype=np.int64) * 2
    labels_whole = np.zeros(2 * recording_rows, np.int32)
    results = results_of(SEGMENTS, row_starts)
    for block in blocks_of(row_starts, 1, 2):
        rows = block.rows_with_overlap
        is_last = rows.stop == recording_rows
        arms = np.tile(np.array([0, 0 if is_last else 1], np.int32), len(rows))
        results.add(block, PointResult({"segment": arms}))
    assert results.finished().columns["segment"].tolist() == labels_whole.tolist()
