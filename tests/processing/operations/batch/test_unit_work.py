"""A drive's tasks are done once, in their order, and what fails stops only what needs it."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import closing
from pathlib import Path

import pytest

from processing.core.errors import Cancelled, InUse
from processing.core.monitor import SilentMonitor
from processing.operations.batch import unit_work
from processing.operations.batch.deliveries import deliveries_of
from processing.operations.batch.job import JobFile, read_job
from processing.operations.batch.unit_state import UnitState, read_state
from processing.operations.batch.unit_work import BatchUnit, is_finished, units_of, work_on
from processing.operations.import_files import ImportOperation, import_files
from processing.operations.inputs import OperationInputs
from processing.operations.operation_files import perform
from processing.operations.run import RunOperation, run_operation
from processing.project.importing.import_request import ImportRequest
from processing.project.project import Project
from tests.delivered_files import make_las
from tests.monitors import CancelledAfter
from tests.processing.operations.batch.job_files import (
    EXPORT,
    HEAD,
    IMPORT,
    NOISE,
    NOISE_OF_TWO,
    deliver,
    write_job,
)

BOTH = '[[steps]]\nkind = "extract"\nextractors = [{tool = "curbs"}, {tool = "trees"}]\n'


def opened(path: Path) -> tuple[JobFile, tuple[BatchUnit, ...]]:
    file = read_job(path)
    return file, units_of(file, deliveries_of(file))


def worked(path: Path) -> UnitState:
    """Work on the only unit of a job, in this process."""
    file, (unit,) = opened(path)
    return work_on(file, unit, SilentMonitor(), lambda: 0)


@pytest.fixture
def performed(monkeypatch: pytest.MonkeyPatch) -> list[object]:
    """What is done, in its order."""
    seen: list[object] = []

    def noting(operation: object, monitor: SilentMonitor) -> object:
        seen.append(operation)
        return perform(operation, monitor)

    monkeypatch.setattr(unit_work, "perform", noting)
    return seen


def columns_of(project: Path) -> dict[str, bytes]:
    with closing(Project.open(project, writing=False)) as one:
        (drive,) = one.drives
        return {path.name: path.read_bytes() for path in sorted(drive.folder.glob("*.bin"))}


def test_results_are_those_of_single_commands_to_the_byte(tmp_path: Path) -> None:
    deliver(tmp_path, ["北"])
    state = worked(write_job(tmp_path, HEAD + IMPORT + NOISE))
    assert state.is_whole
    assert [one.title.en for one in state.tasks] == ["Import", "Noise"]
    folder, single = tmp_path / "out" / "北", tmp_path / "single.zuka"
    request = ImportRequest((tmp_path / "drives" / "北" / "cloud.las",))
    import_files(ImportOperation(single, request), SilentMonitor())
    inputs = OperationInputs(single)
    run_operation(RunOperation("noise", inputs, {}, tmp_path / "noise.las"), SilentMonitor())
    assert (folder / "noise.las").read_bytes() == (tmp_path / "noise.las").read_bytes()
    columns = columns_of(folder / "北.zuka")
    assert columns
    assert columns == columns_of(single)


def test_what_is_done_is_not_done_again(tmp_path: Path, performed: list[object]) -> None:
    deliver(tmp_path, ["a"])
    path = write_job(tmp_path, HEAD + IMPORT + NOISE)
    first = worked(path)
    assert len(performed) == 2
    assert worked(path) == first
    assert len(performed) == 2
    file, (unit,) = opened(path)
    assert is_finished(file, unit)


def test_a_changed_step_is_done_anew_with_all_that_follow(
    tmp_path: Path, performed: list[object]
) -> None:
    deliver(tmp_path, ["a"])
    worked(write_job(tmp_path, HEAD + IMPORT + NOISE + EXPORT))
    performed.clear()
    path = write_job(tmp_path, HEAD + IMPORT + NOISE_OF_TWO + EXPORT)
    file, (unit,) = opened(path)
    assert not is_finished(file, unit)
    assert worked(path).is_whole
    assert [type(one).__name__ for one in performed] == ["RunOperation", "ExportOperation"]


@pytest.mark.parametrize("when", [1, 5, 10])
def test_a_stop_costs_the_running_task_only(
    tmp_path: Path, performed: list[object], when: int
) -> None:
    deliver(tmp_path, ["a"])
    file, (unit,) = opened(write_job(tmp_path, HEAD + IMPORT + NOISE))
    with pytest.raises(Cancelled):
        work_on(file, unit, CancelledAfter(when), lambda: 0)
    noted = read_state(unit.folder, "a").tasks
    begun = len(performed)
    assert work_on(file, unit, SilentMonitor(), lambda: 0).is_whole
    assert len(performed) == begun + 2 - len(noted)
    single = tmp_path / "single"
    deliver(single, ["a"])
    worked(write_job(single, HEAD + IMPORT + NOISE))
    assert columns_of(unit.project) == columns_of(single / "out" / "a" / "a.zuka")


def test_an_extractor_that_a_cloud_does_not_suit_stops_nothing(tmp_path: Path) -> None:
    deliver(tmp_path, ["a"])
    state = worked(write_job(tmp_path, HEAD + IMPORT + BOTH + EXPORT))
    curbs = state.tasks[1]
    assert (curbs.title.en, curbs.became) == ("Curbs", "unsuited")
    assert curbs.error is not None
    assert state.tasks[-1].became == "done"
    assert state.is_whole


def test_a_step_that_fails_is_told_and_those_after_it_are_not_tried(tmp_path: Path) -> None:
    deliver(tmp_path, ["a"])
    curbs = '[[steps]]\nkind = "run"\ntool = "curbs"\n'
    path = write_job(tmp_path, HEAD + IMPORT + curbs + EXPORT)
    state = worked(path)
    assert [one.became for one in state.tasks] == ["done", "failed"]
    assert not state.is_whole
    assert not state.has_defect
    file, (unit,) = opened(path)
    assert not is_finished(file, unit)


def test_a_damaged_delivery_is_told_by_its_import(tmp_path: Path) -> None:
    deliver(tmp_path, ["a"])
    (tmp_path / "drives" / "a" / "cloud.las").write_bytes(b"LASF and no more")
    state = worked(write_job(tmp_path))
    (task,) = state.tasks
    assert (task.title.en, task.became) == ("Import", "failed")
    assert task.error is not None
    assert "cloud.las" in task.error.where.en


def test_a_folder_without_points_is_told(tmp_path: Path) -> None:
    (tmp_path / "drives" / "a").mkdir(parents=True)
    state = worked(write_job(tmp_path))
    (task,) = state.tasks
    assert task.error is not None
    assert "no point files" in task.error.what.en


def test_one_project_holds_all_deliveries_but_the_damaged_one(tmp_path: Path) -> None:
    deliver(tmp_path, ["a", "b", "c"])
    (tmp_path / "drives" / "b" / "cloud.las").write_bytes(b"LASF and no more")
    state = worked(write_job(tmp_path, f'results = "one"\n{HEAD}{IMPORT}{EXPORT}'))
    assert [one.became for one in state.tasks] == ["done", "failed", "done", "done"]
    assert state.tasks[1].title.en == "Import: b"
    assert not state.is_whole
    with closing(Project.open(tmp_path / "out" / "job" / "job.zuka", writing=False)) as project:
        assert [drive.count for drive in project.drives] == [300, 302]


def changed(path: Path) -> None:
    path.unlink()
    make_las(path, count=77)


def written_again(path: Path) -> None:
    content = path.read_bytes()
    path.unlink()
    path.write_bytes(content)


@pytest.mark.parametrize(("change", "is_refused"), [(changed, True), (written_again, False)])
def test_results_are_not_mixed_with_those_of_other_files(
    tmp_path: Path, *, change: Callable[[Path], None], is_refused: bool
) -> None:
    deliver(tmp_path, ["a"])
    path = write_job(tmp_path)
    worked(path)
    change(tmp_path / "drives" / "a" / "cloud.las")
    file, (unit,) = opened(path)
    assert is_finished(file, unit) is not is_refused
    if not is_refused:
        return
    with pytest.raises(InUse, match="changed since"):
        work_on(file, unit, SilentMonitor(), lambda: 0)
