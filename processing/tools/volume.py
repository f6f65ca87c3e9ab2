"""The tool VOLUME: earth between two grounds, cut and filled, and how surely."""

from __future__ import annotations

from processing.core.text import Text
from processing.methods.earthwork.volumes.comparison import compare
from processing.methods.earthwork.volumes.volume_parameters import VolumeParameters
from processing.scoring.scorers import VOLUME_SCORER
from processing.tools.tool import Comparison, Needs, Tool

VOLUME = Tool(
    id="volume",
    name=Text("Volume", "土量"),
    explanation=Text(
        "Cut and fill between two epochs, or against a design or a level, with the area that "
        "nobody measured and an uncertainty.",
        "2時期の間、または設計面・標高との間の切土量と盛土量を、未計測面積と不確かさとともに"
        "求めます。",
    ),
    group=Text("Earthwork", "土工"),
    needs=Needs.POINTS,
    parameters=VolumeParameters,
    method=Comparison(compare),
    scorer=VOLUME_SCORER,
)
