"""Every processing tool by id, in the order in which they are listed, and what follows from that.

What is asked of all tools is read from their declarations at every call: a tool that is listed here
has its button, diagnostics, scorer and classes without another line.
"""

from __future__ import annotations

from collections import ChainMap
from collections.abc import Mapping

from processing.core.errors import name_with_type
from processing.core.text import Text
from processing.scoring.points.asked_classes import AskedClass
from processing.scoring.scorers import Scorer
from processing.tools.classify import CLASSIFY
from processing.tools.colour import COLOUR
from processing.tools.curbs import CURBS
from processing.tools.features import FEATURES
from processing.tools.ground import GROUND_TOOL
from processing.tools.gutters import GUTTERS
from processing.tools.noise import NOISE
from processing.tools.normals import NORMALS
from processing.tools.poles import POLES
from processing.tools.register import REGISTER
from processing.tools.road_map.barriers import BARRIERS
from processing.tools.road_map.clearance import CLEARANCE
from processing.tools.road_map.covers import COVERS
from processing.tools.road_map.edges import EDGES
from processing.tools.road_map.markings import MARKINGS
from processing.tools.road_map.walls import WALLS
from processing.tools.segments import SEGMENTS
from processing.tools.signs import SIGNS
from processing.tools.template import TEMPLATE
from processing.tools.tool import Comparison, NewPoints, NewPointsTogether, SurveyCorrection, Tool
from processing.tools.trees import TREES
from processing.tools.volume import VOLUME
from processing.tools.waveform_classify import WAVEFORM_CLASSIFY
from processing.tools.waveform_points import WAVEFORM_DECOMPOSE, WAVEFORM_ESTIMATE
from processing.tools.wires import WIRES

_DECLARED = (
    CURBS,
    GUTTERS,
    TREES,
    SIGNS,
    POLES,
    WIRES,
    MARKINGS,
    BARRIERS,
    WALLS,
    CLEARANCE,
    COVERS,
    EDGES,
    NOISE,
    GROUND_TOOL,
    CLASSIFY,
    NORMALS,
    SEGMENTS,
    FEATURES,
    COLOUR,
    TEMPLATE,
    VOLUME,
    REGISTER,
    WAVEFORM_DECOMPOSE,
    WAVEFORM_CLASSIFY,
    WAVEFORM_ESTIMATE,
)

_TOOLS = {
    tool.id: tool
    for tool in _DECLARED
    if not isinstance(tool.method, Comparison | NewPoints | NewPointsTogether | SurveyCorrection)
}

TOOLS: Mapping[str, Tool] = _TOOLS
"""Those that run on drives; plug-ins are among them once they are loaded."""

COMPARISONS: Mapping[str, Tool] = {
    tool.id: tool for tool in _DECLARED if isinstance(tool.method, Comparison)
}
"""Those that compare two grounds; they run on no drive."""


POINT_MAKERS: Mapping[str, Tool] = {
    tool.id: tool for tool in _DECLARED if isinstance(tool.method, NewPoints | NewPointsTogether)
}
"""Those that make points of their own, into a file."""


REGISTRATIONS: Mapping[str, Tool] = {
    tool.id: tool for tool in _DECLARED if isinstance(tool.method, SurveyCorrection)
}
"""Those that say how drives are to be moved; they run on all drives of a survey."""


def tools_of_drives() -> Mapping[str, Tool]:
    """Those that run on a drive: tools, with what is added to them later, and what makes points."""
    return ChainMap(dict(POINT_MAKERS), _TOOLS)


def register(tool: Tool) -> None:
    """List a tool that runs on drives beside the program's own; before the window is made."""
    _TOOLS[tool.id] = tool


def every_tool() -> Mapping[str, Tool]:
    """Tools, comparisons, what makes points and what moves drives."""
    return {**TOOLS, **COMPARISONS, **POINT_MAKERS, **REGISTRATIONS}


def point_tools() -> Mapping[str, Tool]:
    """Those that say something about every point."""
    return {tool.id: tool for tool in TOOLS.values() if tool.outputs}


def extractors() -> Mapping[str, Tool]:
    """Those that find things of the catalogue by themselves, in the order of “find all”."""
    return {tool.id: tool for tool in TOOLS.values() if tool.makes and tool.button is not None}


def asked_classes() -> Mapping[str, AskedClass]:
    """What the tools that can be judged on points are asked, by their ids."""
    return {tool.id: tool.asked for tool in TOOLS.values() if tool.asked is not None}


def scorers() -> Mapping[str, Scorer]:
    """How each kind of result is scored, by the tool's id; also for results of other programs."""
    return {tool.id: tool.scorer for tool in every_tool().values() if tool.scorer is not None}


def scorer_of(tool: str) -> Scorer:
    """The scorer of a tool's results.

    Raises
    ------
    OutOfRange
        There is none; names those there are.
    """
    return name_with_type(
        scorers(),
        tool,
        Text("Results of this tool can't be scored.", "このツールの結果は評価できません。"),
    )
