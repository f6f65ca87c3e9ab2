"""Whole sites: files, truth, and what the points say of the ground."""

from __future__ import annotations

import dataclasses
import hashlib
import json
from pathlib import Path

import laspy
import numpy as np
import pytest

from processing.core.errors import Cancelled, InUse, OutOfRange
from processing.core.monitor import SilentMonitor
from processing.laboratory.simulate.requests import SiteRequest
from processing.laboratory.simulate.site import simulate_site
from processing.laboratory.simulate.sites.heights import HeightGrid
from processing.laboratory.simulate.sites.volumes import cut_and_fill
from tests.monitors import CancelledAfter

REQUEST = SiteRequest(seed=11, length_m=24.0, style="levee", stations=3, spacing_m=0.12)


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("sites") / "one"
    made = simulate_site(REQUEST, folder, SilentMonitor())
    assert made.points == (folder / "in/before.laz", folder / "in/after.laz")
    return folder


def heights_of(folder: Path, date: str) -> tuple[HeightGrid, np.ndarray]:
    with np.load(folder / f"truth/terrain_{date}.npz") as found:
        return HeightGrid(found["z"], float(found["res"])), np.array([found["x0"], found["y0"]])


@pytest.mark.parametrize("date", ["before", "after"])
def test_a_cloud_is_delivered_in_time_order_with_its_labels_beside_it(
    site: Path, date: str
) -> None:
    cloud = laspy.read(site / f"in/{date}.laz")
    assert cloud.header.point_format.id == 6
    assert str(cloud.header.version) == "1.4"
    assert cloud.header.parse_crs().to_epsg() == 6677
    assert (cloud.header.scales == 0.001).all()
    assert (np.diff(cloud.gps_time) >= 0).all()
    assert set(np.unique(cloud.point_source_id)) == {1, 2, 3}
    assert (np.asarray(cloud.classification) == 0).all()
    labels = np.load(site / f"truth/labels_{date}.npy")
    kinds = np.load(site / f"truth/kinds_{date}.npy")
    assert labels.dtype == np.uint8
    assert kinds.dtype == np.int8
    assert labels.size == kinds.size == len(cloud) > 20_000
    assert set(np.unique(labels)) <= {1, 2, 7, 18}
    counts = json.loads((site / "truth/scene.json").read_text())["epochs"][date]
    assert counts["points"] == labels.size
    assert counts["ground"] == (labels == 2).sum()


@pytest.mark.parametrize("date", ["before", "after"])
def test_ground_points_lie_on_the_true_ground_within_the_noise(site: Path, date: str) -> None:
    cloud = laspy.read(site / f"in/{date}.laz")
    labels = np.load(site / f"truth/labels_{date}.npy")
    kinds = np.load(site / f"truth/kinds_{date}.npy")
    heights, corner = heights_of(site, date)
    xy = np.column_stack([cloud.x, cloud.y]) - corner
    above = np.asarray(cloud.z) - heights.height(xy[:, 0], xy[:, 1])
    bare = above[(labels == 2) & (kinds == 0)]
    assert abs(np.median(bare)) < 0.02  # blades below 4 cm count as ground and lift it
    assert np.quantile(np.abs(bare), 0.95) < 0.05
    assert (above[labels == 7] < 0.0).all()
    assert (above[kinds == 10] > 0.02).all()


def test_volumes_are_those_of_the_truth_s_own_grounds(site: Path) -> None:
    volume = json.loads((site / "truth/volume.json").read_text())
    (before, corner), (after, _) = heights_of(site, "before"), heights_of(site, "after")
    found = cut_and_fill(before, after, np.array(volume["polygon"]) - corner)
    assert found.cut_m3.sum() == pytest.approx(volume["cut_m3"], rel=1e-9)
    assert found.fill_m3.sum() == pytest.approx(volume["fill_m3"], rel=1e-9)
    assert volume["net_m3"] == pytest.approx(volume["fill_m3"] - volume["cut_m3"], rel=1e-12)
    assert 0.3 < volume["seen_in_both_share"] <= 1
    assert volume["cut_where_seen_m3"] <= volume["cut_m3"]
    ring = json.loads((site / "in/site.geojson").read_text())["features"][0]["geometry"]
    assert ring["coordinates"][0][:-1] == volume["polygon"]


def test_a_seed_gives_the_same_bytes_again(site: Path, tmp_path: Path) -> None:
    simulate_site(REQUEST, tmp_path / "two", SilentMonitor())
    files = sorted(path.relative_to(site) for path in site.rglob("*") if path.is_file())
    assert len(files) == 11
    for name in files:
        one, two = (
            hashlib.sha256((root / name).read_bytes()).digest() for root in (site, tmp_path / "two")
        )
        assert one == two, name


@pytest.mark.parametrize("patience", [0, 3, 20])
def test_a_cancelled_site_leaves_nothing(tmp_path: Path, patience: int) -> None:
    with pytest.raises(Cancelled):
        simulate_site(REQUEST, tmp_path / "site", CancelledAfter(patience))
    assert list(tmp_path.iterdir()) == []


def test_a_folder_with_files_is_refused_and_stays_as_it_is(tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("mine")
    with pytest.raises(InUse):
        simulate_site(REQUEST, tmp_path, SilentMonitor())
    assert [path.name for path in tmp_path.iterdir()] == ["notes.txt"]


@pytest.mark.parametrize(
    "wrong", [{"length_m": 5.0}, {"style": "harbour"}, {"sensor": "vq250"}, {"stations": 13}]
)
def test_a_request_beyond_its_limits_is_refused(tmp_path: Path, wrong: dict[str, object]) -> None:
    with pytest.raises(OutOfRange):
        simulate_site(dataclasses.replace(REQUEST, **wrong), tmp_path / "site", SilentMonitor())
    assert list(tmp_path.iterdir()) == []
