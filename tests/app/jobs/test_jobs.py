"""Jobs end exactly once, on the window's thread, and can be stopped in the middle."""

import threading

import pytest

from app.jobs.jobs import JobLane, JobQueue, JobState
from processing.core.errors import BadFile, Cancelled, Interrupted
from processing.core.text import Text

TITLE = Text("Work", "作業")
ENDINGS = {JobState.FINISHED, JobState.FAILED, JobState.CANCELLED}


@pytest.fixture
def jobs(qapp, tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    queue = JobQueue()
    yield queue
    queue.close()


def _endings(queue):
    seen = []
    queue.changed.connect(lambda status: seen.append(status) if status.state in ENDINGS else None)
    return seen


def test_a_finished_job_gives_its_result_on_the_thread_of_the_window(qtbot, jobs):
    endings = _endings(jobs)
    threads = []
    jobs.finished.connect(lambda *_: threads.append(threading.current_thread()))
    with qtbot.waitSignal(jobs.finished) as reported:
        job = jobs.start(TITLE, lambda monitor: 42)
    assert reported.args == [job, 42]
    assert threads == [threading.main_thread()]
    assert [status.state for status in endings] == [JobState.FINISHED]
    assert not jobs.is_busy


def test_progress_is_told_with_its_words(qtbot, jobs):
    words = Text("half", "半分")
    reported = []
    jobs.changed.connect(lambda status: reported.append((status.fraction, status.text)))
    with qtbot.waitSignal(jobs.finished, timeout=30_000):
        jobs.start(TITLE, lambda monitor: monitor.report(0.5, words))
    assert (0.5, words) in reported


def test_a_job_cancelled_in_the_middle_is_told_as_cancelled_and_gives_nothing(qtbot, jobs):
    running = threading.Event()

    def work(monitor):
        running.set()
        while True:
            monitor.check()

    finished = []
    jobs.finished.connect(lambda *args: finished.append(args))
    job = jobs.start(TITLE, work)
    assert running.wait(10)
    with qtbot.waitSignal(jobs.cancelled) as reported:
        jobs.cancel(job)
    assert reported.args == [job]
    assert not finished


@pytest.mark.parametrize(
    ("ask", "reason"), [("cancel", Cancelled), ("interrupt", Interrupted), ("close", Interrupted)]
)
def test_work_learns_whether_it_is_given_up_or_may_go_on_another_day(qapp, ask, reason):
    queue, running, seen = JobQueue(), threading.Event(), []

    def work(monitor):
        running.set()
        try:
            while True:
                monitor.check()
        except Cancelled as asked:
            seen.append(type(asked))
            raise

    job = queue.start(TITLE, work)
    assert running.wait(30)
    getattr(queue, ask)(*() if ask == "close" else (job,))
    queue.close()
    assert seen == [reason]


def test_a_waiting_job_can_be_cancelled_before_it_starts(qtbot, jobs):
    gate = threading.Event()
    started = []
    jobs.start(TITLE, lambda monitor: gate.wait(10))
    waiting = jobs.start(TITLE, lambda monitor: started.append(True))
    jobs.cancel(waiting)
    with qtbot.waitSignal(jobs.cancelled, timeout=30_000):
        gate.set()
    assert not started


def test_what_is_prepared_does_not_hold_up_what_is_asked_for(qtbot, jobs):
    gate = threading.Event()
    jobs.start(TITLE, lambda monitor: gate.wait(10), lane=JobLane.PREPARED)
    with qtbot.waitSignal(jobs.finished) as reported:
        asked = jobs.start(TITLE, lambda monitor: "asked")
    assert reported.args == [asked, "asked"]
    with qtbot.waitSignal(jobs.finished, timeout=30_000):
        gate.set()


def test_what_the_user_can_mend_is_told_in_its_three_parts(qtbot, jobs):
    error = BadFile(Text.same("what"), Text.same("where"), Text.same("remedy"))

    def work(monitor):
        raise error

    with qtbot.waitSignal(jobs.failed) as reported:
        job = jobs.start(TITLE, work)
    assert reported.args == [job, error]


def test_a_defect_is_told_in_one_sentence_and_logged(qtbot, jobs):
    with qtbot.waitSignal(jobs.failed) as reported:
        jobs.start(TITLE, lambda monitor: 1 / 0)
    assert "ZeroDivisionError" in reported.args[1].line("en")
    assert "\n" not in reported.args[1].line("ja")


@pytest.mark.parametrize("lane", [JobLane.ASKED, JobLane.INTERACTIVE])
def test_what_nobody_waits_for_pauses_while_something_was_asked_for(qtbot, jobs, lane):
    order = []
    started, asked, may_end = threading.Event(), threading.Event(), threading.Event()

    def prepare(monitor):
        started.set()
        asked.wait(30)
        monitor.check()
        order.append("prepared")

    def do(monitor):
        asked.set()
        may_end.wait(30)
        order.append("asked")

    jobs.start(TITLE, prepare, lane=JobLane.PREPARED)
    assert started.wait(30)
    jobs.start(TITLE, do, lane=lane)
    assert asked.wait(30)
    with qtbot.waitSignals([jobs.finished, jobs.finished], timeout=30_000):
        may_end.set()
    assert order == ["asked", "prepared"]


def test_a_job_that_pauses_can_be_cancelled(qtbot, jobs):
    started, asked, may_end = threading.Event(), threading.Event(), threading.Event()

    def prepare(monitor):
        started.set()
        asked.wait(30)
        monitor.check()

    def do(monitor):
        asked.set()
        may_end.wait(30)

    prepared = jobs.start(TITLE, prepare, lane=JobLane.PREPARED)
    assert started.wait(30)
    jobs.start(TITLE, do)
    assert asked.wait(30)
    with qtbot.waitSignal(jobs.cancelled, timeout=30_000) as reported:
        jobs.cancel(prepared)
    assert reported.args == [prepared]
    may_end.set()
