"""What ``zuka score`` answers, for tests of the command."""

from __future__ import annotations

import json
from typing import Any

import pytest

from app.cli.terminal import BAD_INPUT, DONE, run_in_terminal


def scored(capsys: pytest.CaptureFixture[str], *arguments: object) -> dict[str, Any]:
    assert run_in_terminal(["score", *map(str, arguments), "--json"]) == DONE
    reported: dict[str, Any] = json.loads(capsys.readouterr().out)
    return reported


def refused(capsys: pytest.CaptureFixture[str], *arguments: object) -> str:
    assert run_in_terminal(["score", *map(str, arguments)]) == BAD_INPUT
    written = capsys.readouterr()
    assert written.out == ""
    # Progress comes before it; what is wrong is the last line, and one line.
    line = written.err.rstrip("\n").splitlines()[-1]
    assert line.count(" | ") == 2
    return line
