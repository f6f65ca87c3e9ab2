"""What delivered files bring to a project: new drives, and what drives that it has still lack."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import UNCHANGED, OutOfRange
from processing.core.monitor import Monitor, PartMonitor
from processing.core.text import Text
from processing.formats.trajectories.image_list import read_image_list
from processing.map.change import Change
from processing.project.drive_removal import removal_of
from processing.project.importing.drive_completion import CompletedDrive, complete_drive
from processing.project.importing.import_request import ImportRequest
from processing.project.importing.importing import import_drives
from processing.project.importing.known_files import known_files
from processing.project.importing.trajectory_beside import trajectories_beside
from processing.project.importing.trajectory_choice import (
    NamedTrajectory,
    match_trajectory,
    read_trajectories,
)
from processing.project.importing.unfinished_imports import import_folder
from processing.project.project import Project
from processing.recording.camera_images.image_list import ImageList
from processing.recording.columns.ordering import sample_column
from processing.recording.drive import SCAN, Drive
from processing.recording.drive_info import read_drive_info, write_drive_info

_SAMPLE_POINTS = 200_000
_SLACK_S = 1.0


@dataclass(frozen=True)
class Home:
    """The project that files are brought to, as far as a worker may know it.

    Attributes
    ----------
    folder : Path
    drives : tuple of Drive
    taken : collection of str
        Ids that no new drive may get.
    crs : str
    temporary : tuple of Path
        A new folder for each drive that may be completed.
    """

    folder: Path
    drives: tuple[Drive, ...]
    taken: Collection[str]
    crs: str
    temporary: tuple[Path, ...]


@dataclass(frozen=True)
class Additions:
    """What came of files.

    Attributes
    ----------
    folders : tuple of Path
        New drives, in the import's folder.
    completed : tuple of CompletedDrive
    images : mapping of str to ImageList
        By drive: all images that it has now.
    known : tuple of Path
        Point files that are in the project already.
    beside : tuple of Path
        Trajectories that lie beside the new files and were not given.
    replaced : tuple of str
        Ids of drives that the new ones take the place of.
    """

    folders: tuple[Path, ...] = ()
    completed: tuple[CompletedDrive, ...] = ()
    images: Mapping[str, ImageList] = field(default_factory=dict)
    known: tuple[Path, ...] = ()
    beside: tuple[Path, ...] = ()
    replaced: tuple[str, ...] = ()

    @property
    def are_none(self) -> bool:
        """Whether the project has all of it already."""
        return not (self.folders or self.completed or self.images)


def bring_in(
    request: ImportRequest, home: Home, monitor: Monitor, *, only: Collection[str] = ()
) -> Additions:
    """Import what a project has not, and complete the drives that it has.

    Parameters
    ----------
    request : ImportRequest
        Without point files, its trajectories and images are for drives of the project that lack
        them; with files that are there already, for the drives of these.
    only : collection of str
        Ids of drives that trajectories and images without point files are for.

    Returns
    -------
    Additions
        For the project to take over.

    Raises
    ------
    UserError, Cancelled
        As :func:`processing.project.importing.importing.import_drives`; nothing is left behind.
    """
    sorted_out = known_files(request.inputs, home.drives, monitor)
    new = replace(request, inputs=sorted_out.new)
    is_for_drives = not request.inputs and bool(request.files or request.crs)
    completes = bool(home.drives) and (bool(sorted_out.known) or is_for_drives)
    imports = bool(sorted_out.new) or not completes
    completed: tuple[CompletedDrive, ...] = ()
    images: dict[str, ImageList] = {}
    if completes:
        named = [drive for drive in home.drives if drive.id in only] or sorted_out.drives
        asked = _Asked(request, home, tuple(named), is_for_others=imports)
        images = asked.images()
        completed = asked.completed(PartMonitor(monitor, 0.0, 0.5 if imports else 1.0))
    folders: tuple[Path, ...] = ()
    if imports:
        share = PartMonitor(monitor, 0.5 if completes else 0.0, 1.0)
        try:
            into = import_folder(home.folder, new)
            folders = import_drives(new, into, share, taken=home.taken, system=home.crs)
        except BaseException:
            _remove(completed)
            raise
    beside: tuple[Path, ...] = ()
    if folders and not request.trajectories:
        lacking = any(lacks_trajectory(Drive(folder)) for folder in folders)
        beside = trajectories_beside(sorted_out.new, request.crs or home.crs) if lacking else ()
    return Additions(folders, completed, images, sorted_out.known, beside)


def home_of(project: Project) -> Home:
    """What a worker has to know of a project to bring files in."""
    temporary = tuple(project.temporary_folder() for _ in project.drives)
    return Home(project.folder, project.drives, project.taken_ids, project.crs, temporary)


def take_over(project: Project, brought: Additions) -> tuple[Drive, ...]:
    """Let a project have what files brought, as one step; gives drives that are new or others.

    A drive that one other takes the place of gives its name to it; its candidates go with it, what
    was drawn or accepted stays where it is.

    Raises
    ------
    UserError
        As :meth:`Project.take_in`.
    """
    leaving = Change()
    if brought.folders and brought.replaced:
        old = [project.drive(id_) for id_ in brought.replaced]
        leaving = removal_of(project, old)
        if len(old) == len(brought.folders) == 1:
            info = read_drive_info(brought.folders[0])
            write_drive_info(brought.folders[0], replace(info, name=old[0].info.name))
    return project.take_in(brought.folders, brought.completed, brought.images, leaving=leaving)


def lacks_trajectory(drive: Drive) -> bool:
    """Whether a trajectory would make more of a drive: its points have times, and it has none."""
    if drive.trajectory is not None or drive.info.rows_by == SCAN or not drive.count:
        return False
    return bool(np.isfinite(_times_of(drive)).any())


@dataclass(frozen=True)
class _Asked:
    """What is asked for drives that a project has.

    Attributes
    ----------
    named : tuple of Drive
        Those that it is for; none for all that lack it.
    is_for_others : bool
        Whether it is for new drives as well, so that it need not be for all named.
    """

    request: ImportRequest
    home: Home
    named: tuple[Drive, ...]
    is_for_others: bool

    def completed(self, monitor: Monitor) -> tuple[CompletedDrive, ...]:
        """The drives built anew with the trajectories."""
        crs = self.request.crs or self.home.crs
        trajectories = read_trajectories(self.request.trajectories, crs)
        drives = self._to_complete(trajectories) if trajectories else []
        completed: list[CompletedDrive] = []
        try:
            for number, (drive, into) in enumerate(zip(drives, self.home.temporary, strict=False)):
                part = PartMonitor(monitor, number / len(drives), (number + 1) / len(drives))
                completed.append(complete_drive(drive, trajectories, into, part))
        except BaseException:
            _remove(completed)
            raise
        return tuple(completed)

    def _to_complete(self, trajectories: tuple[NamedTrajectory, ...]) -> list[Drive]:
        """A drive that has the same trajectory already is left as it is."""
        asked = self.named or [drive for drive in self.home.drives if lacks_trajectory(drive)]
        covered: list[Drive] = []
        refusal: OutOfRange | None = None
        for drive in asked:
            times, name = _times_of(drive), drive.info.name
            try:
                matched = match_trajectory(times, trajectories, name, is_adjusted_standard=None)
            except OutOfRange as error:
                refusal = error
                continue
            if matched is not None and not _has(drive, matched.trajectory.xyz):
                covered.append(drive)
        if refusal is not None and not self.is_for_others and (self.named or not covered):
            raise refusal
        return covered

    def images(self) -> dict[str, ImageList]:
        """The images of drives: those that they had, and new ones; the lists are of all drives."""
        lists = self.request.images
        given = [image for path in lists for image in read_image_list(path)]
        times = np.array([image.time_s for image in given])
        taken_on = [one for one in self.named or self.home.drives if _is_during(times, one)]
        if self.named and not self.is_for_others:
            taken_on = list(self.named)
        if given and not taken_on and not self.is_for_others:
            raise _not_during(lists)
        images = {}
        for drive in taken_on:
            had = tuple(drive.noted_images or ())
            there = {(str(image.path), image.time_s) for image in had}
            new = [one for one in given if (str(one.path.absolute()), one.time_s) not in there]
            if new:
                images[drive.id] = ImageList((*had, *new))
        return images


def _remove(completed: Sequence[CompletedDrive]) -> None:
    for one in completed:
        one.remove_rest()


def _has(drive: Drive, xyz: NDArray[np.float64]) -> bool:
    return drive.trajectory is not None and np.array_equal(drive.trajectory.xyz, xyz)


def _times_of(drive: Drive) -> NDArray[np.float64]:
    times = sample_column(drive.folder, "time", drive.count, max(1, drive.count // _SAMPLE_POINTS))
    return np.append(times, drive.columns["time"][-1])


def _not_during(lists: tuple[Path, ...]) -> OutOfRange:
    return OutOfRange(
        Text(
            "None of the images was taken while a drive of the project was recorded.",
            "プロジェクトの走行データの計測中に撮影された画像がありません。",
        ),
        Text.same(", ".join(path.name for path in lists)),
        Text(
            "Give the image list of these drives. {unchanged}",
            "この走行の画像一覧を指定してください。{unchanged}",
        ).filled(unchanged=UNCHANGED),
    )


def _is_during(times: NDArray[np.float64], drive: Drive) -> bool:
    when = _times_of(drive)
    when = when[np.isfinite(when)]
    if not when.size:
        return False
    return bool(((times >= when.min() - _SLACK_S) & (times <= when.max() + _SLACK_S)).any())
