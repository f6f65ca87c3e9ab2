"""Every processing tool by id, in the order in which they are listed."""

from __future__ import annotations

from collections.abc import Mapping

from processing.tools.colour import COLOUR
from processing.tools.curbs import CURBS
from processing.tools.ground import GROUND_TOOL
from processing.tools.gutters import GUTTERS
from processing.tools.noise import NOISE
from processing.tools.normals import NORMALS
from processing.tools.segments import SEGMENTS
from processing.tools.template import TEMPLATE
from processing.tools.tool import Tool
from processing.tools.volume import VOLUME

TOOLS: Mapping[str, Tool] = {
    tool.id: tool
    for tool in (CURBS, GUTTERS, NOISE, GROUND_TOOL, NORMALS, SEGMENTS, COLOUR, TEMPLATE)
}

COMPARISONS: Mapping[str, Tool] = {tool.id: tool for tool in (VOLUME,)}
"""Those that compare two grounds; they run on no drive."""

EVERY_TOOL: Mapping[str, Tool] = {**TOOLS, **COMPARISONS}

POINT_TOOLS: Mapping[str, Tool] = {tool.id: tool for tool in TOOLS.values() if tool.outputs}
"""Those that say something about every point."""
