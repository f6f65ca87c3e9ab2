"""What of a volume is kept with a project: what was compared and how, and what came of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import date, datetime
from enum import Enum
from uuid import uuid4

from shapely.geometry.base import BaseGeometry

from processing.core.parameters import ParameterValue
from processing.core.text import Text
from processing.methods.earthwork.volumes.volume_result import Registration, VolumeResult, Volumes


class SideKind(Enum):
    """What a ground that is compared comes from."""

    EPOCH = "epoch"
    DESIGN = "design"
    LEVEL = "level"


@dataclass(frozen=True)
class ChosenSide:
    """One of the two grounds, as it was chosen.

    Attributes
    ----------
    kind : SideKind
    name : str
        What people call it; empty for a level.
    drives : tuple of str
        Ids of an epoch's drives.
    path, surface : str
        A design's file, and which surface in it where there are several.
    measured_on : date or None
        An epoch's first day, where its points tell.
    height_m : float
        Of a level.
    """

    kind: SideKind
    name: str = ""
    drives: tuple[str, ...] = ()
    path: str = ""
    surface: str = ""
    measured_on: date | None = None
    height_m: float = 0.0


@dataclass(frozen=True)
class VolumeRequest:
    """What is to be compared, and how.

    Attributes
    ----------
    before, after : ChosenSide
    parameters : mapping
        Of the tool, by the names of its fields.
    boundary : shapely geometry or None
        Where earth counts, m, project CRS; None: wherever both grounds are.
    line : shapely geometry or None
        Along which sections are cut.
    break_lines : tuple of shapely geometry
        Lines in space that triangles don't cross.
    others : tuple of ChosenSide
        Other epochs, which tell the shape of ground that a compared one did not show.
    boundary_name : str
        What was chosen as the boundary, as people call it.
    """

    before: ChosenSide
    after: ChosenSide
    parameters: Mapping[str, ParameterValue]
    boundary: BaseGeometry | None = None
    line: BaseGeometry | None = None
    break_lines: tuple[BaseGeometry, ...] = ()
    others: tuple[ChosenSide, ...] = ()
    boundary_name: str = ""


@dataclass(frozen=True)
class KeptVolume:
    """A volume without its map.

    Attributes
    ----------
    id : str
        Unique for ever.
    made : datetime
        With its time zone.
    version : int
        The tool's.
    crs : str
        ``EPSG:n`` of all coordinates; empty when unknown.
    """

    id: str
    made: datetime
    version: int
    crs: str
    request: VolumeRequest
    volumes: Volumes
    method: str
    grid_m: float
    registration: Registration | None
    notes: tuple[Text, ...]


def new_volume(
    request: VolumeRequest, result: VolumeResult, *, crs: str, version: int, made: datetime
) -> KeptVolume:
    """A volume with an id that no other has."""
    return KeptVolume(
        id=uuid4().hex,
        made=made,
        version=version,
        crs=crs,
        request=request,
        volumes=result.volumes,
        method=result.method,
        grid_m=result.grid_m,
        registration=result.registration,
        notes=result.notes,
    )
