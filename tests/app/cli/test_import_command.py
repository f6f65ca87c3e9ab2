"""``zuka import`` of what a project has already, and of what a drive lacks."""

from __future__ import annotations

import shutil
from contextlib import closing
from pathlib import Path

import pytest

from app.cli.terminal import run_in_terminal
from processing.project.importing.trajectory_beside import trajectories_beside
from processing.project.project import Project
from processing.recording.drive import Drive
from tests.builders import simulated_drive, write_laz, write_trajectory_csv


@pytest.fixture
def delivery(tmp_path, monkeypatch) -> Path:
    """A folder with a street and its trajectory; commands are typed in it."""
    folder = tmp_path / "納品"
    folder.mkdir()
    simulated = simulated_drive(length_m=4.0)
    write_laz(simulated, folder / "street.laz")
    write_trajectory_csv(simulated, folder / "trajectory.csv")
    monkeypatch.chdir(folder)
    monkeypatch.setenv("ZUKA_LANGUAGE", "en")
    return folder


@pytest.fixture
def zuka(capsys, delivery):
    """Runs a command; gives its status, and the lines it wrote to both streams."""

    def run(*arguments: object) -> tuple[object, list[str], list[str]]:
        capsys.readouterr()
        status = run_in_terminal([str(one) for one in arguments])
        out, err = capsys.readouterr()
        reported = [line for line in err.replace("\r", "\n").splitlines() if "%" not in line]
        return status, out.splitlines(), [line for line in reported if line.strip()]

    return run


def _drives(folder: Path) -> list[Drive]:
    with closing(Project.open(folder, writing=False)) as project:
        return list(project.drives)


def test_an_import_without_trajectory_names_the_one_beside_and_does_not_take_it(zuka, delivery):
    status, out, reported = zuka("import", "a.zuka", "street.laz")
    assert status == 0
    assert len(out) == 1
    assert reported == [
        "street.laz has no trajectory; trajectory.csv beside it covers it: "
        "add --trajectory trajectory.csv"
    ]
    assert _drives(delivery / "a.zuka")[0].trajectory is None


def test_where_none_lies_beside_it_is_said_how_to_add_one(zuka, delivery):
    (delivery / "trajectory.csv").unlink()
    status, _, reported = zuka("import", "a.zuka", "street.laz")
    assert status == 0
    assert len(reported) == 1
    assert "zuka import PROJECT --trajectory FILE" in reported[0]


def test_a_trajectory_alone_completes_the_drive_that_it_covers(zuka, delivery):
    zuka("import", "a.zuka", "street.laz")
    (before,) = _drives(delivery / "a.zuka")
    (delivery / "street.laz").unlink()  # the points are the drive's own
    status, out, reported = zuka("import", "a.zuka", "--trajectory", "trajectory.csv")
    assert (status, reported) == (0, [])
    assert "(trajectory)" in out[0]
    (drive,) = _drives(delivery / "a.zuka")
    assert drive.id == before.id
    assert drive.trajectory is not None
    status, out, _ = zuka("import", "a.zuka", "--trajectory", "trajectory.csv")
    assert status == 0
    assert "no drive lacks it" in out[0]


def test_the_same_file_again_changes_nothing_also_under_another_name(zuka, delivery):
    zuka("import", "a.zuka", "street.laz", "--trajectory", "trajectory.csv")
    (before,) = _drives(delivery / "a.zuka")
    shutil.copy(delivery / "street.laz", delivery / "copy.laz")
    for name in ("street.laz", "copy.laz"):
        status, out, reported = zuka("import", "a.zuka", name)
        assert (status, reported) == (0, [])
        assert out == [f"In the project already, so not imported again: {name}"]
        assert [drive.folder for drive in _drives(delivery / "a.zuka")] == [before.folder]


def test_a_known_file_with_a_trajectory_completes_its_drive_and_a_new_one_comes_in(zuka, delivery):
    zuka("import", "a.zuka", "street.laz")
    other = simulated_drive(seed=3, length_m=4.0)
    write_laz(other, delivery / "other.laz")
    status, out, reported = zuka(
        "import", "a.zuka", "street.laz", "other.laz", "--trajectory", "trajectory.csv"
    )
    assert (status, reported) == (0, [])
    assert [line.partition(":")[0] for line in out] == [
        "other", "street", "In the project already, so not imported again",
    ]  # fmt: skip
    assert [drive.info.rows_by for drive in _drives(delivery / "a.zuka")] == ["trajectory"] * 2


def test_a_trajectory_of_another_day_is_bad_input_and_the_drive_stays(zuka, delivery):
    zuka("import", "a.zuka", "street.laz")
    other = simulated_drive(length_m=4.0, start_time_s=405_000.0)
    write_trajectory_csv(other, delivery / "other.csv")
    status, out, reported = zuka("import", "a.zuka", "--trajectory", "other.csv")
    assert (status, out) == (2, [])
    assert "lie outside those of the trajectory" in reported[0]
    assert _drives(delivery / "a.zuka")[0].trajectory is None
    assert not any((delivery / "a.zuka" / "tmp").iterdir())


def test_a_new_day_with_its_trajectory_comes_in_beside_a_known_one_that_it_does_not_cover(
    zuka, delivery
):
    zuka("import", "a.zuka", "street.laz", "--trajectory", "trajectory.csv")
    (before,) = _drives(delivery / "a.zuka")
    other = simulated_drive(length_m=4.0, start_time_s=405_000.0)
    write_laz(other, delivery / "day2.laz")
    write_trajectory_csv(other, delivery / "day2.csv")
    status, out, reported = zuka(
        "import", "a.zuka", "street.laz", "day2.laz", "--trajectory", "day2.csv"
    )
    assert (status, reported) == (0, [])
    assert out[0].startswith("day2: ")
    first, second = _drives(delivery / "a.zuka")
    assert first.folder == before.folder
    assert second.info.rows_by == "trajectory"


def test_a_reference_system_alone_is_given_to_the_project(zuka, delivery):
    zuka("import", "a.zuka", "street.laz")
    status, _, _ = zuka("import", "a.zuka", "--crs", "EPSG:6677")
    assert status == 0
    with closing(Project.open(delivery / "a.zuka", writing=False)) as project:
        assert project.crs == "EPSG:6677"


@pytest.mark.parametrize("project", ["a.zuka", "new.zuka"])
def test_nothing_at_all_is_refused(zuka, delivery, project):
    zuka("import", "a.zuka", "street.laz")
    status, out, reported = zuka("import", project)
    assert (status, out) == (2, [])
    assert reported[0].startswith("No point files were given.")
    assert not (delivery / "new.zuka").exists()


def test_a_trajectory_is_found_in_a_folder_for_such_and_one_of_another_day_is_not(delivery):
    points = (delivery / "points" / "street.laz",)
    points[0].parent.mkdir()
    (delivery / "street.laz").rename(points[0])
    assert trajectories_beside(points, "") == ()
    (delivery / "Trajectory_1").mkdir()
    there = (delivery / "trajectory.csv").rename(delivery / "Trajectory_1" / "t.csv")
    other = simulated_drive(length_m=4.0, start_time_s=405_000.0)
    write_trajectory_csv(other, delivery / "points" / "other.csv")
    assert trajectories_beside(points, "") == (there.resolve(),)


def test_a_folder_is_imported_with_all_that_was_delivered_in_it(zuka, delivery):
    status, out, reported = zuka("import", delivery.parent / "a.zuka", delivery)
    assert (status, reported) == (0, [])
    assert "(trajectory)" in out[0]
    (drive,) = _drives(delivery.parent / "a.zuka")
    assert drive.trajectory is not None


def test_a_folder_of_structured_scans_is_imported(zuka, delivery):
    folder = delivery.parent / "scans"
    folder.mkdir()
    poses = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"
    points = "".join(f"{x} {y} 0 0.5\n" for x in (1, 2) for y in (1, 2))
    (folder / "a.ptx").write_text(f"2\n2\n{poses}{points}")
    status, _, _ = zuka("import", delivery.parent / "b.zuka", folder)
    assert status == 0
    assert [drive.count for drive in _drives(delivery.parent / "b.zuka")] == [4]


def test_a_folder_without_points_is_refused(zuka, delivery):
    (delivery / "street.laz").unlink()
    (delivery / "trajectory.csv").unlink()
    status, _, reported = zuka("import", delivery.parent / "c.zuka", delivery)
    assert status == 2
    assert "no point files" in reported[0]
