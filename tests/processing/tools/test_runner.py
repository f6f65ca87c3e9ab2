"""Running tools on drives: results for every point, refusals, progress and cancelling."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from uuid import uuid4

import numpy as np
import pytest

from processing.core.errors import Cancelled, OutOfRange, Unsuitable
from processing.core.monitor import SilentMonitor
from processing.core.parameters import parameters_of
from processing.core.text import Text
from processing.recording.camera_images.image_list import ImageList
from processing.recording.camera_images.image_store import write_images
from processing.recording.columns.columns import COLUMN_TYPES, ColumnWriter
from processing.recording.drive import Drive
from processing.recording.drive_info import read_drive_info, write_drive_info
from processing.recording.kinds import ImageKind
from processing.tools.listed.registry import TOOLS, point_tools
from processing.tools.normals import NORMALS, NormalsParameters
from processing.tools.running.runner import RunRequest, check_needs, columns_of, run, tool_of
from processing.tools.segments import SEGMENTS, SegmentsParameters
from processing.tools.tool import Needs
from tests.camera_scene import looking, photograph
from tests.older_project import forget_all_sums
from tests.processing.image.recordings import small_drive, without_revolutions


class Watching:
    """Notes progress, and cancels after some checks."""

    def __init__(self, cancel_after: int = 10**9) -> None:
        self.fractions: list[float] = []
        self.texts: list[Text] = []
        self._left = cancel_after

    def report(self, fraction: float, text: Text | None = None) -> None:
        self.fractions.append(fraction)
        self.texts.extend([text] if text else [])

    def check(self) -> None:
        self._left -= 1
        if self._left < 0:
            raise Cancelled


@pytest.fixture
def drive(tmp_path: Path) -> Drive:
    made = small_drive(tmp_path / "d", multi_return_share=0.1)[0]
    image = looking(tmp_path / "写真" / "front_0001.png", (0.0, 1.0, 2.0), (0.0, 1.0, -0.3))
    photograph(image)
    write_images(made.folder, ImageList((image,)))
    return Drive(made.folder)


def new_in(drive: Drive) -> Path:
    """A folder for results that isn't there yet."""
    return drive.folder.parent / uuid4().hex


@pytest.mark.parametrize("name", list(point_tools()))
def test_a_tool_gives_what_it_declares_and_the_drive_can_store_it(drive: Drive, name: str) -> None:
    tool = TOOLS[name]
    result = run(RunRequest(name, drive, tool.parameters()), SilentMonitor(), into=new_in(drive))
    declared = {output.name: output for output in tool.outputs}
    # Of the features only those are given that were chosen.
    assert columns_of(result).keys() <= declared.keys()
    assert columns_of(result).keys() == declared.keys() or name == "features"
    for output in (declared[one] for one in columns_of(result)):
        values = columns_of(result)[output.name]
        shape = (drive.count,) if output.width == 1 else (drive.count, output.width)
        assert values.shape == shape
        assert values.dtype == output.dtype
        assert np.dtype(COLUMN_TYPES[output.name][0]) == values.dtype
        drive.columns.add(output.name, values)
        np.testing.assert_array_equal(drive.columns[output.name], values)


@pytest.mark.parametrize("name", list(point_tools()))
def test_a_tool_runs_on_a_cloud_without_revolutions(drive: Drive, name: str) -> None:
    flat = without_revolutions(drive)
    assert flat.image_kinds == (ImageKind.TOP_VIEW,)
    result = run(
        RunRequest(name, flat, TOOLS[name].parameters()), SilentMonitor(), into=new_in(flat)
    )
    assert all(len(values) == flat.count for values in columns_of(result).values())


def test_progress_rises_to_one_and_says_what_is_done(drive: Drive) -> None:
    watching = Watching()
    run(RunRequest("segments", drive, SegmentsParameters()), watching, into=new_in(drive))
    assert watching.fractions == sorted(watching.fractions)
    assert watching.fractions[-1] == 1.0
    assert "Segments" in watching.texts[0].en
    assert drive.info.name in watching.texts[0].ja


@pytest.mark.parametrize("checks", [0, 1, 2])
def test_cancelling_leaves_nothing(drive: Drive, checks: int) -> None:
    into = new_in(drive)
    with pytest.raises(Cancelled):
        run(RunRequest("normals", drive, NormalsParameters()), Watching(checks), into=into)
    assert not into.exists()
    assert not drive.columns.has("normal")


def test_an_unknown_tool_is_refused_with_the_known_ones() -> None:
    with pytest.raises(OutOfRange) as refusal:
        tool_of("magic")
    assert "normals" in refusal.value.remedy.en


def test_a_tool_that_needs_revolutions_refuses_a_cloud_without_them(drive: Drive) -> None:
    flat = without_revolutions(drive)
    tool = dataclasses.replace(NORMALS, needs=Needs.REVOLUTIONS)
    with pytest.raises(Unsuitable) as refusal:
        check_needs(tool, flat)
    assert refusal.value.remedy == flat.info.rows_reason
    assert "Normals" in refusal.value.what.en
    check_needs(dataclasses.replace(NORMALS, needs=Needs.PIXELS), flat)


def test_a_tool_that_needs_a_trajectory_refuses_a_drive_without_one(drive: Drive) -> None:
    assert drive.trajectory is None
    with pytest.raises(Unsuitable):
        check_needs(dataclasses.replace(SEGMENTS, needs=Needs.TRAJECTORY), drive)


def test_a_drive_without_delivered_classes_can_be_processed(drive: Drive) -> None:
    (drive.folder / "classification.bin").unlink()
    again = Drive(drive.folder)
    result = run(
        RunRequest("segments", again, SegmentsParameters()), SilentMonitor(), into=new_in(again)
    )
    assert columns_of(result)["segment"].max() > 0


def test_a_drive_without_points_gives_empty_columns(drive: Drive) -> None:
    names = ("xyz", "time", "intensity", "pulse")
    forget_all_sums(drive.folder)
    with ColumnWriter(drive.folder) as writer:
        writer.append({name: np.empty((0, 3) if name == "xyz" else 0) for name in names})
    for path in drive.folder.glob("*.bin"):
        if path.stem not in names:
            path.unlink()
    write_drive_info(drive.folder, dataclasses.replace(read_drive_info(drive.folder), count=0))
    for tool in (NORMALS, SEGMENTS):
        request = RunRequest(tool.id, Drive(drive.folder), tool.parameters())
        found = columns_of(run(request, SilentMonitor(), into=new_in(drive)))
        for output in tool.outputs:
            assert found[output.name].shape == ((0,) if output.width == 1 else (0, output.width))


def test_contradicting_distances_are_refused(drive: Drive) -> None:
    parameters = SegmentsParameters(distance_m=2.0, farthest_m=1.0)
    with pytest.raises(OutOfRange) as refusal:
        run(RunRequest("segments", drive, parameters), SilentMonitor(), into=new_in(drive))
    assert "2 m" in refusal.value.remedy.en


def test_every_tool_explains_its_parameters_in_both_languages() -> None:
    for tool in TOOLS.values():
        assert tool.explanation.en
        assert tool.explanation.ja
        for parameter in parameters_of(tool.parameters):
            assert parameter.explanation.en
            assert parameter.explanation.ja
            if parameter.kind in ("number", "count"):
                assert parameter.low <= float(parameter.default) <= parameter.high


def test_many_blocks_give_the_same_as_one(drive: Drive) -> None:
    request = RunRequest("segments", drive, SegmentsParameters())
    whole = columns_of(run(request, SilentMonitor(), into=new_in(drive)))["segment"]
    watching = Watching()
    cut = columns_of(run(request, watching, into=new_in(drive), points_per_block=500))["segment"]
    np.testing.assert_array_equal(cut, whole)
    assert len(watching.fractions) > 5
