"""What a tool's run gave, on its way from the worker into the project."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime
from typing import Any

from numpy.typing import NDArray

from processing.monitor import Monitor
from processing.project.found_features import FoundFeatures, found_features
from processing.runner import RunRequest, columns_of, run, tool_of
from processing.tools.tool import CandidateResult


@dataclass(frozen=True)
class FinishedRun:
    """Columns for the drive, or candidates for the map.

    Attributes
    ----------
    columns : mapping of str to array
        By column name; empty for a tool that finds candidates.
    found : FoundFeatures or None
        The run with its candidates; None for a tool that says something about points.
    """

    columns: Mapping[str, NDArray[Any]] = field(default_factory=dict)  # each column's own dtype
    found: FoundFeatures | None = None


def finished_run(request: RunRequest, monitor: Monitor) -> FinishedRun:
    """Run a tool and make of what it gives what the project stores; for a worker's thread.

    Raises
    ------
    UserError
        As :func:`processing.runner.run`; `Cancelled`.
    """
    started = datetime.now(UTC)
    result = run(request, monitor)
    if not isinstance(result, CandidateResult):
        return FinishedRun(columns=columns_of(result))
    found = found_features(
        result,
        tool_of(request.tool),
        request.parameters,
        request.drive.id,
        started=started,
        finished=datetime.now(UTC),
    )
    return FinishedRun(found=found)
