"""Registering drives: corrected points, trajectories and a report, into a folder."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from processing.core.errors import MissingInput
from processing.core.monitor import Monitor, PartMonitor
from processing.core.parameters import ParameterValue, fill_parameters
from processing.core.safe_write import refuse_inputs
from processing.core.text import Text
from processing.core.whole_folder import write_whole_folder
from processing.formats.survey.control_points import read_control_points
from processing.formats.trajectories.trajectory_writing import write_sbet, write_trajectory_csv
from processing.methods.registration.control_points import ControlPoint
from processing.methods.registration.corrected_trajectory import corrected_trajectory
from processing.methods.registration.registration import SurveyRegistration
from processing.operations.inputs import OpenedInputs, OperationInputs, opened_inputs
from processing.operations.registration.control_check import check_places
from processing.operations.registration.registration_report import (
    drift_table,
    registration_words,
    report_of,
    residual_table,
)
from processing.project.results.moved_points import write_moved_points
from processing.recording.drive import Drive
from processing.tools.listed.registry import REGISTRATIONS
from processing.tools.register import RegisterParameters
from processing.tools.running.runner import check_needs
from processing.tools.tool import SurveyCorrection, Tool

_OPENED, _REGISTERED = 0.15, 0.75
REPORT, RESIDUALS = "report.json", "residuals.csv"


@dataclass(frozen=True)
class RegisterOperation:
    """Drives to be registered.

    Attributes
    ----------
    inputs : OperationInputs
        All of its drives are one survey.
    output : Path or None
        A folder, new or empty.
    parameters : mapping of str to value
        Those that are given, by name.
    """

    inputs: OperationInputs
    output: Path | None
    parameters: Mapping[str, ParameterValue] = field(default_factory=dict)


@dataclass(frozen=True)
class RegisterOutcome:
    """What was written.

    Attributes
    ----------
    folder : Path
    words : tuple of Text
        What it came to, in lines.
    """

    folder: Path
    words: tuple[Text, ...]


def register(operation: RegisterOperation, monitor: Monitor) -> RegisterOutcome:
    """Register the drives of an input and write their corrected points.

    Raises
    ------
    UserError, Cancelled
        Nothing was written.
    """
    tool = REGISTRATIONS["register"]
    folder = operation.output
    if folder is None:
        raise MissingInput(
            Text(
                "Corrected points are written to a folder.",
                "補正した点はフォルダに書き出します。",
            ),
            Text.same(tool.id),
            Text("Name it with --output.", "--output でフォルダを指定してください。"),
        )
    parameters = fill_parameters(RegisterParameters, operation.parameters)
    control = read_control(parameters)
    with write_whole_folder(folder) as hidden:
        opening = PartMonitor(monitor, 0.0, _OPENED)
        with opened_inputs(operation.inputs, opening, beside=hidden) as opened:
            refuse_inputs(folder, opened.delivered)
            found = found_registration(
                tool, opened, control, PartMonitor(monitor, _OPENED, _REGISTERED)
            )
            _write(found, opened, hidden, PartMonitor(monitor, _REGISTERED, 1.0))
            words = registration_words(found)
    return RegisterOutcome(folder, (Text.same(str(folder)), *words))


def read_control(parameters: RegisterParameters) -> tuple[ControlPoint, ...]:
    """The control points that parameters name; none where they name no file.

    Raises
    ------
    MissingInput, BadFile
        The file can't be read.
    """
    if not parameters.control.strip():
        return ()
    return read_control_points(Path(parameters.control))


def found_registration(
    tool: Tool, opened: OpenedInputs, control: Sequence[ControlPoint], monitor: Monitor
) -> SurveyRegistration:
    """Register the chosen drives of an input.

    Raises
    ------
    UserError, Cancelled
    """
    if not isinstance(tool.method, SurveyCorrection):
        raise TypeError(tool.id)
    for drive in opened.chosen:
        check_needs(tool, drive)
    check_places(control, opened.chosen, opened.crs)
    return tool.method.register(opened.chosen, control, monitor)


def _write(found: SurveyRegistration, opened: OpenedInputs, folder: Path, monitor: Monitor) -> None:
    drives = [
        Drive(drive.folder, correction=correction)
        for drive, correction in zip(found.survey.drives, found.corrections, strict=True)
    ]
    for moved, drive in zip(drives, found.survey.drives, strict=True):
        moved.use_moves(drive.moves)
    written = write_moved_points(drives, folder, monitor)
    names = _write_trajectories(found, folder, opened.crs)
    (folder / RESIDUALS).write_text(residual_table(found), encoding="utf-8")
    # The numbers last: where they are, all of it is.
    files = {str(source): path.name for source, path in written.items()}
    report = report_of(found, files, names)
    text = json.dumps(report, ensure_ascii=False, indent=1, allow_nan=False)
    (folder / REPORT).write_text(text + "\n", encoding="utf-8")


def _write_trajectories(found: SurveyRegistration, folder: Path, crs: str) -> tuple[str, ...]:
    """The corrected trajectory of every track and its drift; their names."""
    names = []
    for number, track in enumerate(found.survey.tracks, 1):
        name = f"trajectory_{number}"
        corrected = corrected_trajectory(found.corrections[track.drives[0]])
        write_trajectory_csv(folder / f"{name}.csv", corrected)
        if crs:
            write_sbet(folder / f"{name}.out", corrected, crs)
        (folder / f"drift_{number}.csv").write_text(
            drift_table(found, number - 1), encoding="utf-8"
        )
        names.append(f"{name}.csv")
    return tuple(names)
