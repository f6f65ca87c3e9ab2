"""The ground points of drives that were recorded together, as an epoch of a site."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from processing.core.errors import MissingInput
from processing.core.monitor import Monitor, SilentMonitor
from processing.core.text import Text
from processing.core.worked_ahead import in_order
from processing.methods.earthwork.surfaces.sides import EpochGround, GroundBlock
from processing.methods.ground.drive_points import Chunk, DrivePoints, read_ahead
from processing.methods.ground.ground_columns import GROUND
from processing.methods.noise.beams.scanner_positions import scanner_position_of
from processing.recording.drive import Drive
from processing.recording.measured_day import measured_day

_POINTS_AT_ONCE = 1 << 17
"""Points read at a time: 3 MiB of coordinates."""


def ground_of_drives(drives: tuple[Drive, ...], monitor: Monitor, *, name: str = "") -> EpochGround:
    """The ground of an epoch: points of class 2 by the class that counts.

    Parameters
    ----------
    name : str
        What to call it; the names of the drives otherwise.

    Raises
    ------
    MissingInput
        No point is ground: it was not looked for yet.
    Cancelled
    """
    points = DrivePoints(drives, _POINTS_AT_ONCE, monitor)
    name = name or ", ".join(dict.fromkeys(drive.info.name for drive in drives))
    if not _has_ground(points):
        raise MissingInput(
            Text("No point is classified as ground.", "地面に分類された点がありません。"),
            Text.same(name),
            Text(
                "Run the tool “Ground” on both epochs first.",
                "先に両時期の点群で「地面抽出」を実行してください。",
            ),
        )

    def block_of(chunk: Chunk) -> GroundBlock:
        is_ground = points.codes(chunk) == GROUND
        return GroundBlock(points.measured_xyz(chunk)[is_ground], chunk.drive)

    def blocks() -> Iterator[GroundBlock]:
        return read_ahead(block_of, points.chunks)

    def everything_of(chunk: Chunk) -> GroundBlock:
        return GroundBlock(points.xyz(chunk), chunk.drive)

    def measured() -> Iterator[GroundBlock]:
        return read_ahead(everything_of, points.chunks)

    positions = list(in_order(scanner_position_of, drives))
    stations = tuple(number for number, position in enumerate(positions) if position is not None)
    return EpochGround(
        name,
        blocks,
        low=np.min([drive.info.lowest for drive in drives], axis=0),
        high=np.max([drive.info.highest for drive in drives], axis=0),
        stands=np.array([positions[number] for number in stations]).reshape(-1, 3),
        stations=stations,
        measured=measured,
        crs=next((drive.info.crs for drive in drives if drive.info.crs), ""),
        measured_on=measured_day(drives),
    )


def has_ground(drives: tuple[Drive, ...]) -> bool:
    """Whether ground was looked for: any point of class 2 by the class that counts."""
    return _has_ground(DrivePoints(drives, _POINTS_AT_ONCE, SilentMonitor()))


def _has_ground(points: DrivePoints) -> bool:
    return any(np.any(points.codes(chunk) == GROUND) for chunk in points.chunks)
