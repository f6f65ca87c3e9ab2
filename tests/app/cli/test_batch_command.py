"""``zuka batch`` tells what came of each drive, and its exit status says whether all went well."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.cli.terminal import BAD_INPUT, run_in_terminal
from tests.processing.operations.batch.job_files import HEAD, IMPORT, NOISE, deliver, write_job


def test_drives_that_failed_are_told_at_the_end(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    deliver(tmp_path, ["a", "b"])
    (tmp_path / "drives" / "b" / "cloud.las").write_bytes(b"LASF and no more")
    assert run_in_terminal(["batch", str(write_job(tmp_path, HEAD + IMPORT))]) == BAD_INPUT
    said = capsys.readouterr()
    assert said.out.splitlines()[0] == "1 of 2 done, 1 failed"
    assert said.out.splitlines()[1].endswith("index.html")
    assert "| b: " in said.err.splitlines()[-1]


def test_a_bad_job_is_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write_job(tmp_path, HEAD + IMPORT + NOISE.replace('"noise"', '"nose"', 1))
    assert run_in_terminal(["batch", str(path)]) == BAD_INPUT
    (line,) = capsys.readouterr().err.splitlines()
    assert "no such tool" in line
    assert "steps[2]" in line
