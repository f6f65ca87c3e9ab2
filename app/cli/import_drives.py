"""``zuka import``: delivered files become a project's drives."""

from __future__ import annotations

import argparse
from dataclasses import replace

from app.cli.opened import request_of, terminal_monitor
from app.cli.output import print_lines
from app.language import system_language
from app.long_work import prepare_images, told_columns
from processing.points.drive import Drive
from processing.project.importing import import_drives
from processing.project.project import Project, is_project
from processing.project.unfinished_imports import import_folder, unfinished_imports
from processing.text import Text

_ROWS = Text(
    "{rows} rows, {turn} turns/s, {pulse} pulses/s, {each} pulses a turn ({by})",
    "{rows} 行, 毎秒 {turn} 回転, 毎秒 {pulse} パルス, 1回転あたり {each} パルス ({by})",
)


def command(arguments: argparse.Namespace) -> int:
    """Import files into a project, made if there is none; an import that was killed goes on."""
    is_new = not is_project(arguments.project)
    if is_new:
        project = Project.create(arguments.project, arguments.crs)
    else:
        project = Project.open(arguments.project)
    finished = False
    try:
        request = replace(request_of(arguments), labels=arguments.labels)
        into = import_folder(project.folder, request)
        taken = tuple(drive.id for drive in project.drives)
        folders = import_drives(request, into, terminal_monitor(), taken=taken)
        drives = project.adopt_drives(folders)
        finished = True
        for drive in drives:
            prepare_images(drive, terminal_monitor())
    finally:
        project.close()
        if is_new and not finished and not unfinished_imports(project.folder):
            Project.remove_new(arguments.project)
    for drive in drives:
        print_lines(describe_drive(drive))
    print_lines(*(told.spoken(system_language()) for told in told_columns(drives)))
    return 0


def describe_drive(drive: Drive) -> str:
    """One line on a drive: points, rows, rates; or why there are no rows."""
    language = system_language()
    info, turns = drive.info, drive.turns
    points = f"{info.count:,} 点" if language == "ja" else f"{info.count:,} points"
    if turns is None:
        return f"{info.name}: {points}, {info.rows_reason.spoken(language)}"
    rows = turns.segments.size
    told = _ROWS.filled(
        rows=f"{rows:,}",
        turn=f"{turns.turn_rate_hz:.3f}",
        pulse=f"{turns.pulse_rate_hz:,.0f}",
        each=f"{turns.pulses_per_turn:.2f}",
        by=turns.method,
    )
    return f"{info.name}: {points}, {told.spoken(language)}"
