"""``zuka run volume --before A --after B``: earth between two grounds, as JSON and on paper."""

from __future__ import annotations

import argparse
import json
from contextlib import ExitStack
from dataclasses import asdict
from importlib.metadata import version
from pathlib import Path

import shapely

from app.cli.opened import terminal_monitor
from app.cli.output import print_lines
from app.cli.set_option import settings_of_words
from app.cli.volume_reports import check_report_options, volume_reports_of
from app.cli.volume_sides import NamedSide, named_side
from processing.core.errors import MissingInput, Unsuitable
from processing.core.monitor import parts_of
from processing.core.parameters import fill_parameters
from processing.core.safe_write import write_safely
from processing.core.scratch_folder import scratch_folder
from processing.core.text import Text
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


def command(arguments: argparse.Namespace) -> int:
    """Compare two sides and write what lies between them."""
    parameters = fill_parameters(VolumeParameters, settings_of_words(arguments.set))
    if not isinstance(parameters, VolumeParameters):
        raise TypeError(parameters)
    _check(arguments, parameters)
    reading, other, comparing, writing = parts_of(terminal_monitor(), (0.35, 0.35, 0.2, 0.1))
    with ExitStack() as stack:
        scratch = stack.enter_context(scratch_folder(arguments.output.parent))
        before, after = (
            stack.enter_context(named_side(words, arguments, scratch, monitor))
            for words, monitor in ((arguments.before, reading), (arguments.after, other))
        )
        crs = _one_system(before, after)
        within = _within(parameters, crs)
        papers = volume_reports_of(parameters, (before, after), crs)
        # All of them before the first is written: nothing half done is left.
        papers.refuse_inputs(arguments.output)
        result = compare(before.side, after.side, parameters, comparing, within)
        evaluations, writing = parts_of(writing, (0.5, 0.5))
        judged = papers.judged(evaluations, within)
        reported = _reported(result, before, after, crs) | _told_of_form(judged)
        written = [*papers.write(result, judged, writing)]
        # The numbers last: where they are, all of it is.
        with write_safely(arguments.output, never=papers.never) as temporary:
            text = json.dumps(reported, ensure_ascii=False, indent=1)
            temporary.write_text(text + "\n", encoding="utf-8")
    print_lines(*(str(path) for path in (arguments.output, *written)))
    return 0


def _check(arguments: argparse.Namespace, parameters: VolumeParameters) -> None:
    """Refuse what can't come to a good end before any work is done."""
    if arguments.before is None or arguments.after is None or arguments.inputs:
        raise MissingInput(
            Text("A volume lies between two grounds.", "土量の計算には2つの地盤が必要です。"),
            Text.same("zuka run volume"),
            Text(
                "Give --before A and --after B: points, a LandXML design or a level.",
                "--before A と --after B に、点群・設計面（LandXML）・標高を指定してください。",
            ),
        )
    if arguments.output is None:
        raise MissingInput(
            Text("A volume is written to a file.", "土量はファイルに書き出します。"),
            Text.same("zuka run volume"),
            Text("Name it with --output.", "--output でファイルを指定してください。"),
        )
    FORMATS.format_to_write(arguments.output, Content.NUMBERS)
    check_report_options(parameters, (arguments.before, arguments.after))


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
