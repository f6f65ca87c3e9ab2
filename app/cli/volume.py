"""``zuka run volume --before A --after B``: earth between two grounds, as JSON and on paper."""

from __future__ import annotations

import argparse
import json
from collections.abc import Mapping
from contextlib import ExitStack
from dataclasses import asdict, dataclass
from datetime import datetime
from importlib.metadata import version
from pathlib import Path

import shapely

from app.cli.opened import terminal_monitor
from app.cli.output import print_lines
from app.cli.run import settings_of_words
from app.cli.volume_sides import NamedSide, named_side
from app.language import system_language
from processing.earthwork.boundary import boundary_polygon
from processing.earthwork.comparison import compare
from processing.earthwork.comparison_checks import name_of
from processing.earthwork.sides import EpochGround
from processing.earthwork.triangle_surface import TriangleSurface
from processing.earthwork.volume_parameters import VolumeParameters
from processing.earthwork.volume_result import VolumeResult
from processing.earthwork.within import Within
from processing.errors import MissingInput, OutOfRange, Unsuitable
from processing.formats.boundary_files import read_boundary
from processing.formats.change_geotiff import write_change_geotiff
from processing.formats.line_files import read_lines
from processing.formats.safe_write import refuse_inputs, written_safely
from processing.formats.volume_report import write_volume_report
from processing.formats.volume_rows import VolumeFacts
from processing.formats.volume_tables import write_volume_csv, write_volume_xlsx
from processing.formats.work_facts import SideFacts, WorkFacts
from processing.monitor import Monitor, parts_of
from processing.project.scratch_folder import scratch_folder
from processing.text import Text
from processing.tools.parameters import filled_in

_JSON = ".json"
_MAPS = (".tif", ".tiff")
_REPORTS = (".pdf", ".xlsx", ".csv")


def command(arguments: argparse.Namespace) -> int:
    """Compare two sides and write what lies between them."""
    parameters = filled_in(VolumeParameters, settings_of_words(arguments.set))
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
        result = compare(before.side, after.side, parameters, comparing, within)
        told = _told(result, before, after, crs)
        papers = _Papers(result, (before, after), parameters, crs)
        paths = papers.write(arguments.output, told, writing)
    print_lines(*(str(path) for path in paths))
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
    _check_ending(arguments.output, (_JSON,))
    if parameters.map:
        _check_ending(Path(parameters.map), _MAPS)
    if parameters.report:
        _check_ending(Path(parameters.report), _REPORTS)


def _check_ending(path: Path, endings: tuple[str, ...]) -> None:
    if path.suffix.lower() not in endings:
        raise OutOfRange(
            Text("The name has another ending.", "ファイル名の拡張子が違います。"),
            Text.same(str(path)),
            Text("Give a name ending in {endings}.", "{endings} の名前にしてください。").filled(
                endings=" / ".join(endings)
            ),
        )


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


def _within(parameters: VolumeParameters, crs: str) -> Within:
    boundary = line = None
    if parameters.boundary:
        boundary = boundary_polygon(read_boundary(Path(parameters.boundary), crs=crs).rings)
    if parameters.line:
        line = max(read_lines(Path(parameters.line), crs=crs), key=_length)[:, :2]
    break_lines = (
        read_lines(Path(parameters.break_lines), crs=crs) if parameters.break_lines else ()
    )
    return Within(boundary, line, break_lines)


def _length(line: object) -> float:
    return float(shapely.LineString(line).length)


def _told(
    result: VolumeResult, before: NamedSide, after: NamedSide, crs: str
) -> Mapping[str, object]:
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


def _day(one: NamedSide) -> str | None:
    day = one.side.measured_on if isinstance(one.side, EpochGround) else None
    return None if day is None else day.isoformat()


@dataclass(frozen=True)
class _Papers:
    """What is written of a volume."""

    result: VolumeResult
    sides: tuple[NamedSide, NamedSide]
    parameters: VolumeParameters
    crs: str

    def write(self, output: Path, told: Mapping[str, object], monitor: Monitor) -> list[Path]:
        """The numbers last: where they are, all of it is."""
        never = [path for side in self.sides for path in side.files]
        named = (self.parameters.boundary, self.parameters.line, self.parameters.break_lines)
        never += [Path(name) for name in named if name]
        # All of them before the first is written: nothing half done is left.
        for name in (output, self.parameters.map, self.parameters.report):
            if name:
                refuse_inputs(Path(name), never)
        written = []
        if self.parameters.map:
            path, change = Path(self.parameters.map), self.result.change
            write_change_geotiff(path, change, crs=self.crs, monitor=monitor, never=never)
            written.append(path)
        if self.parameters.report:
            path = Path(self.parameters.report)
            facts = _facts(self.result, self.sides, self.parameters, self.crs)
            _write_report(path, self.result, facts, never, monitor)
            written.append(path)
        with written_safely(output, never=never) as temporary:
            text = json.dumps(told, ensure_ascii=False, indent=1)
            temporary.write_text(text + "\n", encoding="utf-8")
        return [output, *written]


def _write_report(
    path: Path, result: VolumeResult, facts: VolumeFacts, never: list[Path], monitor: Monitor
) -> None:
    language = system_language()
    if path.suffix.lower() == ".csv":
        write_volume_csv(path, result, facts, language, never=never)
    elif path.suffix.lower() == ".xlsx":
        write_volume_xlsx(path, result, facts, language, never=never)
    else:
        write_volume_report(path, result, facts, language, monitor=monitor, never=never)


def _facts(
    result: VolumeResult,
    sides: tuple[NamedSide, NamedSide],
    parameters: VolumeParameters,
    crs: str,
) -> VolumeFacts:
    work = WorkFacts(crs=crs, version=version("zuka"), made_on=datetime.now().astimezone().date())
    before, after = (_side_facts(side) for side in sides)
    boundary = Path(parameters.boundary).name if parameters.boundary else ""
    return VolumeFacts(work, before, after, boundary, result.line, result.between)


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
