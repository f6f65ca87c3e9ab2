"""Layers of what surrounds the map on a sheet, by the codes of marginal information.

Lines are 79xx (応用測量整飾), words 82xx (測量記録等) of 公共測量標準図式. What has no code
there is called by its name alone. A client that asks for the layers of CAD製図基準 gets those in
their stead, the map's too.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

from processing.formats.drawings.sxf_looks import FRAME_LAYER, TITLE_LAYER
from processing.formats.sheets.paper_shapes import PaperShape

BORDER = "7901_図枠外枠"
WINDOW = "7902_図枠内枠"
TITLE_BOX, TITLE_RULES = "7903_タイトル外枠", "7904_タイトル罫線"
LEGEND_BOX = "7905_凡例外枠"
KEY_BOX, KEY_LINES = "7907_作表外枠", "7908_作表罫線"
GRID_TICKS, GRID_CROSSES = "7911_方眼線", "7912_方眼点"
NORTH = "7913_方位"
TITLE, SCALE, DISTRICT = "8201_図面タイトル", "8202_図面縮尺", "8203_地区名"
CLIENT, MAKER, DATE = "8204_計画機関名", "8205_作業機関名", "8206_作成年月日"
TITLE_WORDS, LEGEND_WORDS, KEY_WORDS = "8207_タイトル文字", "8208_凡例文字", "8209_作表文字"
GRID_WORDS, NORTH_WORDS = "8211_方眼座標値", "8212_方位"
SYSTEM = "8266_座標系"
SCALE_BAR, SCALE_WORDS = "縮尺", "縮尺_文字"
MATCH_LINE, MATCH_WORDS = "接合線", "接合線_文字"

VIEWPORT = "S-TTL-VPRT"
"""Of the edges of windows to the model space; not printed."""

_CAD_BOX, _CAD_RULES = FRAME_LAYER, "S-TTL-LINE"

CAD_LAYERS: Mapping[str, str] = {
    BORDER: _CAD_BOX,
    WINDOW: _CAD_BOX,
    **dict.fromkeys(
        (
            TITLE_BOX, TITLE_RULES, LEGEND_BOX, KEY_BOX, KEY_LINES, GRID_TICKS, GRID_CROSSES,
            NORTH, SCALE_BAR, MATCH_LINE,
        ),
        _CAD_RULES,
    ),
    **dict.fromkeys(
        (
            TITLE, SCALE, DISTRICT, CLIENT, MAKER, DATE, TITLE_WORDS, LEGEND_WORDS, KEY_WORDS,
            GRID_WORDS, NORTH_WORDS, SYSTEM, SCALE_WORDS, MATCH_WORDS,
        ),
        TITLE_LAYER,
    ),
}  # fmt: skip
"""The layer of CAD製図基準 for each."""


def is_of_paper(layer: str) -> bool:
    """Whether a layer holds what surrounds the map."""
    return layer in CAD_LAYERS or layer in CAD_LAYERS.values()


def on_cad_layers(shapes: Iterable[PaperShape]) -> tuple[PaperShape, ...]:
    """Shapes of the paper on the layers of CAD製図基準; those of the map stay on theirs."""
    return tuple(
        replace(one, pen=replace(one.pen, layer=CAD_LAYERS.get(one.pen.layer, one.pen.layer)))
        for one in shapes
    )
