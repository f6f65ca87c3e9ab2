"""Jobs: long work in the background, with progress, time left and a way out."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from datetime import datetime
from enum import Enum
from queue import SimpleQueue
from uuid import uuid4

from PySide6.QtCore import QObject, Qt, Signal, SignalInstance

from app.jobs.error_log import defect_of, log_user_error
from processing.core.errors import Cancelled, Interrupted, UserError
from processing.core.monitor import Monitor
from processing.core.text import Text

JobFunction = Callable[[Monitor], object]


class JobLane(Enum):
    """Which thread a job waits for."""

    ASKED = "asked"
    """What the user asked for, one after the other."""
    PREPARED = "prepared"
    """What nobody waits for: it pauses while there is something to do in the other lanes."""
    STEPS = "steps"
    """What takes its time of what the user did to the map: labels of many points, and undo."""
    INTERACTIVE = "at hand"
    """What the mouse waits for: a moment's work, told to nobody unless it fails."""


_GO_FIRST = JobLane.ASKED, JobLane.STEPS, JobLane.INTERACTIVE
_PAUSE_S = 0.05


class JobState(Enum):
    """What became of a job."""

    WAITING = "waiting"
    RUNNING = "running"
    FINISHED = "finished"
    FAILED = "failed"
    CANCELLED = "cancelled"


@dataclass(frozen=True)
class JobStatus:
    """A job as people see it.

    Attributes
    ----------
    fraction : float
        0 to 1.
    seconds_left : float or None
        None while it isn't known.
    error : UserError or None
        Why it failed.
    is_asked : bool
        Whether the user asked for it, and did not get it while doing something else.
    started_at : datetime or None
        When it began; None while it waits.
    seconds : float
        How long it took; 0 until it is over.
    result : Text
        What it made, in one sentence; empty while that isn't known.
    """

    id: str
    title: Text
    state: JobState = JobState.WAITING
    fraction: float = 0.0
    text: Text = Text("", "")
    seconds_left: float | None = None
    error: UserError | None = None
    is_asked: bool = True
    started_at: datetime | None = None
    seconds: float = 0.0
    result: Text = Text("", "")

    @property
    def is_over(self) -> bool:
        """Whether it has ended in one way or another."""
        return self.state not in (JobState.WAITING, JobState.RUNNING)


class _Stop:
    """How a job learns that it should stop, and whether it is given up or may go on one day."""

    def __init__(self) -> None:
        self._event = threading.Event()
        self._reason: type[Cancelled] = Cancelled

    def ask(self, reason: type[Cancelled]) -> None:
        """Ask the job to stop; what was asked first holds."""
        if not self._event.is_set():
            self._reason = reason
            self._event.set()

    def wait(self, seconds: float) -> bool:
        """Wait, until it is asked to stop at the latest; says whether it is."""
        return self._event.wait(seconds)

    def check(self) -> None:
        """Raise what the job was asked to stop by."""
        if self._event.is_set():
            raise self._reason


@dataclass(frozen=True)
class _Task:
    id: str
    work: JobFunction
    stop: _Stop


class JobQueue(QObject):
    """Runs jobs in a thread for each lane, in each one after the other.

    Every job ends with exactly one of ``finished``,
    ``failed``, ``cancelled``, on the queue's own thread, which is the window's.
    """

    changed = Signal(object)  # JobStatus
    finished = Signal(str, object)  # id, what the work gave
    failed = Signal(str, object)  # id, UserError
    cancelled = Signal(str)  # id
    forgotten = Signal(str)  # id

    _progressed = Signal(str, float, object)
    _started = Signal(str)
    _ended = Signal(str, object, object)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._statuses: dict[str, JobStatus] = {}
        self._stops: dict[str, _Stop] = {}
        self._started_at: dict[str, float] = {}
        self._lanes: dict[JobLane, SimpleQueue[_Task | None]] = {
            lane: SimpleQueue() for lane in JobLane
        }
        self._quiet: set[str] = set()
        self._leaving: set[str] = set()
        queued = Qt.ConnectionType.QueuedConnection
        self._progressed.connect(self._on_worker_progressed, queued)
        self._started.connect(self._on_worker_started, queued)
        self._ended.connect(self._on_worker_ended, queued)
        self._at_work = {lane: threading.Event() for lane in JobLane}
        self._threads = [
            threading.Thread(target=self._run_tasks, args=(lane,), name="jobs", daemon=True)
            for lane in JobLane
        ]
        for thread in self._threads:
            thread.start()

    @property
    def statuses(self) -> tuple[JobStatus, ...]:
        """All jobs of this session that people see, oldest first."""
        return tuple(one for one in self._statuses.values() if one.id not in self._quiet)

    @property
    def asked_at_work(self) -> tuple[JobStatus, ...]:
        """Those that the user asked for and that are not over."""
        return tuple(one for one in self.statuses if one.is_asked and not one.is_over)

    @property
    def is_busy(self) -> bool:
        """Whether a job is running or waiting."""
        return bool(self._stops)

    def start(self, title: Text, work: JobFunction, *, lane: JobLane = JobLane.ASKED) -> str:
        """Queue a job; gives its id.

        Parameters
        ----------
        work : callable
            Called in a worker thread with a monitor; touches no widget and no project.
        lane : JobLane
        """
        task = _Task(uuid4().hex, work, _Stop())
        self._stops[task.id] = task.stop
        if lane is JobLane.INTERACTIVE:
            self._quiet.add(task.id)
        self._report(JobStatus(task.id, title, is_asked=lane is JobLane.ASKED))
        self._lanes[lane].put(task)
        return task.id

    def cancel(self, job: str) -> None:
        """Ask a job to stop; a job that has ended is left alone."""
        if job in self._stops:
            self._stops[job].ask(Cancelled)

    def interrupt(self, job: str) -> None:
        """As :meth:`cancel`, but work that can go on another day keeps what is done."""
        if job in self._stops:
            self._stops[job].ask(Interrupted)

    def note_result(self, job: str, result: Text) -> None:
        """Say what a job made, for those who look at the list later."""
        if job in self._statuses:
            self._report(replace(self._statuses[job], result=result))

    def forget(self, job: str) -> None:
        """Take a job off the list, at its end where it is not over."""
        if job in self._stops:
            self._leaving.add(job)
        elif job in self._statuses:
            del self._statuses[job]
            self.forgotten.emit(job)

    def close(self) -> None:
        """Interrupt everything and wait for the workers."""
        for stop in self._stops.values():
            stop.ask(Interrupted)
        for tasks in self._lanes.values():
            tasks.put(None)
        for thread in self._threads:
            thread.join()

    def _run_tasks(self, lane: JobLane) -> None:
        goes_first = () if lane is not JobLane.PREPARED else _GO_FIRST
        before = tuple(self._at_work[other] for other in goes_first)
        while (task := self._lanes[lane].get()) is not None:
            self._started.emit(task.id)
            self._at_work[lane].set()
            monitor = _JobMonitor(self._progressed, task, before)
            result: object = None
            error: BaseException | None = None
            try:
                monitor.check()
                result = task.work(monitor)
            except (Cancelled, UserError) as refusal:
                error = refusal
            except Exception as defect:  # noqa: BLE001 - a job's last stop: told and logged
                error = defect_of(defect)
            self._at_work[lane].clear()
            self._ended.emit(task.id, result, error)

    def _on_worker_started(self, job: str) -> None:
        self._started_at[job] = time.monotonic()
        now = datetime.now().astimezone()
        self._report(replace(self._statuses[job], state=JobState.RUNNING, started_at=now))

    def _on_worker_progressed(self, job: str, fraction: float, text: Text | None) -> None:
        status = self._statuses[job]
        passed = time.monotonic() - self._started_at.get(job, time.monotonic())
        # The first second says little about the rest.
        left = passed * (1 - fraction) / fraction if fraction > 0.02 and passed > 1.0 else None
        self._report(
            replace(status, fraction=fraction, text=text or status.text, seconds_left=left)
        )

    def _on_worker_ended(self, job: str, result: object, error: BaseException | None) -> None:
        del self._stops[job]
        if error is not None:
            self._quiet.discard(job)
        began = self._started_at.pop(job, time.monotonic())
        status = replace(self._statuses[job], seconds_left=None, seconds=time.monotonic() - began)
        if error is None:
            self._report(replace(status, state=JobState.FINISHED, fraction=1.0))
            self.finished.emit(job, result)
        elif isinstance(error, UserError):
            log_user_error(error)
            self._report(replace(status, state=JobState.FAILED, error=error))
            self.failed.emit(job, error)
        else:
            self._report(replace(status, state=JobState.CANCELLED))
            self.cancelled.emit(job)
        if job in self._quiet:
            self._quiet.discard(job)
            del self._statuses[job]
        if job in self._leaving:
            self._leaving.discard(job)
            self.forget(job)

    def _report(self, status: JobStatus) -> None:
        self._statuses[status.id] = status
        if status.id not in self._quiet and status.id not in self._leaving:
            self.changed.emit(status)


class _JobMonitor:
    """What a job's work talks to: progress is passed on when it moved by a tenth of a percent.

    Parameters
    ----------
    before : tuple of Event
        While one of them is set, the work pauses where it checks.
    """

    def __init__(
        self, progressed: SignalInstance, task: _Task, before: tuple[threading.Event, ...]
    ) -> None:
        self._progressed = progressed
        self._task = task
        self._before = before
        self._reported = -1.0

    def report(self, fraction: float, text: Text | None = None) -> None:
        if text is not None or fraction >= self._reported + 0.001 or fraction < self._reported:
            self._reported = fraction
            self._progressed.emit(self._task.id, fraction, text)

    def check(self) -> None:
        while any(event.is_set() for event in self._before):
            if self._task.stop.wait(_PAUSE_S):
                break
        self._task.stop.check()
