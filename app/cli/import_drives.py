"""``zuka import``: delivered files become a project's drives."""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path

from app.cli.opened import request_of, terminal_monitor
from app.cli.output import print_lines
from app.cli.terminal import say
from app.document.import_words import (
    column_remarks,
    has_already,
    known_words,
    lacking_words,
    waveform_remarks,
)
from app.settings.language import system_language
from processing.core.text import Text
from processing.operations.import_files import ImportOperation, import_files
from processing.project.additions import Additions
from processing.project.importing.import_request import ImportRequest
from processing.recording.drive import Drive

_ROWS = Text(
    "{rows} rows, {rate} revolutions/s, {pulse} pulses/s, {each} pulses per revolution ({by})",
    "{rows} 行, 毎秒 {rate} 回転, 毎秒 {pulse} パルス, 1回転あたり {each} パルス ({by})",
)


_BY_ORDER = Text(
    "{rows} rows, {each} pulses per revolution ({by}). {how}",
    "{rows} 行, 1回転あたり {each} パルス ({by})。{how}",
)


def command(arguments: argparse.Namespace) -> int:
    """Import files into a project, made if there is none; an import that was killed goes on.

    What the project has already is not imported again; with a trajectory or images it is completed.
    """
    request = replace(request_of(arguments), labels=arguments.labels)
    operation = ImportOperation(arguments.project, request, replaces=tuple(arguments.replace))
    outcome = import_files(operation, terminal_monitor())
    _report(outcome.drives, outcome.brought, request)
    return 0


def _report(drives: tuple[Drive, ...], brought: Additions, request: ImportRequest) -> None:
    language = system_language()
    for drive in drives:
        print_lines(describe_drive(drive))
    remarks = (*column_remarks(drives), *waveform_remarks(drives))
    print_lines(*(reported.in_language(language) for reported in remarks))
    if brought.known:
        print_lines(known_words(brought.known).in_language(language))
    elif brought.are_none and request.files:
        print_lines(has_already().in_language(language))
    shown = [_write_path(path) for path in brought.beside]
    lacking = lacking_words(drives, brought, shown).in_language(language)
    if lacking:
        say(lacking)


def _write_path(path: Path) -> str:
    """A path as one types it in this folder."""
    here = Path.cwd()
    return str(path.relative_to(here) if path.is_relative_to(here) else path)


def describe_drive(drive: Drive) -> str:
    """One line on a drive: points, rows, rates; or why there are no rows."""
    language = system_language()
    info, revolutions = drive.info, drive.revolutions
    points = f"{info.count:,} 点" if language == "ja" else f"{info.count:,} points"
    if revolutions is None:
        return f"{info.name}: {points}, {info.rows_reason.in_language(language)}"
    rows = revolutions.segments.size
    words = _ROWS if info.has_measured_times else _BY_ORDER
    reported = words.filled(
        how=info.rows_reason,
        rows=f"{rows:,}",
        rate=f"{revolutions.revolution_rate_hz:.3f}",
        pulse=f"{revolutions.pulse_rate_hz:,.0f}",
        each=f"{revolutions.pulses_per_revolution:.2f}",
        by=revolutions.method,
    )
    return f"{info.name}: {points}, {reported.in_language(language)}"
