"""How a volume is to be had: the parameters of the tool VOLUME."""

from __future__ import annotations

from dataclasses import dataclass

from processing.core.parameters import ParameterChoice, choice, file, length, switch, text
from processing.core.text import Text

GRID, TIN, END_AREA, PRISMOIDAL = "grid", "tin", "end-area", "prismoidal"


@dataclass(frozen=True)
class VolumeParameters:
    """How earth between two grounds is counted; the defaults suit scans from tripods."""

    method: str = choice(
        GRID,
        choices=(
            ParameterChoice(GRID, Text("Grid", "点高法（格子）")),
            ParameterChoice(TIN, Text("TIN against TIN", "TIN対TIN（プリズモイダル法）")),
            ParameterChoice(END_AREA, Text("Average end area", "平均断面法")),
            ParameterChoice(
                PRISMOIDAL, Text("Prismoidal, by sections", "断面法（プリズモイダル公式）")
            ),
        ),
        name=Text("Method", "方法"),
        explanation=Text(
            "Grid sums cells and tells change from noise. TIN against TIN is exact between two "
            "triangulated surfaces and keeps break lines. The other two go along a line, as a "
            "check by hand does.",
            "「点高法」は格子ごとの高低差を合計し、計測ノイズと実際の変化を区別します。"
            "「TIN対TIN」は2つの三角網の間を厳密に計算し、ブレークラインを保ちます。"
            "ほかの2つは測線に沿った断面による従来の検算です。",
        ),
    )
    grid_m: float = length(
        0.2,
        low=0.05,
        high=0.5,
        name=Text("Mesh", "格子間隔"),
        explanation=Text(
            "Side of a cell; half a metre at most (土木工事数量算出要領).",
            "格子の一辺の長さです。0.5m以下とします（土木工事数量算出要領）。",
        ),
    )
    correct_shift: bool = switch(
        default=False,
        name=Text("Correct a shift between the epochs", "時期間のずれを補正"),
        explanation=Text(
            "Moves the later epoch onto the earlier one by ground that didn't change. The shift "
            "is reported in any case.",
            "変化していない地面を基準に、後の時期を前の時期に合わせます。"
            "ずれの量は常に報告されます。",
        ),
    )
    interval_m: float = length(
        5.0,
        low=0.1,
        high=100.0,
        name=Text("Distance of sections", "断面間隔"),
        explanation=Text(
            "Between cross-sections along the line, for the methods by sections.",
            "断面による方法で、測線に沿って断面をとる間隔です。",
        ),
    )
    half_width_m: float = length(
        30.0,
        low=0.5,
        high=500.0,
        name=Text("Half width of sections", "断面の片側幅"),
        explanation=Text(
            "How far a cross-section reaches to each side of the line.",
            "断面が測線から左右に届く距離です。",
        ),
    )
    boundary: str = file(
        name=Text("Boundary", "境界"),
        explanation=Text(
            "A file with the polygon that is counted: GeoJSON, GeoPackage or DXF; FILE#LAYER "
            "where it has polygons on several layers. Empty counts all ground that both sides "
            "have.",
            "計算範囲の多角形のファイルです（GeoJSON・GeoPackage・DXF）。複数のレイヤに多角形が"
            "ある場合は「ファイル#レイヤ名」とします。"
            "空欄では両方に地面がある範囲全体を計算します。",
        ),
    )
    line: str = file(
        name=Text("Line of sections", "断面の測線"),
        explanation=Text(
            "A file with the line that sections stand on: GeoJSON, GeoPackage or DXF. Empty takes "
            "the longer middle line of the area.",
            "断面をとる測線のファイルです（GeoJSON・GeoPackage・DXF）。"
            "空欄では範囲の長い方の中心線とします。",
        ),
    )
    break_lines: str = file(
        name=Text("Break lines", "ブレークライン"),
        explanation=Text(
            "A file with lines that are edges of the triangles, for TIN against TIN.",
            "「TIN対TIN」で三角形の辺とする線のファイルです。",
        ),
    )
    map: str = file(
        name=Text("Map of change", "高低差図"),
        explanation=Text(
            "A GeoTIFF (.tif) for the change of height. Empty writes none.",
            "高低差を書き出すGeoTIFF（.tif）です。空欄では書き出しません。",
        ),
    )
    report: str = file(
        name=Text("Report", "土量計算書"),
        explanation=Text(
            "The volume report as .pdf, .xlsx or .csv. Empty writes none.",
            "土量計算書を書き出すファイルです（.pdf・.xlsx・.csv）。空欄では書き出しません。",
        ),
    )
    form: str = file(
        name=Text("As-built form", "出来形管理様式"),
        explanation=Text(
            "Form 31-2 as .pdf, .xlsx or .csv, where points are compared with a design. Empty "
            "writes none.",
            "様式-31-2を書き出すファイルです（.pdf・.xlsx・.csv）。点群と設計面を比較する場合に"
            "使えます。空欄では書き出しません。",
        ),
    )
    work_type: str = text(
        name=Text("Work type", "工種"),
        explanation=Text(
            "Id of the work type whose limits the form judges by, as the table of limits has it. "
            "Empty takes the one that the project has, or the only one of the table.",
            "様式の判定に用いる工種のidです（規格値表の記載による）。空欄ではプロジェクトの工種、"
            "または表にある唯一の工種とします。",
        ),
    )
    limits: str = file(
        name=Text("Table of limits", "規格値表"),
        explanation=Text(
            "An office's own table of limits (.toml). Empty takes the one that the project has, "
            "or that comes with the program.",
            "事務所独自の規格値表（.toml）です。空欄ではプロジェクトの表、または標準の表とします。",
        ),
    )
    work: str = file(
        name=Text("Work details", "工事情報"),
        explanation=Text(
            "A file (.toml) with what papers say of the work: work, place, client, contractor, "
            "surveyor, height_datum. Empty takes what the project has.",
            "帳票に記載する工事の情報のファイル（.toml）です。項目はwork・place・client・"
            "contractor・surveyor・height_datumです。空欄ではプロジェクトの情報とします。",
        ),
    )
