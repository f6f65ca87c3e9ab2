"""What a tool's run gave, on its way from the worker into the project."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from processing.monitor import Monitor
from processing.project.found_classes import found_classes
from processing.project.found_features import FoundFeatures, found_features
from processing.runner import RunRequest, run, tool_of
from processing.tools.tool import CandidateResult, FinishedColumns


@dataclass(frozen=True)
class FinishedRun:
    """Columns for the drive, or candidates for the map and labels for points.

    Attributes
    ----------
    columns : FinishedColumns or None
        In a folder on the drive's disk; None for a tool that finds candidates or classes.
    found : FoundFeatures or None
        The run with its candidates or labels; None for a tool that makes columns.
    """

    columns: FinishedColumns | None = None
    found: FoundFeatures | None = None


def finished_run(request: RunRequest, into: Path, monitor: Monitor) -> FinishedRun:
    """Run a tool and make of what it gives what the project stores; for a worker's thread.

    Parameters
    ----------
    into : Path
        A new folder on the drive's disk, for columns.

    Raises
    ------
    UserError
        As :func:`processing.runner.run`; `Cancelled`.
    """
    started = datetime.now(UTC)
    result = run(request, monitor, into=into)
    tool, parameters, drive = tool_of(request.tool), request.parameters, request.drive
    times = {"started": started, "finished": datetime.now(UTC)}
    if isinstance(result, CandidateResult):
        return FinishedRun(found=found_features(result, tool, parameters, drive.id, **times))
    if not tool.gives_classes:
        return FinishedRun(columns=result)
    try:
        return FinishedRun(found=found_classes(result, tool, parameters, drive, **times))
    finally:
        result.remove()
