"""The words of the volume report (土量計算書): the same on paper and in tables."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

from shapely.geometry.base import BaseGeometry

from processing.core.text import Text
from processing.formats.work_facts import (
    NOTHING,
    SideFacts,
    WorkFacts,
    crs_words,
    day,
    format_count,
    format_signed,
)
from processing.methods.earthwork.sections.drawing_parts import SectionedLine
from processing.methods.earthwork.volumes.volume_result import Registration, VolumeResult

TITLE = Text("Volume report", "土量計算書")
BEFORE, AFTER = Text("Before", "変化前"), Text("After", "変化後")
SURFACE_COLUMNS = (
    Text("Surface", "地盤面"),
    Text("Name", "名称"),
    Text("Date", "年月日"),
    Text("File", "データ"),
    Text("Count", "点数・面数"),
)
QUANTITY_COLUMNS = (
    Text("Quantity", "項目"),
    Text("Whole", "全体"),
    Text("Where both were measured", "両方の計測がある範囲"),
    Text("Unit", "単位"),
)
SECTION_COLUMNS = (
    Text("Station", "測点"),
    Text("Distance (m)", "距離 (m)"),
    Text("Cut (m²)", "切土断面積 (m²)"),
    Text("Cut (m³)", "切土量 (m³)"),
    Text("Fill (m²)", "盛土断面積 (m²)"),
    Text("Fill (m³)", "盛土量 (m³)"),
)
TOTAL, REMARKS = Text("Total", "合計"), Text("Remarks", "備考")
MAP_TITLE = Text("Map of change (after − before)", "変化量分布図（変化後 − 変化前）")
CUT, FILL = Text("Cut", "切土量"), Text("Fill", "盛土量")

_METHODS: Mapping[str, Text] = {
    "grid": Text("Grid of cells (point height method)", "点高法（メッシュ法）"),
    "tin": Text("TIN against TIN, exact (prismoidal)", "TIN×TIN（プリズモイダル法・厳密解）"),
    "end-area": Text("Average end areas along a line", "平均断面法"),
    "prismoidal": Text(
        "Prismoidal formula along a line, L/6 (A1 + 4Am + A2)",
        "角柱公式（プリズモイダル公式・断面法）L/6 (A1 + 4Am + A2)",
    ),
}
_UNCERTAINTY = Text(
    "Cut, fill and net are each expected to lie within ± {value} m³ of what is stated, in 95 of "
    "100 cases. This allows for the noise of the points, their density, and filled holes.",
    "切土量・盛土量・差引土量の真値は、それぞれ表の値の ± {value} m³ 以内にある見込み（信頼水準"
    "95 %）。点群のばらつき、点密度、補間した範囲を考慮した値。",
)
_NO_REGISTRATION = Text(
    "The position of the two surfaces was not compared on unchanged ground.",
    "不動域での位置合わせの確認は行っていない。",
)
_SHIFT = Text(
    "On {area} m² of unchanged ground the later epoch lies off by east {east}, north {north}, "
    "up {up} m (standard deviations {sure} m).",
    "不動域 {area} m² で、後の計測は東 {east} m、北 {north} m、上 {up} m ずれている"
    "（標準偏差 {sure} m）。",
)
_CORRECTED = Text("It was moved back by this.", "このずれは補正した。")
_NOT_NEEDED = Text(
    "This is within chance and was not corrected.", "偶然の範囲のため補正していない。"
)
_NOT_CORRECTED = Text(
    "This is more than chance; it was not corrected.",
    "偶然の範囲を超えるが、補正していない。",
)


@dataclass(frozen=True)
class VolumeFacts:
    """What the report says besides the result.

    Attributes
    ----------
    before, after : SideFacts
        The two surfaces; a design is one too.
    boundary : str
        Name of the boundary or of its file; empty where all ground that both have counts.
    line : SectionedLine or None
        Sections across a line, where the method is along one, or as figures.
    between : tuple of (float, float)
        Cut and fill told at each section but the first, m³; NaN at one that is halfway only.
        Empty: mean of the areas at both ends times the distance.
    area : shapely geometry or None
        The boundary, m, project CRS: drawn on the map.
    figures : SectionedLine or None
        Sections that only show the ground, where none were needed for the volume.
    """

    work: WorkFacts
    before: SideFacts
    after: SideFacts
    boundary: str = ""
    line: SectionedLine | None = None
    between: tuple[tuple[float, float], ...] = ()
    area: BaseGeometry | None = None
    figures: SectionedLine | None = None


@dataclass(frozen=True)
class SectionRow:
    """A section, and the earth from the one before it to it; NaN at the first."""

    name: str
    distance_m: float
    cut_m2: float
    cut_m3: float
    fill_m2: float
    fill_m3: float


@dataclass(frozen=True)
class Quantity:
    """A number of the report; NaN where it isn't told for the measured part alone."""

    name: Text
    whole: float
    measured: float
    unit: str


def work_rows(facts: VolumeFacts) -> tuple[tuple[Text, Text], ...]:
    """The work and the reference system: names and values."""
    work, same = facts.work, Text.same
    return (
        (Text("Work", "工事名"), same(work.work)),
        (Text("Client", "発注者"), same(work.client)),
        (Text("Contractor", "受注者"), same(work.contractor)),
        (Text("Part", "測点・範囲"), same(work.place)),
        (Text("Surveyor", "測定者"), same(work.surveyor)),
        (Text("CRS", "座標系"), crs_words(work.crs)),
        (Text("Heights", "標高の基準"), same(work.height_datum) if work.height_datum else NOTHING),
        (Text("Made on", "作成年月日"), day(work.made_on)),
        (Text("Software", "使用ソフトウェア"), same(work.software)),
    )


def method_rows(result: VolumeResult, facts: VolumeFacts) -> tuple[tuple[Text, Text], ...]:
    """How the volume was had: names and values."""
    known = _METHODS.get(result.method, Text.same(result.method))
    mesh = Text.same(f"{result.grid_m:g} m × {result.grid_m:g} m")
    mesh_name = Text("Mesh", "メッシュ")
    if result.method != "grid":
        mesh_name = Text("Mesh of the map", "分布図のメッシュ")
    everywhere = Text("where both surfaces are", "両地盤面が重なる全範囲")
    return (
        (Text("Method", "計算方法"), known),
        (mesh_name, mesh),
        (Text("Boundary", "計算範囲"), Text.same(facts.boundary) if facts.boundary else everywhere),
    )


def surface_rows(facts: VolumeFacts) -> tuple[tuple[Text, ...], ...]:
    """Both surfaces, in the order of :data:`SURFACE_COLUMNS`."""
    return tuple(
        (
            name,
            Text.same(side.name),
            day(side.measured_on),
            Text.same(side.source) if side.source else NOTHING,
            format_count(side),
        )
        for name, side in ((BEFORE, facts.before), (AFTER, facts.after))
    )


def quantities(result: VolumeResult) -> tuple[Quantity, ...]:
    """The numbers of the report."""
    reported, nan = result.volumes, math.nan
    measured_net = reported.measured_fill_m3 - reported.measured_cut_m3
    measured_area = reported.area_m2 - reported.unmeasured_area_m2
    return (
        Quantity(CUT, reported.cut_m3, reported.measured_cut_m3, "m³"),
        Quantity(FILL, reported.fill_m3, reported.measured_fill_m3, "m³"),
        Quantity(
            Text("Net (fill − cut)", "差引土量（盛土 − 切土）"), reported.net_m3, measured_net, "m³"
        ),
        Quantity(Text("Uncertainty (±)", "不確かさ（±）"), reported.uncertainty_m3, nan, "m³"),
        Quantity(Text("Area", "対象面積"), reported.area_m2, measured_area, "m²"),
        Quantity(
            Text("Area without data", "データのない面積"), reported.unmeasured_area_m2, nan, "m²"
        ),
        Quantity(
            Text("Of it left out", "うち計算から除外した面積"), reported.left_out_area_m2, nan, "m²"
        ),
    )


def format_value(quantity: Quantity, value: float) -> str:
    """A number as it is printed."""
    if math.isnan(value):
        return "—"
    if quantity.name.en.startswith("Net"):
        return format_signed(value, 1)
    return f"{value:,.1f}"


def section_rows(facts: VolumeFacts) -> tuple[SectionRow, ...]:
    """The sections of the line in its order; none where there is no line."""
    if facts.line is None or not facts.line.sections:
        return ()
    sections = facts.line.sections
    between = facts.between or tuple(
        (
            0.5 * (one.cut_m2 + other.cut_m2) * (other.station_m - one.station_m),
            0.5 * (one.fill_m2 + other.fill_m2) * (other.station_m - one.station_m),
        )
        for one, other in pairwise(sections)
    )
    nan = math.nan
    first = sections[0]
    rows = [SectionRow(first.name, nan, first.cut_m2, nan, first.fill_m2, nan)]
    for (one, other), (cut, fill) in zip(pairwise(sections), between, strict=True):
        distance = other.station_m - one.station_m
        rows.append(SectionRow(other.name, distance, other.cut_m2, cut, other.fill_m2, fill))
    return tuple(rows)


def section_sums(rows: Sequence[SectionRow]) -> tuple[float, float, float]:
    """Distance, cut and fill of all sections together: m, m³, m³."""
    return (
        _sum(row.distance_m for row in rows),
        _sum(row.cut_m3 for row in rows),
        _sum(row.fill_m3 for row in rows),
    )


def class_digits(limit_m: float) -> int:
    """Digits behind the point that the steps of :func:`change_classes` need."""
    return max(2 - math.floor(math.log10(limit_m) + 1e-9), 2)


def remarks(result: VolumeResult) -> tuple[Text, ...]:
    """What a reader of the numbers has to know: how sure they are, how the epochs fit, notes."""
    value = f"{result.volumes.uncertainty_m3:,.1f}"
    return (
        _UNCERTAINTY.filled(value=value),
        *_registration(result.registration),
        *result.notes,
    )


def _registration(found: Registration | None) -> tuple[Text, ...]:
    if found is None:
        return (_NO_REGISTRATION,)
    east, north, up = (format_signed(value, 3) for value in found.shift_m)
    sure = ", ".join(f"{value:.3f}" for value in found.sure_m)
    shift = _SHIFT.filled(
        area=f"{found.stable_area_m2:,.0f}", east=east, north=north, up=up, sure=sure
    )
    done = _NOT_CORRECTED if found.is_significant else _NOT_NEEDED
    done = _CORRECTED if found.is_corrected else done
    return (Text(f"{shift.en} {done.en}", f"{shift.ja}{done.ja}"),)


def _sum(values: Iterable[float]) -> float:
    return math.fsum(value for value in values if not math.isnan(value))
