"""The table of classes of real streets, on a made one whose labels are exact."""

from __future__ import annotations

from pathlib import Path

import laspy
import numpy as np

from processing.laboratory.accuracy.real_street_classes import GROUPS, HEADING, main

GROUND, FACADE, FENCE = 1202, 1400, 1408


def test_a_street_with_a_road_and_a_house_is_scored_by_what_it_has(tmp_path: Path) -> None:
    rng = np.random.default_rng(3)
    road = np.column_stack([rng.uniform(0, 30, (20_000, 2)), rng.normal(0, 0.005, 20_000)])
    house = np.column_stack(
        [rng.uniform(0, 30, 20_000), rng.normal(30, 0.01, 20_000), rng.uniform(0, 9, 20_000)]
    )
    fence = np.column_stack([rng.uniform(0, 30, (50, 2)), rng.uniform(0, 1, 50)])
    labels = np.repeat([GROUND, FACADE, FENCE], [len(road), len(house), len(fence)])
    order = rng.permutation(labels.size)
    header = laspy.LasHeader(point_format=0, version="1.2")
    header.scales = np.full(3, 0.001)
    cloud = laspy.LasData(header)
    cloud.x, cloud.y, cloud.z = np.concatenate([road, house, fence])[order].T
    street = tmp_path / "street_oakland"
    (street / "truth").mkdir(parents=True)
    cloud.write(street / "piece.las")
    (street / "piece.las").rename(street / "piece.laz")
    np.savez(street / "truth" / "piece.npz", label=labels[order])
    page = tmp_path / "page.md"
    page.write_text(f"{HEADING}\nold\n", "utf-8")

    assert main([str(tmp_path), "--markdown", str(page)]) == 0

    head, _, row = page.read_text("utf-8").strip().splitlines()[-3:]
    found = dict(zip(head.split(" | ")[3:], row.split(" | ")[3:], strict=True))
    assert [*found][-1].rstrip(" |") == [*GROUPS][-1]
    assert row.startswith("| street_oakland | 40,000 |")  # fences count neither way
    assert float(found["ground"]) > 0.95
    assert float(found["building"]) > 0.9
    assert found["wire"] == "–"
