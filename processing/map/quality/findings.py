"""Finding: a place of the map where a rule is broken."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from processing.core.text import Text
from processing.map.feature import Position

RuleId = Literal[
    "duplicate",
    "partly_double",
    "crossing",
    "self_crossing",
    "gap",
    "sheet_gap",
    "overlap",
    "too_small",
    "unmeasured",
    "number_missing",
    "ledger_missing",
    "undecided",
    "unseen",
    "drive_gone",
]


@dataclass(frozen=True)
class Rule:
    """What is asked of a map.

    Attributes
    ----------
    name : Text
        What a finding of it is.
    remedy : Text
        What a person does about it.
    is_error : bool
        Whether a delivery with it is wrong; otherwise somebody should look at it.
    """

    name: Text
    remedy: Text
    is_error: bool = True


RULES: Mapping[RuleId, Rule] = {
    "duplicate": Rule(
        Text("Drawn twice", "重複"),
        Text("Delete one of them.", "一方を削除してください。"),
    ),
    "partly_double": Rule(
        Text("Lines partly on one another", "線の一部重複"),
        Text("Cut the part off that is drawn twice.", "重なる部分を切り取ってください。"),
    ),
    "crossing": Rule(
        Text("Lines of one kind cross", "同じ種別の線の交差"),
        Text("Trim them where they meet.", "交点で切り取ってください。"),
    ),
    "self_crossing": Rule(
        Text("Crosses itself", "自己交差"),
        Text("Move the vertices beside the place.", "付近の頂点を移動してください。"),
    ),
    "gap": Rule(
        Text("End not joined", "端点の不接合"),
        Text("Join the lines, or extend the one.", "線を接合するか延長してください。"),
    ),
    "sheet_gap": Rule(
        Text("Not joined across sheets", "図郭間の不接合"),
        Text("Join the lines at the edge of the sheets.", "図郭線で線を接合してください。"),
    ),
    "overlap": Rule(
        Text("Areas of one kind overlap", "同じ種別の面の重なり"),
        Text("Correct the outlines, or delete one.", "外形を修正するか、一方を削除してください。"),
    ),
    "too_small": Rule(
        Text("Without length or area", "長さ・面積なし"),
        Text("Draw it anew, or delete it.", "描き直すか、削除してください。"),
    ),
    "unmeasured": Rule(
        Text("Mostly off the points", "計測点なし"),
        Text(
            "Look at it in the section; survey it if need be.",
            "断面で確認し、必要なら補測してください。",
        ),
        is_error=False,
    ),
    "number_missing": Rule(
        Text("Sign without its legal number", "標識番号なし"),
        Text(
            "Choose the number: before, the sign has no code.",
            "標識番号を選んでください。それまで分類コードが付きません。",
        ),
        is_error=False,
    ),
    "ledger_missing": Rule(
        Text("Ledger without number or route", "整理番号・路線名なし"),
        Text(
            "Draw the centre line with its route, then number along it.",
            "路線名を記入した道路中心線を描き、路線に沿って番号を付けてください。",
        ),
        is_error=False,
    ),
    "undecided": Rule(
        Text("Candidate that nobody decided on", "未確認の候補"),
        Text(
            "Accept or reject it; it is not handed in.", "採用か却下してください。納品されません。"
        ),
        is_error=False,
    ),
    "unseen": Rule(
        Text("Accepted by its confidence, looked at by nobody", "信頼度のみで採用（目視なし）"),
        Text(
            "Look at it, and accept or reject it; it is handed in.",
            "目視で確認し、採用か却下してください。このままでも納品されます。",
        ),
        is_error=False,
    ),
    "drive_gone": Rule(
        Text("Drawn on a drive that is no longer here", "削除・差替え済みの走行データ上の図形"),
        Text(
            "Compare it with the points that are here, and move or delete it if need be.",
            "現在の点群と照合し、必要なら移動・削除してください。",
        ),
        is_error=False,
    ),
}
"""In the order in which they are reported."""


@dataclass(frozen=True)
class Finding:
    """A place where a rule is broken.

    Attributes
    ----------
    features : tuple of str
        Ids of those it is about, one or two.
    kind : str
        Of the first of them.
    position : Position
        Where to look: easting, northing, height in metres, project CRS.
    extent_m : float or None
        How large it is where that can be said: the width of a gap (m), an overlap's area (m²).
    """

    rule: RuleId
    features: tuple[str, ...]
    kind: str
    position: Position
    extent_m: float | None = None
