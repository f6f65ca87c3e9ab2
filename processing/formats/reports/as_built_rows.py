"""The words of form 31-2 (様式-31-2 出来形合否判定総括表): the same on paper and in tables."""

from __future__ import annotations

import math
from dataclasses import dataclass

from processing.core.text import Text
from processing.formats.work_facts import (
    FAIL,
    NOTHING,
    PASS,
    SideFacts,
    WorkFacts,
    crs_words,
    day,
    format_count,
    format_signed,
)
from processing.methods.earthwork.as_built.as_built import AsBuiltResult, FaceMeasure, FaceResult
from processing.methods.earthwork.as_built.limits import AsBuiltLimits

TITLE = Text("Summary of as-built judgement", "出来形合否判定総括表")
FORM = Text("Form 31-2", "様式-31-2")
MEASURED_ITEM = Text("Difference in height (measured − design)", "標高較差（計測値 − 設計値）")
COLUMNS = (
    Text("Face", "部位"),
    Text("Item", "項目"),
    Text("Measured", "測定値"),
    Text("Limit", "規格値"),
    Text("Verdict", "判定"),
)
RESULT = Text("Verdict", "合否判定結果")
MAP_TITLE = Text("Difference ÷ limit of one value", "分布図（標高較差 ÷ 個々の値の規格値）")
NO_DATA = Text("no data", "データなし")

_ONE_SIDED = Text(
    "Where one side has no limit, the map shows that side by the other's; it is no defect there.",
    "規格値が片側だけの場合、分布図の反対側は同じ大きさの値との比で示す（規格値外ではない）。",
)
_MM, _M2, _VALUES = Text.same("mm"), Text.same("m²"), Text("values", "点")


@dataclass(frozen=True)
class FormRow:
    """A line of the form.

    Attributes
    ----------
    value : float
        For tables: the number alone; NaN where there is none.
    unit : Text
    shown : Text
        As it is printed, with its unit and what belongs to it.
    limit : Text
    passes : bool or None
        None where nothing is judged.
    """

    name: Text
    value: float
    unit: Text
    shown: Text
    limit: Text = NOTHING
    passes: bool | None = None

    @property
    def verdict(self) -> Text:
        """In words; a dash where nothing is judged."""
        return NOTHING if self.passes is None else verdict(passes=self.passes)


@dataclass(frozen=True)
class AsBuiltFacts:
    """What the form says besides the result.

    Attributes
    ----------
    design, ground : SideFacts
        The design surface and the measured ground.
    """

    work: WorkFacts
    design: SideFacts
    ground: SideFacts


def verdict(*, passes: bool) -> Text:
    """合格 or 不合格."""
    return PASS if passes else FAIL


def fact_rows(result: AsBuiltResult, facts: AsBuiltFacts) -> tuple[tuple[Text, Text], ...]:
    """What stands above the numbers: names and values, in the form's order."""
    work, same = facts.work, Text.same
    standard = Text(
        f"{result.table.standard.en} ({result.table.edition.en})",
        f"{result.table.standard.ja}（{result.table.edition.ja}）",
    )
    return (
        (Text("Work", "工事名"), same(work.work)),
        (Text("Work type", "工種"), result.work_type.name),
        (Text("Measured item", "測定項目"), MEASURED_ITEM),
        (Text("Client", "発注者"), same(work.client)),
        (Text("Contractor", "受注者"), same(work.contractor)),
        (Text("Part", "測点・範囲"), same(work.place)),
        (Text("Surveyor", "測定者"), same(work.surveyor)),
        (Text("Design", "設計データ"), _source(facts.design)),
        (Text("Measured data", "計測データ"), _source(facts.ground)),
        (Text("Measured on", "測定年月日"), day(facts.ground.measured_on)),
        (Text("Made on", "作成年月日"), day(work.made_on)),
        (Text("CRS", "座標系"), crs_words(work.crs)),
        (Text("Heights", "標高の基準"), same(work.height_datum) if work.height_datum else NOTHING),
        (Text("Standard", "適用基準"), standard),
        (Text("Software", "使用ソフトウェア"), same(work.software)),
    )


def face_rows(face: FaceResult, table: AsBuiltLimits) -> tuple[FormRow, ...]:
    """The lines of one face."""
    mean, single, verdicts = face.limits.mean.words(), face.limits.single.words(), face.verdicts
    least = math.ceil(table.density_per_m2 * face.area_m2 - 1e-6)
    most = math.floor(table.rejected_share * face.count + 1e-6)
    percent = f"{100 * table.rejected_share:g} %"
    empty = face.unmeasured_area_m2
    return (
        _length(Text("Mean", "平均値"), face.mean_m, mean, verdicts[FaceMeasure.MEAN]),
        _length(
            Text("Largest (difference)", "最大値（差）"),
            face.largest_m,
            single,
            verdicts[FaceMeasure.LARGEST],
        ),
        _length(
            Text("Smallest (difference)", "最小値（差）"),
            face.smallest_m,
            single,
            verdicts[FaceMeasure.SMALLEST],
        ),
        FormRow(
            Text("Number of data", "データ数"),
            face.count,
            _VALUES,
            _count(face.count, f"{face.density_per_m2:.2f}", Text("/m²", "点/m²")),
            Text(
                f"{table.density_per_m2:g} /m² or more ({least:,})",
                f"{table.density_per_m2:g} 点/m² 以上（{least:,} 点以上）",
            ),
            verdicts[FaceMeasure.DENSITY],
        ),
        FormRow(
            Text("Evaluated area", "評価面積"),
            round(face.area_m2, 1),
            _M2,
            Text.same(f"{face.area_m2:,.1f} m²"),
        ),
        FormRow(
            Text("Rejected points", "棄却点数"),
            face.rejected,
            _VALUES,
            _share(face.rejected, face.count, digits=2),
            Text(f"{percent} or less ({most:,})", f"{percent} 以下（{most:,} 点以下）"),
            verdicts[FaceMeasure.REJECTED],
        ),
        _within(face, 80, face.within_80),
        _within(face, 50, face.within_50),
        FormRow(
            Text("Area without data", "データのない面積"),
            round(empty, 1),
            _M2,
            Text(
                f"{empty:,.1f} m² ({100 * empty / face.area_m2:.1f} %)",
                f"{empty:,.1f} m²（{100 * empty / face.area_m2:.1f} %）",
            ),
        ),
    )


def notes(result: AsBuiltResult) -> tuple[Text, ...]:
    """What a reader of the form has to know."""
    table, rules = result.table, result.rules
    cell, margin = f"{rules.cell_m:g}", f"{100 * table.margin_m:g}"
    said = [
        Text(
            f"One value per {cell} m × {cell} m: the median of {result.points:,} points' height "
            "above the design in each cell; ground higher than the design is positive.",
            f"データは{cell} m × {cell} mのセルごとに1個（計測点 {result.points:,} 点の設計面との"
            "標高較差の中央値）。設計より高い場合を正とする。",
        ),
        Text(
            f"Slopes: design steeper than {100 * rules.slope_from:g} %, with berms up to "
            f"{rules.berm_m:g} m. Within ±{margin} cm of shoulders and toes nothing is judged.",
            f"設計勾配{100 * rules.slope_from:g} %以上を法面とし、幅{rules.berm_m:g} m以下の小段を"
            f"含む。法肩・法尻から±{margin} cm以内は評価しない。",
        ),
        Text(
            "Mean, largest and smallest are told without the rejected points, which lie beyond "
            "the limit of one value.",
            "平均値・最大値・最小値は棄却点（個々の値の規格値を超える点）を除く。",
        ),
    ]
    if any(face.limits.single.is_one_sided for face in result.faces):
        said.append(_ONE_SIDED)
    for face in result.faces:
        if face.rejected:
            high, low = (
                format_signed(1000 * value, 1)
                for value in (face.largest_of_all_m, face.smallest_of_all_m)
            )
            said.append(
                Text("{face}, with the rejected points: {low} … {high} mm.",
                     "{face}の棄却点を含む値: {low} … {high} mm")
                .filled(face=face.limits.name, low=low, high=high)
            )  # fmt: skip
    return tuple(said)


def _source(side: SideFacts) -> Text:
    names = " / ".join(dict.fromkeys(part for part in (side.name, side.source) if part))
    if side.count is None:
        return Text.same(names)
    return Text("{names} ({count})", "{names}（{count}）").filled(
        names=names, count=format_count(side)
    )


def _length(name: Text, value_m: float, limit: Text, passes: bool) -> FormRow:  # noqa: FBT001
    if math.isnan(value_m):
        return FormRow(name, value_m, _MM, NO_DATA, limit, passes)
    shown = Text.same(f"{format_signed(1000 * value_m, 1)} mm")
    return FormRow(name, round(1000 * value_m, 1), _MM, shown, limit, passes)


def _within(face: FaceResult, percent: int, count: int) -> FormRow:
    name = Text(f"Within ±{percent} % of limit", f"規格値の±{percent} %以内")
    return FormRow(name, count, _VALUES, _share(count, face.count, digits=1))


def _count(count: int, beside: str, unit: Text) -> Text:
    return Text("{count} ({beside} {unit})", "{count} 点（{beside} {unit}）").filled(
        count=f"{count:,}", beside=beside, unit=unit
    )


def _share(count: int, whole: int, *, digits: int) -> Text:
    if not whole:
        return Text("0", "0 点")
    return _count(count, f"{100 * count / whole:.{digits}f}", Text.same("%"))
