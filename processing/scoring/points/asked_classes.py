"""What a tool that gives classes is asked for: which codes mean yes, and words for both sides.

Two studies call opposite classes positive, so every score names its class; the words are here. A
tool that can be judged so names one of these in its declaration.
"""

from __future__ import annotations

from dataclasses import dataclass

from processing.core.text import Text
from processing.scoring.points.point_scores import GROUND_CODES, NOISE_CODES


@dataclass(frozen=True)
class AskedClass:
    """The two sides of one question about points.

    Attributes
    ----------
    codes : frozenset of int
        Classes of the points that the tool looks for.
    found : Text
        Such a point.
    other : Text
        Any other point.
    removes : bool
        Whether the points looked for are those that are taken away; otherwise they are kept.
    """

    codes: frozenset[int]
    found: Text
    other: Text
    removes: bool

    @property
    def kept(self) -> Text:
        """What a kept point is called."""
        return self.other if self.removes else self.found

    @property
    def removed(self) -> Text:
        """What a point that is taken away is called."""
        return self.found if self.removes else self.other


NOISE_ASKED = AskedClass(
    NOISE_CODES,
    Text("noise point", "ノイズ点"),
    Text("true point", "ノイズでない点"),
    removes=True,
)
GROUND_ASKED = AskedClass(
    GROUND_CODES, Text("ground", "地面"), Text("object", "物体"), removes=False
)
