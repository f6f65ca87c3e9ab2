from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from processing.core.monitor import Monitor, SilentMonitor
from processing.laboratory.accuracy import site_volumes
from processing.laboratory.accuracy.known_body import body_points, body_rows, body_volume_m3
from processing.laboratory.accuracy.site_volumes import rows_of, score_site
from processing.laboratory.simulate.requests import SiteRequest
from processing.laboratory.simulate.site import simulate_site
from processing.methods.earthwork.volumes.volume_parameters import VolumeParameters


def test_every_method_comes_near_the_volume_of_a_known_body() -> None:
    off = {row[0]: float(row[4].rstrip(" %")) for row in body_rows()[1:]}

    assert abs(off["grid, 0.2 m"]) < 0.1
    assert abs(off["TIN against TIN"]) < 0.1
    assert abs(off["average end area, 5 m"]) < 1.0
    assert abs(off["prismoidal formula, 5 m"]) < 0.5


def test_the_known_body_is_as_high_as_its_formula_says() -> None:
    points = body_points()
    width, depth = np.ptp(points[:, 0]), np.ptp(points[:, 1])
    mean = points[:, 2].mean() - 20.0

    assert mean * width * depth == pytest.approx(body_volume_m3(), rel=0.01)


def test_a_simulated_site_is_held_against_its_truth(tmp_path: Path) -> None:
    request = SiteRequest(seed=5, length_m=20.0, stations=2, spacing_m=0.06)
    folder = tmp_path / "site"
    simulate_site(request, folder, SilentMonitor())
    site = score_site("small", folder, VolumeParameters())
    rows = rows_of([site])

    # The true sums over what was measured and over all of the site are of one site.
    assert 0.0 < sum(site.true_measured) <= 1.02 * site.moved_m3
    assert site.result.volumes.area_m2 == pytest.approx(site.truth["area_m2"], rel=0.01)
    assert len({len(row) for row in rows}) == 1
    assert rows[1][0] == "small"

    # Shares of what was moved, not of a part that may be next to nothing.
    gap_m3 = site.result.volumes.cut_m3 - site.truth["cut_m3"]
    assert site.errors[2] == pytest.approx(gap_m3 / site.moved_m3)
    assert max(map(abs, site.errors[:2])) < 0.05
    assert max(map(abs, site.bias_m)) < 0.5


def test_sites_are_made_when_they_are_asked_for_and_gone_afterwards(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    made: list[Path] = []

    def simulated(_request: SiteRequest, folder: Path, _monitor: Monitor) -> None:
        folder.mkdir()
        made.append(folder)

    monkeypatch.setattr(site_volumes, "simulate_site", simulated)
    sites = site_volumes.simulated_sites([1, 2, 3], None)
    next(sites)
    assert len(made) == 1
    next(sites)
    assert [folder.exists() for folder in made] == [False, True]

    assert len(list(site_volumes.simulated_sites([1, 2, 3], tmp_path))) == 3
    assert all(folder.exists() for folder in made[2:])
