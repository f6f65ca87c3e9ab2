"""The tool TEMPLATE: a profile drawn once in a section, fitted along the street from there."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from processing.core.errors import MissingInput, Unsuitable
from processing.core.monitor import Monitor, PartMonitor
from processing.core.parameters import angle, file, length, ratio
from processing.core.text import Text
from processing.methods.templates.fit import FitSettings, fit_along
from processing.methods.templates.fitted_lines import FittedLine, fitted_lines
from processing.methods.templates.levels import levels_near
from processing.methods.templates.line_directions import RoadDirection
from processing.methods.templates.profile_template import ProfileTemplate
from processing.methods.templates.slab import SectionFrame
from processing.methods.templates.template_text import parse_template, read_template
from processing.recording.drive import Drive
from processing.tools.tool import Candidate, CandidateResult, Finder, Needs, Tool

_UNKNOWN_HEIGHT_M = -1000.0
_ALONG_ROAD_DEG = -1.0
_FITTING = 0.9


@dataclass(frozen=True)
class TemplateParameters:
    """Where a template begins, and how far it goes."""

    template: str = file(
        name=Text("Template", "テンプレート"),
        explanation=Text(
            "The wanted profile: a template file as the template panel exports it.",
            "あるべき断面形状。テンプレートパネルから書き出したファイルを指定します。",
        ),
    )
    easting_m: float = length(
        0.0,
        low=-1e7,
        high=1e7,
        name=Text("Easting of the start", "開始位置の東距"),
        explanation=Text(
            "Where the template's anchor lies in one section, within 30 cm.",
            "1つの断面で基準点がある位置（30cm以内の精度で指定）。",
        ),
    )
    northing_m: float = length(
        0.0,
        low=-1e7,
        high=1e7,
        name=Text("Northing of the start", "開始位置の北距"),
        explanation=Text("As the easting.", "東距と同様に指定します。"),
    )
    height_m: float = length(
        _UNKNOWN_HEIGHT_M,
        low=_UNKNOWN_HEIGHT_M,
        high=10_000.0,
        name=Text("Height of the start", "開始位置の標高"),
        explanation=Text(
            "Height of the anchor, within 20 cm; −1000: the level at which the template fits best.",
            "基準点の標高（20cm以内の精度）。-1000のときは最もよく合う高さを探します。",
        ),
    )
    heading_deg: float = angle(
        _ALONG_ROAD_DEG,
        low=_ALONG_ROAD_DEG,
        high=360.0,
        name=Text("Direction", "方位角"),
        explanation=Text(
            "In which one looks along the line, clockwise from north; −1: as the vehicle drove.",
            "線に沿って断面を見る向き（北から時計回り）。-1のときは走行方向とします。",
        ),
    )
    step_m: float = length(
        0.5,
        low=0.1,
        high=5.0,
        name=Text("Step", "断面間隔"),
        explanation=Text(
            "From one section to the next along the line.", "線に沿った断面の間隔です。"
        ),
    )
    width_m: float = length(
        0.75,
        low=0.1,
        high=3.0,
        name=Text("Section width", "断面の厚さ"),
        explanation=Text(
            "Points within it are seen as one section; more where points are sparse.",
            "この厚さの中の点を1つの断面とみなします。点が疎らな場合は大きくします。",
        ),
    )
    tolerance_m: float = length(
        0.0,
        low=0.0,
        high=0.2,
        name=Text("Tolerance", "許容差"),
        explanation=Text(
            "Points this near to the shape lie on it; 0: as the template says.",
            "形状からこの距離以内の点を一致とみなします。0のときはテンプレートの値を使います。",
        ),
    )
    least_score: float = ratio(
        0.7,
        low=0.1,
        high=1.0,
        name=Text("Least score", "最小スコア"),
        explanation=Text(
            "Share of the seen shape that must lie on points.",
            "計測されている形状のうち、点と一致すべき割合です。",
        ),
    )
    longest_gap_m: float = length(
        5.0,
        low=0.0,
        high=50.0,
        name=Text("Longest gap", "最大途切れ長"),
        explanation=Text(
            "A line goes on over so much without the shape: driveways, parked cars.",
            "乗入れ部や駐車車両などで形状が途切れても、この長さまでは1本の線として続けます。",
        ),
    )
    search_m: float = length(
        15.0,
        low=0.0,
        high=100.0,
        name=Text("Search beyond the end", "終端からの探索長"),
        explanation=Text(
            "Where a line ends the shape is looked for again this far, to begin another line.",
            "線の終端からこの長さまで形状を探し、見つかれば別の線として続けます。",
        ),
    )


def find_template(
    drive: Drive, parameters: TemplateParameters, monitor: Monitor
) -> CandidateResult:
    """Lines along the street where the template fits.

    Raises
    ------
    MissingInput, BadFile
        There is no template.
    Unsuitable
        It doesn't fit at the start, or nothing tells the direction there.
    """
    template = _template(parameters.template)
    frame = _start(drive, parameters)
    settings = FitSettings(
        parameters.step_m,
        parameters.width_m,
        parameters.tolerance_m,
        parameters.least_score,
        parameters.longest_gap_m,
        parameters.search_m,
    )
    if parameters.height_m == _UNKNOWN_HEIGHT_M:
        frame = levels_near(drive, template, frame, settings, monitor)
    walk = fit_along(drive, template, frame, settings, PartMonitor(monitor, 0.0, _FITTING))
    lines = fitted_lines(drive, walk, settings, monitor)
    return CandidateResult(tuple(_candidate(line) for line in lines))


def _template(given: str) -> ProfileTemplate:
    """A template by its file, or written out as a project hands it over."""
    if not given.strip():
        raise MissingInput(
            Text("No template is given.", "テンプレートが指定されていません。"),
            Text.same("template"),
            Text(
                "Choose a template file; the template panel exports them.",
                "テンプレートパネルから書き出したファイルを指定してください。",
            ),
        )
    if given.lstrip().startswith("{"):
        return parse_template(given, "template")
    return read_template(Path(given))


def _remark(drive: Drive) -> Text | None:
    """Say which parameter nothing else can stand for on this drive."""
    if drive.trajectory is not None:
        return None
    return Text(
        "This drive has no trajectory: give the direction of the line.",
        "この走行データには走行軌跡がないため、線の方位角を指定してください。",
    )


def _start(drive: Drive, parameters: TemplateParameters) -> SectionFrame:
    position = np.array([parameters.easting_m, parameters.northing_m, parameters.height_m])
    if parameters.heading_deg != _ALONG_ROAD_DEG:
        return SectionFrame(position, math.radians(90.0 - parameters.heading_deg))
    heading = RoadDirection(drive.trajectory).heading_near(position)
    if heading is None:
        raise Unsuitable(
            Text(
                "Without a trajectory the direction of the line is not known.",
                "走行軌跡がないため、線の方向が分かりません。",
            ),
            Text.same(drive.info.name),
            Text(
                "Give the direction, or begin in the section view.",
                "方位角を指定するか、断面ビューから開始してください。",
            ),
        )
    return SectionFrame(position, heading)


def _candidate(line: FittedLine) -> Candidate:
    attributes: dict[str, str | float | int | bool | None] = {
        "length_m": round(line.length_m, 2),
        "score_per_m": " ".join(f"{score:.2f}" for score in line.scores),
    }
    if line.edge:
        attributes["edge"] = line.edge
    return Candidate(line.kind, "line", line.xyz, line.points, line.confidence, attributes)


TEMPLATE = Tool(
    id="template",
    name=Text("Fit a template", "テンプレートの追跡"),
    explanation=Text(
        "Follows a curb, gutter or any other profile along the street from one section, where it "
        "was drawn, and gives candidate lines with a score for each metre.",
        "1つの断面に描いた縁石や側溝などの形状を道路に沿って追跡し、1mごとのスコアを付けた候補線を作成します。",
    ),
    group=Text("Lines", "線"),
    needs=Needs.POINTS,
    parameters=TemplateParameters,
    method=Finder(find_template),
    remark=_remark,
    sought=("template", "easting_m", "northing_m", "height_m", "heading_deg"),
)
