"""The accuracy command on a small data folder made here: its tables, its page, its pictures."""

from __future__ import annotations

from pathlib import Path

import laspy
import numpy as np
import pytest

from processing.formats.points.point_files import read_info
from processing.laboratory.accuracy.filters import peer_filters
from processing.laboratory.accuracy.filters.filter_methods import (
    as_delivered,
    noise_methods,
    site_methods,
)
from processing.laboratory.accuracy.filters.filter_scenes import (
    FilterScene,
    airborne_samples,
    noise_scenes,
    sites,
)
from processing.laboratory.accuracy.filters.filter_tables import (
    FilterResult,
    airborne_table,
    noise_table,
    sites_table,
)
from processing.laboratory.accuracy.filters.filters import HEADINGS, main, replace_section
from processing.scoring.points.confusion_matrix import ConfusionMatrix
from processing.scoring.points.point_scores import ground_score, noise_score

WRITTEN_HERE = ("nothing removed", "PTD (Axelsson)", "roller")
"""Peers that need no other program."""


def box_on_plain(seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """A plain of 20 m x 20 m with a box of 2 m on it; codes 2 and 1."""
    random = np.random.default_rng(seed)
    ground = np.column_stack([random.uniform(0, 20, (2000, 2)), random.normal(0, 0.01, 2000)])
    box = random.uniform((9, 9, 0.5), (11, 11, 2.0), (300, 3))
    is_hidden = (np.abs(ground[:, :2] - 10) < 1).all(axis=1)
    xyz = np.concatenate([ground[~is_hidden], box]) + np.array([-11_000.0, -35_000.0, 100.0])
    codes = np.r_[np.full(int((~is_hidden).sum()), 2), np.full(300, 1)].astype(np.uint8)
    return np.round(xyz, 2), codes


@pytest.fixture
def data(tmp_path: Path) -> Path:
    folder = tmp_path / "data"
    xyz, codes = box_on_plain()
    for name in ("site/in", "site/truth", "isprs"):
        (folder / name).mkdir(parents=True)
    header = laspy.LasHeader(point_format=6, version="1.4")
    header.scales, header.offsets = [0.01] * 3, [-11_000.0, -35_000.0, 100.0]
    las = laspy.LasData(header)
    las.xyz = xyz
    las.write(folder / "site" / "in" / "after.laz")
    np.save(folder / "site" / "truth" / "labels_after.npy", codes)
    np.save(folder / "site" / "truth" / "kinds_after.npy", (codes == 1).astype(np.int8))
    rows = np.column_stack([xyz, codes == 1])
    np.savetxt(folder / "isprs" / "samp12.txt", rows, fmt="%.2f\t%.2f\t%.2f\t%d")
    return folder


def test_scenes_are_found_by_their_files_with_truth_and_kinds(data: Path) -> None:
    (site,) = sites(data)
    (sample,) = airborne_samples(data)
    assert site.name == "site, after"
    assert sample.name == "samp12"
    assert np.array_equal(site.truth, sample.truth)
    assert np.allclose(site.xyz, sample.xyz, atol=1e-6)
    assert int(site.kinds["kind"].sum()) == 300
    assert site.local_xyz.min() == 0.0
    assert list(noise_scenes(data)) == []


def test_text_is_delivered_to_the_tools_without_its_truth(data: Path, tmp_path: Path) -> None:
    (sample,) = airborne_samples(data)
    path = as_delivered(sample, tmp_path)
    assert read_info(path).count == len(sample.xyz)
    las = laspy.read(path)
    assert not np.asarray(las.classification).any()
    assert not np.asarray(las.intensity).any()
    assert np.allclose(las.xyz, sample.xyz, atol=1e-6)


def test_the_command_replaces_its_own_section_and_paints_errors(data: Path, tmp_path: Path) -> None:
    page = tmp_path / "accuracy.md"
    heading = HEADINGS["airborne"]
    page.write_text(f"# Accuracy\n\nabove\n\n{heading}\n\nonce\n\n## Below\n\nstays\n", "utf-8")
    pictures = tmp_path / "pictures"
    arguments = [str(data), "--ours", "--markdown", str(page), "--pictures", str(pictures)]
    assert main([*arguments, "--only", "airborne"]) == 0
    text = page.read_text("utf-8")
    assert text.startswith(f"# Accuracy\n\nabove\n\n{heading}\n")
    assert "\nonce\n" not in text
    assert text.endswith("\n\n## Below\n\nstays\n")
    row = next(line for line in text.splitlines() if line.startswith("| adaptive"))
    assert row.count("|") == 7
    assert "published: PTD (Axelsson)" in text
    plan = pictures / "samp12-adaptive-none-to-set-plan.png"
    assert plan.read_bytes().startswith(b"\x89PNG")
    assert main([*arguments, "--only", "airborne"]) == 0
    assert page.read_text("utf-8") == text
    assert main([str(data), "--markdown", str(page), "--only", "noise"]) == 0
    assert page.read_text("utf-8").startswith(text)


def test_a_section_that_is_not_there_yet_comes_to_the_end() -> None:
    assert replace_section("# A\n\nx\n", "## B", "## B\n\ny\n") == "# A\n\nx\n\n## B\n\ny\n"
    page = "# A\n\n## B\n\nold\n\n### deeper\n\nold\n"
    # What stands below it has a heading of its own and is replaced by that.
    deeper = "\n### deeper\n\nold\n"
    assert replace_section(page, "## B", "## B\n\ny\n") == f"# A\n\n## B\n\ny\n{deeper}"


def test_peers_that_are_not_installed_are_named_in_their_rows(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(peer_filters, "find_spec", lambda _: None)
    monkeypatch.setenv("PATH", "")
    xyz, codes = box_on_plain()
    scene = FilterScene("plain", None, None, xyz, codes, {})
    found = []
    for method in (*noise_methods(), *site_methods()):
        if not method.ours and method.name not in WRITTEN_HERE:
            assert method.codes(scene, tmp_path) is None
            found.append(FilterResult("plain", method.name, method.settings, False, None))
    for table in (noise_table(found), sites_table(found), airborne_table(found)):
        lines = table.splitlines()
        assert sum("not installed" in line for line in lines) == len(found)
        assert len({line.count("|") for line in lines}) == 1


def test_tables_have_the_figures_of_the_scores() -> None:
    truth = np.r_[np.full(90, 0), np.full(10, 18)].astype(np.uint8)
    result = truth.copy()
    result[[0, 95]] = 18, 0
    row = noise_table(
        [FilterResult("road", "m", "s", True, noise_score(ConfusionMatrix.of(truth, result)))]
    ).splitlines()[2]
    cells = [cell.strip() for cell in row.split("|")[1:-1]]
    assert cells[:9] == ["road", "m", "s", *["98.889 %"] * 3, "0.900", "0.900", "0.900"]
    truth = np.where(truth == 0, 2, 1).astype(np.uint8)
    result = np.where(result == 0, 2, 1).astype(np.uint8)
    score = ground_score(ConfusionMatrix.of(truth, result))
    found = [FilterResult(f"samp{number}", "m", "s", True, score) for number in (12, 22)]
    cells = [cell.strip() for cell in sites_table(found).splitlines()[2].split("|")[1:-1]]
    assert cells[3:] == [
        *["0.900"] * 3,
        *["0.989"] * 3,
        *["1.11 %", "10.00 %", "2.00 %", "0.889"],
    ]
    cells = [cell.strip() for cell in airborne_table(found).splitlines()[2].split("|")[1:-1]]
    assert cells == ["m", "s", "2.00 %", "2.00 %", "**2.00 %**", "0.889", ""]


def test_open3d_as_a_peer_keeps_what_has_more_than_so_many_neighbours() -> None:
    random = np.random.default_rng(1)
    dense = random.uniform(0, 0.05, (114, 3))
    fewer = np.array([50.0, 0.0, 0.0]) + random.uniform(0, 0.05, (113, 3))
    kept = peer_filters.kept_by_open3d_radius(np.concatenate([dense, fewer]), 0.5, 113)
    assert kept is not None
    assert kept[:114].all()
    assert not kept[114:].any()
