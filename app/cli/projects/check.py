"""``zuka check``: what is damaged in a project, and making again what can be made again."""

from __future__ import annotations

import argparse

from app.cli.opened import terminal_monitor
from app.cli.output import print_json, print_lines
from app.cli.terminal import say
from app.settings.language import system_language
from processing.core.errors import BadFile
from processing.core.text import Text
from processing.operations.check import CheckOperation, check
from processing.project.checking.findings import CheckReport

_WHOLE = Text("{files} files checked: nothing is damaged.", "{files}ファイルを検査: 破損なし。")
_STATES = {
    "damaged": Text("damaged", "破損"),
    "repaired": Text("repaired", "修復"),
    "noted": Text("note", "注意"),
}


def command(arguments: argparse.Namespace) -> int:
    """Check a project; the status is 2 as long as something is damaged."""
    operation = CheckOperation(arguments.project, arguments.repair)
    report = check(operation, terminal_monitor())
    language = system_language()
    if arguments.json:
        print_json(_values(report))
    else:
        for one in report.findings:
            state = _STATES[one.state.value].in_language(language)
            print_lines(f"{state}: {one.words.in_language(language)}")
        if not report.damaged:
            print_lines(_WHOLE.filled(files=report.files).in_language(language))
    if report.damaged:
        say(_refusal(arguments, report).line(language))
        return 2
    return 0


def _values(report: CheckReport) -> dict[str, object]:
    language = system_language()
    return {
        "files": report.files,
        "findings": [
            {
                "file": one.file,
                "state": one.state.value,
                "what": one.what.in_language(language),
                "remedy": one.remedy.in_language(language),
            }
            for one in report.findings
        ],
    }


def _refusal(arguments: argparse.Namespace, report: CheckReport) -> BadFile:
    first = report.damaged[0]
    number = len(report.damaged)
    what = (
        Text("{count} files of the project are damaged.", "{count}ファイルが壊れています。")
        if number > 1
        else Text("A file of the project is damaged.", "1ファイルが壊れています。")
    )
    return BadFile(
        what.filled(count=number),
        Text("{project}: {file}", "{project}: {file}").filled(
            project=arguments.project, file=first.file
        ),
        first.remedy,
    )
