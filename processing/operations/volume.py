"""Comparing two grounds: a value that names them, and what compares, judges and writes."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from dataclasses import asdict, dataclass, field, replace
from importlib.metadata import version
from pathlib import Path
from typing import Any

import shapely

from processing.core.errors import Unsuitable
from processing.core.monitor import Monitor, parts_of
from processing.core.parameters import ParameterValue, fill_parameters
from processing.core.safe_write import write_safely
from processing.core.scratch_folder import scratch_folder
from processing.core.text import Language, Text
from processing.formats.format import Content
from processing.formats.registry import FORMATS
from processing.formats.vectors.boundary_files import file_and_layer, read_boundary
from processing.formats.vectors.line_files import read_lines
from processing.methods.earthwork.as_built.as_built import AsBuiltResult
from processing.methods.earthwork.geometry.boundary import boundary_polygon
from processing.methods.earthwork.geometry.volume_scope import VolumeScope
from processing.methods.earthwork.surfaces.sides import EpochGround
from processing.methods.earthwork.volumes.comparison import compare
from processing.methods.earthwork.volumes.volume_parameters import VolumeParameters
from processing.methods.earthwork.volumes.volume_result import VolumeResult
from processing.operations.project_export import WrittenFiles
from processing.operations.volume_outputs import (
    check_report_options,
    volume_reports_of,
)
from processing.operations.volume_sides import NamedSide, SideReading, VolumeSide, named_side


@dataclass(frozen=True)
class VolumeOperation:
    """Two grounds to be compared.

    Attributes
    ----------
    before, after : VolumeSide
    output : Path
        The figures, as JSON.
    parameters : mapping of str to value
        Those that are given, by name: also which map and papers are written.
    crs : str
        ``EPSG:n`` where files don't name it.
    columns : tuple of str
        What the columns of text files are; empty to go by the files.
    language : "en" or "ja"
        Of the papers.
    others : tuple of VolumeSide
        Points of other dates, which tell the shape of ground that a compared one did not show.
    """

    before: VolumeSide
    after: VolumeSide
    output: Path
    parameters: Mapping[str, ParameterValue] = field(default_factory=dict)
    crs: str = ""
    columns: tuple[str, ...] = ()
    language: Language = "ja"
    others: tuple[VolumeSide, ...] = ()

    @property
    def parameter_class(self) -> type[Any]:
        """What can be set."""
        return VolumeParameters

    def check(self) -> None:
        """Refuse a parameter that there isn't, a value outside its limits, another ending.

        Raises
        ------
        OutOfRange
        """
        fill_parameters(VolumeParameters, self.parameters)
        FORMATS.format_to_write(self.output, Content.NUMBERS)


def compare_grounds(operation: VolumeOperation, monitor: Monitor) -> WrittenFiles:
    """Compare two grounds and write what lies between them.

    Raises
    ------
    UserError, Cancelled
        The file of the figures was not written.
    """
    operation.check()
    parameters = fill_parameters(VolumeParameters, operation.parameters)
    check_report_options(parameters, (operation.before, operation.after))
    first, second, third, comparing, writing = parts_of(monitor, (0.3, 0.3, 0.1, 0.2, 0.1))
    output = operation.output
    with ExitStack() as stack:
        scratch = stack.enter_context(scratch_folder(output.parent))
        reading = SideReading(operation.crs, operation.columns, output.parent, scratch)
        before, after = (
            stack.enter_context(named_side(asked, reading, part))
            for asked, part in ((operation.before, first), (operation.after, second))
        )
        others = [
            stack.enter_context(named_side(asked, reading, part))
            for asked, part in zip(
                operation.others, parts_of(third, (1.0,) * len(operation.others)), strict=True
            )
        ]
        crs = _one_system(before, after)
        within = _within(parameters, crs)
        papers = volume_reports_of(parameters, (before, after), crs, operation.language)
        papers = replace(papers, others=tuple(others))
        # All of them before the first is written: nothing half done is left.
        papers.refuse_inputs(output)
        result = compare(
            before.side, after.side, parameters, comparing, within, others=_epochs(others)
        )
        evaluations, writing = parts_of(writing, (0.5, 0.5))
        judged = papers.judged(evaluations, within)
        reported = _reported(result, before, after, crs) | _told_of_form(judged)
        written = [*papers.write(result, judged, writing)]
        # The numbers last: where they are, all of it is.
        with write_safely(output, never=papers.never) as temporary:
            text = json.dumps(reported, ensure_ascii=False, indent=1)
            temporary.write_text(text + "\n", encoding="utf-8")
    return WrittenFiles((output, *written))


def _one_system(before: NamedSide, after: NamedSide) -> str:
    """The system of both sides, where it is known."""
    systems = {one.crs for one in (before, after) if one.crs}
    if len(systems) > 1:
        raise Unsuitable(
            Text("The two sides have different reference systems.", "2つの座標系が異なります。"),
            Text.same(f"{before.source}: {before.crs}; {after.source}: {after.crs}"),
            Text(
                "Convert one of them, or give the right one with --crs.",
                "一方を変換するか、--crs で正しい座標系を指定してください。",
            ),
        )
    return next(iter(systems), "")


def _epochs(others: Sequence[NamedSide]) -> tuple[EpochGround, ...]:
    """What else was measured: designs and levels tell nothing of hidden ground."""
    epochs = tuple(one.side for one in others if isinstance(one.side, EpochGround))
    if len(epochs) < len(others):
        raise Unsuitable(
            Text("Only points tell of hidden ground.", "未計測部の補間に使えるのは点群だけです。"),
            Text.same("; ".join(one.source for one in others)),
            Text("Give points of another date.", "別の時期の点群を指定してください。"),
        )
    return epochs


def _within(parameters: VolumeParameters, crs: str) -> VolumeScope:
    boundary = line = None
    if parameters.boundary:
        path, layer = file_and_layer(parameters.boundary)
        boundary = boundary_polygon(read_boundary(path, crs=crs, layer=layer).rings)
    if parameters.line:
        line = max(read_lines(Path(parameters.line), crs=crs), key=_length)[:, :2]
    break_lines = (
        read_lines(Path(parameters.break_lines), crs=crs) if parameters.break_lines else ()
    )
    return VolumeScope(boundary, line, break_lines)


def _length(line: object) -> float:
    return float(shapely.LineString(line).length)


def _reported(
    result: VolumeResult, before: NamedSide, after: NamedSide, crs: str
) -> dict[str, object]:
    """What the file says: the contract's names first."""
    volumes, registration = result.volumes, result.registration
    return {
        "cut_m3": volumes.cut_m3,
        "fill_m3": volumes.fill_m3,
        "net_m3": volumes.net_m3,
        "area_m2": volumes.area_m2,
        "method": result.method,
        "grid_m": result.grid_m,
        "uncertainty_m3": volumes.uncertainty_m3,
        "unmeasured_area_m2": volumes.unmeasured_area_m2,
        "left_out_area_m2": volumes.left_out_area_m2,
        "measured_cut_m3": volumes.measured_cut_m3,
        "measured_fill_m3": volumes.measured_fill_m3,
        "crs": crs,
        "before": {"source": before.source, "measured_on": _day(before)},
        "after": {"source": after.source, "measured_on": _day(after)},
        "registration": None if registration is None else asdict(registration),
        "notes": [{"en": note.en, "ja": note.ja} for note in result.notes],
        "software": f"zuka {version('zuka')}",
    }


def _told_of_form(judged: AsBuiltResult | None) -> dict[str, object]:
    if judged is None:
        return {}
    return {"as_built": {"work_type": judged.work_type.id, "passes": judged.passes}}


def _day(one: NamedSide) -> str | None:
    day = one.side.measured_on if isinstance(one.side, EpochGround) else None
    return None if day is None else day.isoformat()
