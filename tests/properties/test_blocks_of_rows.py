"""A tool gives the same, whether a recording is cut into blocks or not: points to the bit."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from uuid import uuid4

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from processing.core.monitor import SilentMonitor
from processing.image.neighbourhoods.segments import OVERLAP_ROWS
from processing.image.point_image import PointCloudImage
from processing.methods.road.curbs.edges.approximate_lines import ApproximateLine, outwards_of
from processing.methods.road.curbs.edges.curb_points import LineCells
from processing.methods.road.gutters.notches.gutter_notches import notches_of
from processing.methods.road.gutters.notches.notches import NotchParameters
from processing.methods.templates.fit import FitSettings, fit_along
from processing.methods.templates.fitted_lines import FittedLine, fitted_lines
from processing.recording.camera_images.image_list import ImageList
from processing.recording.camera_images.image_store import write_images
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from processing.tools.classify import CLASSIFY, ClassifyParameters
from processing.tools.colour import COLOUR, ColourParameters
from processing.tools.curbs import CURBS
from processing.tools.features import FEATURES, FeaturesParameters
from processing.tools.ground import GROUND_TOOL, GroundParameters
from processing.tools.gutters import GUTTERS
from processing.tools.listed.registry import TOOLS, point_tools
from processing.tools.noise import NOISE, NoiseParameters
from processing.tools.normals import NORMALS, NormalsParameters
from processing.tools.poles import POLES
from processing.tools.road_map.barriers import BARRIERS
from processing.tools.road_map.clearance import CLEARANCE
from processing.tools.road_map.covers import COVERS
from processing.tools.road_map.edges import EDGES
from processing.tools.road_map.markings import MARKINGS
from processing.tools.road_map.walls import WALLS
from processing.tools.running.blocks import JoinedResults, blocks_of
from processing.tools.running.runner import RunRequest, columns_of, run
from processing.tools.segments import SEGMENTS, SegmentsParameters, compute_segments
from processing.tools.signs import SIGNS
from processing.tools.template import TEMPLATE
from processing.tools.tool import FinishedColumns, PointBlock, PointResult
from processing.tools.trees import TREES
from processing.tools.waveform_classify import WAVEFORM_CLASSIFY, WaveformClassifyParameters
from processing.tools.wires import WIRES
from tests.builders import simulated_drive
from tests.camera_scene import looking, photograph
from tests.processing.image.recordings import (
    drive_of,
    random_recording,
    small_drive,
    without_revolutions,
)
from tests.processing.methods.templates.curb_street import CURB, CURB_FRAME, recorded

ColumnArrays = Mapping[str, np.ndarray]
BLOCKS = (
    (NORMALS.id, NormalsParameters()),
    (NORMALS.id, NormalsParameters(radius_m=2.0)),
    (SEGMENTS.id, SegmentsParameters()),
    (SEGMENTS.id, SegmentsParameters(bend_deg=180.0, distance_m=0.1, spacing_ratio=1.2)),
)
"""Tools that look at neighbours in the image."""
WITH_IMAGES = (
    (COLOUR.id, ColourParameters()),
    (COLOUR.id, ColourParameters(regards_hidden=False)),
)
IN_SPACE = (
    (NOISE.id, NoiseParameters(method="radius", neighbours=40)),
    (NOISE.id, NoiseParameters(method="statistical", neighbours=30)),
    (NOISE.id, NoiseParameters()),
    (GROUND_TOOL.id, GroundParameters()),
    (CLASSIFY.id, ClassifyParameters()),
    (WAVEFORM_CLASSIFY.id, WaveformClassifyParameters()),
    (FEATURES.id, FeaturesParameters(names="verticality_1m,plan_density_2m,cell_height")),
    (GROUND_TOOL.id, GroundParameters(method="published", grid_m=2.0)),
    (GROUND_TOOL.id, GroundParameters(method="lowest", tolerance_m=0.1)),
)
"""Tools that look around in space, whenever a neighbour was measured, by parts of their own."""
CHUNKS = (
    TEMPLATE.id,
    CURBS.id,
    GUTTERS.id,
    SIGNS.id,
    TREES.id,
    POLES.id,
    WIRES.id,
    MARKINGS.id,
    BARRIERS.id,
    WALLS.id,
    CLEARANCE.id,
    COVERS.id,
    EDGES.id,
)
"""Tools that find candidates, and read the street a stretch at a time."""


def test_every_tool_is_shown_to_give_the_same_by_blocks() -> None:
    shown = {tool for tool, _ in (*BLOCKS, *WITH_IMAGES, *IN_SPACE)}
    assert shown == set(point_tools()), "give a new tool a line in BLOCKS, WITH_IMAGES or IN_SPACE"
    assert shown | set(CHUNKS) == set(TOOLS), "a new tool that finds needs a test of its own"


@pytest.fixture(scope="module")
def drives(tmp_path_factory: pytest.TempPathFactory) -> Mapping[str, Drive]:
    folder = tmp_path_factory.mktemp("drives")
    flat = small_drive(folder / "flat", 7, multi_return_share=0.2, lost_share=0.2)[0]
    return {
        "street": small_drive(folder / "street", 7, multi_return_share=0.2, lost_share=0.2)[0],
        "top view": without_revolutions(flat),
    }


def by_blocks(drive: Drive, tool: str, parameters: object, points: int) -> ColumnArrays:
    into = drive.folder.parent / uuid4().hex
    request = RunRequest(tool, drive, parameters)
    result = run(request, SilentMonitor(), into=into, points_per_block=points)
    assert isinstance(result, FinishedColumns)
    columns = {name: np.array(values) for name, values in columns_of(result).items()}
    result.remove()
    return columns


def assert_same(one: ColumnArrays, other: ColumnArrays) -> None:
    assert one.keys() == other.keys()
    for name, values in one.items():
        assert values.dtype == other[name].dtype
        np.testing.assert_array_equal(values, other[name])


@pytest.mark.parametrize("cloud", ["street", "top view"])
@pytest.mark.parametrize(("tool", "parameters"), BLOCKS)
@given(points=st.integers(1, 12_000))
@example(points=1)
@settings(max_examples=8)
def test_a_cloud_by_blocks_is_the_whole_cloud(
    drives: Mapping[str, Drive], cloud: str, tool: str, parameters: object, points: int
) -> None:
    drive = drives[cloud]
    whole = by_blocks(drive, tool, parameters, drive.count)
    assert_same(by_blocks(drive, tool, parameters, points), whole)


@pytest.mark.parametrize("cloud", ["street", "top view"])
@pytest.mark.parametrize(("tool", "parameters"), IN_SPACE)
@given(points=st.integers(1, 12_000))
@settings(max_examples=3)
def test_parts_of_space_are_the_whole_cloud(
    drives: Mapping[str, Drive], cloud: str, tool: str, parameters: object, points: int
) -> None:
    drive = drives[cloud]
    whole = by_blocks(drive, tool, parameters, drive.count)
    assert_same(by_blocks(drive, tool, parameters, points), whole)


@pytest.fixture(scope="module")
def photographed(tmp_path_factory: pytest.TempPathFactory) -> Drive:
    folder = tmp_path_factory.mktemp("photographed")
    drive = drive_of(simulated_drive(3, pulses_per_revolution=200.0, length_m=4.0), folder / "d")
    images = [
        looking(folder / f"{number}.png", (-0.5, along, 2.0), (0.3, 1.0, -0.3), size=(240, 180))
        for number, along in enumerate((0.5, 2.5))
    ]
    for image in images:
        photograph(image)
    write_images(drive.folder, ImageList(tuple(images)))
    return Drive(drive.folder)


@pytest.mark.parametrize(("tool", "parameters"), WITH_IMAGES)
@given(points=st.integers(1, 12_000))
@settings(max_examples=4)
def test_colours_of_blocks_are_those_of_the_whole(
    photographed: Drive, tool: str, parameters: object, points: int
) -> None:
    whole = by_blocks(photographed, tool, parameters, photographed.count)
    assert whole["is_seen"].any()
    size = max(points, photographed.count // 12)
    assert_same(by_blocks(photographed, tool, parameters, size), whole)


@pytest.fixture(scope="module")
def curb(tmp_path_factory: pytest.TempPathFactory) -> Drive:
    return recorded(tmp_path_factory.mktemp("curb"), without=(18.0, 21.0))


def followed(drive: Drive, stretch_m: float) -> tuple[FittedLine, ...]:
    settled = FitSettings(stretch_m=stretch_m)
    walk = fit_along(drive, CURB, CURB_FRAME, settled, SilentMonitor())
    return fitted_lines(drive, walk, settled, SilentMonitor())


@given(stretch_m=st.floats(2.0, 30.0))
@settings(max_examples=4)
def test_a_template_gives_the_same_lines_whatever_is_read_at_a_time(
    curb: Drive, stretch_m: float
) -> None:
    whole, parts = followed(curb, 80.0), followed(curb, stretch_m)
    assert len(whole) == len(parts) >= 2
    for one, other in zip(whole, parts, strict=True):
        assert np.abs(one.xyz - other.xyz).max() < 0.001
        np.testing.assert_array_equal(one.points, other.points)


@given(points_at_once=st.integers(1_000, 40_000))
@settings(max_examples=4)
def test_curbs_are_measured_by_the_same_points_whatever_is_read_at_a_time(
    curb: Drive, points_at_once: int
) -> None:
    approximate_line = guide_along(curb)
    cells = LineCells([approximate_line], 0.4)
    whole = cells.about(curb, SilentMonitor())
    parts = cells.about(curb, SilentMonitor(), points_at_once)
    assert whole.point.size > 1_000
    np.testing.assert_array_equal(whole.point, parts.point)
    np.testing.assert_array_equal(whole.across, parts.across)


@given(points_at_once=st.integers(2_000, 100_000))
@settings(max_examples=4)
def test_dips_of_the_road_are_the_same_whatever_is_read_at_a_time(
    curb: Drive, points_at_once: int
) -> None:
    whole = notches_of(curb, NotchParameters(), SilentMonitor())
    parts = notches_of(curb, NotchParameters(), SilentMonitor(), points_at_once)
    assert whole.point.size
    np.testing.assert_array_equal(whole.point, parts.point)


def guide_along(drive: Drive) -> ApproximateLine:
    """A guide by the edge of the road, of the length that the template follows."""
    xyz = followed(drive, 80.0)[0].xyz
    count = len(xyz)
    return ApproximateLine(
        xyz,
        outwards_of(xyz),
        np.ones(count, np.bool_),
        np.full(count, 0.15),
        np.zeros(count),
        np.zeros(count, np.bool_),
        np.zeros(count, np.bool_),
        True,
        np.zeros(count, np.int64),
        0,
    )


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


@given(
    seed=st.integers(0, 1000),
    revolutions=st.integers(1, 30),
    points=st.integers(1, 200),
    spread=st.sampled_from([0.05, 0.3, 1.0]),
    stop=st.sampled_from([0, 5000]),
)
@settings(max_examples=150)
def test_components_of_random_points_by_blocks_are_those_of_the_whole(
    seed: int, revolutions: int, points: int, spread: float, stop: int
) -> None:
    recording = random_recording(
        seed, pulses_per_revolution=9, revolutions=revolutions, stop_pulses=stop
    )
    image = PointCloudImage(
        ImageKind.TRAJECTORY_REVERSIBLE, recording.pulses, recording.revolutions
    )
    rows, columns = image.pixel_of(np.arange(image.drive_count))
    xyz = np.column_stack([columns * 0.25, rows * 0.25, columns * 0.0])
    xyz += np.random.default_rng(seed).normal(0, spread, xyz.shape)
    parameters = SegmentsParameters(bend_deg=180.0)

    def components(rows: range) -> PointResult:
        return compute_segments(block_of(image, xyz, rows), parameters, SilentMonitor())

    with TemporaryDirectory() as folder:
        results = JoinedResults(SEGMENTS.outputs, image.row_starts, Path(folder))
        for block in blocks_of(image.row_starts, OVERLAP_ROWS, points):
            results.add(block, components(block.rows_with_overlap))
        joined = columns_of(results.finished(SilentMonitor()))
        assert_same(joined, components(range(image.rows)).columns)


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


def test_a_component_that_only_its_far_end_joins_gets_one_number(tmp_path: Path) -> None:
    # A U: two arms that only the last row connects, in blocks of a row each; a dot stands aside.
    rows = 12
    row_starts = np.arange(rows + 1, dtype=np.int64) * 3
    results = JoinedResults(SEGMENTS.outputs, row_starts, tmp_path)
    for block in blocks_of(row_starts, 1, 3):
        has_last = block.rows_with_overlap.stop == rows
        wide = [[0, 0 if has_last else 1, (1 if has_last else 2) + row]
                for row in range(len(block.rows_with_overlap))]  # fmt: skip
        results.add(block, PointResult({"segment": np.array(wide, np.int32).ravel()}))
    found = columns_of(results.finished(SilentMonitor()))["segment"].reshape(rows, 3)
    assert (found[:, :2] == 0).all()
    assert found[:, 2].tolist() == list(range(1, rows + 1))
