"""A project learns from what was painted in it, keeps both models, and says which one was used."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import laspy
import numpy as np
import pytest
from numpy.typing import NDArray

from processing.core.errors import Unsuitable
from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.labels.label_column import labels_of
from processing.map.change import Change
from processing.map.label_change import label_changes
from processing.methods.classes.class_models import shipped_models
from processing.operations.import_files import ImportOperation, import_files
from processing.operations.inputs import OperationInputs
from processing.operations.learn import LearnOperation, LearntModel, learn_in_project
from processing.operations.map_steps import UndoOperation, undo_step
from processing.operations.run import RunOperation, run_operation
from processing.project.importing.import_request import ImportRequest
from processing.project.own_models import newest_model
from processing.project.project import Project
from processing.project.results.run_findings import set_by_hand
from processing.tools.classify import ClassifyParameters, models_of

GROUND, GRASS, WALL = 2, 3, 6
M = SilentMonitor()


def lawn() -> tuple[NDArray[np.float64], NDArray[np.uint8]]:
    """60 m of smooth ground, a meadow beside it that is no rougher than gravel, a wall behind."""
    rng = np.random.default_rng(5)
    ground = np.column_stack([rng.uniform(0, 60, 30_000), rng.uniform(0, 8, 30_000)])
    is_grass = ground[:, 1] > 4
    height = rng.normal(0.0, np.where(is_grass, 0.02, 0.004))
    wall = np.column_stack(
        [rng.uniform(0, 60, 10_000), rng.normal(8.2, 0.004, 10_000), rng.uniform(0, 4, 10_000)]
    )
    xyz = np.concatenate([np.column_stack([ground, height]), wall])
    codes = np.concatenate([np.where(is_grass, GRASS, GROUND), np.full(len(wall), WALL)])
    return xyz, codes.astype(np.uint8)


@pytest.fixture
def project(tmp_path: Path) -> Path:
    xyz, _ = lawn()
    header = laspy.LasHeader(point_format=6, version="1.4")
    header.scales, header.offsets = np.full(3, 0.001), np.zeros(3)
    cloud = laspy.LasData(header)
    cloud.x, cloud.y, cloud.z = xyz.T
    cloud.write(tmp_path / "lawn.las")
    import_files(
        ImportOperation(
            tmp_path / "p.zuka", ImportRequest((tmp_path / "lawn.las",), crs="EPSG:6677")
        ),
        M,
    )
    return tmp_path / "p.zuka"


@pytest.fixture
def opened(project: Path) -> Iterator[Project]:
    with closing(Project.open(project)) as made:
        yield made


def truth_of(project: Project) -> NDArray[np.uint8]:
    """By the drive's own order of points."""
    xyz = project.drives[0].xyz(slice(0, project.drives[0].count))
    return np.where(xyz[:, 1] > 8.1, WALL, np.where(xyz[:, 1] > 4, GRASS, GROUND)).astype(np.uint8)


def paint(project: Path, codes: tuple[int, ...], places: int) -> NDArray[np.int64]:
    """Strokes of a metre at places 10 m apart, each class where it is; gives what was wrong."""
    with closing(Project.open(project)) as opened:
        (drive,) = opened.drives
        xyz, truth = drive.xyz(slice(0, drive.count)), truth_of(opened)
        is_near = (np.abs(xyz[:, 0] % 10 - 5) < 0.5) & (xyz[:, 0] < 10 * places)
        painted = [np.empty(0, np.int64)]
        for code in codes:
            points = np.flatnonzero(is_near & (truth == code))
            points = points[labels_of(drive, points) != code]
            painted.append(points)
            before = labels_of(drive, points)
            change = Change(labels=label_changes(drive.id, points, before, code))
            opened.features.apply(Text("Paint", "塗る"), change)
        return np.sort(np.concatenate(painted))


def learn(project: Path) -> LearntModel:
    return learn_in_project(LearnOperation(project), M)


def classify(project: Path, **parameters: str) -> Text:
    outcome = run_operation(
        RunOperation("classify", OperationInputs(project), parameters), SilentMonitor()
    )
    return outcome.stored[0].summary


def share_of_grass_found(project: Path) -> float:
    with closing(Project.open(project, writing=False)) as opened:
        (drive,) = opened.drives
        labels = labels_of(drive, np.arange(drive.count))
        return float((labels[truth_of(opened) == GRASS] == GRASS).mean())


def test_a_project_learns_a_meadow_that_the_program_takes_for_ground(project: Path) -> None:
    said = classify(project)
    assert "model" not in said.en
    before = share_of_grass_found(project)
    painted = paint(project, (GROUND, GRASS, WALL), 6)
    learnt = learn(project)
    assert learnt.facts.points == painted.size
    assert learnt.facts.gain.places >= 6
    assert learnt.facts.gain.helps
    assert "model learnt on" in classify(project).en
    assert share_of_grass_found(project) > before + 0.2

    with closing(Project.open(project, writing=False)) as opened:
        (drive,) = opened.drives
        assert drive.columns.has("confidence")
        labels = labels_of(drive, painted)
        # What was painted outlasts every run, and is told from what runs gave.
        np.testing.assert_array_equal(labels, truth_of(opened)[painted])
        assert set_by_hand(drive, painted, labels).all()
        rest = np.setdiff1d(np.arange(drive.count), painted)
        assert not set_by_hand(drive, rest, labels_of(drive, rest)).any()


def test_a_learnt_model_comes_and_goes_as_a_step(project: Path) -> None:
    paint(project, (GROUND, GRASS), 6)
    learn(project)
    newest = newest_model(project)
    assert newest is not None
    own = ClassifyParameters(model_folder=str(newest))
    assert "model learnt on" in models_of(own)[1].en
    assert models_of(replace(own, model="shipped"))[1].en == "the program's own model"
    undo_step(UndoOperation(project), M)
    assert newest_model(project) is None


def test_a_damaged_model_is_named_and_the_shipped_one_takes_its_place(tmp_path: Path) -> None:
    models, note = models_of(ClassifyParameters(model_folder=str(tmp_path)))
    assert models is shipped_models()
    assert note.en.startswith("the program's own model: ")
    (tmp_path / "model.json").write_text("[]", encoding="utf-8")
    _, note = models_of(ClassifyParameters(model_folder=str(tmp_path)))
    assert note.en == "the program's own model: The model is damaged"


@pytest.mark.parametrize(
    ("codes", "places", "what"),
    [((), 0, "Too little"), ((GRASS,), 2, "Too little"), ((GRASS,), 6, "Only one class")],
)
def test_too_little_paint_is_refused_in_one_sentence_and_nothing_is_kept(
    project: Path, codes: tuple[int, ...], places: int, what: str
) -> None:
    paint(project, codes, places)
    with pytest.raises(Unsuitable, match=what):
        learn(project)
    assert newest_model(project) is None
