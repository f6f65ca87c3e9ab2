"""``zuka simulate``: what it writes, what it says of it, what it refuses, and how it is stopped."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import laspy
import numpy as np
import pytest

from app.cli.terminal import BAD_INPUT, CANCELLED, DONE, run_in_terminal
from processing.laboratory.simulate.forecast import forecast_street
from processing.laboratory.simulate.requests import StreetRequest

SMALL = (
    "--style",
    "highway",
    "--length",
    "10",
    "--set",
    "pulses=100",
    "--set",
    "turns_per_s=20",
    "--set",
    "images=no",
)
ROOT = Path(__file__).parents[3]


def refused(capsys: pytest.CaptureFixture[str], *arguments: object) -> str:
    assert run_in_terminal(["simulate", *map(str, arguments)]) == BAD_INPUT
    written = capsys.readouterr()
    assert written.out == ""
    (line,) = written.err.rstrip("\n").splitlines()
    assert line.count(" | ") == 2
    return line


def test_a_street_is_written_as_a_delivery_with_a_label_for_every_point(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "通り"
    assert run_in_terminal(["simulate", "street", "--out", str(out), "--seed", "4", *SMALL]) == DONE
    first, *files, truth = capsys.readouterr().out.splitlines()
    points = 0
    for head in ("left", "right"):
        assert str(out / f"{head}.laz") in files
        labels = np.load(out / "truth" / f"{head}.labels.npy")
        with laspy.open(out / f"{head}.laz") as file:
            assert file.header.point_count == labels.size
        points += labels.size
    assert first == f"{out}: {points:,} points, EPSG:6677"
    request = StreetRequest(style="highway", length_m=10.0, pulses=100, turns_per_s=20.0)
    assert forecast_street(request).points == pytest.approx(points, rel=0.5)
    assert str(out / "trajectory.csv") in files
    assert truth == f"truth: {out / 'truth'}"
    assert "There is something in this folder" in refused(capsys, "street", "--out", out, *SMALL)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--length", "1"), "length_m=1"),
        (("--style", "alley"), "urban, rural, highway"),
        (("--sensor", "p40"), "vq250"),
        (("--seed", "x"), "seed=x"),
        (("--set", "wings=2"), "There is no such parameter"),
        (("--set", "passes"), "A setting has no value"),
    ],
)
def test_what_can_not_be_made_is_refused_and_leaves_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], arguments: tuple[str, ...], said: str
) -> None:
    assert said in refused(capsys, "street", "--out", tmp_path / "a", *arguments)
    assert list(tmp_path.iterdir()) == []


def test_help_lists_what_can_be_set_with_units_and_defaults(
    capsys: pytest.CaptureFixture[str],
) -> None:
    with pytest.raises(SystemExit):
        run_in_terminal(["simulate", "street", "--help"])
    reported = capsys.readouterr().out
    assert "--set length_m=120.0 m (10 … 100000)" in reported
    assert "--set style=urban urban | rural | highway" in reported


# What runs in the background of a shell is started deaf to Ctrl-C.
_HEARING = (
    "import runpy, signal; signal.signal(signal.SIGINT, signal.default_int_handler);"
    "runpy.run_module('app', run_name='__main__')"
)


def test_ctrl_c_ends_a_simulation_as_cancelled_with_nothing_left(tmp_path: Path) -> None:
    arguments = ["simulate", "street", "--length", "600", "--out", str(tmp_path / "street")]
    with subprocess.Popen(
        [sys.executable, "-c", _HEARING, *arguments],
        cwd=ROOT,
        env={**os.environ, "HOME": str(tmp_path.parent)},
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        assert process.stderr is not None
        assert "Recording" in process.stderr.readline()
        process.send_signal(signal.SIGINT)
        process.stderr.read()
    assert process.returncode == CANCELLED
    assert list(tmp_path.iterdir()) == []


def test_a_density_is_written_as_a_picture_and_as_a_table(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for name in ("d.png", "d.csv"):
        wanted = ["--sensor", "zf9012", "--speed", "30", "--out", str(tmp_path / name)]
        assert run_in_terminal(["simulate", "density", *wanted]) == DONE
        assert capsys.readouterr().out == f"{tmp_path / name}\n"
        assert (tmp_path / name).stat().st_size > 1000


@pytest.mark.parametrize(
    ("wanted", "said"),
    [
        (("vq250", "0", "d.png"), "A density needs a speed"),
        (("p40", "30", "d.png"), "no such sensor"),
        (("vq250", "30", "d.pdf"), "Pictures and tables are written as PNG or CSV"),
        (("vq250", "fast", "d.png"), "can't be read"),
    ],
)
def test_a_density_that_can_not_be_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], wanted: tuple[str, str, str], said: str
) -> None:
    sensor, speed, name = wanted
    out = tmp_path / name
    assert said in refused(capsys, "density", "--sensor", sensor, "--speed", speed, "--out", out)
    assert list(tmp_path.iterdir()) == []
