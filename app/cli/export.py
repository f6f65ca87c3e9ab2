"""``zuka export``: a project's map as the files that are handed in."""

from __future__ import annotations

import argparse

from app.cli.opened import terminal_monitor
from app.cli.output import print_lines
from app.settings.language import system_language
from processing.formats.registry import FORMATS
from processing.operations.export import ExportRequest, check_formats, export
from processing.project.project import Project


def command(arguments: argparse.Namespace) -> int:
    """Write the map in each format that was asked for."""
    check_formats(arguments.format)
    project = Project.open(arguments.project, writing=False)
    project.find_sources()
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
        never=tuple(path for drive in project.drives for path in drive.delivered_files),
    )
    try:
        features = tuple(project.features.all())
        paths = export(
            features,
            project.catalogue,
            project.crs,
            request,
            terminal_monitor(),
            drives=project.drives,
        )
    finally:
        project.close()
    print_lines(*(str(path) for path in paths))
    return 0
