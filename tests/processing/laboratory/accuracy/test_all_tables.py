"""One command makes all tables: each is told its own data, and one that fails stops no other."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

import pytest

from processing.laboratory.accuracy import __main__ as tables
from processing.laboratory.accuracy.__main__ import TABLES, AccuracyTable, command_of, main


@pytest.fixture
def data(tmp_path: Path) -> Path:
    for name in ("street_b", "street_a", "earthwork_1", "real/street_labelled"):
        (tmp_path / name / "truth").mkdir(parents=True)
    (tmp_path / "street_without_truth").mkdir()
    (tmp_path / "real" / "trees").mkdir()
    (tmp_path / "real" / "trees" / "oak.laz").touch()
    return tmp_path


@pytest.mark.parametrize("name", list(TABLES))
def test_every_table_has_a_command_of_its_own(name: str) -> None:
    assert importlib.util.find_spec(f"processing.laboratory.{TABLES[name].module}") is not None


def test_a_table_is_told_the_recordings_that_it_needs(data: Path) -> None:
    streets = [str(data / "street_a"), str(data / "street_b")]
    page, pictures = Path("docs/accuracy.md"), Path("pictures")
    trees = command_of(TABLES["trees"], data, page, pictures)
    assert trees[1:] == [
        *("-m", "processing.laboratory.accuracy.road.trees", "--samples", *streets),
        *("--real", str(data / "real" / "trees" / "oak.laz")),
        *("--markdown", str(page)),
    ]
    volumes = command_of(TABLES["volumes"], data, None, pictures)
    assert volumes[3:] == ["--samples", str(data / "earthwork_1")]
    cameras = command_of(TABLES["cameras"], data, page, None)
    assert cameras[3:] == streets
    filters = command_of(TABLES["filters"], data, None, pictures)
    assert filters[3:] == [str(data), "--pictures", str(pictures / "filters")]


def test_a_table_that_fails_is_named_and_the_others_are_made(
    data: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    # Two of the real commands at their shortest: one is asked for help, one lacks its module.
    monkeypatch.setattr(
        tables, "TABLES", {"lost": AccuracyTable("nowhere"), "signs": TABLES["signs"]}
    )
    monkeypatch.setattr(
        tables,
        "command_of",
        lambda table, *_: [sys.executable, "-m", f"processing.laboratory.{table.module}", "--help"],
    )
    assert main([str(data)]) == 1
    said = capfd.readouterr().err
    assert "lost: failed" in said
    assert "signs: made" in said
    assert said.rstrip().endswith("Not made: lost")
