"""The commands that kill operations and fill disks, on a few cases."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from tests.reliability.full_disk import can_make_disks


def _command(module: str, *words: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", f"tests.reliability.{module}", *map(str, words)],
        capture_output=True,
        text=True,
        check=False,
    )


def test_operations_that_are_killed_are_done_or_not(tmp_path: Path) -> None:
    done = _command("kills", tmp_path, "--kills", 6, "--of", "operations")
    assert done.stdout.endswith("{'operations': 6, 'wrong': 0}\n"), done.stdout + done.stderr
    assert done.returncode == 0


def test_a_disk_that_is_full_ends_in_one_sentence_and_loses_nothing(tmp_path: Path) -> None:
    done = _command("full_disk", tmp_path, "--only", "undo", "--tries", 6)
    assert (done.returncode == 0) == can_make_disks(), done.stdout + done.stderr
    assert "wrong" not in done.stdout
