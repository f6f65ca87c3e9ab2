"""What a terminal that isn't UTF-8 gets: every command ends as it does with one that is."""

from __future__ import annotations

import io
import json
import logging
import os
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from laspy import LasData, LasHeader

from app.__main__ import main
from app.cli.terminal import BAD_INPUT, DONE
from app.jobs.error_log import log_path
from processing.core.errors import BadFile
from processing.formats.vectors.mapped_shapes import read_mapped
from processing.project.project import Project
from tests.builders import simulated_drive, write_laz

COMMANDS = (
    *("", "open", "demo", "info", "tools", "score", "bench", "import", "run", "study", "image"),
    *("export", "simulate", "simulate street", "simulate site", "simulate density"),
)
NOT_IN_CP932 = "橋é한글.las"
NO_TEXT = os.fsdecode(b"street\xff\x83.las")


@dataclass
class Terminal:
    """Standard output and error with an encoding of their own."""

    monkeypatch: pytest.MonkeyPatch
    encoding: str

    def run(self, *arguments: str | Path) -> tuple[int, str, str]:
        streams = [io.TextIOWrapper(io.BytesIO(), self.encoding) for _ in range(2)]
        with self.monkeypatch.context() as patch:
            patch.setattr(sys, "stdout", streams[0])
            patch.setattr(sys, "stderr", streams[1])
            patch.setattr(sys, "argv", ["zuka", *map(str, arguments)])
            try:
                status = main()
            except SystemExit as end:  # how argparse leaves after a help
                status = int(str(end.code))
            finally:
                for handler in logging.getLogger("zuka").handlers:
                    handler.close()
        out, err = (self._written(stream) for stream in streams)
        return status, out, err

    def _written(self, stream: io.TextIOWrapper) -> str:
        stream.seek(0)
        return stream.buffer.read().decode(self.encoding)


@pytest.fixture(params=["cp932", "ascii", "utf-8"])
def terminal(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> Terminal:
    return Terminal(monkeypatch, request.param)


@pytest.fixture(params=["ja", "en"])
def language(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.setenv("ZUKA_LANGUAGE", request.param)
    return str(request.param)


def write_las(path: Path) -> Path:
    header = LasHeader(point_format=6, version="1.4")
    las = LasData(header)
    las.x = las.y = las.z = np.arange(4.0)
    with path.open("wb") as file:
        las.write(file)
    return path


@pytest.mark.usefixtures("language")
def test_the_help_of_every_command_is_shown(terminal: Terminal) -> None:
    for command in COMMANDS:
        status, out, err = terminal.run(*command.split(), "--help")
        assert (command, status, err) == (command, DONE, "")
        assert "usage: zuka" in out


def test_signs_of_our_own_sentences_read_on_where_they_are_lacking(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    reported = {
        encoding: Terminal(monkeypatch, encoding).run("simulate", "--help")[1]
        for encoding in ("utf-8", "cp932")
    }
    assert "points/m² beside a vehicle" in reported["utf-8"]
    assert "points/m2 beside a vehicle" in reported["cp932"]


@pytest.mark.usefixtures("language")
@pytest.mark.parametrize("name", [NOT_IN_CP932, NO_TEXT])
def test_a_cloud_is_described_whatever_its_name(
    terminal: Terminal, tmp_path: Path, name: str
) -> None:
    path = write_las(tmp_path / name)
    status, out, err = terminal.run("info", path)
    assert (status, err) == (DONE, "")
    assert "points: 4" in out
    status, out, err = terminal.run("info", path, "--json")
    assert (status, err) == (DONE, "")
    # It is JSON in every encoding, and leads to the file.
    assert json.loads(out)["points"] == 4
    status, out, err = terminal.run("info", path.with_suffix(".laz"))
    assert (status, out) == (BAD_INPUT, "")
    assert err.count("\n") == 1
    log = log_path().read_text(encoding="utf-8").splitlines()[-1]
    assert path.stem.encode("utf-8", "backslashreplace").decode() in log


@pytest.mark.usefixtures("language")
def test_tables_of_scores_are_shown(terminal: Terminal, tmp_path: Path) -> None:
    path = write_las(tmp_path / NOT_IN_CP932)
    status, out, err = terminal.run("score", "ground", path, path)
    assert (status, err.strip()) == (DONE, "100 %")
    assert out.isascii() or terminal.encoding != "ascii"


@pytest.mark.usefixtures("language")
def test_arguments_that_are_not_understood_are_told(terminal: Terminal) -> None:
    for arguments in (["info", "--" + NO_TEXT], ["run", "noise", NOT_IN_CP932, "--bad", NO_TEXT]):
        status, out, err = terminal.run(*arguments)
        assert (status, out) == (BAD_INPUT, "")
        assert err.count("\n") == 1


def test_json_is_made_ascii_only_where_it_has_to_be(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    path = write_las(tmp_path / NOT_IN_CP932)
    names = {}
    for encoding in ("utf-8", "cp932"):
        _, out, _ = Terminal(monkeypatch, encoding).run("score", "ground", path, path, "--json")
        names[encoding] = out
        assert json.loads(out)["result"] == str(path)
    assert "한글" in names["utf-8"]
    assert "\\ud55c\\uae00" in names["cp932"]


def test_a_delivered_file_whose_name_is_no_text_is_imported(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    path = write_laz(simulated_drive(1), tmp_path / "street.laz").rename(tmp_path / NO_TEXT)
    terminal = Terminal(monkeypatch, "cp932")
    status, out, err = terminal.run("import", tmp_path / "p.zuka", path)
    assert status == DONE, err
    assert "street??" in out
    with_source = Project.open(tmp_path / "p.zuka", writing=False)
    (drive,) = with_source.drives
    assert [one.path for one in drive.info.sources] == [str(path)]
    assert drive.info.name == "street??"
    with_source.close()


def test_what_a_library_needs_a_text_for_is_refused_in_one_sentence(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    terminal = Terminal(monkeypatch, "cp932")
    status, _, err = terminal.run("import", tmp_path / NO_TEXT, write_las(tmp_path / "a.las"))
    assert status == BAD_INPUT
    assert "is not text in UTF-8" in err
    assert "street\\xff\\x83.las" in err
    assert not (tmp_path / NO_TEXT).exists()
    package = (tmp_path / NO_TEXT).with_suffix(".gpkg")
    package.write_bytes(b"SQLite format 3\0")
    with pytest.raises(BadFile, match="is not text in UTF-8"):
        read_mapped(package)
