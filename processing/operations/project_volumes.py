"""Comparing two grounds of a project, for the project to keep."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from processing.core.errors import Unsuitable, report_as_user_error
from processing.core.monitor import Monitor, PartMonitor, parts_of
from processing.core.owned_files import unmark
from processing.core.parameters import fill_parameters
from processing.core.text import Text
from processing.formats.surfaces.design import read_design
from processing.map.change import Change
from processing.methods.earthwork.geometry.volume_scope import VolumeScope
from processing.methods.earthwork.surfaces.epoch_ground import ground_of_drives
from processing.methods.earthwork.surfaces.sides import EpochGround, Level, Side
from processing.methods.earthwork.volumes.comparison import compare
from processing.operations.inputs import opened_project
from processing.project.project import Project
from processing.project.volumes.volume import (
    ChosenSide,
    KeptVolume,
    SideKind,
    VolumeRequest,
    new_volume,
)
from processing.project.volumes.volume_store import volume_name, write_volume
from processing.recording.drive import Drive
from processing.tools.volume import VOLUME

_READ_SHARE = 0.3
_STORED = Text(
    "{words}: cut {cut} m³, fill {fill} m³ (± {within} m³)",
    "{words}: 切土 {cut} m³、盛土 {fill} m³（± {within} m³）",
)
_REMOVAL = Text("Remove {volume}", "{volume} を削除")


@dataclass(frozen=True)
class KeepVolumeOperation:
    """Two grounds of a project to be compared, for the project to keep what comes of it.

    Attributes
    ----------
    project : Path
    request : VolumeRequest
        As the window's form gives it.
    """

    project: Path
    request: VolumeRequest


@dataclass(frozen=True)
class StoredVolume:
    """A volume that a project keeps now."""

    kept: KeptVolume

    @property
    def words(self) -> tuple[Text, ...]:
        """One line."""
        volumes = self.kept.volumes
        return (
            _STORED.filled(
                words=words_of(self.kept.request),
                cut=f"{volumes.cut_m3:,.1f}",
                fill=f"{volumes.fill_m3:,.1f}",
                within=f"{volumes.uncertainty_m3:,.1f}",
            ),
        )


@dataclass(frozen=True)
class MadeVolume:
    """A volume whose folder is written and waits to be taken in."""

    kept: KeptVolume
    folder: Path


def make_volume(
    request: VolumeRequest, drives: Sequence[Drive], crs: str, into: Path, monitor: Monitor
) -> MadeVolume:
    """Compare two grounds; what came of it is written into a new folder. For a worker's thread.

    Parameters
    ----------
    drives : sequence of Drive
        Of the project.
    crs : str
        The project's.
    into : Path
        On the project's disk.

    Raises
    ------
    UserError, Cancelled
        As :func:`processing.methods.earthwork.volumes.comparison.compare`, and what stands against
        reading and writing.
    """
    parameters = fill_parameters(VOLUME.parameters, request.parameters)
    before, after = sides_reader(request, drives, crs)(PartMonitor(monitor, 0.0, _READ_SHARE))
    comparing = PartMonitor(monitor, _READ_SHARE, 1.0)
    others = _others(request, drives, monitor)
    result = compare(before, after, parameters, comparing, _within(request), others=others)
    kept = new_volume(request, result, crs=crs, version=VOLUME.version, made=datetime.now(UTC))
    monitor.check()
    write_volume(kept, result, into)
    return MadeVolume(kept, into)


def keep_volume(operation: KeepVolumeOperation, monitor: Monitor) -> StoredVolume:
    """Compare two grounds of a project and let it keep the result, as one step.

    Raises
    ------
    UserError, Cancelled
        As :func:`make_volume` and :func:`store_volume`; the project is as it was.
    """
    with opened_project(operation.project, writing=True) as project:
        into = project.temporary_folder()
        made = make_volume(operation.request, project.drives, project.crs, into, monitor)
        store_volume(project, made)
        return StoredVolume(made.kept)


def store_volume(project: Project, made: MadeVolume) -> Change:
    """Let a project keep a volume, as one step that can be undone.

    Raises
    ------
    NoSpace, InUse, MissingInput
        It keeps what it had.
    """
    files = project.new_step_files()
    with report_as_user_error(made.folder):
        unmark(made.folder)
    files.give(made.folder, volume_name(made.kept.id))
    change = Change(files=files.files())
    project.features.apply(words_of(made.kept.request), change)
    return change


def remove_volume(project: Project, kept: KeptVolume) -> Change:
    """Let a project forget a volume, as one step that can be undone.

    Raises
    ------
    NoSpace, InUse
        It is still there.
    """
    files = project.new_step_files()
    files.take_away(volume_name(kept.id))
    change = Change(files=files.files())
    project.features.apply(_REMOVAL.filled(volume=words_of(kept.request)), change)
    return change


def words_of(request: VolumeRequest) -> Text:
    """What a comparison is called: the tool, and both grounds."""
    return Text("{tool}: {before} → {after}", "{tool}: {before} → {after}").filled(
        tool=VOLUME.name, before=_name_of(request.before), after=_name_of(request.after)
    )


def _name_of(side: ChosenSide) -> Text:
    return Text("level", "標高") if side.kind is SideKind.LEVEL else Text.same(side.name)


def sides_reader(
    request: VolumeRequest, drives: Sequence[Drive], crs: str
) -> Callable[[Monitor], tuple[Side, Side]]:
    """What reads both grounds of a request, before and after, in any thread."""
    by_id = {drive.id: drive for drive in drives}

    def read(monitor: Monitor) -> tuple[Side, Side]:
        first, second = parts_of(monitor, (0.5, 0.5))
        before = _side_of(request.before, by_id, crs, first)
        return before, _side_of(request.after, by_id, crs, second)

    return read


def _others(
    request: VolumeRequest, drives: Sequence[Drive], monitor: Monitor
) -> tuple[EpochGround, ...]:
    by_id = {drive.id: drive for drive in drives}
    return tuple(
        ground_of_drives(tuple(by_id[id_] for id_ in one.drives), monitor, name=one.name)
        for one in request.others
    )


def _side_of(side: ChosenSide, drives: Mapping[str, Drive], crs: str, monitor: Monitor) -> Side:
    match side.kind:
        case SideKind.LEVEL:
            return Level(side.height_m)
        case SideKind.EPOCH:
            epoch = tuple(drives[id_] for id_ in side.drives)
            return ground_of_drives(epoch, monitor, name=side.name)
    design = read_design(Path(side.path), side.surface, monitor)
    if design.crs and crs and design.crs != crs:
        raise Unsuitable(
            Text(
                "The design is in {design}, the project in {project}.",
                "設計データの座標参照系（{design}）がプロジェクト（{project}）と異なります。",
            ).filled(design=design.crs, project=crs),
            Text.same(side.path),
            Text(
                "Deliver the design in the project's reference system.",
                "プロジェクトと同じ座標参照系の設計データを用意してください。",
            ),
        )
    return design.surface


def _within(request: VolumeRequest) -> VolumeScope:
    line = None if request.line is None else shapely.get_coordinates(request.line)
    return VolumeScope(request.boundary, line, tuple(map(_in_space, request.break_lines)))


def _in_space(line: BaseGeometry) -> NDArray[np.float64]:
    positions: NDArray[np.float64] = shapely.get_coordinates(line, include_z=True)
    return positions
