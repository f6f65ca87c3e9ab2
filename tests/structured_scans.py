"""Small scans of a standing scanner whose grid and surroundings are known, made by tests."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pye57
from numpy.typing import NDArray
from pye57 import libe57

from processing.core.arrays import Floats


@dataclass(frozen=True)
class SphereScan:
    """A hollow sphere seen from a place inside it, sweep after sweep.

    Attributes
    ----------
    position, centre : (3,) float64
        Of the scanner and of the sphere, m.
    cells : (n, 2) int64
        Sweep and place in it of every return; sweeps go clockwise, places upwards.
    xyz : (n, 3) float64
    shape : tuple of int
        Sweeps, places in a sweep.
    """

    position: Floats
    centre: Floats
    cells: NDArray[np.int64]
    xyz: Floats
    shape: tuple[int, int]


def sphere_scan(
    sweeps: int = 60,
    length: int = 40,
    *,
    position: tuple[float, float, float] = (100.0, 200.0, 10.0),
) -> SphereScan:
    """A sphere of 5 m; every seventh beam has no return."""
    cells = np.stack(np.divmod(np.arange(sweeps * length), length), axis=1)
    cells = cells[np.arange(cells.shape[0]) % 7 != 3]
    azimuth = -2 * np.pi * cells[:, 0] / sweeps
    elevation = np.radians(-60.0 + 120.0 * cells[:, 1] / (length - 1))
    beams = np.column_stack(
        [
            np.cos(elevation) * np.cos(azimuth),
            np.cos(elevation) * np.sin(azimuth),
            np.sin(elevation),
        ]
    )
    away = np.array([1.0, 0.5, 0.0])  # from the scanner to the sphere's centre
    along = beams @ away
    distance = along + np.sqrt(along**2 - away @ away + 25.0)
    stand = np.array(position)
    return SphereScan(
        stand, stand + away, cells, stand + beams * distance[:, None], (sweeps, length)
    )


def ptx_text(*scans: SphereScan) -> str:
    """A PTX of scans, each in its scanner's own frame with a pose that only shifts."""
    lines: list[str] = []
    for scan in scans:
        east, north, up = scan.position.tolist()
        lines += [f"{scan.shape[0]}", f"{scan.shape[1]}", f"{east} {north} {up}"]
        lines += ["1 0 0", "0 1 0", "0 0 1", "1 0 0 0", "0 1 0 0", "0 0 1 0"]
        lines.append(f"{east} {north} {up} 1")
        rows = np.zeros((scan.shape[0] * scan.shape[1], 4))
        at = scan.cells[:, 0] * scan.shape[1] + scan.cells[:, 1]
        rows[at, :3], rows[at, 3] = scan.xyz - scan.position, 0.25 + 0.5 * (at % 2)
        lines += [" ".join(f"{value:.5f}" for value in row) for row in rows.tolist()]
    return "\n".join([*lines, ""])


def write_e57(path: Path, *scans: SphereScan, by: str = "columnIndex") -> None:
    """An E57 of scans, their points in the grid's order turned over.

    Parameters
    ----------
    by : str
        The index that numbers the sweeps: ``columnIndex``, or ``rowIndex``, which the file then
        says.
    """
    file = pye57.E57(str(path), mode="w")
    names = ("columnIndex", "rowIndex") if by == "columnIndex" else ("rowIndex", "columnIndex")
    for scan in scans:
        east, north, up = (scan.xyz - scan.position)[::-1].T
        data = {"cartesianX": east, "cartesianY": north, "cartesianZ": up}
        data |= {name: scan.cells[::-1, axis] for axis, name in enumerate(names)}
        file.write_scan_raw(data, translation=scan.position)
        if by == "rowIndex":
            _say_sweeps(file, len(file.data3d) - 1)
    file.close()


def _say_sweeps(file: pye57.E57, scan: int) -> None:
    image = file.image_file
    by_line, schemes = libe57.StructureNode(image), libe57.StructureNode(image)
    file.data3d[scan].set("pointGroupingSchemes", schemes)
    schemes.set("groupingByLine", by_line)
    by_line.set("idElementName", libe57.StringNode(image, "rowIndex"))
