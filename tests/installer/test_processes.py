"""Test processes beside each other: as many as cores, each with a screen and threads of its own."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

from installer.commands import processes_for_tests
from tests.conftest import SCREEN, THREADS
from tests.house_rules.sources import ROOT

CONFTEST = "from tests.conftest import pytest_unconfigure, pytest_xdist_setupnodes  # noqa: F401"
TELLS = """
import json, os
from pathlib import Path
import pytest

@pytest.mark.parametrize("number", range(6))
def test_tells_what_its_process_was_given(worker_id, number):
    Path(f"{worker_id}.json").write_text(json.dumps(dict(os.environ)))
"""


def test_there_are_at_least_two_processes_and_no_more_than_memory_bears() -> None:
    assert 2 <= processes_for_tests() <= 6


def test_each_process_has_a_screen_and_its_share_of_the_cores(tmp_path: Path) -> None:
    (tmp_path / "conftest.py").write_text(CONFTEST, encoding="utf-8")
    (tmp_path / "test_tells.py").write_text(TELLS, encoding="utf-8")
    words = ["-q", "-n", "2", "-p", "no:dash", "-p", "no:cacheprovider"]
    answer = subprocess.run(
        [sys.executable, "-m", "pytest", *words, f"--basetemp={tmp_path / 'base'}", "."],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert answer.stdout.splitlines()[-1].startswith("6 passed"), answer.stdout + answer.stderr
    told = [json.loads((tmp_path / f"gw{number}.json").read_text()) for number in range(2)]
    if sys.platform.startswith("linux"):
        screens = {one[SCREEN[0]] for one in told}
        assert len(screens - {os.environ.get(SCREEN[0])}) == 2
    share = str(max(1, (os.cpu_count() or 1) // 2))
    assert {one[name] for one in told for name in THREADS} == {share}
