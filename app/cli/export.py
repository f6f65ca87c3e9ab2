"""``zuka export``: a project's map as the files that are handed in."""

from __future__ import annotations

import argparse

from app.cli.opened import terminal_monitor
from app.cli.output import print_lines
from app.settings.language import system_language
from processing.core.errors import OutOfRange, use_one_of
from processing.core.text import Text
from processing.operations.export import FORMATS, ExportRequest, export
from processing.project.project import Project


def command(arguments: argparse.Namespace) -> int:
    """Write the map in each format that was asked for."""
    for name in arguments.format:
        if name not in FORMATS:
            raise OutOfRange(
                Text("There is no such format.", "そのような形式はありません。"),
                Text.same(name),
                use_one_of(FORMATS),
            )
    project = Project.open(arguments.project, writing=False)
    project.find_sources()
    request = ExportRequest(
        formats=tuple(dict.fromkeys(arguments.format)),
        folder=arguments.out,
        language=system_language(),
        dxf_version=arguments.dxf_version,
        encoding=arguments.encoding,
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
