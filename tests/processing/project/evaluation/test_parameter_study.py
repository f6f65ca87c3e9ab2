"""Parameter studies: every setting is run and counted, on the whole drive or a part of it."""

from __future__ import annotations

import csv
from argparse import Namespace
from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from app.cli.study import command
from processing.core.errors import Cancelled, OutOfRange, Unsuitable
from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.project.evaluation.parameter_study import (
    ParameterStudy,
    StudyCell,
    StudyRequest,
    VariedParameter,
    can_vary,
    steps_of,
    study,
    usual_range,
    varied_of,
)
from processing.project.evaluation.study_store import KeptStudy, StudyStore
from processing.project.evaluation.truth_of_file import coded_truth, truth_of_file
from processing.project.evaluation.truth_store import Truth, TruthStore, read_truth
from processing.project.evaluation.truth_study import study_by_truth
from processing.project.importing.importing import ImportRequest, import_drives
from processing.project.project import Project
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix
from processing.tools.noise import NoiseParameters
from processing.tools.running.runner import RunRequest, run
from tests.builders import write_laz, write_trajectory_csv
from tests.monitors import CancelledAfter
from tests.noisy_street import NoisyStreet, noisy_street

SILENT = SilentMonitor()
NAME = Text("truth", "正解")
NOW = datetime(2024, 5, 1, 12, tzinfo=UTC)


@pytest.fixture(scope="module")
def scene() -> NoisyStreet:
    return noisy_street(7, length_m=3.0)


@pytest.fixture(scope="module")
def files(scene: NoisyStreet, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("delivered")
    write_laz(scene.drive, folder / "左.laz")
    write_trajectory_csv(scene.drive, folder / "軌跡.csv")
    np.savez(folder / "truth.npz", code=scene.noise)
    return folder


@pytest.fixture(scope="module")
def project(files: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Project]:
    project = Project.create(tmp_path_factory.mktemp("project") / "p.zuka", "EPSG:6677")
    into = project.temporary_folder()
    into.mkdir(parents=True)
    request = ImportRequest((files / "左.laz",), (files / "軌跡.csv",))
    project.adopt_drives(import_drives(request, into, SILENT))
    codes = coded_truth(files / "truth.npz")
    made = truth_of_file(project.drives, codes, project.temporary_folder(), SILENT)
    truth = Truth("t", NAME, dict(made.known), NOW)
    TruthStore(project.settings).add(truth, made.folders, project.drive)
    yield project
    project.close()


def radius_study(project: Project, **changes: object) -> StudyRequest:
    varied = (VariedParameter("radius_m", (0.2, 0.4)), VariedParameter("neighbours", (5, 20)))
    fixed = {"method": "radius"}
    return StudyRequest("noise", project.drives, fixed, varied, **changes)  # type: ignore[arg-type] - by name


def test_each_setting_scores_as_a_run_with_it(project: Project, tmp_path: Path) -> None:
    (drive,) = project.drives
    into = tmp_path / "work"
    found = study_by_truth(radius_study(project), "t", into, SILENT, is_part=False)
    assert not into.exists()
    assert [cell.values for cell in found.cells] == [(0.2, 5), (0.2, 20), (0.4, 5), (0.4, 20)]
    is_noise = read_truth(drive, "t", 0, drive.count) > 1
    for cell in found.cells:
        radius_m, neighbours = cell.values
        parameters = NoiseParameters("radius", radius_m=radius_m, neighbours=neighbours)  # type: ignore[arg-type] - as varied
        result = run(RunRequest("noise", drive, parameters), SILENT, into=tmp_path / "run")
        called = np.isin(result.read("classification", 0, drive.count), (7, 18))  # type: ignore[union-attr] - it gives columns
        result.remove()  # type: ignore[union-attr] - it gives columns
        assert cell.counts == BinaryConfusionMatrix.of(is_noise, called)
    assert found.best is max(found.cells, key=lambda cell: cell.counts.f_measure)
    assert found.fixed == {"method": "radius"}


def test_a_part_is_studied_by_itself_and_only_its_known_points_count(
    project: Project, tmp_path: Path
) -> None:
    (drive,) = project.drives
    xyz = drive.xyz(slice(None))
    codes = read_truth(drive, "t", 0, drive.count).copy()
    ahead = xyz[:, 1] - xyz[:, 1].min()
    codes[ahead > 0.5] = 0
    (tmp_path / "part").mkdir()
    codes.tofile(tmp_path / "part" / "truth.bin")
    store = TruthStore(project.settings)
    known = int((codes > 0).sum())
    store.add(
        Truth("p", NAME, {drive.id: known}, NOW), {drive.id: tmp_path / "part"}, project.drive
    )
    request = radius_study(project)
    part = study_by_truth(request, "p", tmp_path / "w", SILENT, is_part=True)
    whole = study_by_truth(request, "p", tmp_path / "w", SILENT, is_part=False)
    # Five metres of surroundings are more than the radius: the same points are found.
    assert part == whole
    assert part.cells[0].counts.count == known
    assert list((drive.folder / "truths").iterdir())
    store.remove("p", project.drive)


def test_without_a_known_point_nothing_is_run(project: Project, tmp_path: Path) -> None:
    def nobody_knows(_drive: object, start: int, stop: int) -> np.ndarray:
        return np.zeros(stop - start, np.uint8)

    with pytest.raises(Unsuitable, match="no point"):
        study(radius_study(project), nobody_knows, SILENT, tmp_path / "w")
    assert not (tmp_path / "w").exists()


@pytest.mark.parametrize("is_part", [False, True])
def test_a_cancelled_study_leaves_nothing(project: Project, tmp_path: Path, is_part: bool) -> None:
    with pytest.raises(Cancelled):
        study_by_truth(
            radius_study(project), "t", tmp_path / "w", CancelledAfter(12), is_part=is_part
        )
    assert not (tmp_path / "w").exists()


def test_values_are_even_within_the_limits_and_words_are_all_of_a_choice() -> None:
    known = {one.id: one for one in can_vary("noise")}
    assert steps_of(known["radius_m"], 0.1, 0.5, 5).values == (0.1, 0.2, 0.3, 0.4, 0.5)
    assert steps_of(known["neighbours"], 1, 3, 9).values == (1, 2, 3)
    assert steps_of(known["method"], 0, 0, 1).values == ("combined", "radius", "statistical")
    assert usual_range(known["radius_m"]) == (0.25, 1.0)
    assert usual_range(known["strictness"]) == (0.25, 1.0)


@pytest.mark.parametrize(
    "words",
    [
        "radius_m",
        "radius_m=1:2",
        "radius_m=a:b:3",
        "radius_m=0.1:1:0",
        "speed=1:2:3",
        "method=1:2:3",
    ],
)
def test_what_cannot_be_varied_is_refused_with_the_words_that_can(words: str) -> None:
    with pytest.raises(OutOfRange, match="radius_m"):
        varied_of("noise", [words])


@pytest.mark.parametrize("varied", [(), (VariedParameter("radius_m", (0.1,)),) * 2])
def test_one_or_two_parameters_are_varied(
    project: Project, tmp_path: Path, varied: tuple[VariedParameter, ...]
) -> None:
    request = StudyRequest("noise", project.drives, {}, varied)
    with pytest.raises(OutOfRange, match="one or two"):
        study_by_truth(request, "t", tmp_path / "w", SILENT, is_part=False)


def test_values_outside_their_limits_are_refused_before_the_first_run(
    project: Project, tmp_path: Path
) -> None:
    request = StudyRequest("noise", project.drives, {}, (VariedParameter("radius_m", (0.1, 99.0)),))
    with pytest.raises(OutOfRange, match=r"0\.01 to 10"):
        study_by_truth(request, "t", tmp_path / "w", SILENT, is_part=False)


def test_the_best_is_the_first_of_equals_and_none_where_nothing_can_be_scored() -> None:
    cells = [StudyCell((one,), BinaryConfusionMatrix(5, 1, 1, 9)) for one in (1, 2)]
    varied = (VariedParameter("neighbours", (1, 2)),)
    assert ParameterStudy("noise", 1, {}, varied, tuple(cells)).best is cells[0]
    nothing = StudyCell((1,), BinaryConfusionMatrix(0, 0, 0, 9))
    assert ParameterStudy("noise", 1, {}, varied, (nothing,)).best is None


def test_studies_are_kept_with_the_project_the_last_fifty(project: Project, tmp_path: Path) -> None:
    cells = (StudyCell((0.5, "radius"), BinaryConfusionMatrix(5, 1, 1, 9)),)
    varied = (VariedParameter("radius_m", (0.5,)), VariedParameter("method", ("radius",)))
    found = ParameterStudy("noise", 1, {"deviations": 1.5}, varied, cells)
    store = StudyStore(project.settings)
    for number in range(52):
        store.add(KeptStudy(str(number), found, NAME, "左", is_part=True, made=NOW))
    again = Project.open(project.folder, writing=False)
    kept = StudyStore(again.settings).all()
    again.close()
    assert [one.id for one in kept] == [str(number) for number in range(2, 52)]
    assert kept[0] == KeptStudy("2", found, NAME, "左", is_part=True, made=NOW)
    store.remove("2")
    assert store.all()[0].id == "3"


def test_the_command_line_writes_a_row_for_each_setting(
    files: Path, scene: NoisyStreet, tmp_path: Path
) -> None:
    output = tmp_path / "study.csv"
    arguments = Namespace(
        columns="",
        tool="noise",
        inputs=[files / "左.laz"],
        trajectory=[files / "軌跡.csv"],
        images=[],
        crs="",
        truth=[files / "truth.npz"],
        vary=["radius_m=0.2:0.4:2"],
        set=["method=radius", "neighbours=20"],
        output=output,
    )
    assert command(arguments) == 0
    with output.open(encoding="utf-8-sig", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["radius_m"] for row in rows] == ["0.2", "0.4"]
    noise = int((scene.noise > 0).sum())
    for row in rows:
        hits, missed = int(row["noise_point_right"]), int(row["noise_point_missed"])
        assert hits + missed == noise
        assert float(row["noise_point_recall"]) == pytest.approx(hits / noise, abs=1e-6)
        assert int(row["points"]) == scene.drive.count
        assert row["method"] == "radius"
    assert [one.name for one in tmp_path.iterdir()] == ["study.csv"]
