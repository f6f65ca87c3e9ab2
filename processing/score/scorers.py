"""Every kind of result that can be scored against a truth, declared once.

``zuka score``, the accuracy tables and the evaluation in the window take their scorers from here.
A tool that classifies points has a :class:`~processing.score.point_scores.PointScorer`.
"""

from __future__ import annotations

from collections.abc import Mapping

from processing.errors import OutOfRange
from processing.score.point_scores import (
    GROUND_CODES,
    NOISE_CODES,
    PointScorer,
    ground_score,
    noise_score,
)
from processing.text import Text

Scorer = PointScorer
"""One per kind of result; a kind that isn't points joins here as a union."""

NOISE_SCORER = PointScorer(
    tool="noise",
    name=Text("Noise", "ノイズ除去"),
    codes=NOISE_CODES,
    if_false=0,
    if_true=18,
    flags={"signal": (18, 0)},
    told=noise_score,
)
GROUND_SCORER = PointScorer(
    tool="ground",
    name=Text("Ground", "地面抽出"),
    codes=GROUND_CODES,
    if_false=2,
    if_true=1,
    flags={"ground": (1, 2)},
    told=ground_score,
)
SCORERS: Mapping[str, Scorer] = {one.tool: one for one in (NOISE_SCORER, GROUND_SCORER)}


def scorer_of(tool: str) -> Scorer:
    """The scorer of a tool's results.

    Raises
    ------
    OutOfRange
        There is none; names those there are.
    """
    if tool not in SCORERS:
        raise OutOfRange(
            Text("Results of this tool can't be scored.", "このツールの結果は評価できません。"),
            Text.same(tool),
            Text("Use one of: {names}.", "次のいずれかを指定してください: {names}").filled(
                names=", ".join(SCORERS)
            ),
        )
    return SCORERS[tool]
