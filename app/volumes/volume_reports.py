"""The papers of a volume: its report, and the form of as-built control."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path, PurePath

from processing.core.monitor import Monitor
from processing.core.text import Language, Text
from processing.formats.reports.as_built_form import write_as_built_form
from processing.formats.reports.as_built_rows import AsBuiltFacts
from processing.formats.reports.as_built_tables import write_as_built_csv, write_as_built_xlsx
from processing.formats.reports.volume_report import write_volume_report
from processing.formats.reports.volume_rows import VolumeFacts
from processing.formats.reports.volume_tables import write_volume_csv, write_volume_xlsx
from processing.formats.reports.work_facts import SideFacts, WorkFacts
from processing.methods.earthwork.as_built.as_built import AsBuiltResult, evaluate_as_built
from processing.methods.earthwork.maps.contours import LevelLine
from processing.methods.earthwork.surfaces.sides import Side
from processing.methods.earthwork.volumes.comparison_checks import ground_and_design
from processing.methods.earthwork.volumes.volume_result import VolumeResult
from processing.project.volumes.volume import ChosenSide, KeptVolume, SideKind
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


def is_judged(kept: KeptVolume) -> bool:
    """Whether a measured ground was compared with a design."""
    kinds = {kept.request.before.kind, kept.request.after.kind}
    return kinds == {SideKind.EPOCH, SideKind.DESIGN}


def write_report(path: Path, given: ExportedVolume, monitor: Monitor) -> None:
    """Write the volume report as PDF."""
    write_volume_report(
        path, given.result, _volume_facts(given), given.language, monitor=monitor, never=given.never
    )


def write_report_xlsx(path: Path, given: ExportedVolume, _monitor: Monitor) -> None:
    """Write the volume report as a workbook."""
    write_volume_xlsx(path, given.result, _volume_facts(given), given.language, never=given.never)


def write_report_csv(path: Path, given: ExportedVolume, _monitor: Monitor) -> None:
    """Write the numbers of the volume report as a table."""
    write_volume_csv(path, given.result, _volume_facts(given), given.language, never=given.never)


def write_form(path: Path, given: ExportedVolume, monitor: Monitor) -> None:
    """Write the form of as-built control as PDF."""
    result, facts = _judged(given, monitor)
    write_as_built_form(path, result, facts, given.language, monitor=monitor, never=given.never)


def write_form_xlsx(path: Path, given: ExportedVolume, monitor: Monitor) -> None:
    """Write the form of as-built control as a workbook."""
    result, facts = _judged(given, monitor)
    write_as_built_xlsx(path, result, facts, given.language, never=given.never)


def write_form_csv(path: Path, given: ExportedVolume, monitor: Monitor) -> None:
    """Write the numbers of the form of as-built control as a table."""
    result, facts = _judged(given, monitor)
    write_as_built_csv(path, result, facts, given.language, never=given.never)


def _judged(given: ExportedVolume, monitor: Monitor) -> tuple[AsBuiltResult, AsBuiltFacts]:
    ground, design = ground_and_design(*given.sides(monitor))
    request = given.kept.request
    named = {side.kind: side for side in (request.before, request.after)}
    limits = given.limits.table, given.limits.shown_work_type
    result = evaluate_as_built(ground, design, limits, monitor, boundary=request.boundary)
    facts = AsBuiltFacts(
        _work_facts(given),
        _side_facts(named[SideKind.DESIGN], given),
        _side_facts(named[SideKind.EPOCH], given),
    )
    return result, facts


def _volume_facts(given: ExportedVolume) -> VolumeFacts:
    request = given.kept.request
    boundary = "" if request.boundary is None else _BOUNDARY.in_language(given.language)
    return VolumeFacts(
        _work_facts(given),
        _side_facts(request.before, given),
        _side_facts(request.after, given),
        boundary,
        given.result.line,
        given.result.between,
    )


def _work_facts(given: ExportedVolume) -> WorkFacts:
    made_on = given.kept.made.astimezone().date()
    return given.details.facts(given.kept.crs, version("zuka"), made_on)


def _side_facts(side: ChosenSide, given: ExportedVolume) -> SideFacts:
    if side.kind is SideKind.LEVEL:
        return SideFacts(_LEVEL.filled(height=side.height_m).in_language(given.language))
    if side.kind is SideKind.DESIGN:
        return SideFacts(side.name, PurePath(side.path).name)
    files = dict.fromkeys(
        PurePath(source.path).name
        for drive in given.drives
        if drive.id in side.drives
        for source in drive.info.sources
    )
    return SideFacts(side.name, ", ".join(files), side.measured_on)
