"""``zuka study``: a tool over a grid of one or two parameters, judged by a truth; a table."""

from __future__ import annotations

import argparse
import math
from pathlib import Path

from app.cli.opened import opened_input, terminal_monitor
from app.cli.output import print_lines
from app.cli.scores.aligned import align_lines
from app.cli.set_option import settings_of_words
from app.settings.language import system_language
from processing.core.monitor import Monitor, PartMonitor
from processing.core.parameters import fill_parameters
from processing.core.safe_write import refuse_inputs
from processing.core.scratch_folder import scratch_folder
from processing.core.text import Language, Text
from processing.formats.format import Content
from processing.formats.registry import FORMATS
from processing.operations.inputs import OpenedInputs
from processing.project.evaluation.class_tables import write_study
from processing.project.evaluation.parameter_study import (
    ParameterStudy,
    StudyRequest,
    TruthOf,
    study,
    varied_of,
)
from processing.project.evaluation.truth_of_file import coded_truth, truth_of_file
from processing.project.evaluation.truth_store import TRUTH
from processing.recording.columns.ordering import read_chunk
from processing.recording.drive import Drive
from processing.tools.listed.registry import asked_classes
from processing.tools.running.runner import check_needs, tool_of

_READING = 0.1
_HEAD = (Text("precision", "適合率"), Text("recall", "再現率"), Text.same("F"))


def command(arguments: argparse.Namespace) -> int:
    """Study a tool on every drive of the input that has a truth, and write the table."""
    tool = tool_of(arguments.tool)
    fixed = settings_of_words(arguments.set)
    fill_parameters(tool.parameters, fixed)
    varied = varied_of(tool.id, arguments.vary)
    FORMATS.format_to_write(arguments.output, Content.TABLE)
    monitor = terminal_monitor()
    with (
        opened_input(arguments, monitor) as opened,
        scratch_folder(arguments.output.parent) as scratch,
    ):
        never = [*arguments.truth, *_delivered_files(opened)]
        refuse_inputs(arguments.output, never)
        for drive in opened.drives:
            check_needs(tool, drive)
        reading = PartMonitor(monitor, 0.0, _READING)
        drives, truth = _truth_of(opened, arguments.truth, scratch, reading)
        request = StudyRequest(tool.id, drives, fixed, varied)
        found = study(request, truth, PartMonitor(monitor, _READING, 1.0), scratch / "runs")
        write_study(arguments.output, found, never=never)
    print_lines(*_lines(found, system_language()), str(arguments.output))
    return 0


def _truth_of(
    opened: OpenedInputs, files: list[Path], scratch: Path, monitor: Monitor
) -> tuple[tuple[Drive, ...], TruthOf]:
    """The drives that files say the truth of, and what they say."""
    folders: dict[str, Path] = {}
    for number, path in enumerate(files):
        into = scratch / f"truth-{number}"
        part = PartMonitor(monitor, number / len(files), (number + 1) / len(files))
        folders |= truth_of_file(opened.drives, coded_truth(path), into, part).folders
    drives = tuple(drive for drive in opened.drives if drive.id in folders)
    return drives, lambda drive, start, stop: read_chunk(folders[drive.id], TRUTH, start, stop)


def _lines(found: ParameterStudy, language: Language) -> list[str]:
    """Every setting with the scores of what the tool looks for, the best one marked."""
    names = [one.parameter for one in found.varied]
    best = found.best
    rows = [
        [
            *names,
            *(
                f"{asked_classes()[found.tool].found.in_language(language)}:{one.in_language(language)}"
                for one in _HEAD
            ),
            "",
        ]
    ]
    for cell in found.cells:
        scores = cell.counts.precision, cell.counts.recall, cell.counts.f_measure
        words = [f"{100 * one:.3f} %" if not math.isnan(one) else "-" for one in scores]
        rows.append([*(str(one) for one in cell.values), *words, "*" if cell is best else ""])
    return align_lines(rows)


def _delivered_files(opened: OpenedInputs) -> list[Path]:
    return [path for drive in opened.drives for path in drive.delivered_files]
