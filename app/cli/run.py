"""``zuka run``: a processing tool on a project or on delivered files."""

from __future__ import annotations

import argparse

from app.cli.opened import opened_drives, terminal_monitor
from app.cli.output import print_lines
from processing.errors import OutOfRange
from processing.monitor import PartMonitor
from processing.project.point_results import write_point_results
from processing.runner import RunRequest, run, tool_of
from processing.text import Text
from processing.tools.parameters import filled_in

_RUNNING = 0.8


def command(arguments: argparse.Namespace) -> int:
    """Run a tool on every drive of the input and write its result."""
    tool = tool_of(arguments.tool)
    parameters = filled_in(tool.parameters, _settings(arguments.set))
    _check_output(arguments)
    monitor = terminal_monitor()
    with opened_drives(arguments, monitor) as drives:
        results = []
        for number, drive in enumerate(drives):
            share = _RUNNING / len(drives)
            part = PartMonitor(monitor, number * share, (number + 1) * share)
            results.append((drive, run(RunRequest(tool.id, drive, parameters), part)))
        writing = PartMonitor(monitor, _RUNNING, 1.0)
        paths = write_point_results(results, arguments.output, writing)
    print_lines(*(str(path) for path in paths))
    return 0


def _settings(words: list[str]) -> dict[str, str]:
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


def _check_output(arguments: argparse.Namespace) -> None:
    if arguments.output.suffix.lower() not in (".las", ".laz"):
        raise OutOfRange(
            Text("Point results are LAS or LAZ files.", "点の処理結果はLASまたはLAZです。"),
            Text.same(str(arguments.output)),
            Text("Give a name ending in .las or .laz.", ".las または .laz の名前にしてください。"),
        )
