"""Running a tool that makes points of its own: into a file, from drives or delivered files."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from processing.core.errors import MissingInput, OutOfRange
from processing.core.monitor import Monitor, parts_of
from processing.core.parameters import ParameterValue, fill_parameters, parameters_of
from processing.core.text import Text
from processing.formats.format import Content
from processing.formats.points.new_points import Part, write_new_points
from processing.formats.points.waveform_output import WaveformLas
from processing.formats.registry import FORMATS
from processing.operations.inputs import OpenedInputs, OperationInputs, opened_inputs
from processing.project.project import Project
from processing.project.results.made_waveforms import write_made_waveforms
from processing.recording.drive import Drive
from processing.recording.recorded_together import recorded_together
from processing.recording.vehicle_path.clock import ClockKind, kind_of
from processing.recording.waveform_packets.descriptors import WaveformDescriptor
from processing.tools.listed.registry import POINT_MAKERS
from processing.tools.running.runner import check_needs
from processing.tools.tool import MadePoints, NewPoints, NewPointsTogether, Tool


@dataclass(frozen=True)
class NewPointsOperation:
    """A tool to be run whose points go into a file.

    Attributes
    ----------
    tool : str
        Id of a tool that makes points.
    inputs : OperationInputs
    output : Path or None
        LAS or LAZ.
    parameters : mapping of str to value
        Those that are given, by name; the others are the tool's own.
    """

    tool: str
    inputs: OperationInputs
    output: Path | None
    parameters: Mapping[str, ParameterValue] = field(default_factory=dict)


def points_operation_on_drive(
    tool: str, parameters: object, drive: Drive, project: Project, output: Path
) -> NewPointsOperation:
    """Points of a drive of a project with all parameters as they are, as the window asks for them.

    What a tool makes of strips together it makes of those that were recorded with the drive.

    Parameters
    ----------
    parameters : object
        An instance of the tool's own parameter class.
    """
    made = POINT_MAKERS[tool]
    values = {one.id: getattr(parameters, one.id) for one in parameters_of(made.parameters)}
    drives: tuple[Drive, ...] = (drive,)
    if isinstance(made.method, NewPointsTogether):
        drives = recorded_together(drive, [one for one in project.drives if one.id != drive.id])
    inputs = OperationInputs(project.folder, tuple(one.id for one in drives))
    return NewPointsOperation(tool, inputs, output, values)


def points_ending(tool: str) -> str:
    """How the name of a file ends that a tool's points are written to, as dialogs offer it."""
    method = POINT_MAKERS[tool].method
    return _WITH_PACKETS if isinstance(method, NewPointsTogether) else _PACKED


def make_points(operation: NewPointsOperation, monitor: Monitor) -> Path:
    """Run the tool on all drives of its inputs, one after the other; gives the file.

    Raises
    ------
    UserError, Cancelled
        Nothing was written.
    """
    tool, output = POINT_MAKERS[operation.tool], operation.output
    parameters = fill_parameters(tool.parameters, operation.parameters)
    if output is None:
        raise MissingInput(
            Text("The new points are written to a file.", "新しい点はファイルに書き出します。"),
            Text.same(operation.tool),
            Text(
                "Name it with --output, LAS or LAZ.",
                "--output でLASかLAZのファイルを指定してください。",
            ),
        )
    method = tool.method
    descriptor = method.descriptor if isinstance(method, NewPointsTogether) else None
    FORMATS.format_to_write(output, Content.POINTS)
    if descriptor is not None and output.suffix.lower() != _WITH_PACKETS:
        raise OutOfRange(
            Text("Waveforms are written beside LAS.", "波形はLASと一緒に書き出します。"),
            Text.same(str(output)),
            Text("Give a name ending in .las.", ".las で終わる名前にしてください。"),
        )
    with opened_inputs(operation.inputs, monitor, beside=output.parent) as opened:
        for drive in opened.chosen:
            check_needs(tool, drive)
        if descriptor is not None:
            _write_with_waveforms(output, opened, (tool, parameters, descriptor), monitor)
            return output
        write_new_points(
            output,
            _parts(tool, parameters, opened, monitor),
            opened.crs,
            monitor,
            never=opened.delivered,
            is_adjusted_standard=_is_adjusted_standard(opened),
        )
    return output


_WITH_PACKETS, _PACKED = ".las", ".laz"


def _parts(
    tool: Tool, parameters: object, opened: OpenedInputs, monitor: Monitor
) -> Iterator[Part]:
    for made in _made(tool, parameters, opened, monitor):
        yield made.xyz, made.columns, made.extra


def _made(
    tool: Tool, parameters: object, opened: OpenedInputs, monitor: Monitor
) -> Iterator[MadePoints]:
    method = tool.method
    if isinstance(method, NewPointsTogether):
        yield from method.make(opened.chosen, parameters, monitor)
        return
    if not isinstance(method, NewPoints):
        raise TypeError(tool.id)
    sizes = [drive.count for drive in opened.chosen]
    for drive, part in zip(opened.chosen, parts_of(monitor, sizes), strict=True):
        yield from method.make(drive, parameters, part)


def _write_with_waveforms(
    output: Path,
    opened: OpenedInputs,
    what: tuple[Tool, object, WaveformDescriptor],
    monitor: Monitor,
) -> None:
    tool, parameters, descriptor = what
    # The grid of the first drive: its points keep their coordinates to the bit.
    info = opened.chosen[0].info
    description = WaveformLas(
        opened.crs, info.scale, info.offset, descriptor, _is_adjusted_standard(opened)
    )
    made = _made(tool, parameters, opened, monitor)
    write_made_waveforms(output, made, description, monitor, never=opened.delivered)


def _is_adjusted_standard(opened: OpenedInputs) -> bool:
    for drive in opened.chosen:
        some = np.asarray(drive.columns["time"][:1]) - drive.info.clock_offset_s
        return kind_of(some) is not ClockKind.WEEK_SECONDS
    return True
