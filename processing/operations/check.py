"""Checking a project: what is damaged, and making again what the delivered files still give."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from processing.core.monitor import Monitor
from processing.project.checking.findings import CheckReport
from processing.project.checking.project_check import check_project


@dataclass(frozen=True)
class CheckOperation:
    """A project to be checked.

    Attributes
    ----------
    repair : bool
        Whether what can be made again is.
    """

    project: Path
    repair: bool = False


def check(operation: CheckOperation, monitor: Monitor) -> CheckReport:
    """Check a project.

    Raises
    ------
    UserError, Cancelled
        As :func:`processing.project.checking.project_check.check_project`.
    """
    return check_project(operation.project, monitor, is_repairing=operation.repair)
