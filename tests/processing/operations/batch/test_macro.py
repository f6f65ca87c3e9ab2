"""What one project was put through is done to another, from a file."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path

import pytest

from processing.core.errors import MissingInput, OutOfRange
from processing.core.monitor import SilentMonitor
from processing.operations import scripting
from processing.operations.batch.job import read_job
from processing.operations.batch.macro import ReplayOperation, record_macro, replay
from processing.project.project import Project
from tests.delivered_files import make_las
from tests.processing.operations.batch.job_files import HEAD, IMPORT


@pytest.fixture
def projects(tmp_path: Path) -> tuple[Path, Path]:
    """Two projects of the same cloud: one that was worked on, and one that is new."""
    make_las(tmp_path / "cloud.las")
    found = tmp_path / "一 a.zuka", tmp_path / "other.zuka"
    for one in found:
        scripting.import_files(one, tmp_path / "cloud.las")
    scripting.run("ground", found[0])
    scripting.run("noise", found[0], radius_m=4.0, neighbours=1)
    scripting.run("ground", found[0])
    return found


def runs_of(folder: Path) -> list[tuple[str, dict[str, object]]]:
    with closing(Project.open(folder, writing=False)) as project:
        return [(run.tool, dict(run.parameters)) for run in project.runs.all()]


def test_a_macro_gives_another_project_the_same_runs(
    projects: tuple[Path, Path], tmp_path: Path
) -> None:
    one, other = projects
    macro = tmp_path / "macro.toml"
    assert record_macro(one, macro) == 2
    assert "parameters.radius_m = 4.0" in macro.read_text(encoding="utf-8")
    words = replay(ReplayOperation(macro, other), SilentMonitor())
    assert len(words) == 2
    assert runs_of(other) == runs_of(one)[1:]


def test_a_macro_can_be_pasted_into_a_job(projects: tuple[Path, Path], tmp_path: Path) -> None:
    macro, job = tmp_path / "macro.toml", tmp_path / "job.toml"
    record_macro(projects[0], macro)
    job.write_text(HEAD + IMPORT + macro.read_text(encoding="utf-8"), encoding="utf-8")
    assert [one["kind"] for one in read_job(job).job.steps] == ["import", "run", "run"]


def test_a_macro_is_checked_before_its_first_step(
    projects: tuple[Path, Path], tmp_path: Path
) -> None:
    macro = tmp_path / "macro.toml"
    record_macro(projects[0], macro)
    with macro.open("a", encoding="utf-8") as file:
        file.write('[[steps]]\nkind = "run"\ntool = "nose"\n')
    with pytest.raises(OutOfRange, match=r"steps\[3\]: nose"):
        replay(ReplayOperation(macro, projects[1]), SilentMonitor())
    assert runs_of(projects[1]) == []


def test_a_project_in_which_nothing_was_run_makes_no_macro(
    projects: tuple[Path, Path], tmp_path: Path
) -> None:
    with pytest.raises(MissingInput, match="Nothing was run"):
        record_macro(projects[1], tmp_path / "macro.toml")
    assert not (tmp_path / "macro.toml").exists()
