"""Too little memory, too few open files, a folder for a file: one sentence and status 2."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from app.cli.terminal import BAD_INPUT, end_with_status, run_in_terminal

_LIMITED = """
import resource, runpy, sys
kind, limit = getattr(resource, sys.argv[1]), int(sys.argv[2])
resource.setrlimit(kind, (limit, limit))
sys.argv = ["zuka", "info", sys.argv[3]]
runpy.run_module("app", run_name="__main__")
"""


@pytest.mark.parametrize(
    ("kind", "limit", "place"),
    [("RLIMIT_AS", 600 * 1024**2, "ulimit -v"), ("RLIMIT_NOFILE", 14, "ulimit -n")],
)
def test_what_the_system_allows_too_little_of_is_named(
    kind: str, limit: int, place: str, sample_street: Path
) -> None:
    done = subprocess.run(
        [sys.executable, "-c", _LIMITED, kind, str(limit), str(sample_street / "left.laz")],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == BAD_INPUT
    (line,) = done.stderr.splitlines()
    assert line.split(" | ")[1] == place
    assert done.stdout == ""


def test_memory_that_runs_out_is_no_defect(capsys: pytest.CaptureFixture[str]) -> None:
    def take_too_much() -> int:
        raise MemoryError("Unable to allocate 3.00 MiB")

    assert end_with_status(take_too_much) == BAD_INPUT
    assert capsys.readouterr().err.startswith("There is not enough memory for this. | Unable")


def test_a_folder_for_a_file_is_told(
    sample_street: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run_in_terminal(["info", str(sample_street)]) == BAD_INPUT
    assert capsys.readouterr().err.startswith("This is a folder, and a file is asked for. | ")
