"""Clouds whose noise or ground is known: where they lie in a folder of data, and how they are read.

A noise scene is a folder with ``in/scan.laz`` and ``truth/truth.npz``, and ``in/trajectory.csv`` if
the scanner moved; a site has ``in/NAME.laz`` and ``truth/labels_NAME.npy``; the ISPRS filter test
is text in a folder ``isprs``.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import MissingInput
from processing.core.text import Text
from processing.formats.points.point_codes import read_result, read_truth
from processing.scoring.points.coded_points import CodedFile
from processing.scoring.scorers import GROUND_SCORER, NOISE_SCORER

NOISE_KINDS = {
    0: "road and ground",
    1: "wire",
    2: "post",
    3: "rail",
    4: "façade",
    5: "grass",
    6: "curb",
    7: "car",
    8: "tree",
    9: "glass",
    10: "far façade",
}
THIN_KINDS = (1, 2, 3, 5, 10)
"""What filters by density destroy."""
SITE_KINDS = {
    0: "ground",
    1: "excavator",
    2: "dump truck",
    3: "bulldozer",
    4: "worker",
    5: "material",
    6: "fence",
    7: "scaffold",
    8: "brush",
    9: "net",
    10: "grass",
    11: "hut",
    -2: "mixed, ghosts",
    -3: "dust",
}


@dataclass(frozen=True)
class FilterScene:
    """One cloud with its truth, whole in memory.

    Attributes
    ----------
    name : str
    cloud : Path or None
        LAS or LAZ; None where the points are text.
    trajectory : Path or None
    xyz : (n, 3) float64
        m, in the file's order.
    truth : (n,) uint8
    kinds : mapping of str to (n,) int16
        As the truth has them.
    """

    name: str
    cloud: Path | None
    trajectory: Path | None
    xyz: NDArray[np.float64]
    truth: NDArray[np.uint8]
    kinds: Mapping[str, NDArray[np.int16]]

    @property
    def local_xyz(self) -> NDArray[np.float64]:
        """Coordinates from the lowest ones, m."""
        local: NDArray[np.float64] = self.xyz - self.xyz.min(axis=0)
        return local


def noise_scenes(data: Path) -> Iterator[FilterScene]:
    """Noise scenes in a folder, by name.

    Raises
    ------
    UserError
        A file can't be read.
    """
    for cloud in sorted(data.glob("*/in/scan.laz")):
        folder = cloud.parents[1]
        truth, path = folder / "truth" / "truth.npz", cloud.with_name("trajectory.csv")
        true = read_truth(
            truth,
            if_false=NOISE_SCORER.if_false,
            if_true=NOISE_SCORER.if_true,
            flags=NOISE_SCORER.flags,
        )
        yield _scene(folder.name, cloud, path if path.is_file() else None, true)


def sites(data: Path) -> Iterator[FilterScene]:
    """Sites with machines in a folder, by name and date; errors as :func:`noise_scenes`."""
    for truth in sorted(data.glob("*/truth/labels_*.npy"), reverse=True):
        folder, date = truth.parents[1], truth.stem.removeprefix("labels_")
        true = _ground_truth(truth)
        yield _scene(f"{folder.name}, {date}", folder / "in" / f"{date}.laz", None, true)


def airborne_samples(data: Path) -> Iterator[FilterScene]:
    """Samples of the ISPRS filter test, by number; errors as :func:`noise_scenes`."""
    for path in sorted(data.glob("**/isprs/samp*.txt")):
        truth = _ground_truth(path)
        xyz = np.concatenate([block.xyz for block in truth.blocks() if block.xyz is not None])
        codes = np.concatenate([block.codes for block in truth.blocks()])
        yield FilterScene(path.stem, None, None, xyz, codes, {})


def _ground_truth(path: Path) -> CodedFile:
    return read_truth(
        path,
        if_false=GROUND_SCORER.if_false,
        if_true=GROUND_SCORER.if_true,
        flags=GROUND_SCORER.flags,
    )


def _scene(name: str, cloud: Path, trajectory: Path | None, truth: CodedFile) -> FilterScene:
    positions = [block.xyz for block in read_result(cloud).blocks() if block.xyz is not None]
    blocks = list(truth.blocks())
    xyz = np.concatenate(positions) if positions else np.empty((0, 3))
    codes = np.concatenate([block.codes for block in blocks])
    if len(xyz) != len(codes):
        raise MissingInput(
            Text(
                "The cloud and its truth have different numbers of points.",
                "点群と正解の点数が一致しません。",
            ),
            Text.same(f"{cloud}: {len(xyz):,}, {truth.path}: {len(codes):,}"),
            Text("Make the scene again.", "データを作り直してください。"),
        )
    kinds = {
        kind: np.concatenate([block.kinds[kind] for block in blocks]) for kind in blocks[0].kinds
    }
    return FilterScene(name, cloud, trajectory, xyz, codes, kinds)
