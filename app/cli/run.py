"""``zuka run``: a processing tool on a project or on delivered files."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path

from app.cli.opened import OpenedInput, opened_input, terminal_monitor
from app.cli.output import print_lines
from app.cli.set_option import settings_of_words
from processing.core.errors import MissingInput
from processing.core.monitor import Monitor, PartMonitor
from processing.core.parameters import fill_parameters
from processing.core.safe_write import refuse_inputs, write_safely
from processing.core.scratch_folder import scratch_folder
from processing.core.text import Text
from processing.formats.format import Content
from processing.formats.registry import FORMATS
from processing.formats.vectors.feature_files import write_feature_file
from processing.map.feature import Feature
from processing.methods.ground.stored_surface import StoredSurface
from processing.project.results.found_features import found_features
from processing.project.results.point_results import check_point_output, write_point_results
from processing.project.results.surface_files import surface_file_of, write_surface_content
from processing.recording.drive import Drive
from processing.tools.registry import COMPARISONS
from processing.tools.runner import RunRequest, check_needs, drives_of, run, run_together, tool_of
from processing.tools.tool import CandidateResult, FinishedColumns, Tool

_RUNNING = 0.8
_NOTE = Text("{tool}: {note}", "{tool}: {note}")


def command(arguments: argparse.Namespace) -> int:
    """Run a tool on every drive of the input and write its result."""
    if arguments.tool in COMPARISONS:
        # What papers need is imported for them alone.
        from app.cli import volume

        return volume.command(arguments)
    tool = tool_of(arguments.tool)
    _check_inputs(arguments)
    parameters = fill_parameters(tool.parameters, settings_of_words(arguments.set))
    _check_output(tool, arguments.output)
    monitor = terminal_monitor()
    with (
        opened_input(arguments, monitor) as opened,
        scratch_folder(arguments.output.parent) as scratch,
    ):
        _check_first(tool, opened, arguments.output, monitor)
        request = _RequestedRun(tool, parameters, opened, arguments.output)
        paths = (_found if tool.gives_candidates else _points)(request, scratch, monitor)
    print_lines(*(str(path) for path in paths))
    return 0


@dataclass(frozen=True)
class _RequestedRun:
    """What is to be run on what, and where the result goes."""

    tool: Tool
    parameters: object
    opened: OpenedInput
    output: Path

    def request(self, drive: Drive) -> RunRequest:
        """A run on a drive, with all others beside it."""
        beside = tuple(other for other in self.opened.drives if other is not drive)
        return RunRequest(self.tool.id, drive, self.parameters, beside)


def _found(request: _RequestedRun, scratch: Path, monitor: Monitor) -> tuple[Path, ...]:
    """What a tool finds on each drive, as one file."""
    drives, done = request.opened.drives, set[str]()
    features: list[Feature] = []
    while left := [drive for drive in drives if drive.id not in done]:
        run_request = request.request(left[0])
        together = [drive.id for drive in drives_of(run_request)]
        ends = (len(done) / len(drives), len(done | set(together)) / len(drives))
        part = PartMonitor(monitor, _RUNNING * ends[0], _RUNNING * ends[1])
        started = datetime.now(UTC)
        result = run(run_request, part, into=scratch / str(len(done)))
        done |= set(together)
        if isinstance(result, CandidateResult):
            _report(request.tool, result.note, monitor, _RUNNING * ends[1])
            result = _for_file(result, request.output)
            times = {"started": started, "finished": datetime.now(UTC)}
            found = found_features(result, request.tool, request.parameters, together, **times)
            features.extend(found.change.added)
    writing = PartMonitor(monitor, _RUNNING, 1.0)
    return _write_features(features, request.opened, request.output, writing)


def _for_file(result: CandidateResult, output: Path) -> CandidateResult:
    """What goes into a file: a drawing has all, other files what was found."""
    if Content.DRAWING in FORMATS.format_to_write(output, Content.FEATURES).writes:
        return result
    kept = tuple(one for one in result.candidates if not one.is_drawing)
    return replace(result, candidates=kept)


def _report(tool: Tool, note: Text, monitor: Monitor, at: float) -> None:
    if note.en:
        monitor.report(at, _NOTE.filled(tool=tool.name, note=note))


def _points(request: _RequestedRun, scratch: Path, monitor: Monitor) -> tuple[Path, ...]:
    """What a tool says about points, beside the points of each file; surfaces where wanted."""
    drives = request.opened.drives
    wanted = surface_file_of(request.parameters)
    if wanted is not None:
        refuse_inputs(wanted, _delivered(request.opened))
    columns: dict[str, FinishedColumns] = {}
    surfaces: list[tuple[str, Path]] = []
    while left := [drive for drive in drives if drive.id not in columns]:
        run_request = request.request(left[0])
        together = drives_of(run_request)
        ends = (len(columns) / len(drives), (len(columns) + len(together)) / len(drives))
        part = PartMonitor(monitor, _RUNNING * ends[0], _RUNNING * ends[1])
        result = run_together(run_request, part, into=scratch / str(len(columns)))
        _report(request.tool, result.note, monitor, _RUNNING * ends[1])
        columns |= {one.id: found for one, found in zip(together, result.columns, strict=True)}
        surfaces.extend((left[0].info.name, path) for path in result.kept)
    with ExitStack() as whole:
        for path, surface in _surface_files(wanted, surfaces):
            never = _delivered(request.opened)
            temporary = whole.enter_context(write_safely(path, never=never))
            write_surface_content(StoredSurface(surface), temporary, monitor)
        pairs = [(drive, columns[drive.id]) for drive in drives]
        return write_point_results(pairs, request.output, PartMonitor(monitor, _RUNNING, 1.0))


def _surface_files(
    wanted: Path | None, surfaces: list[tuple[str, Path]]
) -> Iterator[tuple[Path, Path]]:
    """A file for each surface; where there are several, the name of a drive is added."""
    if wanted is None:
        return
    for name, surface in surfaces:
        alone = len(surfaces) == 1
        yield wanted if alone else wanted.with_name(f"{wanted.stem}-{name}{wanted.suffix}"), surface


def _check_first(tool: Tool, opened: OpenedInput, output: Path, monitor: Monitor) -> None:
    """Refuse what can't come to a good end before hours of work are spent on it."""
    for drive in opened.drives:
        check_needs(tool, drive)
    if tool.gives_candidates:
        refuse_inputs(output, _delivered(opened))
    else:
        check_point_output(opened.drives, output, monitor)


def _delivered(opened: OpenedInput) -> list[Path]:
    return [path for drive in opened.drives for path in drive.delivered_files]


def _write_features(
    features: list[Feature], opened: OpenedInput, output: Path, monitor: Monitor
) -> tuple[Path, ...]:
    write_feature_file(
        output, features, opened.catalogue, opened.crs, monitor=monitor, never=_delivered(opened)
    )
    return (output,)


def _check_inputs(arguments: argparse.Namespace) -> None:
    given = vars(arguments)
    if not arguments.inputs or given.get("before") or given.get("after"):
        raise MissingInput(
            Text("The tool runs on one input.", "このツールは1つの入力を処理します。"),
            Text.same(arguments.tool),
            Text(
                "Name a project or point files, without --before and --after.",
                "--before・--after を使わずに、プロジェクトか点群ファイルを指定してください。",
            ),
        )


def _check_output(tool: Tool, output: Path) -> None:
    content = Content.FEATURES if tool.gives_candidates else Content.POINTS
    FORMATS.format_to_write(output, content)
