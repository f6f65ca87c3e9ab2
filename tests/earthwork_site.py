"""A made-up site: a box on a slope, scanned from two places, with noise below the ground."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import laspy
import numpy as np
from numpy.typing import NDArray
from pyproj import CRS

GROUND, OTHER, LOW_NOISE = 2, 1, 7
GRADE = 0.2
CORNER = np.array([-12_380.0, -36_690.0, 5.0])
SIZE_M = (30.0, 20.0)
BOX_LOW, BOX_HIGH = (14.0, 9.0), (16.0, 10.5)
BOX_TALL_M = 1.2


@dataclass(frozen=True)
class EarthworkSite:
    """A cloud with its truth, in the order of the file.

    Attributes
    ----------
    xyz : (n, 3) float64
    truth : (n,) uint8
        Ground, the box, or noise below the ground.
    station : (n,) uint16
        Which of two scanners measured a point; one after the other.
    """

    xyz: NDArray[np.float64]
    truth: NDArray[np.uint8]
    station: NDArray[np.uint16]


def earthwork_site(seed: int = 0) -> EarthworkSite:
    """Some 20,000 points; the ground rises to the north."""
    random = np.random.default_rng(seed)
    plan = random.uniform((0.0, 0.0), SIZE_M, (18_000, 2))
    in_box = ((plan > BOX_LOW) & (plan < BOX_HIGH)).all(axis=1)
    plan = plan[~in_box]
    ground = np.column_stack([plan, GRADE * plan[:, 1] + random.normal(0, 0.004, len(plan))])
    share = random.uniform(size=(1500, 3))
    side = random.integers(0, 5, 1500)
    for wall in range(4):
        share[side == wall, wall % 2] = wall // 2
    share[side == 4, 2] = 1.0
    box = np.empty_like(share)
    box[:, :2] = np.array(BOX_LOW) + share[:, :2] * (np.array(BOX_HIGH) - BOX_LOW)
    foot = GRADE * box[:, 1]
    box[:, 2] = foot + share[:, 2] * (GRADE * BOX_HIGH[1] + BOX_TALL_M - foot)
    noise = random.uniform((14.0, 5.0), (16.0, 8.0), (120, 2))
    below = GRADE * noise[:, 1] - random.uniform(0.8, 1.4, 120)
    local = np.concatenate([ground, box, np.column_stack([noise, below])])
    xyz = np.round(CORNER + local, 3)  # as the file has them
    truth = np.repeat([GROUND, OTHER, LOW_NOISE], [len(ground), 1500, 120]).astype(np.uint8)
    order = random.permutation(len(xyz))
    station = np.sort(random.integers(1, 3, len(xyz))).astype(np.uint16)
    return EarthworkSite(xyz[order], truth[order], station)


def write_site(site: EarthworkSite, path: Path, *, start_s: float = 1_000.0) -> Path:
    """Write the cloud as it is delivered, unclassified, measured from a time on."""
    header = laspy.LasHeader(point_format=6, version="1.4")
    header.scales, header.offsets = np.full(3, 0.001), np.array([-12_000.0, -36_000.0, 0.0])
    header.add_crs(CRS.from_user_input("EPSG:6677"))
    cloud = laspy.LasData(header)
    cloud.xyz = site.xyz
    cloud.gps_time = start_s + np.arange(len(site.xyz)) * 1e-4
    cloud.point_source_id = site.station
    cloud.intensity = np.full(len(site.xyz), 20_000, np.uint16)
    cloud.return_number = cloud.number_of_returns = np.ones(len(site.xyz), np.uint8)
    cloud.write(str(path))
    return path
