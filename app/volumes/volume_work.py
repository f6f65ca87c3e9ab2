"""What a volume has done in the background: functions for a job's thread."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from processing.core.errors import Unsuitable
from processing.core.monitor import Monitor, PartMonitor, parts_of
from processing.core.parameters import fill_parameters
from processing.core.text import Text
from processing.formats.surfaces.design import read_design
from processing.methods.earthwork.geometry.volume_scope import VolumeScope
from processing.methods.earthwork.maps.change_grid import ChangeGrid
from processing.methods.earthwork.maps.contours import (
    ContourOptions,
    LevelLine,
    change_lines,
    contour_lines,
)
from processing.methods.earthwork.maps.heat_map import change_limit
from processing.methods.earthwork.surfaces.epoch_ground import ground_of_drives
from processing.methods.earthwork.surfaces.sides import Level, Side
from processing.methods.earthwork.volumes.comparison import compare
from processing.methods.earthwork.volumes.volume_result import VolumeResult
from processing.project.volumes.volume import (
    ChosenSide,
    KeptVolume,
    SideKind,
    VolumeRequest,
    new_volume,
)
from processing.project.volumes.volume_store import VolumeStore, write_volume
from processing.recording.drive import Drive
from processing.tools.volume import VOLUME
from widgets.shared.shown_volume import ContourOf, VolumeStyle

_READ_SHARE = 0.3
_SIMPLER_SHARE, _SHORTEST_CELLS = 0.2, 8.0
_MOST_LOOKED_AT = 2_000_000


@dataclass(frozen=True)
class MadeVolume:
    """A volume whose folder is written and waits to be taken in."""

    kept: KeptVolume
    folder: Path


@dataclass(frozen=True, eq=False)
class LoadedMap:
    """A volume whose map can be shown, and the range that suits it."""

    result: VolumeResult
    limit_m: float


def volume_work(
    request: VolumeRequest, drives: Sequence[Drive], crs: str, into: Path
) -> tuple[Text, Callable[[Monitor], MadeVolume]]:
    """Two grounds are compared; what came of it is written into a new folder.

    Parameters
    ----------
    drives : sequence of Drive
        Of the project.
    crs : str
        The project's.
    into : Path
        On the project's disk.
    """
    read = sides_reader(request, drives, crs)

    def work(monitor: Monitor) -> MadeVolume:
        parameters = fill_parameters(VOLUME.parameters, request.parameters)
        before, after = read(PartMonitor(monitor, 0.0, _READ_SHARE))
        result = compare(
            before,
            after,
            parameters,
            PartMonitor(monitor, _READ_SHARE, 1.0),
            _within(request),
        )
        kept = new_volume(request, result, crs=crs, version=VOLUME.version, made=datetime.now(UTC))
        monitor.check()
        write_volume(kept, result, into)
        return MadeVolume(kept, into)

    title = Text("{tool}: {before} → {after}", "{tool}: {before} → {after}").filled(
        tool=VOLUME.name, before=_name_of(request.before), after=_name_of(request.after)
    )
    return title, work


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


def map_work(store: VolumeStore, kept: KeptVolume) -> Callable[[], LoadedMap]:
    """A kept volume is read, and how far the colours of its map should reach."""

    def work() -> LoadedMap:
        result = store.read_result(kept)
        change = result.change
        step = max(1, round((change.change_m.size / _MOST_LOOKED_AT) ** 0.5))
        return LoadedMap(result, change_limit(change.change_m[::step, ::step]))

    return work


def contours_of(change: ChangeGrid, look: VolumeStyle, monitor: Monitor) -> tuple[LevelLine, ...]:
    """The contours that are wished over a map; none where none are.

    Raises
    ------
    OutOfRange
        The interval gives too many of them.
    """
    request = ContourOptions(
        look.interval_m,
        simplify_m=_SIMPLER_SHARE * change.grid.size_m,
        shortest_m=_SHORTEST_CELLS * change.grid.size_m,
    )
    match look.contours:
        case ContourOf.NOTHING:
            return ()
        case ContourOf.CHANGE:
            return change_lines(change, request, monitor)
    ground = change.before if look.contours is ContourOf.BEFORE else change.after
    within = np.where(change.inside > 0, ground, np.float32(np.nan))
    return contour_lines(change.grid, within, request, monitor)


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


def _name_of(side: ChosenSide) -> Text:
    return Text("level", "標高") if side.kind is SideKind.LEVEL else Text.same(side.name)


def _in_space(line: BaseGeometry) -> NDArray[np.float64]:
    positions: NDArray[np.float64] = shapely.get_coordinates(line, include_z=True)
    return positions
