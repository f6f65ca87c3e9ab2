"""``zuka road``: a project's road model, or the centre lines of its roads."""

from __future__ import annotations

import argparse

from app.cli.opened import terminal_monitor
from app.cli.output import print_lines, print_notes
from app.settings.language import system_language
from processing.core.errors import OutOfRange
from processing.core.text import Text
from processing.map.routes.route import PITCH_M
from processing.operations.export import ExportRequest
from processing.operations.map_steps import (
    ROAD_FORMAT,
    CentreLineOperation,
    draw_centre_lines,
)
from processing.operations.project_export import ExportOperation, export_project


def command(arguments: argparse.Namespace) -> int:
    """Draw centre lines where it is asked, then write the model where a folder is given."""
    language, monitor = system_language(), terminal_monitor()
    if not (arguments.draw or arguments.out):
        raise OutOfRange(
            Text("Nothing was asked for.", "処理の指定がありません。"),
            Text.same("zuka road"),
            Text("Give --out DIR or --draw.", "--out DIR か --draw を指定してください。"),
        )
    if arguments.draw:
        drawn = draw_centre_lines(CentreLineOperation(arguments.project), monitor)
        print_lines(*(words.in_language(language) for words in drawn.words))
    if arguments.out is not None:
        pitch = PITCH_M if arguments.pitch is None else arguments.pitch
        options = {"road_pitch": pitch}
        request = ExportRequest((ROAD_FORMAT,), arguments.out, language, options)
        written = export_project(ExportOperation(arguments.project, request), monitor)
        print_notes(*(note.in_language(language) for note in written.notes))
        print_lines(*(str(path) for path in written.paths))
    return 0
