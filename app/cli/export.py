"""``zuka export``: a project's map as the files that are handed in."""

from __future__ import annotations

import argparse

from app.cli.opened import terminal_monitor
from app.cli.output import print_lines, print_notes
from app.settings.language import system_language
from processing.formats.registry import FORMATS
from processing.operations.export import ExportRequest
from processing.operations.project_export import ExportOperation, export_project


def command(arguments: argparse.Namespace) -> int:
    """Write the map in each format that was asked for."""
    request = ExportRequest(
        formats=tuple(dict.fromkeys(arguments.format)),
        folder=arguments.out,
        language=system_language(),
        options={
            option.id: given
            for option in FORMATS.map_options()
            if (given := getattr(arguments, option.id)) is not None
        },
        candidates=arguments.candidates,
    )
    written = export_project(ExportOperation(arguments.project, request), terminal_monitor())
    print_notes(*(note.in_language(system_language()) for note in written.notes))
    print_lines(*(str(path) for path in written.paths))
    return 0
