"""Running a tool on a drive: the one door for the window, the command line and batch jobs."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import closing, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, assert_never

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import Unsuitable, name_with_type, report_as_user_error
from processing.core.monitor import Monitor
from processing.core.owned_files import make_marked, remove_folder
from processing.core.text import Text
from processing.image.images_of_drives import image_of
from processing.image.point_image import PointCloudImage
from processing.recording.columns.columns import Columns
from processing.recording.columns.ordering import read_chunk
from processing.recording.drive import Drive
from processing.recording.recorded_together import recorded_together, surveyed_together
from processing.tools.listed.registry import TOOLS, every_tool
from processing.tools.running.blocks import POINTS_PER_BLOCK, JoinedResults, blocks_of
from processing.tools.tool import (
    CandidateResult,
    Comparison,
    Finder,
    FinishedColumns,
    Needs,
    NewPoints,
    NewPointsTogether,
    PerDrive,
    PerPoint,
    PerPointOfDrive,
    PointBlock,
    SurveyCorrection,
    SurveyFinder,
    Together,
    TogetherResult,
    Tool,
)

RunResult = FinishedColumns | CandidateResult

_RUNNING = Text("{tool}: {name}", "{tool}: {name}")


@dataclass(frozen=True)
class RunRequest:
    """What to run.

    Attributes
    ----------
    tool : str
        A key of `TOOLS`.
    drive : Drive
    parameters : object
        An instance of the tool's own parameter class.
    beside : tuple of Drive
        Other drives of the same street; the result is about ``drive`` alone.
    """

    tool: str
    drive: Drive
    parameters: object
    beside: tuple[Drive, ...] = ()


def run(
    request: RunRequest,
    monitor: Monitor,
    *,
    into: Path,
    points_per_block: int = POINTS_PER_BLOCK,
) -> RunResult:
    """Run a tool on a whole drive; the drive itself isn't changed.

    Parameters
    ----------
    into : Path
        A folder that isn't there yet, for the columns of a tool that says something about points;
        on the drive's disk where the drive is to have them. Removed again if the run fails.
    points_per_block : int
        What is held in memory at a time; the result doesn't depend on it.

    Returns
    -------
    FinishedColumns or CandidateResult
        A column file for each of the tool's outputs; or what the tool found.

    Raises
    ------
    Unsuitable
        The drive lacks what the tool needs.
    OutOfRange
        There is no such tool, or parameters contradict each other.
    NoSpace
        The disk can't hold the columns.
    Cancelled
        Nothing is kept.
    """
    tool = tool_of(request.tool)
    check_needs(tool, request.drive)
    text = _RUNNING.filled(tool=tool.name, name=request.drive.info.name)
    monitor.check()
    monitor.report(0.0, text)
    found = _result_of(request, monitor, _Columns(into, points_per_block))
    result: RunResult
    if isinstance(found, TogetherResult):
        result, *others = found.columns
        for other in others:
            other.remove()
    else:
        result = found
    if isinstance(result, FinishedColumns):
        result.keep_sums()
    monitor.report(1.0, text)
    return result


def drives_of(request: RunRequest) -> tuple[Drive, ...]:
    """The drives that one run is about: the request's, and for some tools those recorded with it.

    A tool that finds things on several drives gets those of the survey that have what it needs.

    Raises
    ------
    OutOfRange
        There is no such tool.
    """
    tool = tool_of(request.tool)
    match tool.method:
        case Together():
            return recorded_together(request.drive, request.beside)
        case SurveyFinder():
            is_met, _, _ = _NEEDS[tool.needs]
            suited = tuple(drive for drive in request.beside if is_met(drive))
            return surveyed_together(request.drive, suited)
        case _:
            return (request.drive,)


def run_together(
    request: RunRequest,
    monitor: Monitor,
    *,
    into: Path,
    points_per_block: int = POINTS_PER_BLOCK,
) -> TogetherResult:
    """Run a tool that says something about points on all drives that :func:`drives_of` names.

    Parameters
    ----------
    into : Path
        As :func:`run`; it holds the columns of all the drives.

    Raises
    ------
    Unsuitable, OutOfRange, NoSpace, Cancelled
        As :func:`run`.
    """
    if not isinstance(tool_of(request.tool).method, Together):
        result = run(request, monitor, into=into, points_per_block=points_per_block)
        if isinstance(result, FinishedColumns):
            return TogetherResult((result,), note=result.note)
        return TogetherResult(())
    found = _result_of(request, monitor, _Columns(into, points_per_block))
    return found if isinstance(found, TogetherResult) else TogetherResult(())


def columns_of(result: RunResult) -> Mapping[str, NDArray[Any]]:
    """The columns of a result, by name, mapped; none where it holds candidates."""
    if isinstance(result, CandidateResult):
        return {}
    columns = Columns(result.folder, result.count)
    return {name: columns[name] for name in result.names}


def any_tool(name: str) -> Tool:
    """The tool of an id, also one that compares two grounds.

    Raises
    ------
    OutOfRange
        There is none.
    """
    return name_with_type(every_tool(), name, _NO_SUCH_TOOL)


def tool_of(name: str) -> Tool:
    """The tool of an id that runs on drives.

    Raises
    ------
    OutOfRange
        There is none.
    """
    return name_with_type(TOOLS, name, _NO_SUCH_TOOL)


def check_needs(tool: Tool, drive: Drive) -> None:
    """Refuse a drive that lacks what a tool needs.

    Raises
    ------
    Unsuitable
    """
    is_met, what, remedy = _NEEDS[tool.needs]
    if is_met(drive):
        return
    if tool.needs is Needs.REVOLUTIONS and drive.info.rows_reason.en:
        remedy = drive.info.rows_reason
    raise Unsuitable(what.filled(tool=tool.name), Text.same(drive.info.name), remedy)


_NO_SUCH_TOOL = Text("There is no such tool.", "そのようなツールはありません。")

_Need = tuple[Callable[[Drive], bool], Text, Text]
_NEEDS: Mapping[Needs, _Need] = {
    Needs.POINTS: (lambda _: True, Text("", ""), Text("", "")),
    Needs.PIXELS: (lambda _: True, Text("", ""), Text("", "")),
    Needs.REVOLUTIONS: (
        lambda drive: drive.revolutions is not None,
        Text(
            "“{tool}” needs the revolutions of the scanner, which this drive doesn't have.",
            "「{tool}」にはスキャナの回転情報が必要ですが、この走行データにはありません。",
        ),
        Text(
            "Import the points of a rotating scanner with their times and the trajectory.",
            "回転式スキャナの時刻付き点群を走行軌跡と一緒にインポートしてください。",
        ),
    ),
    Needs.TRAJECTORY: (
        lambda drive: drive.trajectory is not None,
        Text(
            "“{tool}” needs a trajectory, which this drive doesn't have.",
            "「{tool}」には走行軌跡が必要ですが、この走行データにはありません。",
        ),
        Text(
            "Import the drive again together with its trajectory.",
            "走行軌跡と一緒に走行データをインポートし直してください。",
        ),
    ),
    Needs.IMAGES: (
        lambda drive: bool(drive.images),
        Text(
            "“{tool}” needs camera images, which this drive doesn't have.",
            "「{tool}」にはカメラ画像が必要ですが、この走行データにはありません。",
        ),
        Text(
            "Import the drive again together with the list of its images.",
            "画像一覧と一緒に走行データをインポートし直してください。",
        ),
    ),
}


@dataclass(frozen=True)
class _Columns:
    """Where columns come to lie, and how many points are held at a time."""

    into: Path
    points_at_once: int


def _result_of(
    request: RunRequest, monitor: Monitor, columns: _Columns
) -> CandidateResult | TogetherResult:
    """What a tool gives, by the kind of its method: the one place that knows the kinds."""
    tool, parameters = tool_of(request.tool), request.parameters
    match tool.method:
        case Finder(find):
            return find(request.drive, parameters, monitor)
        case SurveyFinder(find_together):
            return find_together(drives_of(request), parameters, monitor)
        case PerPoint() as method:
            return _by_blocks(method, request, monitor, columns)
        case PerPointOfDrive(computer_of, outputs, overlap_rows):
            compute = computer_of(request.drive, request.beside, parameters, monitor)
            method = PerPoint(compute, outputs, overlap_rows)
            return _by_blocks(method, request, monitor, columns)
        case PerDrive(mark):
            with _removed_on_failure(columns.into):
                marked = mark(
                    request.drive, parameters, columns.into, columns.points_at_once, monitor
                )
                monitor.check()
            return TogetherResult((marked,), note=marked.note)
        case Together(mark_together):
            drives = _checked_together(tool, request, monitor)
            with _removed_on_failure(columns.into):
                result = mark_together(
                    drives, parameters, columns.into, columns.points_at_once, monitor
                )
                monitor.check()
            return result
        case Comparison() | NewPoints() | NewPointsTogether() | SurveyCorrection():
            message = f"{tool.id} says nothing about the points of a drive"
            raise ValueError(message)
        case _:
            assert_never(tool.method)


def _by_blocks(
    method: PerPoint, request: RunRequest, monitor: Monitor, columns: _Columns
) -> TogetherResult:
    """What a method says about every point, block by block."""
    image = image_of(request.drive, request.drive.pixel_kind)
    total = max(request.drive.count, 1)
    with (
        _removed_on_failure(columns.into),
        closing(JoinedResults(method.outputs, image.row_starts, columns.into)) as results,
    ):
        for block in blocks_of(image.row_starts, method.overlap_rows, columns.points_at_once):
            monitor.check()
            monitor.report(float(image.row_starts[block.rows.start]) / total)
            request.drive.columns.give_back()
            points = _block_of(request.drive, image, block.rows_with_overlap)
            results.add(block, method.compute(points, request.parameters, monitor))
        finished = results.finished(monitor)
        monitor.check()
    return TogetherResult((finished,))


def _checked_together(tool: Tool, request: RunRequest, monitor: Monitor) -> tuple[Drive, ...]:
    """All drives of a run, which have what the tool needs."""
    drives = drives_of(request)
    for drive in drives:
        check_needs(tool, drive)
    monitor.report(
        0.0, _RUNNING.filled(tool=tool.name, name=", ".join(drive.info.name for drive in drives))
    )
    return drives


@contextmanager
def _removed_on_failure(folder: Path) -> Iterator[None]:
    with report_as_user_error(folder):
        make_marked(folder)
    try:
        yield
    except BaseException:
        remove_folder(folder)
        raise


def _block_of(drive: Drive, image: PointCloudImage, rows: range) -> PointBlock:
    grid, points = image.grid(rows)

    # The type of a column's values is the column's own.
    def read(name: str) -> NDArray[Any]:
        # Read, not mapped: what was read doesn't stay in memory with the next block.
        return read_chunk(drive.folder, name, points.start, points.stop)

    has_classes = drive.columns.has("classification")
    return PointBlock(
        xyz=drive.coordinates.chunk_xyz(points.start, points.stop),
        intensity=read("intensity"),
        time=read("time"),
        classification=(
            read("classification")
            if has_classes
            else np.zeros(points.stop - points.start, np.uint8)
        ),
        grid=grid,
        seen_from=None
        if drive.info.scanner_position is None
        else np.array(drive.info.scanner_position),
    )
