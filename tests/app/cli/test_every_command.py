"""Commands that tell, draw and study: what they print and leave, and how each refuses."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import cv2
import numpy as np
import pytest

from app.cli.terminal import BAD_INPUT, DONE, run_in_terminal
from processing.tools.listed.registry import every_tool
from tests.builders import write_laz, write_trajectory_csv
from tests.noisy_street import noisy_street


@pytest.fixture(scope="module")
def street(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a short street, its trajectory and what is noise in it."""
    folder, street = tmp_path_factory.mktemp("street"), noisy_street(7, length_m=2.0)
    write_laz(street.drive, folder / "street.laz")
    write_trajectory_csv(street.drive, folder / "trajectory.csv")
    np.savez(folder / "truth.npz", code=street.noise)
    return folder


def printed(capsys: pytest.CaptureFixture[str], *words: object) -> str:
    assert run_in_terminal([*map(str, words)]) == DONE
    return capsys.readouterr().out


def image_words(street: Path, output: Path, **changed: str) -> list[object]:
    said = {"kind": "trajectory-center", "attribute": "intensity", **changed}
    options = [word for name, value in said.items() for word in (f"--{name}", value)]
    recorded = (street / "street.laz", "--trajectory", street / "trajectory.csv")
    return ["image", *recorded, *options, "--output", output]


def study_words(street: Path, output: Path, *vary: str) -> list[object]:
    recorded = (street / "street.laz", "--trajectory", street / "trajectory.csv")
    settings = ("--set", "method=radius", "--set", "neighbours=12")
    varied = [word for one in vary for word in ("--vary", one)]
    truth = ("--truth", street / "truth.npz")
    return ["study", "noise", *recorded, *truth, *settings, *varied, "--output", output]


@pytest.mark.parametrize("language", ["en", "ja"])
def test_every_tool_is_listed_in_the_language_and_in_full_as_json(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, language: str
) -> None:
    monkeypatch.setenv("ZUKA_LANGUAGE", language)
    listed = printed(capsys, "tools")
    described = json.loads(printed(capsys, "tools", "--json"))
    assert [one["id"] for one in described] == list(every_tool())
    for tool in every_tool().values():
        assert tool.name.in_language("ja" if language == "ja" else "en") in listed
    noise = json.loads(printed(capsys, "tools", "noise", "--json"))
    assert noise in described
    (radius,) = (one for one in noise["parameters"] if one["id"] == "radius_m")
    assert radius["unit"] == "m"


def test_an_image_has_room_for_the_points_and_is_not_empty(
    street: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    output = tmp_path / "画像.png"
    printed(capsys, *image_words(street, output))
    picture = cv2.imdecode(np.fromfile(output, np.uint8), cv2.IMREAD_UNCHANGED)
    assert picture is not None
    info = json.loads(printed(capsys, "info", street / "street.laz", "--json"))
    assert picture.shape[0] * picture.shape[1] * 2 > info["points"]
    assert np.unique(picture).size > 10


def test_a_study_has_a_row_a_setting_with_scores_by_the_truth(
    street: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    output = tmp_path / "study.csv"
    printed(capsys, *study_words(street, output, "radius_m=0.2:0.4:3"))
    with output.open(encoding="utf-8-sig", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["radius_m"]) for row in rows] == pytest.approx([0.2, 0.3, 0.4])
    found = [float(value) for row in rows for name, value in row.items() if name.endswith("_f")]
    assert len(found) >= len(rows)
    assert 0.5 < max(found) <= 1.0


@pytest.mark.parametrize("language", ["en", "ja"])
def test_each_command_refuses_in_one_sentence_and_leaves_nothing(
    street: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    language: str,
) -> None:
    monkeypatch.setenv("ZUKA_LANGUAGE", language)
    out = tmp_path / "out"
    cases: dict[str, list[object]] = {
        "sculpt": ["sculpt"],
        "ceilings": ["tools", "ceilings"],
        "fish-eye": image_words(street, out, kind="fish-eye"),
        "smell": image_words(street, out, attribute="smell"),
        "nothing.laz": ["info", tmp_path / "nothing.laz"],
        "nothing.zuka": ["export", tmp_path / "nothing.zuka", "--format", "dxf", "--out", out],
        "colour=1:2:3": study_words(street, out, "colour=1:2:3"),
        "radius_m=1": study_words(street, out, "radius_m=1"),
        "jump": ["bench", "jump"],
    }
    for said, words in cases.items():
        assert run_in_terminal([*map(str, words)]) == BAD_INPUT, said
        line = capsys.readouterr().err.rstrip("\n").splitlines()[-1]
        what, where, remedy = line.split(" | ")
        assert said in what + where, line
        for one in (what, remedy):
            assert any(ord(letter) > 0x3000 for letter in one) == (language == "ja"), line
    assert list(tmp_path.iterdir()) == []


def test_the_road_command_says_what_it_needs(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run_in_terminal(["road", str(tmp_path / "none")]) == BAD_INPUT
    assert "--out" in capsys.readouterr().err
    assert run_in_terminal(["road", str(tmp_path / "none"), "--draw"]) == BAD_INPUT
    assert capsys.readouterr().err.count("\n") == 1
