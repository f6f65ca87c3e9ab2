"""Where there is no screen a sentence says so, and work without a person goes on all the same."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]


def _zuka(*arguments: str, folders: str) -> subprocess.CompletedProcess[str]:
    hidden = ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM")
    bare = {name: value for name, value in os.environ.items() if name not in hidden}
    return subprocess.run(
        [sys.executable, "-m", "app", *arguments],
        env={**bare, "PATH": folders, "LANG": "C.UTF-8"},
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )


def test_a_window_without_a_screen_is_refused_in_a_sentence() -> None:
    ended = _zuka(folders=os.environ["PATH"])
    assert ended.returncode == 2
    assert len(ended.stderr.splitlines()) == 1
    assert "DISPLAY" in ended.stderr


def test_the_demo_without_a_person_asks_for_what_makes_a_virtual_screen(tmp_path: Path) -> None:
    ended = _zuka("demo", "--headless", "--out", str(tmp_path / "out"), folders=str(tmp_path))
    assert ended.returncode == 2
    assert "xvfb" in ended.stderr
    assert not (tmp_path / "out").exists()


def test_the_demo_without_a_person_starts_again_on_a_virtual_screen(tmp_path: Path) -> None:
    stand_in = tmp_path / "xvfb-run"
    stand_in.write_text('#!/bin/sh\necho "$@"\n')
    stand_in.chmod(0o755)
    folders = f"{tmp_path}{os.pathsep}{os.environ['PATH']}"
    ended = _zuka("demo", "--headless", "--out", "出力", folders=folders)
    assert ended.returncode == 0
    assert ended.stdout.rstrip().endswith("-P -m app demo --headless --out 出力")
