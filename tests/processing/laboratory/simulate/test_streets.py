"""A street made to order: its files, its truth, and that chance decides nothing twice."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import laspy
import numpy as np
import pytest

from processing.core.errors import Cancelled, InUse, OutOfRange
from processing.core.monitor import SilentMonitor
from processing.formats.trajectories.trajectory_csv import read_trajectory_csv
from processing.laboratory.simulate.requests import StreetRequest
from processing.laboratory.simulate.streets import simulate_street
from processing.laboratory.simulate.truth import TRUTH_FILES
from tests.monitors import CancelledAfter

_REQUEST = StreetRequest(
    seed=11, length_m=15.0, sensor="vq250", pulses=500, turns_per_s=40.0, images=False
)
DeliveryMaker = Callable[[StreetRequest], Path]


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> DeliveryMaker:
    known: dict[StreetRequest, Path] = {}

    def make(request: StreetRequest) -> Path:
        if request not in known:
            known[request] = tmp_path_factory.mktemp("made") / "street"
            simulate_street(request, known[request], SilentMonitor())
        return known[request]

    return make


def _files(folder: Path) -> dict[str, bytes]:
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


def test_the_same_seed_gives_the_same_bytes(made: DeliveryMaker, tmp_path: Path) -> None:
    simulate_street(_REQUEST, tmp_path / "again", SilentMonitor())
    assert _files(made(_REQUEST)) == _files(tmp_path / "again")


def test_another_seed_gives_another_street(made: DeliveryMaker) -> None:
    one, other = (
        laspy.read(made(request) / "left.laz") for request in (_REQUEST, replace(_REQUEST, seed=12))
    )
    assert not np.array_equal(one.x[:1000], other.x[:1000])


def test_a_longer_street_begins_like_a_shorter_one(made: DeliveryMaker) -> None:
    short, long = (
        laspy.read(made(request) / "right.laz")
        for request in (_REQUEST, replace(_REQUEST, length_m=25.0))
    )
    same = int(0.95 * len(short.points))
    assert len(long.points) > 1.3 * len(short.points)
    assert (short.points.array[:same] == long.points.array[:same]).all()


def test_files_are_as_deliveries_are(made: DeliveryMaker) -> None:
    folder = made(_REQUEST)
    trajectory = read_trajectory_csv(folder / "trajectory.csv")
    for number, name in enumerate(("left", "right"), start=1):
        points = laspy.read(folder / f"{name}.laz")
        times = np.asarray(points.gps_time)
        assert points.header.version == "1.4"
        assert points.header.point_format.id == 6
        assert points.header.parse_crs().to_epsg() == 6677
        assert (np.diff(times) >= 0).all()
        assert times[0] >= trajectory.time[0]
        assert times[-1] <= trajectory.time[-1]
        assert (points.point_source_id == number).all()
        assert not np.asarray(points.classification).any()
        assert (np.asarray(points.return_number) <= np.asarray(points.number_of_returns)).all()


def test_beams_leave_from_where_the_trajectory_says(made: DeliveryMaker) -> None:
    """Seen from the head, pulses of one turn lie in the plane square to its axis."""
    folder = made(_REQUEST)
    trajectory = read_trajectory_csv(folder / "trajectory.csv")
    head = json.loads((folder / "truth" / "scene.json").read_text())["heads"]["left"]
    points = laspy.read(folder / "left.laz")
    own = trajectory.to_vehicle(points.xyz, np.asarray(points.gps_time))
    beams = own - np.array(head["lever_arm_fwd_left_up_m"])
    yaw, pitch = np.radians([head["spin_axis_yaw_deg"], head["spin_axis_pitch_deg"]])
    axis = [np.cos(yaw) * np.cos(pitch), np.sin(yaw) * np.cos(pitch), np.sin(pitch)]
    assert np.percentile(np.abs(beams @ np.array(axis)), 99) < 0.05


def test_every_point_has_its_truth(made: DeliveryMaker) -> None:
    truth = made(_REQUEST) / "truth"
    kinds = json.loads((truth / "instance_kinds.json").read_text())
    for name in ("left", "right"):
        count = len(laspy.read(made(_REQUEST) / f"{name}.laz").points)
        labels = np.load(truth / f"{name}.labels.npy")
        instances = np.load(truth / f"{name}.instances.npy")
        assert labels.shape == instances.shape == (count,)
        assert labels.dtype == np.uint8
        assert instances.dtype == np.int32
        assert set(np.unique(labels).tolist()) <= {1, 2, 3, 4, 5, 6, 7, 11, 14, 18, 64, 65, 66, 67}
        assert {str(one) for one in np.unique(instances) if one} <= set(kinds)
        assert (labels == 11).mean() > 0.05


def test_counts_of_the_truth_are_those_of_the_points(made: DeliveryMaker) -> None:
    truth = made(_REQUEST) / "truth"
    instances = np.concatenate(
        [np.load(truth / f"{one}.instances.npy") for one in ("left", "right")]
    )
    for name in TRUTH_FILES:
        for one in json.loads((truth / f"{name}.geojson").read_text())["features"]:
            facts = one["properties"]
            seen = int((instances == facts["instance"]).sum())
            if name in ("trees", "poles", "gutters", "wires", "markings", "barriers", "covers"):
                assert facts["points"] == seen
            elif name == "curbs":
                # Edges of one run share their points; pieces beyond the line belong to none.
                assert sum(part["points"] for part in facts["sections"]) <= 2 * seen + 2
            elif name == "plant_areas":
                assert (facts["points"] > 0) >= (facts["covered"] > 0)
            elif name in ("walls", "edges"):
                # Those of the ground have no instance of their own.
                assert facts["points"] == sum(facts["piece_points"])
            else:
                assert facts["front_points"] <= facts["points"] <= seen


def test_a_second_pass_is_another_delivery_of_the_same_street(made: DeliveryMaker) -> None:
    folder = made(replace(_REQUEST, passes=2))
    assert {one.name for one in folder.glob("*.laz")} == {
        "left.laz",
        "right.laz",
        "left_2.laz",
        "right_2.laz",
    }
    ids = {one.name: set(laspy.read(one).point_source_id.tolist()) for one in folder.glob("*.laz")}
    assert sorted(ids.values(), key=min) == [{1}, {2}, {3}, {4}]  # each is a drive of its own
    first, second = (read_trajectory_csv(folder / f"trajectory{end}.csv") for end in ("", "_2"))
    assert second.time[0] > first.time[-1]
    assert np.linalg.norm(first.xyz[0, :2] - second.xyz[-1, :2]) < 15


def test_phase_scanners_record_too(made: DeliveryMaker) -> None:
    folder = made(replace(_REQUEST, sensor="zf9012", style="rural"))
    points = laspy.read(folder / "scan.laz")
    assert (points.number_of_returns == 1).all()
    assert len(points.points) > 5000


def test_the_shortest_and_fastest_pass_of_the_slowest_sensor_is_recorded(
    made: DeliveryMaker,
) -> None:
    request = replace(_REQUEST, style="highway", length_m=10.0, speed_km_h=130.0, pulses=1)
    folder = made(replace(request, turns_per_s=0.5))
    assert len(laspy.read(folder / "left.laz").points) <= 4


def test_a_stopped_simulation_leaves_nothing(tmp_path: Path) -> None:
    with pytest.raises(Cancelled):
        simulate_street(_REQUEST, tmp_path / "street", CancelledAfter(2))
    assert not list(tmp_path.iterdir())


def test_wrong_requests_are_told(tmp_path: Path) -> None:
    for request in (replace(_REQUEST, style="moon"), replace(_REQUEST, sensor="p40")):
        with pytest.raises(OutOfRange):
            simulate_street(request, tmp_path / "street", SilentMonitor())
    (tmp_path / "mine").write_text("x")
    with pytest.raises(InUse):
        simulate_street(_REQUEST, tmp_path, SilentMonitor())
