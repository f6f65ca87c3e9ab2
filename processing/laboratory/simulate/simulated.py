"""What was made: the files of a delivery and their truth."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Simulated:
    """Files that a simulation wrote.

    Attributes
    ----------
    folder : Path
    points, trajectories, images : tuple of Path
        As `zuka import` takes them.
    truth : Path
        Folder of the truth.
    crs : str
        ``EPSG:n``.
    count : int
        Points in all.
    """

    folder: Path
    points: tuple[Path, ...]
    trajectories: tuple[Path, ...]
    images: tuple[Path, ...]
    truth: Path
    crs: str
    count: int
