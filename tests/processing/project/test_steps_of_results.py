"""Results of tools, comparisons and imports are taken back and done again; no kill hurts."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator, Mapping
from contextlib import closing
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from processing.core.errors import NoSpace
from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.map.catalogue import Geometry
from processing.map.change import Change
from processing.map.feature import Feature, Vertex
from processing.methods.earthwork.maps.change_grid import ChangeGrid
from processing.methods.earthwork.volumes.volume_result import VolumeResult, Volumes
from processing.methods.ground.filters.cells import CellGrid
from processing.operations.import_files import ImportOperation, import_files
from processing.operations.map_steps import UndoneStep, UndoOperation, undo_step
from processing.operations.project_volumes import MadeVolume, remove_volume, store_volume
from processing.operations.runs.finished_runs import finish_run, with_photos
from processing.operations.store import store_prepared, store_run
from processing.project.additions import bring_in, home_of, take_over
from processing.project.importing.import_request import ImportRequest
from processing.project.photos import photo_of
from processing.project.project import Project
from processing.project.store.exchanged_files import ExchangedFiles
from processing.project.volumes.volume import ChosenSide, SideKind, VolumeRequest, new_volume
from processing.project.volumes.volume_store import VolumeStore, write_volume
from processing.recording.camera_images.image_list import ImageList
from processing.tools.running.runner import RunRequest, tool_of
from processing.tools.tool import Candidate, CandidateResult
from tests.builders import simulated_drive, write_laz
from tests.processing.project.candidates import found
from tests.processing.project.labelled import labelled_project

SIGN = Feature("sign", "sign", Geometry.POINT, (Vertex((1.0, 2.0, 3.0)),))
DRAW = Text("Draw", "作図")
_IMAGES = (
    "path,time_s,easting_m,northing_m,height_m,omega_deg,phi_deg,kappa_deg,focal_px,cx_px,cy_px,"
    "width_px,height_px\n"
)


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A closed project with one drive, with delivered files of another beside it."""
    folder = tmp_path_factory.mktemp("whole")
    write_laz(simulated_drive(length_m=2.0, start_time_s=405_000.0), folder / "later.laz")
    return labelled_project(folder)


@pytest.fixture
def project(whole: Path, tmp_path: Path) -> Iterator[Project]:
    folder = Path(shutil.copytree(whole, tmp_path / "p.zuka"))
    with closing(Project.open(folder)) as project:
        project.features.apply(DRAW, Change(added=(SIGN,)))
        yield project


def run(project: Project, tool: str, **parameters: float) -> None:
    made = tool_of(tool).parameters(**parameters)
    request = RunRequest(tool, project.drives[0], made)
    into, labels = project.temporary_folder(), project.label_folder()
    done = finish_run(request, into, SilentMonitor(), labels_into=labels, begin=lambda: None)
    store_run(project, done)


def _normals(project: Project) -> None:
    run(project, "normals")


def _normals_again(project: Project) -> None:
    run(project, "normals", radius_m=1.5)


def _ground(project: Project) -> None:
    run(project, "ground")


def volume() -> tuple[VolumeRequest, VolumeResult]:
    """A comparison that found as much cut as fill."""
    ground = np.zeros((3, 4), np.float32)
    inside = np.ones((3, 4), np.float32)
    change = ChangeGrid(CellGrid(np.zeros(3), 0.5, 3, 4), ground, inside, inside > 0, inside)
    volumes = Volumes(1.5, 2.25, 3.0, 0.5, 0.125, 1.25, 2.0)
    before, level = ChosenSide(SideKind.DESIGN, "面"), ChosenSide(SideKind.LEVEL, height_m=4.0)
    request = VolumeRequest(before, level, {})
    return request, VolumeResult(volumes, "grid", 0.5, change, None, ())


def _volume(project: Project) -> None:
    request, result = volume()
    kept = new_volume(request, result, crs="", version=1, made=datetime.now(UTC))
    folder = project.temporary_folder()
    write_volume(kept, result, folder)
    store_volume(project, MadeVolume(kept, folder))


def _volume_removed(project: Project) -> None:
    remove_volume(project, VolumeStore(project.folder).all()[0])


def bring(project: Project, request: ImportRequest) -> None:
    take_over(project, bring_in(request, home_of(project), SilentMonitor()))


def _delivery(project: Project) -> Path:
    return Path(project.drives[0].info.sources[0].path).parent


def _import(project: Project) -> None:
    bring(project, ImportRequest((_delivery(project) / "later.laz",)))


def _images(project: Project) -> None:
    drive = project.drives[0]
    line = f"image.jpg,{drive.columns['time'][5]},1,2,3,0,0,0,1000,500,500,1000,1000\n"
    listed = project.folder.parent / "images.csv"
    listed.write_text(_IMAGES + line, encoding="utf-8")
    bring(project, ImportRequest((), images=(listed,)))


def _pictured(project: Project) -> None:
    picture = np.full((3, 4, 3), 200, np.uint8)
    sign = Candidate("sign", "point", np.ones((1, 3)), np.array([-1]), 0.9, picture=picture)
    made = found(CandidateResult((sign,)), drive=project.drives[0].id)
    store_run(project, with_photos(made, project.temporary_folder()))


STEPS: Mapping[str, tuple[tuple[Callable[[Project], None], ...], str, str]] = {
    "a column": ((_normals,), "street: normal", "街路"),
    "a column for another": ((_normals, _normals_again), "street: normal", "normal"),
    "ground": ((_ground,), "Ground", "地面"),
    "ground again": ((_ground, _ground), "Ground", "地面"),
    "a volume": ((_volume,), "Volume: 面 → level", "土量"),
    "a removed volume": ((_volume, _volume_removed), "Remove Volume", "を削除"),
    "an import": ((_import,), "Import later", "later のインポート"),
    "a picture": ((_pictured,), "Curbs: 1 candidate", "候補1件"),
    "images": ((_images,), "Add to street", "street への追加"),
}
"""What is done, and what the undo menu calls the last of it."""


def state_of(project: Project) -> dict[str, object]:
    """All that a user could miss of a project."""
    columns = ("normal", "shape", "segment", "label")
    return {
        "features": list(project.features.all()),
        "drives": [drive.info for drive in project.drives],
        "columns": {
            (drive.id, name): drive.columns[name].tobytes()
            for drive in project.drives
            for name in columns
            if drive.columns.has(name)
        },
        "surfaces": {
            drive.id: path.read_bytes()
            for drive in project.drives
            if (path := drive.folder / "ground_surface.tiles").is_file()
        },
        "images": [tuple(drive.noted_images or ImageList(())) for drive in project.drives],
        "photos": {
            one.id: photo.read_bytes()
            for one in project.features.all()
            if (photo := photo_of(one, project.folder)) is not None
        },
        "volumes": [
            (one.id, VolumeStore(project.folder).read_result(one).volumes)
            for one in VolumeStore(project.folder).all()
        ],
    }


def without_labels_of_nothing(state: dict[str, object]) -> dict[str, object]:
    """A column of labels that are all 0 says as much as none."""
    columns = state["columns"]
    assert isinstance(columns, dict)
    kept = {key: one for key, one in columns.items() if key[1] != "label" or any(one)}
    return {**state, "columns": kept}


def same(one: dict[str, object], other: dict[str, object]) -> bool:
    return without_labels_of_nothing(one) == without_labels_of_nothing(other)


def done(project: Project, step: str) -> tuple[dict[str, object], dict[str, object]]:
    """The project before and after the last of what is done."""
    first, last = STEPS[step][0][:-1], STEPS[step][0][-1]
    for one in first:
        one(project)
    before = state_of(project)
    last(project)
    after = state_of(project)
    assert not same(before, after) or step == "ground again"
    return before, after


@pytest.mark.parametrize("step", STEPS)
def test_a_result_is_one_step_that_is_taken_back_and_done_again(
    project: Project, step: str
) -> None:
    position = project.history.position + len(STEPS[step][0])
    before, after = done(project, step)
    assert project.history.position == position
    label = project.history.undo_label
    assert label is not None
    assert STEPS[step][1] in label.en
    assert any(words in label.ja for words in (STEPS[step][2], "street"))
    for _ in range(2):
        assert project.features.undo() is not None
        assert same(state_of(project), before)
        assert project.features.redo() is not None
        assert same(state_of(project), after)


@pytest.mark.parametrize("step", STEPS)
def test_a_step_outlives_the_closed_project_both_ways(project: Project, step: str) -> None:
    folder = project.folder
    before, after = done(project, step)
    project.close()
    for moved, state in (("undo", before), ("redo", after), ("undo", before)):
        with closing(Project.open(folder)) as again:
            move = again.features.undo if moved == "undo" else again.features.redo
            assert move() is not None
            assert same(state_of(again), state)
    with closing(Project.open(folder)) as again:
        assert same(state_of(again), before)
        while again.features.undo() is not None:
            pass
        assert not list(again.features.all())


@pytest.mark.parametrize("step", STEPS)
@pytest.mark.parametrize("moves", [(), ("undo",), ("undo", "redo")])
@pytest.mark.parametrize("most", [0, 1])
def test_a_kill_in_a_step_leaves_it_done_or_not(
    project: Project, step: str, moves: tuple[str, ...], most: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The database has the step; none or one of its files has its place."""
    folder, copy = project.folder, project.folder.with_name("killed.zuka")
    states: list[dict[str, object]] = []

    class Killed(BaseException):
        pass

    exchange = ExchangedFiles._exchange
    left = [10**6]

    def killed(files: ExchangedFiles, *one: object) -> None:
        if left[0] == 0:
            raise Killed
        left[0] -= 1
        exchange(files, *one)  # type: ignore[arg-type]

    monkeypatch.setattr(ExchangedFiles, "_exchange", killed)
    actions = (*STEPS[step][0], *moves)
    for number, action in enumerate(actions):
        if number == len(actions) - 1:
            states.append(state_of(project))
            left[0] = most
        try:
            if isinstance(action, str):
                getattr(project.features, action)()
            else:
                action(project)
        except Killed:
            break
    shutil.copytree(folder, copy, ignore=shutil.ignore_patterns("lock*"))
    left[0] = 10**6
    with closing(Project.open(copy)) as again:
        moved = again.features.redo if moves[-1:] == ("undo",) else again.features.undo
        now = state_of(again)
        assert not same(now, states[0]) or step == "ground again"
        assert moved() is not None
        assert same(state_of(again), states[0])


def test_what_no_step_wants_any_more_goes_when_the_project_is_closed(project: Project) -> None:
    folder, kept = project.folder, len(project.drives)
    for step in (_normals, _volume, _import):
        step(project)
    for _ in range(3):
        project.features.undo()
    assert len(list((folder / "step_files").iterdir())) == 2
    assert len(list((folder / "drives").iterdir())) == kept + 1
    project.features.apply(DRAW, Change(added=(replace(SIGN, id="other"),)))
    project.close()
    assert not list((folder / "step_files").iterdir())
    assert len(list((folder / "drives").iterdir())) == kept


def test_steps_are_taken_back_in_their_order(project: Project) -> None:
    _import(project)
    later = project.drives[1].id
    project.features.apply(DRAW, Change(added=(replace(SIGN, id="on the new drive"),)))
    assert project.features.undo() is not None
    assert [drive.id for drive in project.drives[1:]] == [later]
    assert project.features.undo() is not None
    assert len(project.drives) == 1
    _normals(project)
    assert project.features.redo() is None


def test_the_first_drive_takes_its_reference_system_with_it(whole: Path, tmp_path: Path) -> None:
    with closing(Project.create(tmp_path / "n.zuka", "")) as project:
        bring(project, ImportRequest((whole.parent / "later.laz",)))
        assert project.crs == "EPSG:6677"
        assert project.features.undo() is not None
        assert (project.crs, project.drives) == ("", ())
        assert project.features.redo() is not None
        assert project.crs == "EPSG:6677"
        assert project.features.undo() is not None
        project.set_crs("EPSG:6678")
        # A drive of another system can't come back into it.
        assert not project.history.can_redo
    with closing(Project.open(tmp_path / "n.zuka")) as project:
        assert (project.crs, project.drives) == ("EPSG:6678", ())


def test_what_nobody_asked_for_is_no_step_and_comes_back_when_a_run_is_taken_back(
    project: Project,
) -> None:
    drive, position = project.drives[0], project.history.position
    request = RunRequest("normals", drive, tool_of("normals").parameters())
    into, labels = project.temporary_folder(), project.label_folder()
    made = finish_run(request, into, SilentMonitor(), labels_into=labels, begin=lambda: None)
    store_prepared(project, made)
    assert project.history.position == position
    prepared = drive.columns["normal"].tobytes()
    _normals_again(project)
    assert drive.columns["normal"].tobytes() != prepared
    project.features.undo()
    assert drive.columns["normal"].tobytes() == prepared


def test_a_full_disk_leaves_what_was_there(
    project: Project, monkeypatch: pytest.MonkeyPatch
) -> None:
    _normals(project)
    before, position = state_of(project), project.history.position
    exchange, seen = ExchangedFiles._exchange, []

    def full(files: ExchangedFiles, step: object, file: object) -> None:
        seen.append(file)
        if len(seen) == 2:
            raise NoSpace(DRAW, DRAW, DRAW)
        exchange(files, step, file)  # type: ignore[arg-type]

    monkeypatch.setattr(ExchangedFiles, "_exchange", full)
    with pytest.raises(NoSpace):
        _normals_again(project)
    assert len(seen) > 2
    assert project.history.position == position
    assert state_of(project) == before


def test_the_command_line_takes_an_import_back(project: Project) -> None:
    folder, request = project.folder, ImportRequest((_delivery(project) / "later.laz",))
    project.close()
    import_files(ImportOperation(folder, request), SilentMonitor())
    undone = undo_step(UndoOperation(folder), SilentMonitor())
    assert undone == UndoneStep(Text("Import later", "later のインポート"))
    with closing(Project.open(folder)) as again:
        assert len(again.drives) == 1
        assert again.history.can_redo


def test_the_picture_of_a_feature_is_a_file_of_its_project_and_nothing_else(
    project: Project,
) -> None:
    _pictured(project)
    (sign,) = (one for one in project.features.all() if one.id != SIGN.id)
    path = photo_of(sign, project.folder)
    assert path is not None
    assert path.is_relative_to(project.folder)
    assert photo_of(SIGN, project.folder) is None
    for typed in ("P1010023.jpg", "results/photos/../../project.gpkg", 7):
        written = replace(sign, attributes={"photo": typed})
        assert photo_of(written, project.folder) is None
