"""What a tool's run gave, on its way from the worker into the project."""

from __future__ import annotations

import shutil
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from processing.errors import told_as_user_error
from processing.monitor import Monitor
from processing.points.drive import Drive
from processing.project.found_classes import found_classes
from processing.project.found_features import FoundFeatures, found_features
from processing.project.run_findings import adopt_finding, write_finding
from processing.runner import RunRequest, run, tool_of
from processing.score.asked_classes import ASKED
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
    said : Path or None
        What the run said of each point of the drive, to be kept with it; in a folder of its own.
    """

    columns: FinishedColumns | None = None
    found: FoundFeatures | None = None
    said: Path | None = None

    def keep_said(self, drive: Drive) -> None:
        """Keep with a drive what the run said of its points.

        Raises
        ------
        NoSpace, InUse
        """
        if self.found is not None and self.said is not None:
            adopt_finding(drive, self.found.run.id, self.said)
            shutil.rmtree(self.said.parent, ignore_errors=True)


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
        found = found_classes(result, tool, parameters, drive, **times)
        if tool.id not in ASKED:
            return FinishedRun(found=found)
        said = into.with_name(f"{into.name}-said") / "said"
        with told_as_user_error(said):
            said.parent.mkdir()
        write_finding(result, ASKED[tool.id].codes, said)
        return FinishedRun(found=found, said=said)
    finally:
        result.remove()
