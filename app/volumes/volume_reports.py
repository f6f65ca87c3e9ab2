"""The papers of a volume: its report, and the form of as-built control."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path, PurePath

from processing.core.monitor import Monitor
from processing.core.text import Language, Text
from processing.formats.work_facts import SideFacts
from processing.methods.earthwork.maps.contours import LevelLine
from processing.methods.earthwork.surfaces.sides import Side
from processing.methods.earthwork.volumes.volume_result import VolumeResult
from processing.operations.volume_papers import VolumePapers, judged_ground
from processing.project.volumes.volume import ChosenSide, KeptVolume, SideKind, VolumeRequest
from processing.project.work_details import WorkDetails
from processing.project.work_store import ChosenLimits
from processing.recording.drive import Drive

_BOUNDARY = Text("Area of the project", "プロジェクトで指定した範囲")
_LEVEL = Text("Level {height:.3f} m", "標高 {height:.3f} m")


@dataclass(frozen=True)
class ExportedVolume:
    """A volume as it is given out.

    Attributes
    ----------
    details : WorkDetails
        What the papers say of the work; its name is the project's where no other was entered.
    drives : tuple of Drive
        Of the project.
    limit_m : float
        Range of the colours, as they are shown.
    contours : tuple of LevelLine
        As they are shown.
    language : Language
        Of words in the file.
    limits : ChosenLimits
        That count in as-built control.
    sides : callable
        Reads both grounds again, before and after.
    never : tuple of Path
        Delivered files, which must not be overwritten.
    """

    details: WorkDetails
    kept: KeptVolume
    result: VolumeResult
    drives: tuple[Drive, ...]
    limit_m: float
    contours: tuple[LevelLine, ...]
    language: Language
    limits: ChosenLimits
    sides: Callable[[Monitor], tuple[Side, Side]]
    never: tuple[Path, ...]


Write = Callable[[Path, ExportedVolume, Monitor], None]


def is_judged(kept: KeptVolume) -> bool:
    """Whether a measured ground was compared with a design."""
    kinds = {kept.request.before.kind, kept.request.after.kind}
    return kinds == {SideKind.EPOCH, SideKind.DESIGN}


def report_writer(ending: str) -> Write:
    """What writes the volume report as a file of an ending."""

    def write(path: Path, given: ExportedVolume, monitor: Monitor) -> None:
        _papers_of(given).write_report(path, given.result, monitor, ending=ending)

    return write


def form_writer(ending: str) -> Write:
    """What writes the form of as-built control as a file of an ending."""

    def write(path: Path, given: ExportedVolume, monitor: Monitor) -> None:
        limits = given.limits.table, given.limits.shown_work_type
        boundary = given.kept.request.boundary
        judged = judged_ground(given.sides(monitor), limits, boundary, monitor)
        _papers_of(given).write_form(path, judged, monitor, ending=ending)

    return write


def _papers_of(given: ExportedVolume) -> VolumePapers:
    request = given.kept.request
    made_on = given.kept.made.astimezone().date()
    return VolumePapers(
        given.details.facts(given.kept.crs, version("zuka"), made_on),
        _side_facts(request.before, given),
        _side_facts(request.after, given),
        given.language,
        given.never,
        _name_of_area(request, given.language),
        request.boundary,
        is_design_before=request.before.kind is SideKind.DESIGN,
    )


def _name_of_area(request: VolumeRequest, language: Language) -> str:
    if request.boundary is None:
        return ""
    return request.boundary_name or _BOUNDARY.in_language(language)


def _side_facts(side: ChosenSide, given: ExportedVolume) -> SideFacts:
    if side.kind is SideKind.LEVEL:
        return SideFacts(_LEVEL.filled(height=side.height_m).in_language(given.language))
    if side.kind is SideKind.DESIGN:
        return SideFacts(side.name, PurePath(side.path).name)
    drives = [drive for drive in given.drives if drive.id in side.drives]
    files = dict.fromkeys(
        PurePath(source.path).name for drive in drives for source in drive.info.sources
    )
    points = sum(drive.count for drive in drives) if drives else None
    return SideFacts(side.name, ", ".join(files), side.measured_on, points)
