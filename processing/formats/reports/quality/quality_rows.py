"""What a quality report says, as words and rows, whatever file it goes into."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from processing.core.text import Language, Text
from processing.formats.work_facts import WorkFacts
from processing.map.catalogue import Catalogue
from processing.map.quality.check_points import PointCheck
from processing.map.quality.findings import RULES, Finding
from processing.map.quality.map_check import MapCheck
from processing.map.renewal.map_agreement import KindAgreement

TITLE = Text("Quality of the map", "図化成果 品質評価表")
RULE_COLUMNS = (
    Text("Rule", "点検項目"),
    Text("Found", "件数"),
    Text("Verdict", "判定"),
    Text("What to do", "対処"),
)
KIND_COLUMNS = (
    Text("Kind", "種別"),
    Text("Code", "分類コード"),
    Text("Handed in", "納品"),
    Text("Found by tools", "うち自動抽出"),
    Text("Not looked at", "うち目視なし"),
    Text("Undecided", "未確認"),
    Text("Rejected", "却下"),
    Text("Precision", "適合率"),
    Text("Recall", "再現率"),
)
FINDING_COLUMNS = (
    Text("No.", "番号"),
    Text("Rule", "点検項目"),
    Text("Kind", "種別"),
    Text("Feature", "地物"),
    Text("Easting (m)", "東距 Y (m)"),
    Text("Northing (m)", "北距 X (m)"),
    Text("Height (m)", "標高 (m)"),
)
ACCURACY_COLUMNS = (
    Text("Accuracy", "精度"),
    Text("Points", "点数"),
    Text("RMSE (m)", "RMSE (m)"),
    Text("Largest (m)", "最大 (m)"),
    Text("Limit (m)", "制限値 (m)"),
    Text("Verdict", "判定"),
)
POINT_COLUMNS = (
    Text("Check point", "検証点"),
    Text("Kind", "種別"),
    Text("Feature", "地物"),
    Text("In plan (m)", "水平較差 (m)"),
    Text("Height (m)", "標高較差 (m)"),
)
HAND_COLUMNS = (
    Text("Kind", "種別"),
    Text("Hand check", "別途点検"),
    Text("Map: precision", "図面の適合率"),
    Text("Map: recall", "図面の再現率"),
    Text("Tools: precision", "自動抽出の適合率"),
    Text("Tools: recall", "自動抽出の再現率"),
)
HAND_TITLE = Text("Precision and recall by a separate hand check", "別途点検による適合率・再現率")
POINTS_TITLE = Text("Check points", "検証点")
_PLAN, _HEIGHT = Text("In plan", "水平位置"), Text("Height", "標高")
_NOT_FOUND = Text("no vertex near", "該当なし")
_NOT_CHECKED = Text("not checked", "未検証")
_GAPS = ("gap", "sheet_gap")
RULES_TITLE = Text("Rules", "点検項目")
KINDS_TITLE = Text("Kinds", "種別ごとの数量")
FINDINGS_TITLE = Text("Findings", "指摘箇所")
NO_FINDINGS = Text("Nothing was found.", "指摘はありません。")
NO_CODE = Text("none", "なし")
PASSED = Text("passed", "適合")
LOOK = Text("look at it", "要確認")
FAILED = Text("failed", "不適合")
_SYSTEM = Text("Reference system", "座標参照系")
_WORK, _CLIENT = Text("Work", "業務名"), Text("Client", "計画機関")
_CONTRACTOR = Text("Contractor", "作業機関")
_HEIGHTS = Text("Heights", "標高の基準")
_UNKNOWN = Text("not known", "不明")
_FEATURES = Text("Features handed in", "納品する地物")
_DECIDED = Text(
    "Looked at and decided on, of what tools found", "自動抽出のうち目視で採否を決めた割合"
)
_ERRORS = Text("Errors", "不適合の件数")
_LOOKS = Text("To be looked at", "要確認の件数")


_NUMBER = re.compile(r"-?[\d,]+(\.\d+)?%?")


@dataclass(frozen=True)
class HandCheck:
    """The map, and what tools found for it, by one that was drawn separately.

    Attributes
    ----------
    map, tools : tuple of KindAgreement
        By kind, in the same order.
    """

    map: tuple[KindAgreement, ...]
    tools: tuple[KindAgreement, ...]


@dataclass(frozen=True)
class QualityFacts:
    """What a report is about.

    Attributes
    ----------
    crs : str
        ``EPSG:n``; empty where it is not known.
    software : str
        Name and version of the program.
    points : PointCheck or None
        None where no check points were given.
    work : WorkFacts
        Whose names stand on the report where they are known.
    hand : HandCheck or None
        None where no map was drawn separately.
    """

    check: MapCheck
    catalogue: Catalogue
    crs: str
    software: str
    points: PointCheck | None = None
    work: WorkFacts = field(default_factory=WorkFacts)
    hand: HandCheck | None = None

    def kind_name(self, kind: str) -> Text:
        """What a kind is called."""
        return self.catalogue[kind].name if kind in self.catalogue else Text.same(kind)


def summary_rows(facts: QualityFacts) -> Iterator[tuple[Text, Text]]:
    """What is known of the whole map: names and values."""
    check, work = facts.check, facts.work
    for name, words in (
        (_WORK, work.work), (_CLIENT, work.client), (_CONTRACTOR, work.contractor),
    ):  # fmt: skip
        if words:
            yield name, Text.same(words)
    yield _SYSTEM, Text.same(facts.crs) if facts.crs else _UNKNOWN
    if work.height_datum:
        yield _HEIGHTS, Text.same(work.height_datum)
    yield _FEATURES, Text.same(f"{sum(one.accepted for one in check.kinds):,}")
    yield _DECIDED, Text.same(f"{check.decided_share:.1%}")
    yield _ERRORS, Text.same(f"{check.errors:,}")
    yield _LOOKS, Text.same(f"{len(check.findings) - check.errors:,}")


def rule_rows(facts: QualityFacts) -> Iterator[tuple[Text, Text, Text, Text]]:
    """Every rule: name, how often it is broken, verdict, remedy where it is broken."""
    for id_, rule in RULES.items():
        count = facts.check.count(id_)
        broken = FAILED if rule.is_error else LOOK
        remedy = rule.remedy if count else Text.same("")
        yield rule.name, Text.same(f"{count:,}"), broken if count else PASSED, remedy


def accuracy_title(points: PointCheck) -> Text:
    """What stands above the accuracy: the level, and points that were not found."""
    title = Text(
        "Accuracy at check points, map level {level} (作業規程の準則 第80条)",
        "検証点による精度（地図情報レベル{level}、作業規程の準則 第80条）",
    ).filled(level=points.level)
    if not points.missing:
        return title
    missing = Text("{title}; {count} not found on the map", "{title}　図面にない検証点: {count}点")
    return missing.filled(title=title, count=len(points.missing))


def accuracy_rows(points: PointCheck) -> Iterator[tuple[Text, ...]]:
    """In plan and of heights: number, RMSE, largest, limit, verdict."""
    for name, one in ((_PLAN, points.plan), (_HEIGHT, points.height)):
        verdict = PASSED if one.passes else FAILED
        yield (
            name,
            Text.same(f"{one.count:,}"),
            *(_metres(value) for value in (one.rmse_m, one.most_m, one.limit_m)),
            verdict if one.count else _NOT_CHECKED,
        )


def point_rows(facts: QualityFacts, points: PointCheck) -> Iterator[tuple[Text, ...]]:
    """Every check point: id, kind, feature, differences."""
    for one in points.points:
        kind = facts.kind_name(one.point.kind) if one.point.kind else Text.same("")
        feature = Text.same(f"#{one.feature[:8]}") if one.feature else _NOT_FOUND
        yield Text.same(one.point.id), kind, feature, _metres(one.plan_m), _metres(one.height_m)


def _share(value: float) -> Text:
    return Text.same("–" if math.isnan(value) else f"{value:.1%}")


def _metres(value: float) -> Text:
    return Text.same("–" if math.isnan(value) else f"{value:.3f}")


def kind_rows(facts: QualityFacts) -> Iterator[tuple[Text, ...]]:
    """Every kind on the map: name, official code or that there is none, counts, precision, recall.

    By review: what was rejected tools found wrongly, what was drawn by hand they missed.
    """
    for one in facts.check.kinds:
        code = facts.catalogue[one.kind].dm_code
        counts = (one.accepted, one.by_tools, one.unseen, one.candidates, one.rejected)
        yield (
            facts.kind_name(one.kind),
            Text.same(code) if code else NO_CODE,
            *(Text.same(f"{count:,}") for count in counts),
            *(_share(value) for value in (one.precision, one.recall)),
        )


def hand_rows(facts: QualityFacts, hand: HandCheck) -> Iterator[tuple[Text, ...]]:
    """Every kind of the hand check: how much there is, precision and recall of map and tools."""
    for one, tools in zip(hand.map, hand.tools, strict=True):
        amount = f"{one.truth:,.1f} m" if one.is_line else f"{one.truth:,.0f}"
        shares = (one.precision, one.recall, tools.precision, tools.recall)
        yield facts.kind_name(one.kind), Text.same(amount), *map(_share, shares)


def finding_rows(facts: QualityFacts) -> Iterator[tuple[Text, ...]]:
    """Every finding: number, rule, kind, features, place."""
    for number, one in enumerate(facts.check.findings, start=1):
        yield (
            Text.same(f"{number}"),
            _with_extent(one),
            facts.kind_name(one.kind),
            Text.same(", ".join(f"#{id_[:8]}" for id_ in one.features)),
            *(Text.same(f"{value:.3f}") for value in one.position),
        )


def _with_extent(finding: Finding) -> Text:
    name = RULES[finding.rule].name
    if finding.extent_m is None:
        return name
    extent = f"{finding.extent_m:.3f} m" if finding.rule in _GAPS else f"{finding.extent_m:.2f} m²"
    return Text(f"{name.en} ({extent})", f"{name.ja}（{extent}）")


def in_language(rows: Iterator[tuple[Text, ...]], language: Language) -> list[list[str]]:
    """Rows as plain words."""
    return [[cell.in_language(language) for cell in row] for row in rows]


def is_number(words: str) -> bool:
    """Whether a cell holds a number, which stands to the right."""
    return _NUMBER.fullmatch(words) is not None
