"""``zuka check``: its words, its exit status and its JSON."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from app.cli.terminal import BAD_INPUT, DONE, run_in_terminal
from tests.processing.project.labelled import labelled_project


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return labelled_project(tmp_path_factory.mktemp("whole"))


def test_damage_is_listed_repaired_and_gone(
    whole: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    project = Path(shutil.copytree(whole, tmp_path / "p.zuka"))
    assert run_in_terminal(["check", str(project)]) == DONE
    assert "nothing is damaged" in capsys.readouterr().out
    (column,) = project.glob("drives/*/xyz.bin")
    data = bytearray(column.read_bytes())
    data[50:60] = b"0123456789"
    column.write_bytes(data)
    assert run_in_terminal(["run", "curbs", str(project)]) == BAD_INPUT
    assert "xyz.bin, bytes 0" in capsys.readouterr().err
    assert run_in_terminal(["check", str(project)]) == BAD_INPUT
    said = capsys.readouterr()
    assert said.out.startswith("damaged: drives/")
    assert said.err.rstrip("\n").splitlines()[-1].count(" | ") == 2
    assert run_in_terminal(["check", str(project), "--repair"]) == DONE
    assert "Made again from the delivered files." in capsys.readouterr().out
    assert run_in_terminal(["run", "curbs", str(project)]) == DONE


def test_json_names_file_state_fault_and_remedy(
    whole: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    project = Path(shutil.copytree(whole, tmp_path / "p.zuka"))
    (column,) = project.glob("drives/*/classification.bin")
    column.write_bytes(b"1")
    assert run_in_terminal(["check", str(project), "--json"]) == BAD_INPUT
    (finding,) = json.loads(capsys.readouterr().out)["findings"]
    assert finding["file"].endswith("classification.bin")
    assert finding["state"] == "damaged"
    assert all(finding[name] for name in ("what", "remedy"))


def test_a_folder_without_a_project_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run_in_terminal(["check", str(tmp_path)]) == BAD_INPUT
    assert "There is no project here." in capsys.readouterr().err
