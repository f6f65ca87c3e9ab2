"""What ``zuka run volume`` writes beside its numbers: the map, the report, the as-built form."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from datetime import datetime
from importlib.metadata import version
from pathlib import Path

from processing.core.errors import MissingInput, OutOfRange, Unsuitable, use_one_of
from processing.core.monitor import Monitor
from processing.core.safe_write import refuse_inputs
from processing.core.text import Language, Text
from processing.formats.format import Content
from processing.formats.registry import FORMATS
from processing.formats.surfaces.change_geotiff import write_change_geotiff
from processing.formats.vectors.boundary_files import file_and_layer, read_boundary
from processing.formats.work_facts import SideFacts
from processing.methods.earthwork.as_built.as_built import AsBuiltResult
from processing.methods.earthwork.as_built.limits import AsBuiltLimits
from processing.methods.earthwork.as_built.limits_file import as_built_limits, read_limits
from processing.methods.earthwork.geometry.boundary import boundary_polygon
from processing.methods.earthwork.geometry.triangle_surface import TriangleSurface
from processing.methods.earthwork.geometry.volume_scope import VolumeScope
from processing.methods.earthwork.surfaces.sides import EpochGround
from processing.methods.earthwork.volumes.comparison_checks import name_of
from processing.methods.earthwork.volumes.volume_parameters import VolumeParameters
from processing.methods.earthwork.volumes.volume_result import VolumeResult
from processing.operations.volume_papers import VolumePapers, judged_ground
from processing.operations.volume_sides import NamedSide, VolumeSide
from processing.project.work_details import WorkDetails, read_work_details


def check_report_options(
    parameters: VolumeParameters, sides: tuple[VolumeSide, VolumeSide]
) -> None:
    """Refuse what can't be written before any work is done.

    Raises
    ------
    UserError
        A name has another ending; there is nothing to judge; what stands on the papers, or by
        which limits is judged, can't be read.
    """
    for name, content in (
        (parameters.map, Content.RASTER),
        (parameters.report, Content.REPORT),
        (parameters.form, Content.REPORT),
    ):
        if name:
            FORMATS.format_to_write(Path(name), content)
    if parameters.work:
        read_work_details(Path(parameters.work))
    if parameters.limits:
        read_limits(Path(parameters.limits))
    if parameters.form and parameters.report:
        _check_different(Path(parameters.form), Path(parameters.report))
    has_level = any(one.level_m is not None for one in sides)
    if parameters.form and (sum(one.is_design for one in sides) != 1 or has_level):
        raise Unsuitable(
            Text(
                "The as-built form judges points by a design.",
                "出来形管理様式は、計測した点群を設計面と比較して判定します。",
            ),
            Text.same(" / ".join(one.words for one in sides)),
            Text(
                "Give points on one side and a LandXML design on the other.",
                "一方に点群、他方に設計面（LandXML）を指定してください。",
            ),
        )
    if parameters.form and not any(one.is_project for one in sides):
        _limits(parameters, ())


def _check_different(form: Path, report: Path) -> None:
    if form.resolve() == report.resolve():
        raise OutOfRange(
            Text(
                "The form and the report have the same name.",
                "様式と土量計算書の名前が同じです。",
            ),
            Text.same(str(form)),
            Text("Give each a name of its own.", "別の名前にしてください。"),
        )


@dataclass(frozen=True)
class VolumeReports:
    """What is written of a volume beside its numbers.

    Attributes
    ----------
    crs : str
        ``EPSG:n`` of both sides, or empty when unknown.
    details : WorkDetails
        Of the file that was named, else of a project that is compared.
    limits : (AsBuiltLimits, str) or None
        The table and the work type that the form judges by; None without a form.
    language : "en" or "ja"
        Of the papers.
    others : tuple of NamedSide
        Further dates that are read.
    """

    parameters: VolumeParameters
    sides: tuple[NamedSide, NamedSide]
    crs: str
    details: WorkDetails
    limits: tuple[AsBuiltLimits, str] | None
    language: Language
    others: tuple[NamedSide, ...] = ()

    @property
    def never(self) -> list[Path]:
        """Files that must not be overwritten: all that was read."""
        given = self.parameters
        named = (given.line, given.break_lines, given.limits, given.work)
        files = [path for side in (*self.sides, *self.others) for path in side.files]
        files += [Path(name) for name in named if name]
        if given.boundary:
            files.append(file_and_layer(given.boundary)[0])
        return files

    def refuse_inputs(self, output: Path) -> None:
        """Refuse all that would be written over what was read.

        Raises
        ------
        InUse
        """
        given = (self.parameters.map, self.parameters.report, self.parameters.form)
        for path in (output, *(Path(name) for name in given if name)):
            refuse_inputs(path, self.never)

    def judged(self, monitor: Monitor, within: VolumeScope) -> AsBuiltResult | None:
        """What the form says; None where none is asked for.

        Raises
        ------
        Unsuitable, OutOfRange
            The design can't be judged by.
        """
        if self.limits is None:
            return None
        before, after = (one.side for one in self.sides)
        return judged_ground((before, after), self.limits, within.boundary, monitor)

    def write(
        self, result: VolumeResult, judged: AsBuiltResult | None, monitor: Monitor
    ) -> Iterator[Path]:
        """Write them; gives each path when it is there."""
        if self.parameters.map:
            path = Path(self.parameters.map)
            write_change_geotiff(
                path, result.change, crs=self.crs, monitor=monitor, never=self.never
            )
            yield path
        if self.parameters.report:
            path = Path(self.parameters.report)
            self._papers().write_report(path, result, monitor, ending=path.suffix.lower())
            yield path
        if judged is not None:
            path = Path(self.parameters.form)
            self._papers().write_form(path, judged, monitor, ending=path.suffix.lower())
            yield path

    def _papers(self) -> VolumePapers:
        before, after = self.sides
        boundary, area = "", None
        if self.parameters.boundary:
            file, layer = file_and_layer(self.parameters.boundary)
            boundary = f"{file.name}#{layer}" if layer else file.name
            area = boundary_polygon(read_boundary(file, crs=self.crs, layer=layer).rings)
        today = datetime.now().astimezone().date()
        return VolumePapers(
            self.details.facts(self.crs, version("zuka"), today),
            _side_facts(before),
            _side_facts(after),
            self.language,
            self.never,
            boundary,
            area,
            is_design_before=isinstance(before.side, TriangleSurface),
        )


def volume_reports_of(
    parameters: VolumeParameters,
    sides: tuple[NamedSide, NamedSide],
    crs: str,
    language: Language,
) -> VolumeReports:
    """What is to be written: the details and limits named, else those of a project.

    Raises
    ------
    UserError
        They can't be read; the work type to judge by isn't told, or isn't in the table.
    """
    limits = _limits(parameters, sides) if parameters.form else None
    details = _details(parameters, sides)
    return VolumeReports(parameters, sides, crs, details, limits, language)


def _details(parameters: VolumeParameters, sides: tuple[NamedSide, NamedSide]) -> WorkDetails:
    if parameters.work:
        return read_work_details(Path(parameters.work))
    # Of two projects the later one's: there the work went on.
    for side in reversed(sides):
        if side.work is not None:
            details = side.work.details()
            return replace(details, work=details.work or Path(side.source).stem)
    return WorkDetails()


def _limits(
    parameters: VolumeParameters, sides: tuple[NamedSide, ...]
) -> tuple[AsBuiltLimits, str]:
    """The table and the work type that count."""
    table, chosen = as_built_limits(), ""
    for side in sides:
        if side.work is not None:
            kept = side.work.limits()
            table, chosen = kept.table, kept.work_type
    if parameters.limits:
        table = read_limits(Path(parameters.limits))
        chosen = chosen if any(one.id == chosen for one in table.work_types) else ""
    return table, _chosen_work_type(table, parameters.work_type or chosen)


def _chosen_work_type(table: AsBuiltLimits, id_: str) -> str:
    """The work type of an id, or the only one of a table."""
    if not id_ and len(table.work_types) > 1:
        raise MissingInput(
            Text(
                "The form has to know the work type whose limits count.",
                "様式の判定に用いる工種が指定されていません。",
            ),
            Text.same("--set work_type=…"),
            use_one_of(one.id for one in table.work_types),
        )
    return table[id_].id if id_ else table.work_types[0].id


def _side_facts(one: NamedSide) -> SideFacts:
    if isinstance(one.side, TriangleSurface):
        count = len(one.side.corners)
        return SideFacts(
            name_of(one.side), Path(one.source).name, None, count, counts_triangles=True
        )
    if isinstance(one.side, EpochGround):
        day = one.side.measured_on
        return SideFacts(one.side.name, Path(one.source).name, day, one.points)
    return SideFacts(one.source)
