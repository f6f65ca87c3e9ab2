"""``zuka run``: a processing tool on a project or on delivered files."""

from __future__ import annotations

import argparse
from datetime import UTC, datetime
from pathlib import Path

from app.cli.opened import OpenedInput, opened_input, terminal_monitor
from app.cli.output import print_lines
from processing.errors import OutOfRange
from processing.formats.safe_write import refuse_inputs
from processing.monitor import Monitor, PartMonitor
from processing.project.feature import Feature
from processing.project.feature_files import check_ending, write_feature_file
from processing.project.found_features import found_features
from processing.project.point_results import check_point_output, write_point_results
from processing.project.scratch_folder import scratch_folder
from processing.runner import RunRequest, check_needs, run, tool_of
from processing.text import Text
from processing.tools.parameters import filled_in
from processing.tools.tool import CandidateResult, FinishedColumns, Tool

_RUNNING = 0.8


def command(arguments: argparse.Namespace) -> int:
    """Run a tool on every drive of the input and write its result."""
    tool = tool_of(arguments.tool)
    parameters = filled_in(tool.parameters, settings_of_words(arguments.set))
    _check_output(tool, arguments.output)
    monitor = terminal_monitor()
    with (
        opened_input(arguments, monitor) as opened,
        scratch_folder(arguments.output.parent) as scratch,
    ):
        _check_first(tool, opened, arguments.output, monitor)
        columns: list[FinishedColumns] = []
        features: list[Feature] = []
        for number, drive in enumerate(opened.drives):
            share = _RUNNING / len(opened.drives)
            part = PartMonitor(monitor, number * share, (number + 1) * share)
            started = datetime.now(UTC)
            beside = tuple(other for other in opened.drives if other is not drive)
            request = RunRequest(tool.id, drive, parameters, beside)
            result = run(request, part, into=scratch / str(number))
            if isinstance(result, CandidateResult):
                times = {"started": started, "finished": datetime.now(UTC)}
                found = found_features(result, tool, parameters, drive.id, **times)
                features.extend(found.change.added)
            else:
                columns.append(result)
        writing = PartMonitor(monitor, _RUNNING, 1.0)
        if tool.find is not None:
            paths = _write_features(features, opened, arguments.output, writing)
        else:
            pairs = list(zip(opened.drives, columns, strict=True))
            paths = write_point_results(pairs, arguments.output, writing)
    print_lines(*(str(path) for path in paths))
    return 0


def _check_first(tool: Tool, opened: OpenedInput, output: Path, monitor: Monitor) -> None:
    """Refuse what can't come to a good end before hours of work are spent on it."""
    for drive in opened.drives:
        check_needs(tool, drive)
    if tool.find is None:
        check_point_output(opened.drives, output, monitor)
    else:
        refuse_inputs(output, _delivered(opened))


def _delivered(opened: OpenedInput) -> list[Path]:
    return [path for drive in opened.drives for path in drive.delivered_files]


def _write_features(
    features: list[Feature], opened: OpenedInput, output: Path, monitor: Monitor
) -> tuple[Path, ...]:
    write_feature_file(
        output, features, opened.catalogue, opened.crs, monitor=monitor, never=_delivered(opened)
    )
    return (output,)


def settings_of_words(words: list[str]) -> dict[str, str]:
    """What ``--set NAME=VALUE`` says, by name.

    Raises
    ------
    OutOfRange
        A setting has no value.
    """
    settings = {}
    for word in words:
        name, sign, value = word.partition("=")
        if not sign:
            raise OutOfRange(
                Text("A setting has no value.", "設定に値がありません。"),
                Text.same(f"--set {word}"),
                Text("Write --set NAME=VALUE.", "--set 名前=値 の形で指定してください。"),
            )
        settings[name] = value
    return settings


def _check_output(tool: Tool, output: Path) -> None:
    if tool.find is not None:
        check_ending(output)
    elif output.suffix.lower() not in (".las", ".laz"):
        raise OutOfRange(
            Text("Point results are LAS or LAZ files.", "点の処理結果はLASまたはLAZです。"),
            Text.same(str(output)),
            Text("Give a name ending in .las or .laz.", ".las または .laz の名前にしてください。"),
        )
