"""A job from its file to its results: drives dealt to workers, watched, told at the end by name."""

from __future__ import annotations

import os
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Protocol

from filelock import FileLock, Timeout

from processing.core.errors import InUse, UserError, report_as_user_error
from processing.core.monitor import Monitor
from processing.core.text import Language, Text
from processing.operations.batch.cluster import Cluster
from processing.operations.batch.deliveries import BatchDelivery, deliveries_of
from processing.operations.batch.index_map import write_index_map
from processing.operations.batch.job import JobFile, read_job
from processing.operations.batch.job_page import PAGE, BatchStatus, Standing, UnitRow, write_status
from processing.operations.batch.local_workers import LocalWorkers, worker_count
from processing.operations.batch.unit_process import STOP_FILE, order_for
from processing.operations.batch.unit_state import (
    PROGRESS_FILE,
    ErrorWords,
    TaskState,
    UnitProgress,
    UnitState,
    read_progress,
    read_state,
)
from processing.operations.batch.unit_work import BatchUnit, is_finished, units_of
from processing.operations.written_values import Table

_LOCK = ".batch-lock"
_WAIT_S = 0.1
_PAGE_S = 2.0
_LEAST_FRACTION = 0.02
_WORK = Text("Work on the drive", "走行データの処理")


@dataclass(frozen=True)
class BatchOperation:
    """A job to be done.

    Attributes
    ----------
    job : Path
        Its file.
    scheduler : str
        The address of a Dask scheduler; empty for this machine's own processes.
    language : "en" or "ja"
        Of the page.
    """

    job: Path
    scheduler: str = ""
    language: Language = "en"


@dataclass(frozen=True)
class BatchOutcome:
    """What came of a job.

    Attributes
    ----------
    rows : tuple of UnitRow
        By drive, in the order of their names.
    paths : tuple of Path
        The page and the maps of extents.
    """

    rows: tuple[UnitRow, ...]
    paths: tuple[Path, ...]

    @property
    def failed(self) -> tuple[UnitRow, ...]:
        """Those that did not come to a good end."""
        return tuple(one for one in self.rows if one.standing != "done")

    @property
    def has_defect(self) -> bool:
        """Whether the program itself is to blame for one of them."""
        return any(one.state.has_defect for one in self.rows)

    @property
    def words(self) -> tuple[Text, ...]:
        """A line on all of it, and one for each file that tells more."""
        status = BatchStatus("", self.rows)
        return (status.text, *(Text.same(str(path)) for path in self.paths))

    @property
    def errors(self) -> tuple[UserError, ...]:
        """What went wrong, each with the name of its drive."""
        return tuple(
            _of_drive(row.state.name, trouble.error)
            for row in self.rows
            for trouble in row.state.troubles
            if trouble.error is not None
        )


class _Workers(Protocol):
    """Where drives are worked on."""

    @property
    def dashboard(self) -> str: ...

    def ended(self) -> Mapping[str, UnitState | str]: ...

    def close(self) -> None: ...


def run_batch(operation: BatchOperation, monitor: Monitor) -> BatchOutcome:
    """Do a job: what an earlier run has done is not done again, what fails stops no other drive.

    Raises
    ------
    MissingInput, BadFile, OutOfRange
        As :func:`read_job`; a pattern matches nothing; the scheduler does not answer.
    InUse
        The job is being done already.
    Cancelled
        What was noted stays; the next run goes on.
    """
    file = read_job(operation.job)
    return run_deliveries(file, deliveries_of(file), operation, monitor)


def run_deliveries(
    file: JobFile, deliveries: Sequence[BatchDelivery], operation: BatchOperation, monitor: Monitor
) -> BatchOutcome:
    """As :func:`run_batch`, for deliveries that are known.

    Raises
    ------
    InUse, MissingInput, Cancelled
    """
    with report_as_user_error(file.output):
        file.output.mkdir(parents=True, exist_ok=True)
    lock = FileLock(file.output / _LOCK, timeout=0)
    try:
        lock.acquire()
    except Timeout as error:
        raise InUse(
            Text("The job is being done already.", "このジョブはすでに実行中です。"),
            Text.same(str(file.output)),
            Text("Wait for it, or end it.", "終わるのを待つか、終了させてください。"),
        ) from error
    try:
        with report_as_user_error(file.output):
            (file.output / STOP_FILE).unlink(missing_ok=True)
        return _Board(file, units_of(file, deliveries), operation).work(monitor)
    finally:
        lock.release()


class _Board:
    """How the drives of a job stand, while it is done."""

    def __init__(
        self, file: JobFile, units: Sequence[BatchUnit], operation: BatchOperation
    ) -> None:
        self._file = file
        self._operation = operation
        self._units = {one.name: one for one in units}
        self._rows = {one.name: _row_before(one) for one in units}
        self._begun_s: dict[str, float] = {}
        self._started_s = time.monotonic()
        self._done_before = 0.0

    def work(self, monitor: Monitor) -> BatchOutcome:
        """Have all drives worked on that are not finished."""
        left = []
        for unit in self._units.values():
            monitor.check()
            if is_finished(self._file, unit):
                self._settle(unit.name, read_state(unit.folder, unit.name))
            else:
                left.append(unit)
        self._done_before = self._status("").fraction
        for unit in left:
            (unit.folder / PROGRESS_FILE).unlink(missing_ok=True)
        workers = self._workers(left)
        try:
            self._watch(workers, monitor)
        except BaseException:
            with report_as_user_error(self._file.output):
                (self._file.output / STOP_FILE).touch()
            raise
        finally:
            workers.close()
            self._stop_the_rest()
            self._write(workers.dashboard)
        return BatchOutcome(tuple(self._rows.values()), self._files())

    def _workers(self, left: Sequence[BatchUnit]) -> _Workers:
        if self._operation.scheduler:
            cluster = Cluster(self._operation.scheduler)
            cluster.begin(self._orders(left, 1), self._file.output)
            return cluster
        count = max(1, min(worker_count(self._file.job.workers), len(left)))
        own = LocalWorkers(count)
        own.begin(self._orders(left, max(1, (os.cpu_count() or 1) // count)))
        return own

    def _orders(self, units: Sequence[BatchUnit], threads: int) -> list[Table]:
        return [order_for(self._file, one, threads) for one in units]

    def _watch(self, workers: _Workers, monitor: Monitor) -> None:
        written_s = -_PAGE_S
        while any(row.standing in ("waiting", "working") for row in self._rows.values()):
            monitor.check()
            for name, state in workers.ended().items():
                self._settle(name, self._failed(name, state) if isinstance(state, str) else state)
            self._follow()
            if time.monotonic() > written_s + _PAGE_S:
                written_s = time.monotonic()
                self._write(workers.dashboard)
            status = self._status("")
            monitor.report(status.fraction, status.text)
            time.sleep(_WAIT_S)

    def _failed(self, name: str, reason: str) -> UnitState:
        """What can't even be noted with its drive, or died again and again with its worker."""
        what = Text(
            f"The drive was given up: {reason}", f"処理を続けられませんでした（{reason}）。"
        )
        unit = self._units[name]
        again = Text(
            "Look at the folder and the workers, then run the job again.",
            "フォルダとワーカーを確認して、ジョブをもう一度実行してください。",
        )
        words = ErrorWords(what, Text.same(str(unit.folder)), again)
        return UnitState(name, trouble=TaskState("", _WORK, "failed", error=words))

    def _settle(self, name: str, state: UnitState) -> None:
        row = self._rows[name]
        standing: Standing = "done" if state.is_whole and not state.troubles else "failed"
        self._rows[name] = replace(row, state=state, standing=standing, seconds=state.seconds)

    def _follow(self) -> None:
        """See how far those at work are."""
        for name, row in self._rows.items():
            if row.standing not in ("waiting", "working"):
                continue
            progress = read_progress(row.folder)
            if progress == UnitProgress():
                continue
            begun = self._begun_s.setdefault(name, time.monotonic())
            seconds = time.monotonic() - begun
            self._rows[name] = replace(row, standing="working", progress=progress, seconds=seconds)

    def _stop_the_rest(self) -> None:
        for name, row in self._rows.items():
            if row.standing in ("waiting", "working"):
                self._rows[name] = replace(row, standing="stopped")

    def _status(self, dashboard: str) -> BatchStatus:
        status = BatchStatus(self._file.name, tuple(self._rows.values()), dashboard=dashboard)
        done = status.fraction - self._done_before
        if done < _LEAST_FRACTION or status.fraction >= 1.0:
            return status
        passed = time.monotonic() - self._started_s
        return replace(status, left_s=passed * (1.0 - status.fraction) / done)

    def _write(self, dashboard: str) -> None:
        write_status(self._file.output, self._status(dashboard), self._operation.language)

    def _files(self) -> tuple[Path, ...]:
        maps = write_index_map(self._file.output, tuple(self._rows.values()))
        return (self._file.output / PAGE, *maps)


def _row_before(unit: BatchUnit) -> UnitRow:
    return UnitRow(UnitState(unit.name), "waiting", size=unit.size, folder=unit.folder)


def _of_drive(name: str, error: ErrorWords) -> UserError:
    where = Text("{name}: {where}", "{name}: {where}").filled(name=name, where=error.where)
    return UserError(error.what, where, error.remedy)
