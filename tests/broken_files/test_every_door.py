"""Damaged files of every format, given to the commands that read them.

A command ends with what it could read, or with one sentence that names the file and a remedy, in
the language that is asked for; nothing is left that wasn't there before. A format that is added to
the registry is missed here until it has a small file of its own.
"""

from __future__ import annotations

import shutil
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest

from app.cli.terminal import BAD_INPUT, DONE, run_in_terminal
from processing.formats.format import Content
from processing.formats.registry import FORMATS
from processing.project.project import Project
from tests.app.volume_command import write_design
from tests.broken_files.every_format import COUNT, SMALL_FILES
from tests.delivered_files import make_las

_BY_WINDOW_ONLY = (Content.CATALOGUE, Content.LIMITS)
_MAGIC, _HEADER = 8, 200


def _empty(_data: bytes) -> bytes:
    return b""


def _only_a_start(data: bytes) -> bytes:
    return data[:7]


def _half(data: bytes) -> bytes:
    return data[: len(data) // 2]


def _zeros(data: bytes) -> bytes:
    return bytes(len(data))


def _other_bytes(data: bytes) -> bytes:
    return np.random.default_rng(1).bytes(len(data))


def _huge_header(data: bytes) -> bytes:
    """The format's mark, then counts, sizes and offsets as large as they can be said."""
    end = min(_HEADER, len(data))
    return data[:_MAGIC] + b"\xff" * (end - _MAGIC) + data[end:]


def _huge_numbers(data: bytes) -> bytes:
    """Every number of a text far too large; a binary file loses single bytes."""
    return data.replace(b"1", b"1e999").replace(b"0.", b"0x")


DAMAGES: tuple[Callable[[bytes], bytes], ...] = (
    _empty,
    _only_a_start,
    _half,
    _zeros,
    _other_bytes,
    _huge_header,
    _huge_numbers,
)
_NEVER_READ = (_empty, _zeros, _other_bytes)
_MAY_BE_ZERO = "pulses"
"""A folder of plain numbers: angles of 0 are angles."""


def _ending(id_: str) -> str:
    return FORMATS[id_].endings[0] if FORMATS[id_].endings else ""


def _command(content: Content, path: Path, beside: Path) -> list[object]:
    """The words of a command that reads a content from a file."""
    out, points = beside / "out", beside / "points.las"
    if content is Content.POINTS:
        return ["import", out, path]
    if content is Content.TRAJECTORY:
        return ["import", out, points, "--trajectory", path, "--crs", "EPSG:6677"]
    if content is Content.IMAGES:
        return ["import", out, points, "--images", path]
    if content is Content.FEATURES:
        # SIMA has no lines, the extended DM doesn't say which edge of a curb one is.
        return ["score", "trees" if path.suffix in (".sim", ".dm") else "curbs", path, path]
    if content is Content.CLASSES:
        return ["score", "noise", points, path]
    volume = ["run", "volume", "--output", out.with_suffix(".json"), "--set", "grid_m=0.5"]
    if content is Content.SURFACE:
        return [*volume, "--before", path, "--after", "6"]
    volume += ["--before", beside / "design.xml", "--after", "6"]
    if content is Content.AREAS:
        return [*volume, "--set", f"boundary={path}"]
    return [*volume, "--set", "method=end-area", "--set", f"line={path}"]


@pytest.fixture
def beside(tmp_path: Path) -> Path:
    """What else the commands need."""
    folder = tmp_path / "beside"
    folder.mkdir()
    make_las(folder / "points.las", count=COUNT)
    write_design(folder / "design.xml", "FH1")
    return folder


def _damaged_file(content: Content, id_: str, folder: Path) -> tuple[Path, Path, bytes]:
    """What a command is given, the file that is damaged in it, and what that holds."""
    path = folder / f"測量 1{_ending(id_)}"
    SMALL_FILES[content, id_](path)
    inside = next(path.glob("*/*")) if path.is_dir() else path
    return path, inside, inside.read_bytes()


def test_every_format_that_a_command_reads_has_a_small_file() -> None:
    read = {
        (content, one.id) for one in FORMATS for content in one.reads if content in _command_reads()
    }
    assert read == SMALL_FILES.keys()


def _command_reads() -> set[Content]:
    return set(Content) - set(_BY_WINDOW_ONLY)


@pytest.mark.parametrize("held", SMALL_FILES, ids=lambda held: f"{held[0].name}-{held[1]}")
def test_a_damaged_file_ends_in_a_result_or_in_one_sentence(
    tmp_path: Path,
    beside: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    held: tuple[Content, str],
) -> None:
    content, id_ = held
    path, inside, whole = _damaged_file(content, id_, tmp_path)
    words = [str(word) for word in _command(content, path, beside)]
    kept = sorted(beside.iterdir())
    assert run_in_terminal(words) == DONE, capsys.readouterr().err
    _forget_new(beside, kept)
    for number, damage in enumerate(DAMAGES):
        language = ("en", "ja")[number % 2]
        monkeypatch.setenv("ZUKA_LANGUAGE", language)
        inside.write_bytes(damage(whole))
        status = run_in_terminal(words)
        said = capsys.readouterr().err.rstrip("\n").splitlines()
        assert status in (DONE, BAD_INPUT), (damage.__name__, said)
        if status == DONE:
            assert damage not in _NEVER_READ or (damage, id_) == (_zeros, _MAY_BE_ZERO)
            _forget_new(beside, kept)
            continue
        _check_sentence(said[-1], path, language)
        _check_nothing_new(beside, kept)


def _check_sentence(line: str, path: Path, language: str) -> None:
    what, where, remedy = line.split(" | ")
    assert path.name in where
    for words in (what, remedy):
        assert any(ord(one) > 0x3000 for one in words) == (language == "ja"), line


def _check_nothing_new(beside: Path, kept: list[Path]) -> None:
    """No output; a project, if one was made, is whole and empty."""
    project = beside / "out"
    if project.is_dir():
        with closing(Project.open(project, writing=False)) as made:
            assert not made.drives
        shutil.rmtree(project)
    assert sorted(beside.iterdir()) == kept


def _forget_new(beside: Path, kept: list[Path]) -> None:
    for path in set(beside.iterdir()) - set(kept):
        if path.is_dir():
            shutil.rmtree(path)
        else:
            path.unlink()
