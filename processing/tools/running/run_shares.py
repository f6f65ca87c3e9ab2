"""A tool on all of some drives: one run for each, or for those that it takes together."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from processing.core.monitor import Monitor, PartMonitor
from processing.recording.drive import Drive
from processing.tools.running.runner import RunRequest, drives_of, run_together, tool_of


@dataclass(frozen=True)
class RunShare:
    """One of the runs after which a tool was on all drives.

    Attributes
    ----------
    request : RunRequest
        For the first of ``drives``, with all others beside it.
    drives : tuple of Drive
        What the run is about, as :func:`processing.tools.running.runner.drives_of` says.
    monitor : Monitor
        Gets this run's share of the progress.
    """

    request: RunRequest
    drives: tuple[Drive, ...]
    monitor: Monitor


def run_shares(
    tool: str,
    drives: Sequence[Drive],
    parameters: object,
    monitor: Monitor,
    *,
    beside: Sequence[Drive] = (),
) -> Iterator[RunShare]:
    """The runs after which a tool was on all of some drives.

    Parameters
    ----------
    drives : sequence of Drive
        That the result is wanted of; each is in exactly one share.
    parameters : object
        An instance of the tool's own parameter class.
    beside : sequence of Drive
        Others of the same street, which a run may be about as well.

    Raises
    ------
    OutOfRange
        There is no such tool.
    """
    everything, left = (*drives, *beside), list(drives)
    while left:
        others = tuple(one for one in everything if one is not left[0])
        request = RunRequest(tool, left[0], parameters, others)
        together = drives_of(request)
        later = [one for one in left if one not in together]
        ends = ((len(drives) - len(one)) / len(drives) for one in (left, later))
        yield RunShare(request, together, PartMonitor(monitor, *ends))
        left = later


def mark_all(
    tool: str,
    drives: Sequence[Drive],
    monitor: Monitor,
    *,
    into: Path,
    parameters: object | None = None,
) -> None:
    """Let a tool say of all points of some drives what it says.

    For drives that were imported for the moment: what is said becomes their columns at once.

    Parameters
    ----------
    into : Path
        A folder on their disk, which needn't exist.
    parameters : object, optional
        An instance of the tool's own parameter class; its own values without.

    Raises
    ------
    Unsuitable, OutOfRange, NoSpace, Cancelled
        As :func:`processing.tools.running.runner.run`.
    """
    asked = tool_of(tool).parameters() if parameters is None else parameters
    for share in run_shares(tool, drives, asked, monitor):
        folder = into / f"{tool}-{share.drives[0].id}"
        result = run_together(share.request, share.monitor, into=folder)
        # The first folder may hold those of the others: it goes last.
        for drive, columns in reversed(list(zip(share.drives, result.columns, strict=True))):
            columns.hand_over(drive.columns)
