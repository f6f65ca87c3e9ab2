"""Ground in a project: one click treats all drives recorded together, as one step of undo."""

from __future__ import annotations

from argparse import Namespace
from dataclasses import replace
from pathlib import Path

import laspy
import numpy as np
import pytest
from pytestqt.qtbot import QtBot

from app.classes.truth_evaluations import TruthEvaluations
from app.cli.run import command
from app.document.document import Document
from app.jobs.jobs import JobQueue
from processing.core.errors import InUse, UserError
from processing.core.text import Text
from processing.labels.label_column import labels_of
from processing.map.change import Change
from processing.map.label_change import label_changes
from processing.methods.ground.stored_surface import ground_surface_of
from processing.project.evaluation.truth_making import CheckedPoints
from processing.project.evaluation.truth_store import has_truth
from processing.project.importing.importing import ImportRequest
from processing.recording.vehicle_path.clock import DAY_S
from processing.tools.ground import GroundParameters
from tests.builders import SimulatedDrive, simulated_drive, write_laz, write_trajectory_csv
from tests.earthwork_site import GROUND, earthwork_site, write_site

WAIT_MS = 30_000


@pytest.fixture(scope="module")
def heads() -> tuple[SimulatedDrive, SimulatedDrive]:
    return simulated_drive(1, length_m=6.0), simulated_drive(2, length_m=6.0, head="right")


@pytest.fixture
def delivery(heads: tuple[SimulatedDrive, SimulatedDrive], tmp_path: Path) -> ImportRequest:
    clouds = tuple(
        write_laz(one, tmp_path / f"{name}.laz") for one, name in zip(heads, "lr", strict=True)
    )
    return ImportRequest(clouds, (write_trajectory_csv(heads[0], tmp_path / "t.csv"),))


def test_one_run_labels_both_heads_and_one_undo_takes_it_back(
    street: Document, tmp_path: Path, qtbot: QtBot
) -> None:
    reported: list[Text] = []
    street.reported.connect(reported.append)
    first, second = street.drives()
    request = GroundParameters(surface=str(tmp_path / "地表面.tif"))
    with qtbot.waitSignal(street.reported, timeout=WAIT_MS):
        street.start_run("ground", second.id, request)
    for drive in (first, second):
        labels = labels_of(drive, np.arange(drive.count))
        assert set(np.unique(labels)) == {1, 2}
        surface = ground_surface_of(drive)
        assert surface is not None
        ground = drive.xyz(labels == 2)
        off = np.abs(surface.heights_at(ground[:, :2]) - ground[:, 2])
        # Ground that is not near the surface lies on the face of a step.
        assert (off <= 0.3).mean() > 0.99
    assert "cells of 0." in reported[-1].en
    (run,) = street.runs()
    assert set(run.drives) == {first.id, second.id}
    assert (tmp_path / "地表面.tif").is_file()
    assert street.undo()
    assert not any(labels_of(one, np.arange(one.count)).any() for one in street.drives())


def test_a_truth_made_by_hand_is_about_all_that_was_recorded_together(
    street: Document, jobs: JobQueue, qtbot: QtBot
) -> None:
    evaluations = TruthEvaluations(street, jobs)
    first, second = street.drives()
    street.shared.view_settings.show_image(second.id, second.image_kinds[0])
    with qtbot.waitSignal(evaluations.truth_made, timeout=WAIT_MS):
        evaluations.make_truth(CheckedPoints.WHOLE, None)
    (whole,) = evaluations.truths()
    assert whole.known == {first.id: first.count, second.id: second.count}
    assert whole.name.en == f"{second.info.name} and 1 more: all checked"
    refused: list[UserError] = []
    street.refused.connect(refused.append)
    with qtbot.waitSignal(street.refused, timeout=WAIT_MS):
        evaluations.make_truth(CheckedPoints.PAINTED, None)
    assert refused[0].what.en == "No point was painted by hand."
    points = np.arange(10, 30)
    none = labels_of(first, points)
    assert street.apply(Text.same("p"), Change(labels=label_changes(first.id, points, none, 2)))
    with qtbot.waitSignal(evaluations.truth_made, timeout=WAIT_MS):
        evaluations.make_truth(CheckedPoints.PAINTED, None)
    assert evaluations.truths()[-1].known == {first.id: 20}
    assert not has_truth(second, evaluations.truths()[-1].id)


def _request(delivery: ImportRequest, output: Path, *settings: str) -> Namespace:
    return Namespace(
        columns="",
        tool="ground",
        inputs=list(delivery.inputs),
        trajectory=list(delivery.trajectories),
        images=[],
        crs="",
        set=list(settings),
        output=output,
    )


def test_the_command_line_gives_classes_heights_and_the_surface(
    heads: tuple[SimulatedDrive, SimulatedDrive], delivery: ImportRequest, tmp_path: Path
) -> None:
    out = tmp_path / "out"
    assert command(_request(delivery, out / "g.laz", f"surface={out / 's.tif'}")) == 0
    assert {path.name for path in out.iterdir()} == {"g-l.laz", "g-r.laz", "s.tif"}
    for head, name in zip(heads, "lr", strict=True):
        cloud = laspy.read(out / f"g-{name}.laz")
        said = np.asarray(cloud.classification)
        is_road = head.surface == 0
        assert (said[is_road] == 2).mean() > 0.98
        assert (said[head.surface == 3] == 1).mean() > 0.9
        above = np.asarray(cloud["height_above_ground"])
        assert above.dtype == np.float32
        assert np.abs(above[is_road]).max() < 0.2
        np.testing.assert_array_equal(cloud.X, head.columns["xyz"][:, 0])


def test_two_dates_with_the_same_station_numbers_are_judged_apart(tmp_path: Path) -> None:
    dug = np.array([0.0, 0.0, -0.6])
    before, after = earthwork_site(1), earthwork_site(2)
    sites = {"before": before, "after": replace(after, xyz=after.xyz + dug)}
    clouds = tuple(
        write_site(site, tmp_path / f"{name}.laz", start_s=3.5e8 + number * 30 * DAY_S)
        for number, (name, site) in enumerate(sites.items())
    )
    out = tmp_path / "out"
    assert command(_request(ImportRequest(clouds), out / "g.laz", f"surface={out / 's.tif'}")) == 0
    surfaces = {f"s-{name} (1).tif" for name in sites}
    assert {path.name for path in out.iterdir()} == {*surfaces, "g-before.laz", "g-after.laz"}
    for name, site in sites.items():
        cloud = laspy.read(out / f"g-{name}.laz")
        np.testing.assert_allclose(np.asarray(cloud.xyz), site.xyz, atol=1e-6)
        is_ground = np.asarray(cloud.classification) == GROUND
        assert is_ground[site.truth == GROUND].mean() > 0.99
        assert is_ground[site.truth != GROUND].mean() < 0.1


def test_a_surface_never_overwrites_a_delivered_file(
    delivery: ImportRequest, tmp_path: Path
) -> None:
    taken = delivery.inputs[0].rename(tmp_path / "l.tif")
    request = ImportRequest((taken, delivery.inputs[1]), delivery.trajectories)
    before = taken.read_bytes()
    with pytest.raises(InUse):
        command(_request(request, tmp_path / "out" / "g.laz", f"surface={taken}"))
    assert taken.read_bytes() == before
