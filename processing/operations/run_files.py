"""What a tool's run gives, written to files: found things, or the points of the delivered files."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path

from processing.core.monitor import Monitor, PartMonitor
from processing.core.safe_write import refuse_inputs, write_safely
from processing.core.scratch_folder import scratch_folder
from processing.core.text import Language, Text
from processing.formats.format import Content
from processing.formats.registry import FORMATS
from processing.formats.vectors.feature_files import write_feature_file
from processing.map.feature import Feature
from processing.methods.ground.stored_surface import StoredSurface
from processing.operations.inputs import OpenedInputs
from processing.project.results.found_features import found_features
from processing.project.results.point_results import check_point_output, write_point_results
from processing.project.results.surface_files import (
    surface_beside,
    surface_file_of,
    write_surface_content,
)
from processing.recording.drive import Drive
from processing.tools.running.run_shares import RunShare, run_shares
from processing.tools.running.runner import run, run_together
from processing.tools.tool import CandidateResult, FinishedColumns, Tool

_RUNNING = 0.8
_NOTE = Text("{tool}: {note}", "{tool}: {note}")


def write_run(
    tool: Tool,
    parameters: object,
    opened: OpenedInputs,
    output: Path,
    monitor: Monitor,
    *,
    language: Language | None = None,
) -> tuple[Path, ...]:
    """Run a tool on all drives that are chosen and write what it gives.

    Parameters
    ----------
    parameters : object
        An instance of the tool's own parameter class.
    output : Path
        A file of features for a tool that finds, else LAS or LAZ.
    language : "en", "ja" or None
        Of the headers of a table of features.

    Returns
    -------
    tuple of Path
        All are written, or none.

    Raises
    ------
    UserError, Cancelled
        Nothing was written.
    """
    wanted = surface_file_of(parameters)
    if tool.gives_candidates:
        refuse_inputs(output, opened.delivered)
    else:
        check_point_output(opened.drives, output, monitor)
    if wanted is not None:
        refuse_inputs(wanted, opened.delivered)
    with scratch_folder(output.parent) as scratch:
        job = _Job(tool, parameters, opened, output, scratch, language)
        return (_found if tool.gives_candidates else _points)(job, monitor)


@dataclass(frozen=True)
class _Job:
    """What is run on what, and where the result goes."""

    tool: Tool
    parameters: object
    opened: OpenedInputs
    output: Path
    scratch: Path
    language: Language | None

    def shares(self, monitor: Monitor) -> Iterator[tuple[RunShare, Path]]:
        """The runs, each with a folder of its own."""
        running = PartMonitor(monitor, 0.0, _RUNNING)
        chosen, beside = self.opened.chosen, self.opened.beside
        shares = run_shares(self.tool.id, chosen, self.parameters, running, beside=beside)
        for number, share in enumerate(shares):
            yield share, self.scratch / str(number)


def _found(job: _Job, monitor: Monitor) -> tuple[Path, ...]:
    """What a tool finds on each drive, as one file."""
    features: list[Feature] = []
    for share, into in job.shares(monitor):
        started = datetime.now(UTC)
        result = run(share.request, share.monitor, into=into)
        if isinstance(result, CandidateResult):
            _report(job.tool, result.note, share.monitor)
            result = _for_file(result, job.output)
            times = {"started": started, "finished": datetime.now(UTC)}
            ids = [drive.id for drive in share.drives]
            found = found_features(result, job.tool, job.parameters, ids, **times)
            features.extend(found.change.added)
    write_feature_file(
        job.output,
        features,
        job.opened.catalogue,
        job.opened.crs,
        monitor=PartMonitor(monitor, _RUNNING, 1.0),
        never=job.opened.delivered,
        language=job.language,
    )
    return (job.output,)


def _for_file(result: CandidateResult, output: Path) -> CandidateResult:
    """What goes into a file: a drawing has all, other files what was found."""
    if Content.DRAWING in FORMATS.format_to_write(output, Content.FEATURES).writes:
        return result
    kept = tuple(one for one in result.candidates if not one.is_drawing)
    return replace(result, candidates=kept)


def _report(tool: Tool, note: Text, monitor: Monitor) -> None:
    if note.en:
        monitor.report(1.0, _NOTE.filled(tool=tool.name, note=note))


def _points(job: _Job, monitor: Monitor) -> tuple[Path, ...]:
    """What a tool says about points, beside the points of each file; surfaces where wanted."""
    wanted, never = surface_file_of(job.parameters), job.opened.delivered
    columns: dict[str, FinishedColumns] = {}
    surfaces: list[tuple[Drive, Path]] = []
    for share, into in job.shares(monitor):
        result = run_together(share.request, share.monitor, into=into)
        _report(job.tool, result.note, share.monitor)
        columns |= {one.id: found for one, found in zip(share.drives, result.columns, strict=True)}
        surfaces.extend((share.drives[0], path) for path in result.kept)
    with ExitStack() as whole:
        for path, surface in _surface_files(wanted, surfaces):
            temporary = whole.enter_context(write_safely(path, never=never))
            write_surface_content(StoredSurface(surface), temporary, monitor)
        pairs = [(drive, columns[drive.id]) for drive in job.opened.drives]
        return write_point_results(pairs, job.output, PartMonitor(monitor, _RUNNING, 1.0))


def _surface_files(
    wanted: Path | None, surfaces: list[tuple[Drive, Path]]
) -> Iterator[tuple[Path, Path]]:
    """A file for each surface; where there are several, the name of a drive is added."""
    if wanted is None:
        return
    for drive, surface in surfaces:
        yield wanted if len(surfaces) == 1 else surface_beside(wanted, drive), surface
