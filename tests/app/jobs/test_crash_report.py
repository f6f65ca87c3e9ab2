"""A window that crashes or is killed leaves a report; one that ends or still lasts does not."""

from __future__ import annotations

import signal
import subprocess
import sys
from pathlib import Path

from app.jobs.crash_report import NotedRun, report_broken_runs

_RUN = """
import ctypes, sys
from pathlib import Path
from app.jobs.crash_report import NotedRun
run = NotedRun(Path(sys.argv[1]))
print("begun", flush=True)
{ending}
"""


def _begin(folder: Path, ending: str) -> subprocess.Popen[str]:
    process = subprocess.Popen(
        [sys.executable, "-c", _RUN.format(ending=ending), str(folder)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "begun\n"
    return process


def test_a_crash_leaves_what_the_threads_did(tmp_path: Path) -> None:
    process = _begin(tmp_path, "ctypes.string_at(0)")
    process.communicate()
    assert process.returncode == -signal.SIGSEGV
    (report,) = report_broken_runs(tmp_path)
    text = report.read_text(encoding="utf-8")
    assert "Segmentation fault" in text
    assert "string_at" in text
    assert report_broken_runs(tmp_path) == ()


def test_a_killed_run_is_told_once_it_no_longer_lasts(tmp_path: Path) -> None:
    process = _begin(tmp_path, "sys.stdin.read()")
    assert report_broken_runs(tmp_path) == ()
    process.kill()
    process.communicate()
    (report,) = report_broken_runs(tmp_path)
    assert "it was killed" in report.read_text(encoding="utf-8")


def test_a_proper_end_leaves_nothing(tmp_path: Path) -> None:
    process = _begin(tmp_path, "run.end()")
    process.communicate()
    assert process.returncode == 0
    assert list(tmp_path.iterdir()) == []


def test_ten_reports_are_kept(tmp_path: Path) -> None:
    for number in range(14):
        (tmp_path / f"{number:02}.trace").write_text("Zuka\nFatal", encoding="utf-8")
    assert report_broken_runs(tmp_path)
    assert len(list(tmp_path.glob("crash-*.txt"))) == 10


def test_a_folder_that_cannot_be_written_stops_nobody(tmp_path: Path) -> None:
    occupied = tmp_path / "runs"
    occupied.write_text("a file", encoding="utf-8")
    NotedRun(occupied).end()
    assert report_broken_runs(occupied) == ()
