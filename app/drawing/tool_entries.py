"""The mouse tools and the snaps as the menu shows them: names, keys, icons, hints."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from processing.core.text import Text
from widgets.shared.snap_state import SnapMode


@dataclass(frozen=True)
class ToolEntry:
    """A tool of the toolbox as the menu shows it."""

    name: str
    text: Text
    key: str
    icon: str
    hint: Text
    toolbar: int = 3
    menu: str = "draw"


TOOL_ENTRIES: tuple[ToolEntry, ...] = (
    ToolEntry(
        "select",
        Text("Pointer", "選択"),
        "S",
        "mdi6.cursor-default-outline",
        Text(
            "Click to choose, drag a box, Shift adds; drag a vertex of what is chosen.",
            "クリックで選択、ドラッグで矩形選択、Shiftで追加。選択した地物の頂点はドラッグで移動。",
        ),
    ),
    ToolEntry(
        "lasso",
        Text("Lasso", "投げ縄選択"),
        "Shift+S",
        "mdi6.lasso",
        Text("Draw round what is to be chosen.", "囲んで選択します。"),
        toolbar=0,
    ),
    ToolEntry(
        "point",
        Text("Point", "点"),
        "P",
        "mdi6.map-marker-outline",
        Text(
            "Click a point; drag to where a sign faces or a lamp reaches.",
            "点をクリックします。ドラッグすると標識や照明の向きになります。",
        ),
    ),
    ToolEntry(
        "line",
        Text("Line", "線"),
        "L",
        "mdi6.vector-polyline",
        Text(
            "Click vertices; Enter ends, Backspace takes back, Shift: straight on, Ctrl: no snap.",
            "頂点をクリック。Enterで終了、Backspaceで戻る、Shiftで方向固定、Ctrlでスナップなし。",
        ),
    ),
    ToolEntry(
        "trace",
        Text("Trace", "追跡"),
        "T",
        "mdi6.vector-curve",
        Text(
            "Click start and end of a curb, wall foot or marking; drag the line where it is wrong.",
            "縁石・壁の下端・標示の始点と終点をクリック。外れた所はドラッグで直します。",
        ),
    ),
    ToolEntry(
        "arc",
        Text("Arc", "円弧"),
        "Shift+A",
        "mdi6.vector-radius",
        Text(
            "Goes on with an arc over a click to another.",
            "通過点と終点をクリックして円弧を描きます。",
        ),
        toolbar=0,
    ),
    ToolEntry(
        "spline",
        Text("Spline", "スプライン"),
        "Shift+L",
        "mdi6.vector-bezier",
        Text(
            "Goes on with a smooth curve through all clicks.",
            "クリックした点を通る滑らかな曲線を描きます。",
        ),
        toolbar=0,
    ),
    ToolEntry(
        "area",
        Text("Area", "面"),
        "A",
        "mdi6.vector-polygon",
        Text("Click corner by corner; Enter closes it.", "角を順にクリックし、Enterで閉じます。"),
    ),
    ToolEntry(
        "rectangle",
        Text("Rectangle by three points", "3点の矩形"),
        "R",
        "mdi6.vector-rectangle",
        Text(
            "Two corners of a side, then the width: lids, gratings, square manholes.",
            "1辺の両端と幅をクリックします（側溝蓋・グレーチング・角形マンホール）。",
        ),
    ),
    ToolEntry(
        "circle",
        Text("Circle by three points", "3点の円"),
        "Shift+R",
        "mdi6.vector-circle-variant",
        Text(
            "Three places on the rim; a point gets the middle and the diameter.",
            "円周上の3点をクリックします。点の地物では中心と直径になります。",
        ),
        toolbar=0,
    ),
    ToolEntry(
        "row",
        Text("Row of lids", "側溝蓋の列"),
        "Shift+G",
        "mdi6.view-column-outline",
        Text(
            "Click the first and the last lid, or one gap: lids are laid as those beside them.",
            "最初と最後の蓋の中心、または1枚分の隙間をクリックすると、周囲の蓋に合わせて配置します。",
        ),
        toolbar=0,
    ),
    ToolEntry(
        "parallel",
        Text("Parallel copy", "平行複写"),
        "O",
        "mdi6.arrow-split-vertical",
        Text(
            "Click a line, then where its copy is to run.",
            "線、次に複写する位置をクリックします。",
        ),
    ),
    ToolEntry(
        "edit",
        Text("Edit vertices", "頂点編集"),
        "V",
        "mdi6.vector-polyline-edit",
        Text(
            "Drag a vertex; press on a segment to put one in; Delete takes one out.",
            "頂点をドラッグで移動、辺を押すと挿入、Deleteでマウス下の頂点を削除します。",
        ),
        toolbar=4,
    ),
    ToolEntry(
        "move",
        Text("Move or copy features", "地物の移動・複写"),
        "G",
        "mdi6.cursor-move",
        Text(
            "Drag what is chosen; with Ctrl a copy.",
            "選択した地物をドラッグで移動、Ctrlで複写します。",
        ),
        toolbar=0,
    ),
    ToolEntry(
        "split",
        Text("Split a line", "線の分割"),
        "X",
        "mdi6.content-cut",
        Text("Click where the line is to be two.", "線を分ける位置をクリックします。"),
        toolbar=0,
        menu="edit/lines",
    ),
    ToolEntry(
        "extend",
        Text("Extend a line to another", "線を他の線まで延伸"),
        "Shift+X",
        "mdi6.arrow-expand-right",
        Text(
            "Click near the end of a line, then the line up to which it goes on.",
            "延ばす線の端の近く、次に延伸先の線をクリックします。",
        ),
        toolbar=0,
        menu="edit/lines",
    ),
    ToolEntry(
        "trim",
        Text("Trim lines at another", "線を他の線で切り取り"),
        "Shift+T",
        "mdi6.scissors-cutting",
        Text(
            "Click the line that cuts, then the parts to keep.",
            "境界となる線、次に残す部分をクリックします。",
        ),
        toolbar=0,
        menu="edit/lines",
    ),
    ToolEntry(
        "measure",
        Text("Measure", "計測"),
        "M",
        "mdi6.ruler",
        Text(
            "Distance, height difference, slope, length and angle by clicks.",
            "距離・高低差・勾配・延長・角度をクリックで計測します。",
        ),
        toolbar=4,
    ),
    ToolEntry(
        "measure-area",
        Text("Measure an area", "面積の計測"),
        "Shift+M",
        "mdi6.ruler-square",
        Text("Area and perimeter by clicks.", "面積と周長をクリックで計測します。"),
        toolbar=0,
    ),
    ToolEntry(
        "paint-brush",
        Text("Paint labels", "ラベルを塗る"),
        "U",
        "mdi6.brush",
        Text(
            "Drag over points to give them the chosen class; [ and ] change the brush.",
            "点の上をドラッグして、選んだクラスのラベルを付けます。[ と ] でブラシの大きさを変更。",
        ),
        toolbar=4,
        menu="draw/labels",
    ),
    ToolEntry(
        "paint-rectangle",
        Text("Label a rectangle", "矩形内にラベルを付ける"),
        "Shift+U",
        "mdi6.select-drag",
        Text(
            "All measured points inside a box that is dragged.",
            "ドラッグした矩形内のすべての計測点にラベルを付けます。",
        ),
        toolbar=0,
        menu="draw/labels",
    ),
    ToolEntry(
        "paint-lasso",
        Text("Label inside a lasso", "投げ縄内にラベルを付ける"),
        "Ctrl+U",
        "mdi6.lasso",
        Text(
            "Draw round the points to label, in the image, the section, 3D or on the map.",
            "画像・断面・3D・地図で、ラベルを付ける点を囲みます。",
        ),
        toolbar=0,
        menu="draw/labels",
    ),
    ToolEntry(
        "paint-segment",
        Text("Label segments", "セグメントにラベルを付ける"),
        "Y",
        "mdi6.auto-fix",
        Text(
            "Click a segment, or drag over several: each is labelled as a whole.",
            "セグメントをクリック、またはドラッグして、触れたセグメント全体にラベルを付けます。",
        ),
        toolbar=0,
        menu="draw/labels",
    ),
    ToolEntry(
        "template",
        Text("Draw a template", "テンプレートを描く"),
        "",
        "mdi6.vector-polyline",
        Text(
            "Click the wanted profile in the section, the vertex where the line belongs first.",
            "断面にあるべき形を描きます。線を作成する位置の頂点を最初にクリックします。",
        ),
        toolbar=0,
        menu="draw/templates",
    ),
    ToolEntry(
        "template-zone",
        Text("Draw an empty zone", "空白域を描く"),
        "",
        "mdi6.vector-polygon",
        Text(
            "Draw round where the template has no points.",
            "テンプレートで点があってはならない範囲を囲みます。",
        ),
        toolbar=0,
        menu="draw/templates",
    ),
)

SNAP_HINTS: Mapping[SnapMode, Text] = {
    SnapMode.VERTEX: Text("Vertices that are drawn.", "作図済みの頂点。"),
    SnapMode.CROSSING: Text("Where lines cross in plan.", "線どうしの交点。"),
    SnapMode.LINE: Text(
        "The nearest place on a line, or square to it from the last vertex.",
        "線上の最も近い位置、または最後の頂点からの垂線の足。",
    ),
    SnapMode.EXTENSION: Text("Straight on beyond a line's end.", "線の端の先の延長上。"),
    SnapMode.LOWEST: Text(
        "The lowest point in the mouse's circle: gutter bottoms.",
        "カーソル円内の最低点（側溝の底など）。",
    ),
    SnapMode.HIGHEST: Text(
        "The highest point in the mouse's circle: tops of walls.",
        "カーソル円内の最高点（壁の上端など）。",
    ),
    SnapMode.EDGE: Text(
        "The strongest bend of the surface beside the mouse: curb edges, wall feet.",
        "カーソル付近で面が最も強く折れる所（縁石の縁、壁の下端など）。",
    ),
}
