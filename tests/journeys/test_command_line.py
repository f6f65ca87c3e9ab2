"""The contract's commands as processes: what they write, print and give as status."""

import json
import subprocess
import sys
from pathlib import Path

import laspy
import numpy as np
import pytest

STREET = Path(__file__).parents[2] / "resources" / "sample_street"


def zuka(*arguments, language="en", cwd=None):
    import os

    environment = {**os.environ, "ZUKA_LANGUAGE": language}
    return subprocess.run(
        [sys.executable, "-m", "app", *map(str, arguments)],
        capture_output=True,
        text=True,
        encoding="utf-8",
        env=environment,
        cwd=cwd,
        timeout=120,
        check=False,
    )


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    folder = tmp_path_factory.mktemp("日本語 フォルダ") / "通り.zuka"
    done = zuka(
        "import", folder, STREET / "left.laz", STREET / "right.laz",
        "--trajectory", STREET / "trajectory.csv", "--images", STREET / "images.csv",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "revolutions/s" in done.stdout
    return folder


def test_info_tells_scanners_rows_and_rates_of_a_project(project):
    done = zuka("info", project, "--json")
    reported = json.loads(done.stdout)
    assert reported["crs"] == "EPSG:6677"
    assert [drive["scanner"] for drive in reported["drives"]] == [1, 2]
    for drive in reported["drives"]:
        assert abs(drive["turns_per_s"] - 100.0) < 0.05
        assert abs(drive["pulses_per_s"] - 100_000.0) < 1.0
        assert 440 < drive["revolutions"] < 460


def test_info_tells_what_a_file_holds():
    reported = json.loads(zuka("info", STREET / "left.laz", "--json").stdout)
    assert reported["points"] == 290_429
    assert reported["scanners"] == [1]
    assert reported["crs"] == "EPSG:6677"
    assert reported["waveforms"] is False


def test_an_image_is_written_with_a_row_for_each_revolution(project, tmp_path):
    import cv2

    out = tmp_path / "画像.png"
    done = zuka(
        "image", STREET / "left.laz", "--trajectory", STREET / "trajectory.csv",
        "--kind", "trajectory-reversible", "--attribute", "intensity", "--output", out,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    picture = cv2.imdecode(np.fromfile(out, np.uint8), cv2.IMREAD_COLOR)
    assert 440 < picture.shape[0] < 460
    assert 1000 <= picture.shape[1] < 1100


def test_a_tool_gives_the_points_of_the_file_in_their_order_with_its_columns(tmp_path):
    out = tmp_path / "normals.laz"
    done = zuka(
        "run", "normals", STREET / "left.laz", "--trajectory", STREET / "trajectory.csv",
        "--output", out,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    before, after = laspy.read(STREET / "left.laz"), laspy.read(out)
    for name in ("X", "Y", "Z", "gps_time", "intensity"):
        assert (before[name] == after[name]).all()
    lengths = np.sqrt(sum(np.asarray(after[f"normal_{axis}"]) ** 2 for axis in "xyz"))
    assert np.median(lengths) == pytest.approx(1.0, abs=0.02)


def test_an_empty_map_is_exported_as_whole_files(project, tmp_path):
    formats = ("--format", "dxf", "csv", "--format", "gpkg", "geojson")
    done = zuka("export", project, *formats, "--out", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    for path in done.stdout.split("\n")[:-1]:
        assert Path(path).is_file()


def test_tools_are_listed_with_parameters_and_limits():
    reported = json.loads(zuka("tools", "--json").stdout)
    assert {"normals", "segments"} <= {tool["id"] for tool in reported}
    for tool in reported:
        for parameter in tool["parameters"]:
            assert parameter["name"]["ja"]
            assert parameter["name"]["en"]


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (("info", "nothing.laz"), "nothing.laz"),
        (("fly",), "fly"),
        (("run", "curve", STREET / "left.laz", "--output", "x.laz"), "curve"),
        (("run", "normals", STREET / "left.laz", "--set", "a=1", "--output", "x.laz"), "a"),
        (("run", "normals", STREET / "left.laz", "--output", "x.txt"), "x.txt"),
        (("open", "nowhere.zuka"), "nowhere.zuka"),
        (("export", "nowhere.zuka", "--format", "dxf", "--out", "o"), "nowhere.zuka"),
        (("info", STREET / "README.md"), "README.md"),
    ],
)
def test_bad_input_is_one_line_with_its_place_and_status_2(tmp_path, arguments, word):
    for language in ("en", "ja"):
        done = zuka(*arguments, language=language, cwd=tmp_path)
        assert done.returncode == 2
        assert done.stdout == ""
        lines = done.stderr.strip().split("\n")
        assert len(lines) == 1, done.stderr
        assert word in lines[0]
        assert lines[0].count(" | ") == 2
    assert not list(tmp_path.iterdir())


def test_a_trajectory_of_another_day_is_refused_and_no_project_is_left(tmp_path):
    lines = (STREET / "trajectory.csv").read_text().splitlines()
    moved = [lines[0]]
    for line in lines[1:]:
        time, _, rest = line.partition(",")
        moved.append(f"{float(time) + 12_345.0:.6f},{rest}")
    (tmp_path / "軌跡.csv").write_text("\n".join(moved), encoding="utf-8")
    project = tmp_path / "p.zuka"
    done = zuka("import", project, STREET / "left.laz", "--trajectory", tmp_path / "軌跡.csv")
    assert done.returncode == 2
    assert "軌跡.csv" in done.stderr
    assert not project.exists()
