"""Running a tool that makes points of its own: into a file, from drives or delivered files."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from processing.core.errors import MissingInput
from processing.core.monitor import Monitor, parts_of
from processing.core.parameters import ParameterValue, fill_parameters
from processing.core.text import Text
from processing.formats.format import Content
from processing.formats.points.new_points import Part, write_new_points
from processing.formats.registry import FORMATS
from processing.operations.inputs import OpenedInputs, OperationInputs, opened_inputs
from processing.recording.vehicle_path.clock import ClockKind, kind_of
from processing.tools.registry import POINT_MAKERS
from processing.tools.running.runner import check_needs
from processing.tools.tool import NewPoints, Tool


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
    FORMATS.format_to_write(output, Content.POINTS)
    with opened_inputs(operation.inputs, monitor, beside=output.parent) as opened:
        for drive in opened.chosen:
            check_needs(tool, drive)
        write_new_points(
            output,
            _parts(tool, parameters, opened, monitor),
            opened.crs,
            monitor,
            never=opened.delivered,
            is_adjusted_standard=_is_adjusted_standard(opened),
        )
    return output


def _parts(
    tool: Tool, parameters: object, opened: OpenedInputs, monitor: Monitor
) -> Iterator[Part]:
    method = tool.method
    if not isinstance(method, NewPoints):
        raise TypeError(tool.id)
    sizes = [drive.count for drive in opened.chosen]
    for drive, part in zip(opened.chosen, parts_of(monitor, sizes), strict=True):
        for made in method.make(drive, parameters, part):
            yield made.xyz, made.columns, made.extra


def _is_adjusted_standard(opened: OpenedInputs) -> bool:
    for drive in opened.chosen:
        some = np.asarray(drive.columns["time"][:1]) - drive.info.clock_offset_s
        return kind_of(some) is not ClockKind.WEEK_SECONDS
    return True
