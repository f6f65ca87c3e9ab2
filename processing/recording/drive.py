"""Drive: one scanner's recording, the unit in which points are kept, shown and processed."""

from __future__ import annotations

import threading
from collections.abc import Callable, Hashable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from processing.core.block_sums import refuse_damaged
from processing.core.errors import BadFile, report_as_user_error
from processing.core.text import Text
from processing.recording.camera_images.calibration import CameraOffset, apply_offsets
from processing.recording.camera_images.image_list import ImageList
from processing.recording.camera_images.image_store import read_images
from processing.recording.camera_images.offset_store import read_offsets, write_offsets
from processing.recording.columns.array_files import read_array
from processing.recording.columns.columns import Columns
from processing.recording.columns.coordinates import Coordinates, Correction, PointSelection
from processing.recording.columns.mapped_pages import MappedPages
from processing.recording.columns.quantisation import Quantisation
from processing.recording.columns.source_order import sources_of
from processing.recording.drive_info import DriveInfo, SourceFile, read_drive_info
from processing.recording.file_locations import FolderMove, folder_of, path_now
from processing.recording.kinds import ImageKind
from processing.recording.revolutions.revolutions import Revolutions
from processing.recording.revolutions.revolutions_file import read_revolutions
from processing.recording.vehicle_path.trajectory import Trajectory
from processing.recording.waveform_packets.kept_packets import read_packet_files

_Part = TypeVar("_Part")

SCAN = "scan"
"""What :class:`DriveInfo` says of rows that are the sweeps of a standing scanner."""

_WITH_REVOLUTIONS = (
    ImageKind.TRAJECTORY_CENTER,
    ImageKind.FEATURE_CENTER,
    ImageKind.REVERSIBLE,
    ImageKind.TRAJECTORY_REVERSIBLE,
)


class Drive:
    """One scanner's recording, opened from its folder; nothing is loaded before it is asked for.

    Parameters
    ----------
    folder : Path
        As written by :mod:`processing.project.importing.importing`.
    pages : MappedPages, optional
        Shared by drives whose columns are to be bounded together.
    correction : Correction, optional
        Moves the points; ``info`` then tells an extent that holds them all.

    Attributes
    ----------
    coordinates : Coordinates
        Where its points are.
    noted_images : ImageList or None
        Camera images taken on this drive, where and as they were delivered.

    Raises
    ------
    MissingInput, BadFile
        The folder is missing, incomplete or damaged.
    """

    def __init__(
        self,
        folder: Path,
        pages: MappedPages | None = None,
        correction: Correction | None = None,
    ) -> None:
        self._folder = folder
        self.info: DriveInfo = read_drive_info(folder)
        if correction is not None:
            self.info = self.info.widened(correction.reach_m)
        self.columns = Columns(folder, self.info.count, pages)
        quantisation = Quantisation(self.info.scale, self.info.offset)
        self.coordinates = Coordinates(self.columns, quantisation, folder, correction)
        self.noted_images: ImageList | None = read_images(folder)
        self._offsets = read_offsets(folder)
        self._moves: tuple[FolderMove, ...] = ()
        self._delivered_images = self.noted_images
        self._images: ImageList | None = None
        self._check_columns()
        self.revolutions: Revolutions | None = read_revolutions(folder)
        self._trajectory: Trajectory | None = None
        self._kept: dict[Hashable, Any] = {}  # Any: parts of any type, each known by its key
        self._making = threading.RLock()

    @property
    def id(self) -> str:
        """The drive's id, unique in its project."""
        return self.info.id

    @property
    def count(self) -> int:
        """Number of points."""
        return self.info.count

    @property
    def folder(self) -> Path:
        """Where the drive is kept."""
        return self._folder

    @property
    def delivered_files(self) -> tuple[Path, ...]:
        """The files it was imported from, which nothing may ever write; where noted, where now."""
        noted = [source.path for source in self.info.sources]
        noted += [packets.delivered for packets in read_packet_files(self._folder)]
        now = [path_now(path, self._moves) for path in noted]
        return tuple(dict.fromkeys([Path(path) for path in noted] + now))

    def source_path(self, source: SourceFile) -> Path:
        """Where one of ``info.sources`` is now, as far as is known."""
        return path_now(source.path, self._moves)

    @property
    def moves(self) -> tuple[FolderMove, ...]:
        """Where folders of its delivered files are now, as told by :meth:`use_moves`."""
        return self._moves

    def use_moves(self, moves: tuple[FolderMove, ...]) -> bool:
        """Look for delivered files and camera images where their folders are now.

        Returns
        -------
        bool
            Whether any of them is elsewhere than it was thought to be.
        """
        noted = {folder_of(source.path) for source in self.info.sources}
        noted |= {folder_of(str(image.path)) for image in self.noted_images or ()}
        mine = tuple(move for move in moves if move.noted in noted)
        if mine == self._moves:
            return False
        self._moves, self._images = mine, None
        if self.noted_images is not None:
            self._delivered_images = ImageList(
                tuple(
                    replace(image, path=path_now(str(image.path), mine))
                    for image in self.noted_images
                )
            )
        return True

    @property
    def trajectory(self) -> Trajectory | None:
        """Where the vehicle was; None when the drive has no trajectory."""
        if self._trajectory is None:
            self._trajectory = read_kept_trajectory(self._folder)
        return self._trajectory

    @property
    def delivered_images(self) -> ImageList | None:
        """Camera images, where they are now, oriented as they were delivered."""
        return self._delivered_images

    @property
    def images(self) -> ImageList | None:
        """Camera images taken on this drive, with the offsets of their cameras; None without."""
        if self._images is None and self.delivered_images is not None:
            self._images = apply_offsets(self.delivered_images, self._offsets, self.trajectory)
        return self._images

    @property
    def camera_offsets(self) -> Mapping[str, CameraOffset]:
        """Offsets by :func:`processing.recording.camera_images.calibration.camera_of`."""
        return dict(self._offsets)

    def keep_camera_offsets(self, offsets: Mapping[str, CameraOffset]) -> None:
        """Keep other offsets in the drive's folder; `images` follows them.

        Raises
        ------
        NoSpace
            The disk is full or refuses the write; the offsets stay as they were.
        """
        write_offsets(self._folder, offsets)
        self._offsets = dict(offsets)
        self._images = None

    @property
    def image_kinds(self) -> tuple[ImageKind, ...]:
        """The kinds of image that this drive can be shown as."""
        if self.revolutions is not None:
            return _WITH_REVOLUTIONS
        return (ImageKind.SCAN if self.info.rows_by == SCAN else ImageKind.TOP_VIEW,)

    @property
    def pixel_kind(self) -> ImageKind:
        """The kind whose pixels hold one pulse or cell each, so that neighbours are true ones."""
        return self.image_kinds[-1]

    def xyz(self, points: PointSelection) -> NDArray[np.float64]:
        """Coordinates of points.

        Returns
        -------
        (n, 3) float64
            m, project CRS, a copy.
        """
        return self.coordinates.xyz(points)

    def local_xyz(self, points: PointSelection, origin: NDArray[np.float64]) -> NDArray[np.float32]:
        """Coordinates about a local origin, exact enough for drawing.

        Parameters
        ----------
        origin : (3,) float64
            m, project CRS; subtracted before rounding to float32.

        Returns
        -------
        (n, 3) float32
        """
        return self.coordinates.local_xyz(points, origin)

    def sources(self, start: int, stop: int) -> tuple[NDArray[np.uint16], NDArray[np.int64]]:
        """Where the points ``start … stop − 1`` were delivered.

        Returns
        -------
        files : (n,) uint16
            Index into ``info.sources``.
        indices : (n,) int64
            Index of the point in that file.

        Raises
        ------
        BadFile
            The columns that say it are damaged.
        """
        runs, sources = self.info.source_runs, len(self.info.sources)
        return sources_of(self.columns, runs, start, stop, sources=sources)

    def kept(self, key: Hashable, make: Callable[[], _Part]) -> _Part:
        """What is made of the drive once and kept as long as it is open, such as its images.

        Parameters
        ----------
        key : Hashable
            Names the part; the same key always stands for a part of the same type.
        make : callable
            Makes the part when it is asked for the first time, by one thread only. It may ask
            for other parts. Whatever else is asked of the drive for the first time waits for it,
            so what takes seconds is kept in a part with a lock of its own.
        """
        if key not in self._kept:
            with self._making:
                if key not in self._kept:
                    self._kept[key] = make()
        part: _Part = self._kept[key]
        return part

    def has_kept(self, key: Hashable) -> bool:
        """Whether a part was made already."""
        return key in self._kept

    def _check_columns(self) -> None:
        for name in ("xyz", "time", "intensity", "pulse"):
            if not self.columns.has(name):
                raise BadFile(
                    Text(
                        "A drive lacks one of its columns.",
                        "走行データに必要な列データがありません。",
                    ),
                    Text.same(f"{self._folder}: {name}"),
                    Text(
                        "Import the drive again from the delivered files.",
                        "納品ファイルから走行データを再インポートしてください。",
                    ),
                )


TRAJECTORY_FILE = "trajectory.npy"


def write_trajectory(folder: Path, trajectory: Trajectory) -> None:
    """Write a drive's trajectory into its folder: (m, 7) float64."""
    table = np.column_stack(
        [trajectory.time, trajectory.xyz, trajectory.roll_pitch_heading_deg]
    ).astype(np.float64)
    path = folder / TRAJECTORY_FILE
    with report_as_user_error(path):
        np.save(path, table)


def read_kept_trajectory(folder: Path) -> Trajectory | None:
    """The trajectory in a drive's folder; None where there is none.

    Raises
    ------
    BadFile
        It is damaged.
    """
    path = folder / TRAJECTORY_FILE
    if not path.is_file():
        return None
    refuse_damaged(path)
    with report_as_user_error(path):
        try:
            table = read_array(path)
            _check_trajectory(table)
        except (ValueError, EOFError) as error:
            raise BadFile(
                Text(
                    "The trajectory of a drive is damaged.",
                    "走行データの走行軌跡が壊れています。",
                ),
                Text.same(f"{path}: {error}"),
                Text(
                    "Import the drive again from the delivered files.",
                    "納品ファイルから走行データを再インポートしてください。",
                ),
            ) from error
    return Trajectory(
        time=table[:, 0],
        xyz=table[:, 1:4],
        roll_pitch_heading_deg=table[:, 4:7],
        has_attitude=True,
    )


def _check_trajectory(table: NDArray[np.float64]) -> None:
    """Refuse by a ValueError what no place can be taken from."""
    if table.ndim != 2 or table.shape[1] != 7 or len(table) < 2 or table.dtype != np.float64:
        message = f"{table.dtype} {table.shape}"
        raise ValueError(message)
    if not np.isfinite(table[:, :4]).all() or not (table[:-1, 0] < table[1:, 0]).all():
        message = "time"
        raise ValueError(message)
