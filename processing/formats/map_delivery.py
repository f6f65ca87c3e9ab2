"""What writers of the map are given, and what can be chosen for them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from processing.core.monitor import Monitor
from processing.core.parameters import (
    ParameterChoice,
    ParameterValue,
    choice,
    count,
    file,
    fill_parameters,
    length,
    parameters_of,
    text,
)
from processing.core.text import Language, Text
from processing.formats.format import MAP
from processing.formats.work_facts import WorkFacts

if TYPE_CHECKING:  # the command line asks for the options alone
    from processing.map.catalogue import Catalogue
    from processing.map.feature import Feature
    from processing.recording.drive import Drive

OptionsT = TypeVar("OptionsT")
Position = Callable[[str], Path]
"""From a file's name to where it is written for the time being."""

_MOST_DIGITS = 9


# Any: as the declarations of processing.core.parameters.
def _encoding() -> Any:
    return choice(
        "utf-8",
        choices=(
            ParameterChoice("utf-8", Text.same("UTF-8")),
            ParameterChoice("cp932", Text.same("Shift_JIS (cp932)")),
        ),
        name=Text("Text of DXF, CSV and Shapefile", "DXF・CSV・Shapefileの文字コード"),
        explanation=Text(
            "Of a DXF, its version decides.", "DXFの文字コードはバージョンによって決まります。"
        ),
    )


# Any: as the declarations of processing.core.parameters.
def _digits() -> Any:
    return count(
        3,
        low=0,
        high=_MOST_DIGITS,
        name=Text("Decimals of coordinates", "座標の小数点以下の桁数"),
        explanation=Text("Of metres, in CSV and XLSX.", "CSV・XLSXに書き出す座標（m）の桁数です。"),
    )


# Any: as the declarations of processing.core.parameters.
def _layers() -> Any:
    return choice(
        "codes",
        choices=(
            ParameterChoice("codes", Text("Class codes", "分類コード（公共測量標準図式）")),
            ParameterChoice("cad", Text("CAD製図基準", "CAD製図基準")),
        ),
        name=Text("Layers of drawings", "図面のレイヤ"),
        explanation=Text(
            "Class codes: the layers of the catalogue, which can be edited.",
            "分類コードを選ぶと、カタログで定めたレイヤ（編集可）を使います。",
        ),
    )


@dataclass(frozen=True)
class DxfOptions:
    """What can be chosen for a drawing."""

    dxf_version: str = choice(
        "R2018",
        choices=(
            ParameterChoice("R2018", Text.same("DXF 2018 (UTF-8)")),
            ParameterChoice("R2007", Text.same("DXF 2007 (UTF-8)")),
            ParameterChoice("R2000", Text.same("DXF 2000 (Shift_JIS)")),
            ParameterChoice("R12", Text.same("DXF R12 (Shift_JIS)")),
        ),
        name=Text("Version of DXF", "DXFのバージョン"),
    )
    dxf_heights: str = choice(
        "3d",
        choices=(
            ParameterChoice("3d", Text("In space (3D)", "3次元（標高あり）")),
            ParameterChoice("2d", Text("In plan (2D)", "2次元（平面）")),
        ),
        name=Text("Heights of the DXF", "DXFの標高"),
        explanation=Text(
            "CAD programs draw line types on lines in plan alone.",
            "線種は2次元の線にだけ表示するCADがあります。",
        ),
    )
    drawing_layers: str = _layers()
    encoding: str = _encoding()


@dataclass(frozen=True)
class TableOptions:
    """What can be chosen for tables."""

    encoding: str = _encoding()
    digits: int = _digits()


@dataclass(frozen=True)
class WorkbookOptions:
    """What can be chosen for workbooks."""

    digits: int = _digits()


@dataclass(frozen=True)
class ShapefileOptions:
    """What can be chosen for Shapefiles."""

    encoding: str = _encoding()


@dataclass(frozen=True)
class DmOptions:
    """What can be chosen for the extended DM."""

    dm_accuracy: int = count(
        34,
        low=11,
        high=99,
        name=Text("Accuracy class of the DM", "DMの精度区分"),
        explanation=Text(
            "Tens: the method (2 total station, 3 plotting, 6 airborne lidar); units: the level"
            " (4: 500).",
            "十の位は作成方法（2 TS等、3 数値図化、6 航空レーザ）、"
            "一の位は地図情報レベル（4: 500）です。",
        ),
    )
    dm_company: str = text(name=Text("Survey company (DM)", "測量会社名（DM）"))
    dm_approval: str = text(name=Text("Approval number (DM)", "公共測量の承認番号（DM）"))


@dataclass(frozen=True)
class QualityOptions:
    """What can be chosen for the quality report."""

    check_points: str = file(
        name=Text("Check points (quality report)", "検証点（品質評価表）"),
        explanation=Text(
            "CSV with the columns id, easting_m, northing_m and, if known, height_m and kind.",
            "id・easting_m・northing_m（必要に応じてheight_m・kind）の列をもつCSVです。",
        ),
    )
    check_map: str = file(
        name=Text("Hand check (quality report)", "別途点検の図面（品質評価表）"),
        explanation=Text(
            "A map of part of the job that somebody drew separately: precision and recall of the"
            " map and of the tools are judged by it.",
            "業務範囲の一部を別に図化した図面です。これを正として、"
            "図面と自動抽出の適合率・再現率を求めます。",
        ),
    )
    map_level: str = choice(
        "500",
        choices=tuple(ParameterChoice(one, Text.same(one)) for one in ("250", "500", "1000")),
        name=Text("Map level of the check", "検証する地図情報レベル"),
    )


# Any: as the declarations of processing.core.parameters.
def _same_choices(default: str, names: tuple[str, ...], name: Text) -> Any:
    """Words that are called alike in every language."""
    choices = tuple(ParameterChoice(one, Text.same(one)) for one in names)
    return choice(default, choices=choices, name=name)


# Any: as the declarations of processing.core.parameters.
def _scales(default: str, names: tuple[str, ...], name: Text) -> Any:
    """Denominators of scales."""
    choices = tuple(ParameterChoice(one, Text.same(f"1:{one}")) for one in names)
    return choice(default, choices=choices, name=name)


# Any: as the declarations of processing.core.parameters.
def _paper() -> Any:
    name = Text("Paper of the sheets", "図面の用紙")
    return _same_choices("A1", ("A0", "A1", "A2", "A3"), name)


# Any: as the declarations of processing.core.parameters.
def _sheet_route() -> Any:
    return text(
        name=Text("Route of the sheets", "図面の路線名"),
        explanation=Text("Empty: every route.", "空欄のときは全路線です。"),
    )


# Any: as the declarations of processing.core.parameters.
def _sheet_title() -> Any:
    return text(
        name=Text("Drawing name", "図面名"),
        explanation=Text("Empty: the project's name.", "空欄のときはプロジェクト名です。"),
    )


# Any: as the declarations of processing.core.parameters.
def _sheet_heights() -> Any:
    return text(
        name=Text("Zero of heights (sheets)", "高さの基準（図面）"),
        explanation=Text("As T.P., JGD2024.", "例: T.P.（測地成果2024）"),
    )


# Any: as the declarations of processing.core.parameters.
def _section_pitch() -> Any:
    return length(20.0, low=1.0, high=1000.0, name=Text("From section to section", "横断図の間隔"))


# Any: as the declarations of processing.core.parameters.
def _section_stations() -> Any:
    return text(
        name=Text("Further stations", "追加する測点"),
        explanation=Text(
            "As 35.2 or No.1+15.20, with commas between.",
            "例: 35.2、No.1+15.20（カンマ区切り）",
        ),
    )


# Any: as the declarations of processing.core.parameters.
def _section_reach() -> Any:
    return length(10.0, low=1.0, high=100.0, name=Text("Reach to either side", "横断図の片側の幅"))


# Any: as the declarations of processing.core.parameters.
def _section_depth() -> Any:
    return length(
        0.5,
        low=0.05,
        high=5.0,
        name=Text("Depth of a section", "断面の奥行き"),
        explanation=Text(
            "Points so near together are drawn as the ground.",
            "この範囲の点から地盤線を求めます。",
        ),
    )


@dataclass(frozen=True)
class SheetOptions:
    """What can be chosen for drawing sheets, and what their title blocks say."""

    sheet_scale: str = _scales(
        "500", ("250", "500", "1000"), Text("Scale of the sheets", "図面の縮尺")
    )
    sheet_division: str = choice(
        "grid",
        choices=(
            ParameterChoice("grid", Text("Plain grid", "任意の格子")),
            ParameterChoice("map", Text("Grid of the public survey", "国土基本図の図郭")),
            ParameterChoice("route", Text("Along the route", "路線に沿って")),
        ),
        name=Text("Division into sheets", "図面の分割"),
        explanation=Text(
            "A sheet of the public survey's grid takes the paper A0; a route is a centre line.",
            "国土基本図の図郭にはA0が必要です。路線には中心線を使います。",
        ),
    )
    drawing_layers: str = _layers()
    sheet_paper: str = _paper()
    sheet_overlap: float = length(
        10.0,
        low=0.0,
        high=100.0,
        name=Text("Overlap along the route", "路線方向の重複"),
        explanation=Text(
            "Of a sheet and the next; the match line is in its middle.",
            "隣り合う図面の重複です。接合線はその中央に引きます。",
        ),
    )
    sheet_route: str = _sheet_route()
    sheet_title: str = _sheet_title()
    sheet_client: str = text(name=Text("Client (sheets)", "計画機関名（図面）"))
    sheet_maker: str = text(name=Text("Maker (sheets)", "作業機関名（図面）"))
    sheet_surveyor: str = text(name=Text("Surveyor (sheets)", "測量者（図面）"))
    sheet_date: str = text(name=Text("Date (sheets)", "年月日（図面）"))
    sheet_heights: str = _sheet_heights()


@dataclass(frozen=True)
class SectionOptions:
    """What can be chosen for sections along a route, and what their title blocks say."""

    section_scale: str = _scales(
        "100", ("50", "100", "200", "500"), Text("Scale of cross sections", "横断図の縮尺（横）")
    )
    section_height_scale: str = _scales(
        "100", ("50", "100", "200", "500"), Text("Scale of their heights", "横断図の縮尺（縦）")
    )
    profile_scale: str = _scales(
        "500",
        ("250", "500", "1000", "2500"),
        Text("Scale of the longitudinal section", "縦断図の縮尺（横）"),
    )
    profile_height_scale: str = _scales(
        "100", ("50", "100", "200", "500"), Text("Scale of its heights", "縦断図の縮尺（縦）")
    )
    section_pitch: float = _section_pitch()
    section_stations: str = _section_stations()
    section_reach: float = _section_reach()
    section_depth: float = _section_depth()
    sheet_paper: str = _paper()
    sheet_route: str = _sheet_route()
    sheet_title: str = _sheet_title()
    sheet_client: str = text(name=Text("Client (sheets)", "計画機関名（図面）"))
    sheet_maker: str = text(name=Text("Maker (sheets)", "作業機関名（図面）"))
    sheet_surveyor: str = text(name=Text("Surveyor (sheets)", "測量者（図面）"))
    sheet_date: str = text(name=Text("Date (sheets)", "年月日（図面）"))
    sheet_heights: str = _sheet_heights()
    encoding: str = _encoding()
    digits: int = _digits()


@dataclass(frozen=True)
class LandXmlOptions:
    """What can be chosen for LandXML."""

    landxml_form: str = _same_choices(
        "J-LandXML", ("J-LandXML", "LandXML"), Text("Form of LandXML", "LandXMLの形式")
    )
    sheet_route: str = _sheet_route()
    section_pitch: float = _section_pitch()
    section_stations: str = _section_stations()
    section_reach: float = _section_reach()
    section_depth: float = _section_depth()
    sheet_heights: str = _sheet_heights()


@dataclass(frozen=True)
class OpenDriveOptions:
    """What can be chosen for OpenDRIVE."""

    lane_pitch: float = length(
        5.0,
        low=0.5,
        high=100.0,
        name=Text("From width to width of lanes", "車線幅員の間隔"),
        explanation=Text(
            "Along the route; straight in between.",
            "路線に沿った間隔です。間は直線的に補間します。",
        ),
    )
    sheet_route: str = _sheet_route()


@dataclass(frozen=True)
class RoadModelOptions:
    """What can be chosen for the road model."""

    road_pitch: float = length(
        20.0,
        low=1.0,
        high=1000.0,
        name=Text("From station to station (road model)", "測点の間隔（道路モデル）"),
    )
    road_clearance: float = length(
        4.5,
        low=2.0,
        high=10.0,
        name=Text("Free over the carriageway", "車道の建築限界の高さ"),
        explanation=Text(
            "Road Structure Ordinance, article 12: 4.5 m.", "道路構造令第12条では4.5 mです。"
        ),
    )
    walk_clearance: float = length(
        2.5,
        low=1.2,
        high=10.0,
        name=Text("Free over walks", "歩道の建築限界の高さ"),
        explanation=Text(
            "Road Structure Ordinance, article 12: 2.5 m.", "道路構造令第12条では2.5 mです。"
        ),
    )
    encoding: str = _encoding()


@dataclass(frozen=True)
class DeliveryOptions:
    """What the program can't know of a survey; the rest is that of the project's work details."""

    delivery_start: str = text(
        name=Text("Begin of the work (delivery)", "履行期間の着手（電子納品）"),
        explanation=Text("As 2026-04-01.", "例: 2026-04-01"),
    )
    delivery_end: str = text(
        name=Text("End of the work (delivery)", "履行期間の完了（電子納品）"),
        explanation=Text("As 2027-03-31.", "例: 2027-03-31"),
    )
    delivery_area: str = text(name=Text("Area surveyed (delivery)", "測量区域・地区名（電子納品）"))
    delivery_advice: str = text(
        name=Text("Number of GSI's advice (delivery)", "助言番号（電子納品）"),
        explanation=Text(
            "As R08A0001: the metadata's name. Empty: META0001.",
            "メタデータのファイル名にします（例: R08A0001）。空欄のときはMETA0001です。",
        ),
    )
    delivery_folder: str = text(
        name=Text("Folder of the survey (delivery)", "測量細区分フォルダ名（電子納品）"),
        explanation=Text(
            "As the edition calls it; empty: ZUKA_A.",
            "適用する要領で定める名前です。空欄のときはZUKA_A（図化）です。",
        ),
    )
    delivery_edition: str = text(
        name=Text("Edition (delivery)", "適用要領基準（電子納品）"),
        explanation=Text(
            "As the client asks for it, such as 測量202103-01; it is written as it is.",
            "発注者が指定する値です（例: 測量202103-01）。入力どおりに記載します。",
        ),
    )
    delivery_dtds: str = file(
        name=Text("DTD of the edition (delivery)", "要領のDTD（電子納品）"),
        explanation=Text(
            "One of the ministry's files; those beside it are taken too, and the management files"
            " are checked by them.",
            "国土交通省が公開するDTDを1つ選ぶと、同じフォルダのDTDも格納し、"
            "管理ファイルを検査します。",
        ),
    )


def tell_nobody(_note: Text) -> None:
    """Leave it unsaid."""


def _no_points(_position: Position, _monitor: Monitor) -> None:
    """Write nothing: the map was given without drives."""


@dataclass(frozen=True)
class MapDelivery:
    """A map as it is handed in.

    Attributes
    ----------
    features : tuple of Feature
        In the order in which they are written.
    crs : str
        ``EPSG:n``; empty where it is not known, which the file then says.
    language : "en", "ja" or None
        Of headers of tables; None for their ids.
    options : mapping of str to value
        What was chosen, by the ids of :meth:`FormatList.map_options`; defaults for the rest.
    drives : tuple of Drive
        In which sections are cut.
    write_points : callable
        Writes the points of the drives with their labels.
    every_feature : tuple of Feature
        Those handed in and those that aren't, for reports on the work.
    name : str
        What files are named after that hold the whole map: the project's name.
    tell : callable
        Takes sentences about what a file holds otherwise than the map has it: features that the
        format has no place for, characters that were replaced.
    work : WorkFacts
        What papers say of the work; empty where the map is of no project.
    """

    features: tuple[Feature, ...]
    catalogue: Catalogue
    crs: str
    language: Language | None = None
    options: Mapping[str, ParameterValue] = field(default_factory=dict)
    write_points: Callable[[Position, Monitor], None] = _no_points
    drives: tuple[Drive, ...] = ()
    every_feature: tuple[Feature, ...] = ()
    name: str = MAP
    tell: Callable[[Text], None] = tell_nobody
    work: WorkFacts = field(default_factory=WorkFacts)

    def options_of(self, options: type[OptionsT]) -> OptionsT:
        """What was chosen for a format.

        Raises
        ------
        OutOfRange
            A value outside its limits.
        """
        known = {one.id for one in parameters_of(options)}
        chosen = {id_: value for id_, value in self.options.items() if id_ in known}
        return fill_parameters(options, chosen)
